/** The step Parts: its numbers, its parameters and its lesson. */
import { choice, facts, fold, select, slider, toggle } from '../controls.js';
import { h, show } from '../dom.js';
import { duration, number, percent, perMille, plural } from '../format.js';
import { lesson } from '../lesson.js';
import { costCurve, histogram } from '../plot.js';
import { METHODS, reading, SLIDERS, SMOOTHINGS } from './parameters.js';
import { MARK } from './views.js';
import { warnings } from './warnings.js';

export const partsStep = {
  id: 'parts',
  title: 'Parts',
  summary: (app) => (app.result ? plural(app.result.parts.length, 'part') : ''),
  build,
};

/** @param {import('../app.js').App} app */
function build(app) {
  const quality = h('div');
  const curve = h('div');
  const table = h('div');
  const deformation = h('div');
  const noticed = h('div');
  const parameters = parameterFold(app);

  const showResult = () => {
    const { result } = app;
    for (const box of [quality, curve, table, deformation, noticed]) box.hidden = !result;
    if (!result) return;
    show(quality, qualityFacts(result));
    const plot = result.curve.length
      ? costCurve(result.curve, result.parts.length, (parts) => app.setParts(parts), 'Cost of losing a part, by number of parts')
      : null;
    show(curve, plot && h('h3', {}, 'What one part less costs'), plot,
      plot && h('p', { class: 'small faint' }, 'Added residual, logarithmic, over the number of parts. Click to choose.'));
    show(table, partTable(app));
    show(deformation, h('h3', {}, 'Deformation'),
      histogram(result.deformation, result.deformable, epsilonMark(result), 'Histogram of the deformation distance'),
      h('p', { class: 'small faint' }, 'Faces by deformation distance, logarithmic. Coloured: the deformable set A.'));
    show(noticed, ...warnings(app, result.warnings));
  };
  app.on('result', showResult);
  showResult();
  return h('div', { class: 'step' }, h('h2', {}, 'Parts'), quality, noticed, curve, table, deformation, parameters,
    fold('How it works', { load: () => lesson('parts') }));
}

function qualityFacts(result) {
  const seconds = result.seconds.reduce((sum, [, value]) => sum + value, 0);
  return facts([
    ['Parts', String(result.parts.length)],
    ['Residual', perMille(result.rigid_residual),
      'Rms distance of faces from where their part’s best rigid motion puts them, in thousandths of the diagonal'],
    ['Before smoothing', perMille(result.residual_before_smoothing)],
    seconds > 0 && ['Computed in', duration(seconds), result.seconds.map(([name, value]) => `${name}: ${duration(value)}`).join('\n')],
  ]);
}

/** The deformation distance that as many faces exceed as ε made deformable. */
function epsilonMark({ deformation, deformable, epsilon }) {
  const faces = deformable.reduce((sum, value) => sum + value, 0);
  if (!faces || faces === deformable.length) return null;
  return { value: deformation.toSorted()[deformation.length - faces], label: `ε = ${number(epsilon)}` };
}

const MOST_ROWS = 60;

function partTable(app) {
  const { colours } = app;
  const { parts, labels } = app.result;
  const row = (part, index) => h('tr', { tabindex: '0', on: {
    pointerenter: () => highlight(app, labels, index),
    focus: () => highlight(app, labels, index),
    pointerleave: () => app.paint(),
    blur: () => app.paint(),
  } },
  h('th', { scope: 'row' },
    h('span', { class: 'chip', style: { 'background-color': `rgb(${colours.slice(3 * index, 3 * index + 3).join()})` } }), String(index + 1)),
  h('td', { class: 'number' }, percent(part.area)),
  h('td', { class: 'number' }, perMille(part.residual)));
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

function parameterFold(app) {
  const body = h('div', { class: 'stack' });
  const sliders = SLIDERS.map((definition) => {
    const control = slider({
      ...definition,
      reading: (value) => reading(definition, value),
      change: (value) => app.setParameter(definition.name, value),
      reset: () => app.setParameter(definition.name, null),
    });
    return { definition, control };
  });
  const update = () => {
    for (const { definition, control } of sliders) {
      const value = app.parameters[definition.name] ?? (app.result ? definition.found?.(app.result) : null);
      const automatic = app.parameters[definition.name] == null;
      const text = value == null ? 'from the data' : reading(definition, value);
      control.set(value ?? definition.low, automatic && value != null ? `${text} · from the data` : text, definition.name in app.changes);
    }
    show(body,
      choice('Method', METHODS, app.parameters.method, (value) => app.setParameter('method', value), 'stacked'),
      ...sliders.map(({ control }) => control.element),
      select('Smooth boundaries', SMOOTHINGS, app.parameters.smoothing, (value) => app.setParameter('smoothing', value)),
      toggle('Exact distances', app.parameters.exact, (on) => app.setParameter('exact', on || null),
        'Average distances from all pairs of faces instead of from landmarks. Slow: made to check the fast answer.'));
  };
  // A control that is being used must not be rebuilt under the pointer; its value is right already.
  app.on('parameters result', update);
  update();
  return fold('Parameters', { content: [body] });
}
