/** Form controls in the page's own style. */
import { h, icon, show } from './dom.js';

/** The id of a control follows from its label, so that it is the same when the control is made again. */
const idOf = (...words) => `control-${words.join('-').toLowerCase().replace(/[^a-z0-9]+/g, '-')}`;

/**
 * A slider with its name, its value in words, the paper's range on the track, and a reset.
 * `change` hears the value when it is let go of, `input` while it moves.
 * @returns {{element: HTMLElement, disabled: boolean, set(value: number, text: string, changed: boolean): void}}
 */
export function slider({ id: own, label, symbol = '', help, low, high, step, paper, reading, change, input, reset }) {
  const id = own ?? idOf(label);
  const value = h('output', { class: 'number', for: id });
  const range = h('input', { id, type: 'range', min: low, max: high, step, title: help, on: {
    input: () => {
      value.textContent = reading(range.valueAsNumber);
      input?.(range.valueAsNumber);
    },
    change: () => change?.(range.valueAsNumber),
  } });
  const back = h('button', { type: 'button', class: 'reset', title: 'Back to the default', 'aria-label': `Reset ${label}`, on: { click: reset } },
    icon('reset'));
  const share = (v) => (v - low) / (high - low);
  const band = paper && h('span', { class: paper[0] === paper[1] ? 'paper point' : 'paper', title: `The paper: ${paperText(paper, reading)}`, style: {
    '--from': share(paper[0]), '--to': share(paper[1]),
  } });
  const element = h('div', { class: 'slider' },
    h('div', { class: 'slider-head' },
      h('label', { for: id, title: help }, label, symbol && h('i', { class: 'symbol' }, symbol)), back, value),
    h('div', { class: 'track' }, range, band),
    paper && h('p', { class: 'small faint paper-text' }, `paper ${paperText(paper, reading)}`));
  return {
    element,
    set(number, text, changed) {
      range.valueAsNumber = number;
      value.textContent = text;
      back.hidden = !changed;
    },
    /** Whether it has nothing to act on. */
    set disabled(disabled) {
      range.disabled = disabled;
    },
    /** The element, at a value; for a slider that is made anew each time. */
    with(number) {
      this.set(number, reading(number), false);
      return element;
    },
  };
}

const paperText = ([from, to], reading) => (from === to ? reading(from) : `${reading(from)} to ${reading(to)}`);

/**
 * A drop-down list. `options` are `[value, label]`, `props` those of the list. Where `change` promises false, nothing came of
 * it: the list shows what holds.
 */
export function select(label, options, chosen, change, { id = idOf(label), ...props } = {}) {
  const list = h('select', { id, ...props, on: {
    change: async () => {
      const { value } = list;
      if ((await change(value)) === false && list.value === value) list.value = chosen;
    },
  } },
    ...options.map(([value, text]) => h('option', { value, selected: value === chosen }, text)));
  return h('div', { class: 'row' }, h('label', { for: id }, label), list);
}

/** A switch. */
export function toggle(label, checked, change, help) {
  const box = h('input', { id: idOf(label), type: 'checkbox', role: 'switch', checked, on: { change: () => change(box.checked) } });
  return h('label', { class: 'row switch', title: help }, h('span', {}, label), box);
}

/** A row of choices of which one holds. `options` are `[value, label, title]`. */
export function choice(label, options, chosen, change, kind = 'chips') {
  const name = idOf(label);
  return h('fieldset', { class: kind }, h('legend', { class: 'hidden' }, label),
    ...options.map(([value, text, title]) => h('label', { title },
      h('input', { id: idOf(label, value), type: 'radio', name, value, checked: value === chosen, on: { change: () => change(value) } }),
      h('span', {}, text))));
}

/** Names and numbers in two columns. */
export function facts(pairs) {
  return h('dl', { class: 'facts' }, ...pairs.filter(Boolean).flatMap(([name, value, title]) =>
    [h('dt', { title }, name), h('dd', { class: 'number' }, value)]));
}

/** A part of the panel that folds. `load` makes its content when it is first opened. */
export function fold(title, { open = false, load, content = [] } = {}) {
  const body = h('div', { class: 'fold-body' }, ...content);
  const element = h('details', { class: 'fold', open, on: {
    toggle: async () => {
      if (!element.open || !load || body.childElementCount) return;
      show(body, ...(await load()));
    },
  } }, h('summary', {}, title), body);
  return element;
}
