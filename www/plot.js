/** Small plots as SVG. Sizes are in units of the view box; text is set by the style sheet. */
import { h, svg } from './dom.js';
import { number } from './format.js';

export const WIDTH = 304;
export const HEIGHT = 112;
export const FOOT = 20;
const BINS = 44;
/** A histogram spans at most this many powers of ten: below is only the rounding of the input. */
const MOST_DECADES = 5;

/**
 * Histogram of a field over the logarithm of its values. A threshold stands on it; what exceeds it is in the accent
 * colour, and it can be dragged.
 * @param {Float32Array} field
 * @param {{value: number, read: (value: number) => string, choose: (value: number) => void}} threshold
 */
export function histogram(field, threshold, label) {
  const logs = Float64Array.from(field, (value) => Math.log10(value));
  const finite = logs.filter(Number.isFinite).sort();
  if (finite.length < 2 || finite[0] === finite.at(-1)) return null;
  const top = finite[Math.ceil(0.999 * finite.length) - 1];
  const low = Math.min(Math.max(finite[Math.floor(0.002 * finite.length)], top - MOST_DECADES), top - 1e-6);
  const high = Math.max(top, Math.min(Math.log10(threshold.value), top + 1));
  const bins = new Array(BINS).fill(0);
  // What is smaller than the scale is in the first bin.
  for (const log of logs) bins[Math.min(BINS - 1, Math.max(0, Math.floor(((log - low) / (high - low)) * BINS)))]++;
  const most = Math.max(1, ...bins.slice(1));
  const floor = HEIGHT - FOOT;
  const width = WIDTH / BINS;
  const bars = (kind) => bins.map((size, i) => {
    const height = Math.min(1, size / most) * (floor - 14);
    return size > 0 && svg('rect', { x: (i * width + 0.5).toFixed(2), width: (width - 1).toFixed(2), y: (floor - height).toFixed(2), height: height.toFixed(2), class: kind });
  });
  const place = (value) => Math.min(WIDTH, Math.max(0, ((Math.log10(value) - low) / (high - low)) * WIDTH));
  const value = (x) => 10 ** (low + (Math.min(WIDTH, Math.max(0, x)) / WIDTH) * (high - low));
  const above = svg('svg', { y: 0, height: HEIGHT, viewBox: '0 0 1 1' }, svg('g', {}, ...bars('bar accent')));
  const line = svg('line', { y1: 0, y2: floor, class: 'mark' });
  const grip = svg('circle', { cy: floor, r: 5, class: 'dot accent' });
  const words = svg('text', { y: 9, class: 'mark-text' });
  const set = (number) => {
    const x = place(number);
    const left = x > WIDTH - 64;
    // The accent bars lie over the others and are cut off at the threshold.
    above.setAttribute('x', x);
    above.setAttribute('width', Math.max(0.001, WIDTH - x));
    above.setAttribute('viewBox', `${x} 0 ${Math.max(0.001, WIDTH - x)} ${HEIGHT}`);
    for (const name of ['x1', 'x2']) line.setAttribute(name, x);
    grip.setAttribute('cx', Math.min(WIDTH - 5, Math.max(5, x)));
    words.setAttribute('x', x + (left ? -4 : 4));
    words.setAttribute('text-anchor', left ? 'end' : 'start');
    words.textContent = threshold.read(number);
  };
  set(threshold.value);
  const plot = frame(label, ...bars('bar'), above, axis(),
    ...decades(low, high).map((power) => tick(place(10 ** power), number(10 ** power, 1))), line, words, grip);
  plot.classList.add('draggable');
  const at = (event) => {
    const box = plot.getBoundingClientRect();
    return value(((event.clientX - box.left) / box.width) * WIDTH);
  };
  plot.addEventListener('pointerdown', (event) => {
    plot.setPointerCapture(event.pointerId);
    set(at(event));
  });
  plot.addEventListener('pointermove', (event) => plot.hasPointerCapture(event.pointerId) && set(at(event)));
  plot.addEventListener('pointerup', (event) => threshold.choose(at(event)));
  plot.addEventListener('pointercancel', () => set(threshold.value));
  return plot;
}

