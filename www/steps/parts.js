/** The step Parts: its numbers, its parameters and its lesson. */
import { choice, facts, fold, select, slider, toggle } from '../controls.js';
import { h, show } from '../dom.js';
import { duration, number, percent, plural } from '../format.js';
import { lesson, stageLesson } from '../lesson.js';
import { costCurve, histogram } from '../plot.js';
import { fitting, METHODS, reading, SLIDERS, SMOOTHINGS } from './parameters.js';
import { MARK } from './paint.js';
import { VIEWS } from './views.js';
import { warnings } from './warnings.js';

export const partsStep = {
  id: 'parts',
  title: 'Parts',
  views: VIEWS,
  view: 'parts',
  enter: (app) => app.parts.begin(),
  summary: (app) => (app.result ? plural(app.result.parts.length, 'part') : ''),
  build,
};

/** @param {import('../app.js').App} app */
function build(app) {
  const find = h('button', { type: 'button', class: 'button', id: 'find-parts', on: { click: () => app.parts.begin() } }, 'Find the parts');
  const quality = h('div');
  const noticed = h('div', { class: 'stack' });
  const curve = h('div');
  const deformation = h('div');
  const table = h('div');
  const folds = [
    parameterFold(app),
    fold('Deformable faces', { content: [deformation] }),
    fold('How it works', { load: () => lesson('parts') }),
    fold('Each part', { open: true, content: [table] }),
  ];
  const showResult = () => {
    const { result } = app;
    for (const box of [quality, noticed, curve, ...folds]) box.hidden = !result;
    if (!result) return;
    show(quality, qualityFacts(result), h('p', { class: 'small faint note' },
      'Residual: how far faces are from moving rigidly with their part, in per cent of the size of the whole.'));
    show(noticed, ...warnings(app, result.warnings));
    show(curve, ...curvePlot(app));
    show(deformation, ...weightPlot(app));
    show(table, partTable(app));
  };
  const offer = () => (find.hidden = Boolean(app.result) || !app.sequence || app.parts.searching);
  app.on('result', showResult);
  app.on('result busy', offer);
  showResult();
  offer();
  return h('div', { class: 'step' }, h('h2', {}, 'Parts'), stageLesson(app, 'parts'), find, quality, noticed, curve, ...folds);
}

function curvePlot(app) {
  // What stands still loses nothing.
  if (!app.sequence.sizes.poses) return [];
  const { curve, parts } = app.result;
  const plot = costCurve(curve, parts.length, (count) => app.parts.setCount(count), 'Cost of losing a part, by number of parts');
  return plot ? [h('h3', {}, 'What one part less costs'), plot,
    h('p', { class: 'small faint' }, 'Added residual, logarithmic, over the number of parts. Click to choose.')] : [];
}

function qualityFacts(result) {
  const seconds = result.seconds.reduce((sum, [, value]) => sum + value, 0);
  return facts([
    ['Parts', String(result.parts.length)],
    ['Residual', percent(result.rigid_residual, 3),
      'Rms distance of faces from where their part’s best rigid motion puts them, over the diagonal of the bounding box'],
    ['Before smoothing', percent(result.residual_before_smoothing, 3)],
    seconds > 0 && ['Computed in', duration(seconds), result.seconds.map(([name, value]) => `${name}: ${duration(value)}`).join('\n')],
  ]);
}

/** The weights that ε is compared with, and ε on them. */
function weightPlot(app) {
  const { weight, epsilon } = app.result;
  const plot = histogram(weight, {
    value: epsilon,
    read: (value) => `ε = ${number(value)}`,
    choose: (value) => app.parts.setParameter('epsilon', fitting('epsilon', value)),
  }, `Faces by the weight of their heaviest dual edge; ε = ${number(epsilon)}`);
  if (!plot) return [h('p', { class: 'small faint' }, 'Nothing deforms: every face moves with its neighbours.')];
  return [plot, h('p', { class: 'small faint' },
    'How many faces have how heavy an edge (Eq. 5), logarithmic. Those above ε form the deformable set A. Drag ε to move it.')];
}

const MOST_ROWS = 60;

function partTable(app) {
  const { colours } = app;
  const { parts, labels } = app.result;
  const row = (part, index) => h('tr', { on: { pointerenter: () => highlight(app, labels, index), pointerleave: () => app.paint() } },
  h('th', { scope: 'row' }, h('button', { type: 'button', class: 'part', 'aria-label': `Show part ${index + 1}`, on: {
    click: () => highlight(app, labels, index),
    focus: () => highlight(app, labels, index),
    blur: () => app.paint(),
  } }, h('span', { class: 'chip', style: { 'background-color': `rgb(${colours.slice(3 * index, 3 * index + 3).join()})` } }), String(index + 1))),
  h('td', { class: 'number' }, percent(part.area)),
  h('td', { class: 'number' }, percent(part.residual, 3)));
  return h('div', {},
    h('table', {},
      h('thead', {}, h('tr', {}, h('th', { scope: 'col' }, 'Part'), h('th', { scope: 'col', class: 'number' }, 'Area'), h('th', { scope: 'col', class: 'number' }, 'Residual'))),
      h('tbody', {}, ...parts.slice(0, MOST_ROWS).map(row))),
    parts.length > MOST_ROWS && h('p', { class: 'small faint' }, `and ${plural(parts.length - MOST_ROWS, 'smaller part')}`));
}

function highlight(app, labels, part) {
  const faces = [];
  labels.forEach((label, face) => label === part && faces.push(face));
  app.stage.mark(Uint32Array.from(faces), MARK.highlight);
}

/** Parameters that only the method of the paper asks for. */
const OF_THE_PAPER = new Set(['gamma']);

function parameterFold(app) {
  const sliders = SLIDERS.map((definition) => {
    const control = slider({
      ...definition,
      reading: (value) => reading(definition, value),
      change: (value) => app.parts.setParameter(definition.name, value),
      reset: () => app.parts.setParameter(definition.name, null),
    });
    return { definition, control };
  });
  const method = choice('Method', METHODS, null, (value) => app.parts.setParameter('method', value), 'stacked');
  const smoothing = select('Smooth boundaries', SMOOTHINGS, null, (value) => app.parts.setParameter('smoothing', value));
  const exact = toggle('Exact distances', false, (on) => app.parts.setParameter('exact', on),
    'Average distances from all pairs of faces instead of from landmarks. Slow: made to check the fast answer.');
  const reset = h('button', { type: 'button', class: 'text-button', on: { click: () => app.parts.resetParameters() } }, 'Reset all');
  const update = () => {
    const { parameters, changes, result } = app;
    for (const { definition, control } of sliders) {
      const chosen = parameters[definition.name];
      const value = chosen ?? (result ? definition.found(result) : null);
      const text = value == null ? 'auto' : reading(definition, value);
      const idle = OF_THE_PAPER.has(definition.name) && parameters.method !== 'paper';
      const words = chosen == null && value != null ? `${text} · auto` : text;
      control.set(value ?? definition.low, idle ? 'not used' : words, !idle && definition.name in changes);
      control.disabled = idle;
      control.element.title = idle ? 'Only the paper’s own method asks for it.' : '';
    }
    method.querySelector(`[value="${parameters.method}"]`).checked = true;
    smoothing.querySelector('select').value = parameters.smoothing;
    exact.querySelector('input').checked = parameters.exact;
    reset.hidden = Object.keys(changes).length === 0;
  };
  app.on('parameters result', update);
  update();
  return fold('Parameters', { content: [h('div', { class: 'stack' }, method, ...sliders.map(({ control }) => control.element), smoothing, exact, reset)] });
}
