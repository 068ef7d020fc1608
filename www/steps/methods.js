/** The ways in which a target can follow. */
export const METHODS = [
  ['bones', 'Sinew', 'The source’s near-rigid bones, found on the target by the weights of the points, and set joint on joint.'],
  ['direct', 'Direct, as in the paper', 'The maps of the source’s points, as they are (§3.6).'],
  ['relative', 'Relative', 'About the target’s own points, with their way scaled to its size.'],
];
