/**
 * Two methods side by side: the target by another method lies over the source's picture, seen and timed as the target
 * is, and both are painted by how far they are apart.
 */
import { h } from './dom.js';
import { ofSize } from './format.js';
import { link } from './stage.js';
import { METHODS } from './steps/methods.js';

const MAP = 'viridis';

/** Whether two methods are seen side by side. */
export const compares = (app) => Boolean(app.transfer.other && app.step === 'transfer' && app.second);

/** What the colours mean meanwhile, whichever view was chosen: see steps/views.js. */
export function comparison(app) {
  const { sequence } = app.target;
  const high = (100 * most(app.transfer.other, sequence.reference.length)) / sequence.diagonal;
  return { kind: 'scalar', map: MAP, marks: [0, high / 2, high], unit: 'distance between the two methods, % of the size' };
}

/**
 * @param {import('./app.js').App} app
 * @param {HTMLElement} first the host of the source's picture
 * @param {(host: HTMLElement) => import('./stage.js').Stage} make
 */
export function beside(app, first, make) {
  const host = h('div', { class: 'stage beside', hidden: true });
  const words = h('p', { class: 'beside-words small', 'aria-live': 'polite' });
  host.append(words);
  first.append(host);
  let unlink = null;
  let painted = null;

  const arrange = () => {
    const on = compares(app);
    host.hidden = !on;
    painted = null;
    if (!on) {
      if (app.third) {
        unlink?.();
        app.third.close();
        app.third = null;
        app.paint();
      }
      return;
    }
    const { sequence } = app.target;
    if (!app.third) {
      app.third = make(host);
      app.third.dark = app.stage.kept.dark;
      app.third.lie(app.stage.kept.insets, app.stage.kept.room);
      unlink = link(app.second, app.third);
    }
    const { other } = app.transfer;
    app.third.describe(`${sequence.name} by another method`);
    app.third.open({ faces: sequence.faces, reference: sequence.reference, poses: other.positions }, app.stage.kept.loop);
    app.third.turn = app.second.turn;
    app.third.time = app.second.kept.time;
    app.third.boundaries = false;
    paint();
  };

  /** Paints both by their distance in the pose that is nearest to the moment. */
  const paint = () => {
    if (!compares(app) || !app.third) return;
    const { other } = app.transfer;
    const { sequence } = app.target;
    const length = sequence.reference.length;
    const count = other.positions.length / length;
    const moment = Math.round(app.third.kept.time);
    const pose = moment < 0 ? -1 : moment % count;
    if (pose === painted) return;
    painted = pose;
    const high = most(other, length);
    const values = pose < 0 ? new Float32Array(length / 3) : distances(other.own, other.positions, pose * length, length);
    for (const figure of [app.second, app.third]) figure.paint(['paint_vertices', values, 0, high, MAP]);
    if (pose < 0) {
      words.textContent = 'In the reference pose all methods agree: play.';
      return;
    }
    const mean = values.reduce((sum, value) => sum + value, 0) / values.length;
    const name = METHODS.find(([id]) => id === other.method)?.[1];
    words.textContent = `${name}: off by ${ofSize(mean / sequence.diagonal)} on average here`;
  };

  app.on('rival step target second', arrange);
  app.on('painted', () => {
    painted = null;
    paint();
  });
  app.stage.addEventListener('tick', paint);
}

/** #V: how far the vertices of one pose are apart. */
function distances(a, b, from, length) {
  const values = new Float32Array(length / 3);
  for (let v = 0, i = from; v < values.length; v++, i += 3) values[v] = Math.hypot(a[i] - b[i], a[i + 1] - b[i + 1], a[i + 2] - b[i + 2]);
  return values;
}

const scales = new WeakMap();

/** The distance that nineteen of twenty vertices, over all poses, keep below. */
function most(other, length) {
  if (!scales.has(other)) {
    const poses = [];
    const step = Math.max(1, Math.floor(other.own.length / length / 12)) * length;
    for (let from = 0; from < other.own.length; from += step) poses.push(distances(other.own, other.positions, from, length));
    const all = new Float32Array(poses.length * (length / 3));
    poses.forEach((distances, i) => all.set(distances, (i * length) / 3));
    all.sort();
    scales.set(other, Math.max(all[Math.floor(0.95 * all.length)] ?? 0, 1e-9));
  }
  return scales.get(other);
}
