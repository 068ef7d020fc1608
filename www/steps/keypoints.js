/** The step Key points: finding them, their error, the list, and how they were chosen. */
import { choice, facts, fold, slider, toggle } from '../controls.js';
import { errorCurve, fallingLines, ranking } from '../curves.js';
import { h, show } from '../dom.js';
import { duration, ofSize, plural } from '../format.js';
import { lesson, stageLesson } from '../lesson.js';
import { placeIn } from '../stages.js';
import { hardest } from './alternation-view.js';
import { reading } from './parameters.js';
import { pointList } from './point-list.js';
import { KEY_POINT_VIEWS } from './point-views.js';
import { candidates, pointOf } from './search-views.js';
import { SLIDERS, STOPS } from './search-parameters.js';
import { warnings } from './warnings.js';

export const keypointsStep = {
  id: 'keypoints',
  title: 'Key points',
  views: KEY_POINT_VIEWS,
  view: 'points',
  points: true,
  pair: true,
  enter: (app) => app.keypoints.begin(),
  summary: ({ doc }) => (doc.count ? plural(doc.count, 'point') : ''),
  build,
};

/** @param {import('../app.js').App} app */
function build(app) {
  const words = h('p', { class: 'small faint' });
  const find = h('button', { type: 'button', class: 'button', on: { click: () => app.keypoints.find() } }, 'Find key points');
  const numbers = h('div');
  const noticed = h('div', { class: 'stack' });
  const curve = h('div');
  const energy = h('div');
  const choices = h('div');
  const list = listSection(app);
  const how = [
    parameterFold(app),
    fold('Energy by round', { content: [energy] }),
    fold('How each was chosen', { content: [choices] }),
  ];
  const update = () => {
    const { doc, keypoints } = app;
    const none = !doc.count;
    words.textContent = introduction(app);
    find.hidden = !none || !keypoints.hasMotion || keypoints.searching;
    for (const box of [numbers, noticed, curve, list]) box.hidden = none;
    show(energy, ...energyPlot(app));
    show(choices, ...choicePlot(app));
    if (none) return;
    show(numbers, pointFacts(app));
    show(noticed, ...warnings(app, doc.run?.warnings));
    show(curve, ...curvePlot(app));
  };
  app.on('doc points source busy', update);
  app.on('view place', () => show(choices, ...choicePlot(app)));
  update();
  return h('div', { class: 'step' }, h('h2', {}, 'Key points'), stageLesson(app, 'keypoints'), words, find, numbers, curve, list, noticed, ...how,
    fold('How it works', { load: () => lesson('keypoints') }));
}

function introduction(app) {
  if (!app.keypoints.hasMotion) return 'This one stands still, and key points are found from how a thing moves. Drop its poses here as well, or open something that moves.';
  if (app.keypoints.searching) return 'Looking for the few points that carry the whole motion …';
  return app.doc.count ? 'A few points whose motion carries all the rest. Drag one along the surface to move it.'
    : 'A few points whose motion carries all the rest.';
}

function pointFacts(app) {
  const { doc, keypoints } = app;
  const seconds = doc.run?.seconds.reduce((sum, [, value]) => sum + value, 0) ?? 0;
  return facts([
    ['Points', String(doc.count)],
    ['Error', keypoints.error === undefined ? '…' : ofSize(keypoints.error), 'Mean distance of vertices from where they should be, over all poses, in per cent of the radius of the whole'],
    seconds > 0 && ['Found in', duration(seconds), doc.run.seconds.map(([name, value]) => `${name}: ${duration(value)}`).join('\n')],
  ]);
}

function curvePlot(app) {
  const { run, count } = app.doc;
  if (!run) return [];
  const { parameters, error } = app.keypoints;
  const bound = parameters.stop === 'error' && !parameters.points ? parameters.error : null;
  const plot = errorCurve(run.errors, { count, error, bound, choose: (points) => app.keypoints.setCount(points) },
    `Error by number of points; ${count} in use`);
  return [h('h3', {}, 'Error by number of points'), plot, h('p', { class: 'small faint' }, 'Drag the mark to use fewer or more.')];
}

function energyPlot(app) {
  const { current } = app.keypoints;
  const worst = current ? hardest(current) : 0;
  const plot = fallingLines(current?.energies ?? [], worst, 'Energy of each pose by round');
  return plot ? [plot, h('p', { class: 'small faint' },
    `Energy of Eq. 5 after each round, over where it began, a line a pose; in colour pose ${worst + 1}, the hardest. It never rises.`)]
    : [h('p', { class: 'small faint' }, 'Known once the points are fitted.')];
}

function choicePlot(app) {
  const { run } = app.doc;
  const shown = placeIn(app, candidates);
  const step = run?.steps[shown];
  if (!step) return [h('p', { class: 'small faint' }, 'Known for points that were searched for.')];
  const chosen = [...step.candidates].indexOf(step.chosen);
  const plot = ranking(step.errors, chosen, `Candidates of step ${shown + 1} by error`);
  return [
    plot, h('p', { class: 'small faint' },
      `Error if a candidate becomes point ${pointOf(shown)}, from the best to the worst of ${step.errors.length}. Under the picture, “Choice” shows where they are, step by step.`)];
}

function listSection(app) {
  const add = h('button', { type: 'button', class: 'text-button', 'aria-pressed': 'false', title: 'Then click on the source', on: {
    click: () => app.keypoints.setAdding(!app.keypoints.adding),
  } }, 'Add a point');
  const again = h('button', { type: 'button', class: 'text-button', on: { click: () => app.keypoints.restore() } }, 'As found');
  const search = h('button', { type: 'button', class: 'text-button', on: { click: () => app.keypoints.again() } }, 'Find again');
  const update = () => {
    const { adding, untouched } = app.keypoints;
    add.setAttribute('aria-pressed', String(adding));
    add.textContent = adding ? 'Click on the source …' : 'Add a point';
    again.hidden = !app.doc.run || untouched;
    search.hidden = Boolean(app.doc.run);
  };
  app.on('selected doc points', update);
  update();
  return h('div', {}, h('h3', {}, 'Points'), pointList(app, 'source'), h('div', { class: 'actions' }, add, again, search));
}

function parameterFold(app) {
  const sliders = SLIDERS.map((definition) => ({ definition, control: slider({
    ...definition,
    reading: (value) => reading(definition, value),
    change: (value) => app.keypoints.setParameter(definition.name, value),
    reset: () => app.keypoints.setParameter(definition.name, null),
  }) }));
  const stop = choice('How many', STOPS, null, (value) => app.keypoints.setStop(value), 'stacked');
  const literal = toggle('By the letter', false, (on) => app.keypoints.setParameter('literal', on),
    'The algorithm exactly as printed: the same points or nearly so, much slower. Made to check the fast answer.');
  const reset = h('button', { type: 'button', class: 'text-button', on: { click: () => app.keypoints.resetParameters() } }, 'Reset all');
  const update = () => {
    if (!app.about) return;
    const { parameters } = app.keypoints;
    const { search } = app.doc;
    for (const { definition, control } of sliders) {
      const value = parameters[definition.name];
      control.set(value ?? definition.low, reading(definition, value), definition.name in search);
    }
    const chosen = stop.querySelector(`[value="${parameters.points ? 'count' : parameters.stop}"]`);
    if (chosen) chosen.checked = true;
    literal.querySelector('input').checked = Boolean(parameters.literal);
    reset.hidden = Object.keys(search).length === 0;
  };
  app.on('doc source', update);
  update();
  return fold('Parameters', { content: [h('div', { class: 'stack' }, stop, ...sliders.map(({ control }) => control.element), literal, reset)] });
}
