/** The parameters of the selection of key points: names, ranges, and what the paper says of each. */
import { ofSize } from '../format.js';

export const SLIDERS = [
  { name: 'error', symbol: 'ε', label: 'Stop below', low: 0.005, high: 0.1, step: 0.001, paper: [0.03, 0.03], format: ofSize,
    help: 'The selection ends when vertices are on average no farther off than this, in per cent of the radius of the whole (Eq. 22).' },
  { name: 'candidates', symbol: 'n', label: 'Candidate points', low: 10, high: 300, step: 5, paper: [100, 100],
    help: 'How many points, far apart from each other, the key points are chosen from (§3.1).' },
  { name: 'lambda', symbol: 'λ', label: 'Rigidity', low: 0, high: 4, step: 0.05, paper: [0.5, 0.5],
    help: 'How much keeping the local shape counts beside meeting the pose (Eq. 5).' },
  { name: 'gamma-rotation', symbol: 'γ', label: 'Rotation in groups', low: 0, high: 4, step: 0.05, paper: [1, 1],
    help: 'How much the rotation of a vertex counts beside its weights when groups are formed (Eq. 15).' },
  { name: 'gamma-shear', symbol: 'γₛ', label: 'Shear in groups', low: 0, high: 2, step: 0.05, paper: [0.1, 0.1],
    help: 'How much scale and shear of a vertex count when groups are formed (Eq. 15).' },
];

/** What the page begins with: enough points for any figure, few enough to place by hand. */
export const BEGINNING = { points: 12 };

export const STOPS = [
  ['count', 'as many as you like', 'A dozen, or as many as the slider under the picture says.'],
  ['error', 'until the error is below ε', 'The rule of the paper.'],
  ['flat', 'until more help little', 'Where the curve of errors is flat.'],
];

/** Whether a value, from a link for example, is one that the controls could have given. */
export function isValidSearch(name, value) {
  if (name === 'stop') return STOPS.some(([stop]) => stop === value);
  if (name === 'literal') return typeof value === 'boolean';
  if (name === 'points' && value === null) return true;
  if (name === 'points') return Number.isInteger(value) && value > 0 && value <= 60;
  const slider = SLIDERS.find((entry) => entry.name === name);
  return Boolean(slider) && typeof value === 'number' && value >= slider.low && value <= slider.high;
}
