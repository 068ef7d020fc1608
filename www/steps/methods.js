/** The ways in which a target can follow. */
export const METHODS = [
  ['biharmonic', 'Sinew', 'The points of the paper and more between them, matched by their weights.'],
  ['direct', 'Direct, as in the paper', 'The maps of the source’s points, as they are (§3.6).'],
  ['relative', 'Relative', 'About the target’s own points, with their way scaled to its size.'],
];
