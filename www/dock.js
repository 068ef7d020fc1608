/**
 * What lies under the picture: the views of the step, and what belongs to the view that is shown — the slider for
 * the number of parts, a legend in numbers. Between them one goes through the positions of a stage: strip.js.
 */
import { compares, comparison } from './beside.js';
import { choice, slider } from './controls.js';
import { h, iconButton, show } from './dom.js';
import { number, ofSize, plural } from './format.js';
import { colourBar } from './plot.js';
import { stageStrip } from './strip.js';
import { stepNamed } from './steps/index.js';
import { MOST_POINTS } from './keypoints.js';
import { dot } from './steps/point-list.js';

/** The slider ends here even if the finest parts are more. */
const MOST_PARTS = 48;

/** @param {HTMLElement} host @param {import('./app.js').App} app */
export function dock(host, app) {
  const views = h('div', { class: 'views' });
  const strip = stageStrip(app);
  const legend = h('div', { class: 'legend' });
  const partsControl = partsSlider(app);
  const pointsControl = pointsSlider(app);
  show(host, h('div', { class: 'stage-row' }, strip.back, views, strip.on), strip.element, legend);

  let shown = '';
  const choose = (id) => {
    app.setView(id);
    // Beside a lesson, its figure runs by itself.
    if (app.lessons) app.changed('run-stage');
  };
  const showViews = () => {
    show(views, choice('View', available(app).map(({ id, label, title }) => [id, label, title]), app.view, choose, 'ribbon'));
  };
  const reveal = () => {
    views.querySelector(':checked')?.parentElement.scrollIntoView?.({ block: 'nearest', inline: 'center' });
    fade();
  };
  // On which sides there are more views than are seen.
  const fade = () => {
    const ribbon = views.firstChild;
    if (!ribbon) return;
    const more = [ribbon.scrollLeft > 1 && 'before', ribbon.scrollLeft + ribbon.clientWidth < ribbon.scrollWidth - 1 && 'after'].filter(Boolean);
    if (more.length) ribbon.dataset.more = more.join(' ');
    else delete ribbon.dataset.more;
  };
  views.addEventListener('scroll', fade, { capture: true, passive: true });
  new ResizeObserver(() => reveal()).observe(views);
  const update = () => {
    const { hidden } = host;
    const step = stepNamed(app.step);
    const held = legend.contains(document.activeElement);
    host.hidden = !step.views || (step.points ? !app.doc.count : !app.result);
    if (host.hidden) return;
    strip.update();
    if (shown !== app.step || views.querySelector(':checked')?.value !== app.view) showViews();
    shown = app.step;
    if (hidden) reveal();
    const said = compares(app) ? comparison(app) : step.views.find(({ id }) => id === app.view).legend(app);
    if (said.kind === 'parts') {
      partsControl.update();
      if (legend.firstChild !== partsControl.element) show(legend, partsControl.element);
    } else if (said.kind === 'points' && app.step === 'keypoints') {
      pointsControl.update();
      if (legend.firstChild !== pointsControl.element) show(legend, pointsControl.element);
    } else if (said.kind === 'points') show(legend, whereNext(app));
    else if (said.kind === 'scalar') show(legend, scalarLegend(app, said));
    else if (said.kind === 'sets') show(legend, setLegend(said));
    else show(legend, h('p', { class: 'small' }, said.text));
    // What was pressed may have had its last use.
    if (held && !legend.contains(document.activeElement)) views.querySelector(':checked')?.focus();
  };
  app.on('view place step result doc points selected motion target rival', update);
  app.on('view step', reveal);
  update();
  reveal();
}

/** The stages that there are: by the letter of the paper there is no merge tree. */
const available = (app) => stepNamed(app.step).views.filter((view) => !view.needs || !app.result || view.needs(app) || view.id === app.view);

function partsSlider(app) {
  const words = h('p', { class: 'small faint' });
  const own = h('span', { class: 'paper point', title: 'What Sinew would choose' });
  const control = slider({
    label: 'Number of parts', low: 1, high: MOST_PARTS, step: 1, reading: (value) => String(value),
    input: (value) => app.parts.setCount(value), reset: () => app.parts.setCount(null),
  });
  control.element.classList.add('wide');
  const range = control.element.querySelector('input');
  range.after(own);
  const element = h('div', {}, control.element, words);
  return {
    element,
    update() {
      const { result } = app;
      const counts = result.curve.map(({ parts }) => parts);
      const few = counts.length === 0 || !app.sequence.sizes.poses;
      control.element.hidden = few;
      words.hidden = !few;
      if (few) {
        words.textContent = whyNoChoice(app);
        return;
      }
      range.min = Math.min(...counts);
      range.max = Math.min(Math.max(...counts) + 1, Math.max(MOST_PARTS, result.parts.length));
      const share = (result.automatic.parts.length - range.min) / (range.max - range.min);
      own.style.setProperty('--from', share);
      own.style.setProperty('--to', share);
      // While it is dragged the slider is ahead of the answer.
      const shown = app.wanted ?? result.parts.length;
      control.set(shown, String(shown), app.wanted != null && app.wanted !== result.automatic.parts.length);
    },
  };
}

