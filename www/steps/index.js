/** The steps of the rail, in order. A step is `{id, title, summary(app), build(app)}`. */
import { partsStep } from './parts.js';
import { sourceStep } from './source.js';

export const STEPS = [sourceStep, partsStep];
