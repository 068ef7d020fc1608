/**
 * The steps of the rail, in order. A step is `{id, title, summary(app), build(app)}`, and as it needs them:
 * `views` and `view` (the one to begin with), `points` (it is about key points: pins are shown), `pair` (it shows the
 * target beside the source), `enter(app, before)`.
 */
import { exportStep } from './export.js';
import { keypointsStep } from './keypoints.js';
import { partsStep } from './parts.js';
import { sourceStep } from './source.js';
import { targetStep } from './target.js';
import { transferStep } from './transfer.js';

export { PARTS_VIEW } from './views.js';

export const STEPS = [sourceStep, partsStep, keypointsStep, targetStep, transferStep, exportStep];

export const stepNamed = (name) => STEPS.find(({ id }) => id === name) ?? STEPS[0];