function pointsSlider(app) {
  const control = slider({
    id: 'control-number-of-key-points', label: 'Key points', low: 1, high: 24, step: 1, reading: (value) => String(value),
    input: (value) => value <= app.doc.points.length && app.keypoints.setCount(value),
    change: (value) => app.keypoints.setCount(value),
    reset: () => app.keypoints.setCount(app.doc.run?.key_points.length ?? app.doc.count),
  });
  control.element.classList.add('wide');
  const range = control.element.querySelector('input');
  const chosen = h('span', { class: 'chosen' });
  control.element.querySelector('output').before(chosen);
  return {
    element: control.element,
    update() {
      const { count, points, run } = app.doc;
      show(chosen, ...(app.selected < 0 ? [] : [dot(app, app.selected),
        textButton('dock-remove', 'Remove', `Remove point ${app.selected + 1} (Delete)`, () => app.keypoints.remove(app.selected))]));
      range.max = Math.min(MOST_POINTS, Math.max(16, points.length + 4));
      const { error } = app.keypoints;
      control.set(count, error === undefined ? String(count) : `${count} · error ${ofSize(error)}`, Boolean(run) && count !== run.key_points.length);
    },
  };
}

const textButton = (id, text, title, click) => h('button', { type: 'button', class: 'text-button small', id, title, on: { click } }, text);

/** What to do with the points of the target next. */
function whereNext(app) {
  const { target, doc, selected } = app;
  const chosen = doc.points[selected];
  const { proposed, missing } = target.tally;
  const line = (index, text, ...buttons) => h('div', { class: 'where' }, index >= 0 && dot(app, index), h('span', { class: 'small' }, text), ...buttons);
  const all = proposed > 0 && textButton('dock-accept-all', 'Accept all', 'Accept all proposals (A)', () => target.acceptAll());
  if (!doc.target) return line(-1, 'Choose a figure that is to move like this one.');
  if (chosen) {
    const remove = chosen.target != null && textButton('dock-remove', 'Remove', `Take point ${selected + 1} off the target (Delete)`, () => target.remove(selected));
    if (chosen.state === 'proposed') return line(selected, 'Proposed. Drag it if wrong.', remove, textButton('dock-accept', 'Accept', `Accept point ${selected + 1} (Enter)`, () => target.accept(selected)));
    return line(selected, chosen.target == null ? 'Click on the target to place it.' : 'Placed. Drag it to move it.', remove, all);
  }
  if (app.step === 'target' && (proposed || missing) && target.wanted >= 0) return line(target.wanted, 'Click where this one lies on the target.', all);
  if (proposed) return line(-1, `${plural(proposed, 'point')} proposed`, all);
  return line(-1, missing ? `${plural(missing, 'point')} without a place` : 'Every point has its place.');
}

function whyNoChoice({ sequence, parameters, result }) {
  if (sequence.sizes.poses === 0) return 'It stands still, and parts show only in how a thing moves. Drop its poses here as well, or open it as a target.';
  if (parameters.method === 'paper') return `${plural(result.parts.length, 'part')}: by the letter of the paper, the method decides how many.`;
  return 'It moves as one: there is nothing to divide.';
}

function scalarLegend(app, { map, marks, unit, exact, step }) {
  const colours = app.stage.colourMap(map);
  return h('div', { class: 'scale' },
    h('div', { class: 'scale-head' }, h('p', { class: 'small faint' }, unit), step && h('div', { class: 'stepper' },
      iconButton('previous', `Previous ${step.name}`, () => step.go(-1), { id: 'legend-previous' }), step.at && h('span', { class: 'number small' }, step.at),
      iconButton('next', `Next ${step.name}`, () => step.go(1), { id: 'legend-next' }))),
    colours && colourBar(colours),
    h('div', { class: 'marks small' }, ...marks.map((value, i) =>
      h('span', { class: 'number' }, i === marks.length - 1 && !exact ? `≥ ${number(value, 2)}` : number(value, 2)))));
}

function setLegend({ a, b, text }) {
  return h('p', { class: 'sets small' }, h('span', { class: 'chip in' }), a, h('span', { class: 'chip out' }), b, h('span', { class: 'faint number' }, text));
}
