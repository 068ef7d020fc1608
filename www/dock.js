/**
 * What lies under the picture: the views of the step, and what belongs to the view that is shown — the slider for
 * the number of parts, a legend in numbers, or a stepper.
 */
import { choice, slider } from './controls.js';
import { h, iconButton, show } from './dom.js';
import { number, plural } from './format.js';
import { colourBar } from './plot.js';
import { VIEWS } from './steps/views.js';

/** The slider ends here even if the finest parts are more. */
const MOST_PARTS = 48;

/** @param {HTMLElement} host @param {import('./app.js').App} app */
export function dock(host, app) {
  const views = h('div', { class: 'views' });
  const legend = h('div', { class: 'legend' });
  const partsControl = partsSlider(app);
  show(host, views, legend);

  const showViews = () => {
    show(views, choice('View', VIEWS.map(({ id, label, title }) => [id, label, title]), app.view, (id) => app.setView(id), 'ribbon'));
  };
  const reveal = () => views.querySelector(':checked')?.parentElement.scrollIntoView?.({ block: 'nearest', inline: 'center' });
  const update = () => {
    const { hidden } = host;
    host.hidden = app.step !== 'parts' || !app.result;
    if (host.hidden) return;
    if (views.querySelector(':checked')?.value !== app.view) showViews();
    if (hidden) reveal();
    const said = VIEWS.find(({ id }) => id === app.view).legend(app);
    if (said.kind === 'parts') {
      partsControl.update();
      if (legend.firstChild !== partsControl.element) show(legend, partsControl.element);
    } else if (said.kind === 'steps') showSteps(legend, app, said);
    else if (said.kind === 'scalar') show(legend, scalarLegend(app, said));
    else if (said.kind === 'sets') show(legend, setLegend(said));
    else show(legend, h('p', { class: 'small' }, said.text));
  };
  app.on('view step result', update);
  app.on('view step', reveal);
  update();
  reveal();
}

function partsSlider(app) {
  const words = h('p', { class: 'small faint' });
  const own = h('span', { class: 'paper point', title: 'What Sinew would choose' });
  const control = slider({
    label: 'Number of parts', low: 1, high: MOST_PARTS, step: 1, reading: (value) => String(value),
    input: (value) => app.setParts(value), reset: () => app.setParts(null),
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
      const few = counts.length === 0;
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

function whyNoChoice({ sequence, parameters, result }) {
  if (sequence.sizes.poses === 0) return 'It has a single pose. Parts show only in how a thing moves.';
  if (parameters.method === 'paper') return `${plural(result.parts.length, 'part')}: by the letter of the paper, the method decides how many.`;
  return 'It moves as one: there is nothing to divide.';
}

function scalarLegend(app, { map, marks, unit }) {
  const colours = app.stage.colourMap(map);
  return h('div', { class: 'scale' },
    h('p', { class: 'small faint' }, unit),
    colours && colourBar(colours),
    h('div', { class: 'marks small' }, ...marks.map((value, i) =>
      h('span', { class: 'number' }, i === marks.length - 1 ? `≥ ${number(value, 2)}` : number(value, 2)))));
}

function setLegend({ a, b, text }) {
  return h('p', { class: 'sets small' }, h('span', { class: 'chip in' }), a, h('span', { class: 'chip out' }), b, h('span', { class: 'faint number' }, text));
}

function showSteps(legend, app, { name, index, count, text, go }) {
  // The buttons stay the same elements while one steps, so that the keyboard keeps its place.
  if (legend.dataset.go !== go || !legend.querySelector('.stepper')) {
    const step = (by) => () => app[go](app[go === 'setFeature' ? 'feature' : 'round'] + by);
    show(legend, h('div', { class: 'stepper' },
      iconButton('previous', `Previous ${name.toLowerCase()}`, step(-1)),
      h('span', { class: 'number' }),
      iconButton('next', `Next ${name.toLowerCase()}`, step(1)),
      h('span', { class: 'small faint' })));
    legend.dataset.go = go;
  }
  const [previous, where, next, what] = legend.firstChild.children;
  where.textContent = count ? `${name} ${index + 1} of ${count}` : `No ${name.toLowerCase()}`;
  what.textContent = text;
  previous.disabled = index <= 0;
  next.disabled = index >= count - 1;
}
