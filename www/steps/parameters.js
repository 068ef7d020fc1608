/** The parameters of the segmentation: names, ranges, and what the paper says of each. */
import { number, percent } from '../format.js';

/**
 * `paper` is the paper's range (or value twice) and is drawn on the track; `found` reads the value that the engine
 * chose from the data where the default is to choose.
 */
export const SLIDERS = [
  { name: 'epsilon', symbol: 'ε', label: 'Deformable above', low: 0, high: 4, step: 0.05, paper: [0.3, 0.8], found: (r) => r.epsilon,
    help: 'Faces that a dual edge heavier than this touches form the deformable set A (§3.2, step 1).' },
  { name: 'gamma', symbol: 'γ', label: 'Regions merge below', low: 0, high: 2, step: 0.02, paper: [0.4, 1.6], found: (r) => r.gamma,
    help: 'Influence regions merge when their average gradients differ by less (squared) in every pose (§3.2, step 3).' },
  { name: 'delta', symbol: 'δ', label: 'Share of distance', low: 0, high: 1, step: 0.01, paper: [0.1, 0.2],
    help: 'How much plain geodesic distance counts beside deformation in a dual edge (Eq. 5).' },
  { name: 'alpha', symbol: 'α', label: 'Deformation in cuts', low: 0, high: 1, step: 0.01, paper: [0, 0.1],
    help: 'How much deformation counts beside length in the price of a boundary (Eq. 8).' },
  { name: 'min-area', symbol: '', label: 'Smallest region', low: 0.0001, high: 0.02, step: 0.0001, format: (v) => percent(v, 2),
    help: 'The search for features ends at regions of influence smaller than this share of the area.' },
  { name: 'harmonic-level', symbol: '', label: 'Edge of influence', low: 0.001, high: 0.2, step: 0.001, paper: [0.01, 0.01],
    help: 'A face belongs to a feature’s region where the harmonic field is above this (§3.2, step 4).' },
];

export const METHODS = [
  ['tree', 'Sinew', 'Many small parts, merged and refined by how rigidly they move.'],
  ['paper', 'The paper by the letter', 'Lee, Wang and Chen 2006 with its own parameters.'],
];

export const SMOOTHINGS = [
  ['deformable', 'where it deforms'],
  ['printed', 'Eq. 8 as printed'],
  ['none', 'not at all'],
];

/** How a slider's value reads. */
export const reading = (slider, value) => (slider.format ?? number)(value);

/** The value nearest to one that is wanted which a parameter's slider could give, at a finer step. */
export function fitting(name, value) {
  const { low, high } = SLIDERS.find((entry) => entry.name === name);
  return Number(Math.min(Math.max(value, low), high).toPrecision(3));
}

/** Whether a value, from a link for example, is one that the controls could have given. */
export function isValid(name, value) {
  const among = (options) => options.some(([option]) => option === value);
  if (name === 'method') return among(METHODS);
  if (name === 'smoothing') return among(SMOOTHINGS);
  if (name === 'exact') return typeof value === 'boolean';
  const slider = SLIDERS.find((entry) => entry.name === name);
  return Boolean(slider) && typeof value === 'number' && value >= slider.low && value <= slider.high;
}
