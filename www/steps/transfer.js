/** The step Transfer: the target moves. How, with what numbers. */
import { choice, facts, fold, select } from '../controls.js';
import { h, show } from '../dom.js';
import { count, duration, number, plural } from '../format.js';
import { lesson } from '../lesson.js';
import { METHODS } from './methods.js';
import { FIT_VIEW } from './fit-view.js';
import { PAIR_VIEWS } from './point-views.js';
import { warnings } from './warnings.js';

export const transferStep = {
  id: 'transfer',
  title: 'Transfer',
  views: [...PAIR_VIEWS, FIT_VIEW],
  view: 'points',
  points: true,
  pair: true,
  enter(app) {
    app.keypoints.begin();
    app.transfer.begin();
    app.play();
  },
  summary: ({ transfer: { motion } }) => (motion ? plural(motion.pairs, 'pair') : ''),
  build,
};

/** @param {import('../app.js').App} app */
function build(app) {
  const words = h('p', { class: 'small faint' });
  // While they are searched for there is nothing to be done about them.
  const found = () => app.doc.count || app.keypoints.searching;
  const go = h('button', { type: 'button', class: 'button', on: { click: () => app.setStep(found() ? 'target' : 'keypoints') } });
  const again = h('button', { type: 'button', class: 'button', id: 'transfer-again', on: { click: () => app.transfer.begin() } }, 'Let it move');
  const now = () => {
    words.textContent = introduction(app);
    go.textContent = found() ? 'Choose a target' : 'Find key points';
    again.hidden = !app.transfer.behind;
  };
  const method = choice('Variant', METHODS, null, (value) => app.transfer.setMethod(value), 'stacked');
  const about = h('p', { class: 'small faint said' });
  const numbers = h('div');
  const noticed = h('div', { class: 'stack' });
  const beside = h('div');
  const variants = h('div', {}, h('h3', {}, 'Variant'), method, about, beside);
  const update = () => {
    const { transfer: { motion, method: name, pairs }, doc } = app;
    go.hidden = Boolean(motion) || pairs.length > 0 || !app.keypoints.hasMotion;
    now();
    variants.hidden = !doc.target || !doc.count;
    const chosen = method.querySelector(`[value="${name}"]`);
    if (chosen) chosen.checked = true;
    show(beside, select('Beside it', [['', 'the source'], ...METHODS.filter(([id]) => id !== name).map(([id, label]) => [id, label])],
      app.transfer.rival, (value) => app.transfer.setRival(value)));
    about.textContent = METHODS.find(([id]) => id === name)?.[2] ?? '';
    show(numbers, motion && app.target.sequence && motionFacts(app));
    show(noticed, ...warnings(app, motion?.warnings, app.second));
  };
  app.on('doc motion target source rival', update);
  app.on('busy', now);
  update();
  return h('div', { class: 'step' }, h('h2', {}, 'Transfer'), words, go, again, numbers, noticed, variants,
    fold('How it works', { load: () => lesson('transfer') }));
}

function introduction(app) {
  const { transfer, doc, target } = app;
  if (!app.keypoints.hasMotion) return 'The source stands still: there is no motion to hand on.';
  const still = app.sequence.sizes.poses === 1;
  if (!doc.target) return still ? 'The source stands still, in a single pose. Choose a target, and it takes that pose.' : 'Choose a target, and it moves like the source.';
  if (!transfer.pairs.length) return still ? 'Place a point on the target, and it takes the pose of the source.' : 'Place a point on the target, and it begins to move.';
  const does = still ? 'It takes the single pose of the source.' : 'It moves like the source.';
  if (transfer.behind) return transfer.motion ? 'It moves as before: the points were changed, and the motion does not follow yet.' : 'It does not move yet.';
  const { proposed } = target.tally;
  return proposed ? `${does} ${plural(proposed, 'point')} of it ${proposed === 1 ? 'is' : 'are'} only proposed.`
    : `${does} Drag a point on it, and ${still ? 'the pose' : 'the motion'} follows.`;
}

function motionFacts({ transfer: { motion }, target: { sequence }, sequence: source }) {
  return facts([
    ['Pairs', String(motion.pairs)],
    motion.quality && ['Covered', `${Math.round(1000 * motion.quality.coverage) / 10} %`, 'Share of the target that the source, bent into it, lies near to and facing the same way'],
    motion.quality && ['Apart', number(100 * motion.quality.distance, 2) + ' %', 'Mean distance of the target from the source bent into it, in its radii'],
    motion.quality && ['Flipped', `${Math.round(1000 * motion.quality.flipped) / 10} %`, 'Share of the target where the nearest sheet of the bent source faces the other way'],
    motion.parts > 0 && ['Parts turned', String(motion.parts), 'Near-rigid parts of the source, each turned into its posture on the target'],
    motion.bones > 0 && ['Bones', String(motion.bones), 'Near-rigid pieces of the source that were found in its motion'],
    ['Vertices', count(sequence.sizes.vertices)],
    ['Poses', count(source.sizes.poses)],
    ['Computed in', duration(motion.took), motion.seconds.map(([name, value]) => `${name}: ${Math.round(1000 * value)} ms`).join('\n')],
  ]);
}
