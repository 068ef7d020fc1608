/** The stage of the fit by faces: the source bent into the target, round by round. See views.js for what a view is. */
import { ofSize, percent } from '../format.js';
import { clay } from './search-views.js';

const ready = ({ transfer: { motion } }) => motion?.rounds > 0;

export const FIT_VIEW = {
  id: 'fit',
  label: 'Fit',
  title: 'The source is bent into the target, ever more strongly to the nearest point that faces the same way (Sumner and Popović 2004, §5)',
  name: 'Round',
  start: 'As it is',
  moves: true,
  count: (app) => (ready(app) ? app.transfer.motion.rounds : 1),
  first: (app) => FIT_VIEW.count(app) - 1,
  where: (app, index) => ['', 'by the points alone'][index] ?? 'pulled to the target',
  paint(app, index) {
    clay(app);
    if (ready(app)) app.hold({ poses: app.transfer.motion.shapes }, index);
    else app.release();
  },
  legend(app) {
    if (!ready(app)) return { kind: 'words', text: 'By “Gradients” the source is bent into the target: choose that to see how.' };
    const { coverage, distance } = app.transfer.motion.quality;
    return { kind: 'words', text: `At the end it covers ${percent(coverage)} of the target, at a mean distance of ${ofSize(distance)} of its radius.` };
  },
};
