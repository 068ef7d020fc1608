/** Plots of the key points: the error by their number, energies by round, candidates by error. */
import { svg } from './dom.js';
import { number, ofSize } from './format.js';
import { axis, frame, HEIGHT, FOOT, tick, ticksBetween, WIDTH } from './plot.js';

const FLOOR = HEIGHT - FOOT;
const SIDE = 8;
const TOP = 16;
/** So many points more than there are can be asked for at once. */
const BEYOND = 4;

/**
 * The error after each point, with the number in force marked: drag it, also beyond the end.
 * @param {ArrayLike<number>} errors after the first, the second, … point
 * @param {{count: number, error: number|undefined, bound: number|null, choose: (count: number) => void}} now
 */
export function errorCurve(errors, { count, error, bound, choose }, label) {
  if (errors.length < 1) return null;
  const last = Math.max(errors.length, count) + BEYOND;
  const most = Math.max(...errors, error ?? 0, bound ?? 0) || 1;
  const x = (points) => SIDE + ((points - 1) / (last - 1)) * (WIDTH - 2 * SIDE);
  const y = (value) => FLOOR - (value / most) * (FLOOR - TOP);
  const line = svg('line', { y2: FLOOR, class: 'mark' });
  const grip = svg('circle', { r: 5, class: 'dot accent' });
  const words = svg('text', { class: 'mark-text' });
  const at = (points) => (points === count && error !== undefined ? error : errors[points - 1]);
  const set = (points) => {
    const value = at(points);
    const place = [x(points), y(value ?? errors[errors.length - 1])];
    for (const name of ['x1', 'x2']) line.setAttribute(name, place[0]);
    line.setAttribute('y1', place[1]);
    grip.setAttribute('cx', place[0]);
    grip.setAttribute('cy', place[1]);
    const left = place[0] > WIDTH - 96;
    words.setAttribute('x', place[0] + (left ? -8 : 8));
    words.setAttribute('y', Math.max(10, place[1] - 8));
    words.setAttribute('text-anchor', left ? 'end' : 'start');
    words.textContent = value === undefined ? `${points} points` : `${points} · ${ofSize(value)}`;
  };
  set(count);
  const points = Array.from(errors, (value, i) => [x(i + 1), y(value)]);
  const plot = frame(label, axis(),
    bound && [svg('line', { x1: 0, x2: WIDTH, y1: y(bound), y2: y(bound), class: 'mark faint' }),
      svg('text', { x: WIDTH, y: y(bound) - 4, 'text-anchor': 'end' }, `ε = ${ofSize(bound)}`)],
    svg('polyline', { points: points.map((p) => p.map((v) => v.toFixed(1)).join()).join(' '), class: 'curve' }),
    ...points.map(([cx, cy]) => svg('circle', { cx, cy, r: 2, class: 'dot' })),
    line, grip, words,
    ...ticksBetween(1, last).map((n) => tick(x(n), String(n))));
  plot.classList.add('draggable');
  const read = (event) => {
    const box = plot.getBoundingClientRect();
    const share = (((event.clientX - box.left) / box.width) * WIDTH - SIDE) / (WIDTH - 2 * SIDE);
    return Math.min(last, Math.max(1, Math.round(1 + share * (last - 1))));
  };
  plot.addEventListener('pointerdown', (event) => {
    plot.setPointerCapture(event.pointerId);
    set(read(event));
  });
  plot.addEventListener('pointermove', (event) => plot.hasPointerCapture(event.pointerId) && set(read(event)));
  plot.addEventListener('pointerup', (event) => choose(read(event)));
  plot.addEventListener('pointercancel', () => set(count));
  return plot;
}

/**
 * Falling series over their number of rounds, each as a share of where it began, logarithmic.
 * @param {ArrayLike<number>[]} series @param {number} chosen the one that stands out
 */
export function fallingLines(series, chosen, label) {
  const shown = series.filter((values) => values.length > 1 && values[0] > 0);
  if (!shown.length) return null;
  const rounds = Math.max(...shown.map((values) => values.length)) - 1;
  const log = (values) => Array.from(values, (value) => Math.log10(Math.max(value / values[0], 1e-9)));
  const low = Math.min(...shown.map((values) => Math.min(...log(values))), -1e-3);
  const x = (round) => SIDE + (round / rounds) * (WIDTH - 2 * SIDE);
  const y = (value) => FLOOR - 4 - ((value - low) / -low) * (FLOOR - TOP);
  const path = (values) => log(values).map((value, i) => `${x(i).toFixed(1)},${y(value).toFixed(1)}`).join(' ');
  const front = series[chosen];
  return frame(label, axis(),
    ...shown.filter((values) => values !== front).map((values) => svg('polyline', { points: path(values), class: 'curve thin' })),
    front?.length > 1 && front[0] > 0 && svg('polyline', { points: path(front), class: 'curve accent' }),
    svg('text', { x: 0, y: 9 }, '1'), svg('text', { x: 0, y: FLOOR - 6 }, number(10 ** low, 2)),
    ...ticksBetween(0, rounds).map((round) => tick(x(round), String(round))));
}

/**
 * What some candidates would bring, from the best to the worst; the chosen one stands out.
 * @param {ArrayLike<number>} errors @param {number} chosen place of the chosen one
 */
export function ranking(errors, chosen, label) {
  const order = Array.from(errors, (error, i) => ({ error, i })).filter(({ error }) => Number.isFinite(error)).sort((a, b) => a.error - b.error);
  if (order.length < 2) return null;
  const most = order.at(-1).error || 1;
  const x = (rank) => SIDE + (rank / (order.length - 1)) * (WIDTH - 2 * SIDE);
  const y = (error) => FLOOR - (error / most) * (FLOOR - TOP);
  return frame(label, axis(),
    ...order.map(({ error, i }, rank) => svg('circle', { cx: x(rank).toFixed(1), cy: y(error).toFixed(1), r: i === chosen ? 4.5 : 2, class: i === chosen ? 'dot accent' : 'dot' })),
    svg('text', { x: 0, y: 9 }, ofSize(most)),
    ...ticksBetween(1, order.length).map((rank) => tick(x(rank - 1), String(rank))));
}