function decades(low, high) {
  const all = [];
  for (let power = Math.ceil(low); power <= high; power++) all.push(power);
  const every = Math.ceil(all.length / 4) || 1;
  return all.filter((power) => (power - all[0]) % every === 0);
}

/**
 * Cost of losing a part, over the number of parts, with the number in force marked. A click chooses a number.
 * @param {{parts: number, cost: number}[]} curve
 */
export function costCurve(curve, current, choose, label) {
  const shown = curve.filter(({ parts }) => parts <= 40).sort((a, b) => a.parts - b.parts);
  if (shown.length < 2) return null;
  const floor = HEIGHT - FOOT;
  const costs = shown.map(({ cost }) => Math.log10(Math.max(cost, 1e-12)));
  const low = Math.min(...costs);
  const high = Math.max(...costs, low + 1e-6);
  const first = shown[0].parts;
  const last = Math.max(shown.at(-1).parts, first + 1);
  const x = (parts) => 8 + ((parts - first) / (last - first)) * (WIDTH - 16);
  const y = (log) => floor - 8 - ((log - low) / (high - low)) * (floor - 20);
  const points = shown.map(({ parts }, i) => [x(parts), y(costs[i])]);
  const at = shown.findIndex(({ parts }) => parts === current);
  const plot = frame(label,
    axis(),
    svg('polyline', { points: points.map((p) => p.map((v) => v.toFixed(1)).join()).join(' '), class: 'curve' }),
    ...points.map(([px, py]) => svg('circle', { cx: px, cy: py, r: 2, class: 'dot' })),
    at >= 0 && [
      svg('line', { x1: points[at][0], x2: points[at][0], y1: points[at][1], y2: floor, class: 'mark' }),
      svg('circle', { cx: points[at][0], cy: points[at][1], r: 4.5, class: 'dot accent' }),
    ],
    ...ticksBetween(first, last).map((parts) => tick(x(parts), String(parts))));
  plot.classList.add('clickable');
  plot.addEventListener('click', (event) => {
    const box = plot.getBoundingClientRect();
    const share = ((event.clientX - box.left) / box.width) * WIDTH;
    choose(Math.round(first + ((share - 8) / (WIDTH - 16)) * (last - first)));
  });
  return plot;
}

export function ticksBetween(first, last) {
  const step = [1, 2, 5, 10, 20].find((size) => (last - first) / size <= 6) ?? 50;
  const ticks = [];
  for (let value = Math.ceil(first / step) * step; value <= last; value += step) ticks.push(value);
  return ticks;
}

export const axis = () => svg('line', { x1: 0, x2: WIDTH, y1: HEIGHT - FOOT, y2: HEIGHT - FOOT, class: 'axis' });

export const tick = (x, text) => svg('text', { x: Math.min(WIDTH - 6, Math.max(6, x)), y: HEIGHT - 5, class: 'tick', 'text-anchor': 'middle' }, text);

export const frame = (label, ...children) =>
  svg('svg', { viewBox: `0 0 ${WIDTH} ${HEIGHT}`, class: 'plot', role: 'img', 'aria-label': label }, ...children.flat().filter(Boolean));

/** A colour map as a bar. @param {Uint8Array} colours sRGB triples */
export function colourBar(colours) {
  const width = colours.length / 3;
  const canvas = h('canvas', { class: 'colour-bar', width, height: 1, 'aria-hidden': 'true' });
  const context = canvas.getContext('2d');
  const image = context.createImageData(width, 1);
  for (let i = 0; i < width; i++) image.data.set([...colours.subarray(3 * i, 3 * i + 3), 255], 4 * i);
  context.putImageData(image, 0, 0);
  return canvas;
}
