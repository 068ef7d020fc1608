/** The ways in which a target can follow. */
export const METHODS = [
  ['bones', 'Sinew', 'The source’s near-rigid bones. The target, bent onto the source, tells where on it they are; they are set joint on joint.'],
  ['direct', 'Direct, as in the paper', 'The maps of the source’s points, as they are (§3.6).'],
  ['relative', 'Relative', 'About the target’s own points, with their way scaled to its size.'],
  ['gradients', 'Gradients', 'What each face of the source does, asked of the target’s faces (Sumner and Popović 2004).'],
  ['posed', 'Gradients, posed', 'The same, after the target’s parts were turned into the posture of the source: for arms out and arms down.'],
];
