/** The step Target: another figure, and where the key points lie on it. */
import { facts, fold } from '../controls.js';
import { nameOf } from '../doc.js';
import { doctor, untold } from '../doctor.js';
import { h, show } from '../dom.js';
import { chosen } from '../files.js';
import { count, plural, title } from '../format.js';
import { lesson } from '../lesson.js';
import { upright } from '../upright.js';
import { pairGallery } from './gallery.js';
import { pointList } from './point-list.js';
import { PAIR_VIEWS } from './point-views.js';
import { ACCEPT } from './source.js';
import { warnings } from './warnings.js';

export const targetStep = {
  id: 'target',
  title: 'Target',
  views: PAIR_VIEWS,
  view: 'points',
  points: true,
  pair: true,
  enter: (app) => app.keypoints.begin(),
  summary: ({ doc }) => nameOf(doc.target),
  build,
};

/** @param {import('../app.js').App} app */
function build(app) {
  const now = h('div', { class: 'stack' });
  const health = doctor(app, 'target');
  const pairs = h('div');
  const list = pointList(app, 'target');
  const acceptAll = h('button', { type: 'button', class: 'button', title: 'Accept all proposals (A)', on: { click: () => app.target.acceptAll() } }, 'Accept all');
  const again = h('button', { type: 'button', class: 'text-button', on: { click: () => app.target.proposeAgain() } }, 'Propose again');
  const words = h('p', { class: 'small faint' });
  const tally = h('p', { class: 'small number note' });
  show(pairs, h('h3', {}, 'Points'), words, tally, h('div', { class: 'actions first' }, acceptAll, again), list);
  const creatures = h('div', { class: 'chips' });
  const update = () => {
    const { sequence } = app.target;
    pairs.hidden = !sequence || !app.doc.count;
    now.hidden = !sequence;
    if (sequence) {
      show(now,
        h('div', { class: 'row' }, h('p', { class: 'name' }, nameOf(app.doc.target)),
          h('button', { type: 'button', class: 'text-button', id: 'target-away', on: { click: () => app.target.close() } }, 'Put away')),
        facts([['Vertices', count(sequence.sizes.vertices)], ['Faces', count(sequence.sizes.faces)]]),
        ...warnings(app, untold(sequence.warnings).filter(({ code }) => code !== 'no-animation'), app.second),
        upright(app, 'target', 'step'));
    }
    const { placed, proposed, missing } = app.target.tally;
    tally.textContent = [placed && `${placed} placed`, proposed && `${proposed} proposed`, missing && `${missing} missing`].filter(Boolean).join(' · ');
    const crowded = app.keypoints.used.filter((point) => point.crowded).length;
    words.textContent = crowded ? `The target has too few vertices: there is no place for ${plural(crowded, 'point')}.`
      : missing + proposed === 0 ? 'Every point has its place. Drag one to move it: the motion follows.'
      : 'Click on the target to place a point, drag to move it. What is proposed is right or wrong: accept it, or drag it.';
    acceptAll.hidden = !proposed;
    again.hidden = placed === app.doc.count;
  };
  const choose = () => show(creatures, ...app.about.creatures.map((name) =>
    h('button', { type: 'button', class: 'chip-button', 'aria-pressed': String(app.doc.target?.source.recipe?.name === name), id: `target-${name}`,
      on: { click: () => app.target.openCreature({ name }) } }, title(name))));
  app.on('doc target source', update);
  app.on('target source', choose);
  app.on('target', () => health.update());
  update();
  choose();
  health.update();
  return h('div', { class: 'step' }, h('h2', {}, 'Target'),
    h('p', { class: 'small faint' }, 'A second figure that is to move like the first. It needs no skeleton and no animation.'),
    now, health.element, pairs,
    h('h3', {}, 'Creatures'), creatures,
    h('h3', {}, 'Your own'), fileButton(app),
    h('p', { class: 'small faint' }, 'Or drop it anywhere while this step is open.'),
    h('h3', {}, 'Made for each other'), pairGallery(app),
    fold('How it works', { load: () => lesson('target') }));
}

function fileButton(app) {
  const input = h('input', { type: 'file', multiple: true, accept: ACCEPT, class: 'hidden', id: 'target-files', on: {
    change: () => {
      if (input.files.length) app.target.openFiles(chosen(input.files));
      input.value = '';
    },
  } });
  return h('div', { class: 'file' }, input, h('label', { for: 'target-files', class: 'button' }, 'Open a target'));
}
