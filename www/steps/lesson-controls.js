/** What stands beside an equation in a lesson: the control of a symbol, or what the numbers are just now. */
import { slider } from '../controls.js';
import { errorCurve, fallingLines, ranking } from '../curves.js';
import { h, show } from '../dom.js';
import { number } from '../format.js';
import { poseShown } from '../overlay.js';
import { costCurve, histogram } from '../plot.js';
import { placeIn } from '../stages.js';
import { hardest } from './alternation-view.js';
import { faceOf, gradientOf } from './face-views.js';
import { fitting, reading, SLIDERS } from './parameters.js';
import { candidates } from './search-views.js';

/** @returns {{element: HTMLElement, update(): void}} */
export function lessonControl(app, name) {
  const element = h('div', { class: 'lesson-control' });
  const make = MAKERS[name];
  if (SLIDERS.some((entry) => entry.name === name) && !make) return parameter(app, name);
  return { element, update: () => make && ready(app, name) && show(element, ...make(app).filter(Boolean)) };
}

const ready = (app, name) => (['errors', 'energies', 'ranking'].includes(name) ? app.doc.count > 0 : Boolean(app.result));

/** The slider of a parameter. */
function parameter(app, name) {
  const definition = SLIDERS.find((entry) => entry.name === name);
  const control = slider({
    ...definition,
    id: `lesson-${name}`,
    reading: (value) => reading(definition, value),
    change: (value) => app.parts.setParameter(name, value),
    reset: () => app.parts.setParameter(name, null),
  });
  control.element.classList.add('lesson-control');
  return {
    element: control.element,
    update() {
      const chosen = app.parameters[name];
      const value = chosen ?? (app.result ? definition.found?.(app.result) : null);
      const text = value == null ? 'auto' : reading(definition, value);
      control.set(value ?? definition.low, chosen == null && value != null ? `${text} · auto` : text, name in app.changes);
    },
  };
}

const MAKERS = {
  gradient(app) {
    const face = faceOf(app);
    const pose = poseShown(app);
    const found = gradientOf(app, face, pose);
    const where = pose < 0 ? 'in the reference itself' : `in pose ${pose + 1}`;
    if (!found) return [h('p', { class: 'small' }, `Face ${face} has no area, so no gradient of its own.`)];
    const { m, angle, stretches } = found;
    return [
      h('p', { class: 'small faint' }, `Face ${face} ${where}`),
      h('table', { class: 'matrix number' }, h('tbody', {}, ...[0, 1, 2].map((row) =>
        h('tr', {}, ...[0, 1, 2].map((column) => h('td', {}, fixed(m[3 * column + row]))))))),
      h('p', { class: 'small' }, `It turns by ${Math.round((angle * 180) / Math.PI)}° and stretches by ${stretches.map((value) => fixed(value)).join(', ')}.`),
    ];
  },
  epsilon(app) {
    const { weight, epsilon } = app.result;
    return [histogram(weight, {
      value: epsilon,
      read: (value) => `ε = ${number(value)}`,
      choose: (value) => app.parts.setParameter('epsilon', fitting('epsilon', value)),
    }, `Faces by the weight of their heaviest edge; ε = ${number(epsilon)}`),
    h('p', { class: 'small faint' }, 'Faces by their heaviest link, logarithmic. Drag ε.')];
  },
  cost(app) {
    const { curve, parts } = app.result;
    return [costCurve(curve, parts.length, (count) => app.parts.setCount(count), 'Cost of losing a part, by number of parts')];
  },
  ranking(app) {
    const step = app.doc.run?.steps[placeIn(app, candidates)];
    return step ? [ranking(step.errors, [...step.candidates].indexOf(step.chosen), 'Candidates of this step by error')] : [];
  },
  errors(app) {
    const { run, count } = app.doc;
    const { error } = app.keypoints;
    return run ? [errorCurve(run.errors, { count, error, bound: null, choose: (points) => app.keypoints.setCount(points) }, `Error by number of points; ${count} in use`)] : [];
  },
  energies(app) {
    const { current } = app.keypoints;
    return current?.energies.length ? [fallingLines(current.energies, hardest(current), 'Energy of each pose by round')] : [];
  },
};

const fixed = (value) => value.toFixed(2).replace('-', '−');
