/** The stage of the fit: rotations and maps in turn, round by round, as E falls (§3.4). See views.js for what a view is. */
import { number, plural } from '../format.js';
import { poseOf } from '../gradient.js';
import { clay } from './search-views.js';

const ERROR = 'cividis';
/** The most handles that a vertex follows in the picture. */
const MOST = 16;

/** The pose that is hardest to follow: the one with the largest error. */
export const hardest = ({ fit_errors: errors }) => errors.reduce((best, error, pose) => (error > errors[best] ? pose : best), 0);

/** A share of the distances is told from so many of them. */
const SAMPLE = 20_000;

const skins = new WeakMap();

/** The source as a skin that is moved by the rounds of one fit: the moment k is the round k. */
function skinOf(current, vertices) {
  if (!skins.has(current)) {
    const handles = current.points.length;
    const each = Math.min(MOST, handles);
    const indices = new Uint16Array(vertices * each);
    const weights = new Float32Array(vertices * each);
    for (let v = 0; v < vertices; v++) takeLargest(current.weights, v * handles, handles, { indices, weights, from: v * each, each });
    const pose = hardest(current);
    skins.set(current, { pose, skin: { handles, indices, weights, K: each, matrices: current.rounds[pose] }, fields: new Map() });
  }
  return skins.get(current);
}

/** The largest `each` of `count` values from `first` on, as places and as shares of their sum. */
function takeLargest(values, first, count, { indices, weights, from, each }) {
  let end = from;
  for (let k = 0; k < count; k++) {
    const value = values[first + k];
    if (end < from + each) end++;
    else if (value <= weights[end - 1]) continue;
    let i = end - 1;
    for (; i > from && weights[i - 1] < value; i--) {
      weights[i] = weights[i - 1];
      indices[i] = indices[i - 1];
    }
    weights[i] = value;
    indices[i] = k;
  }
  let sum = 0;
  for (let i = from; i < end; i++) sum += weights[i];
  for (let i = from; i < end; i++) weights[i] /= sum || 1;
}

/** #V: how far each vertex is from where the pose has it after a round, in radii of the whole. */
function distances(app, known, round) {
  if (!known.fields.has(round)) {
    const { reference } = app.sequence;
    const { radius } = app.keypoints.current;
    const wanted = poseOf(app.sequence, known.pose);
    const { handles, indices, weights, K, matrices } = known.skin;
    const maps = matrices.subarray(12 * handles * round, 12 * handles * (round + 1));
    const field = new Float32Array(reference.length / 3);
    for (let v = 0; v < field.length; v++) {
      const [x, y, z] = [reference[3 * v], reference[3 * v + 1], reference[3 * v + 2]];
      let sum = 0;
      for (let r = 0; r < 3; r++) {
        let at = 0;
        for (let i = 0; i < K; i++) {
          const m = 12 * indices[v * K + i] + 4 * r;
          at += weights[v * K + i] * (maps[m] * x + maps[m + 1] * y + maps[m + 2] * z + maps[m + 3]);
        }
        sum += (at - wanted[3 * v + r]) ** 2;
      }
      field[v] = Math.sqrt(sum) / radius;
    }
    known.fields.set(round, field);
  }
  return known.fields.get(round);
}

/** What two in a hundred values are above, as a sample of them tells. */
function nearlyLargest(values) {
  const step = Math.ceil(values.length / SAMPLE);
  const some = values.filter((_, i) => i % step === 0).sort();
  return some.at(-1 - Math.floor(0.02 * some.length));
}

/** The end of the colours: nearly the largest distance at the beginning. */
function topOf(app, known) {
  known.top ??= nearlyLargest(distances(app, known, 0)) || 1e-6;
  return known.top;
}

const ready = ({ keypoints: { current }, sequence }) => current?.rounds?.length > 0 && sequence.sizes.poses > 0;

export const alternation = {
  id: 'alternation',
  label: 'Fit',
  title: 'Rotations of groups and maps of points are found in turn, and the energy falls (§3.4)',
  name: 'Round',
  start: 'Before the first round',
  moves: true,
  count: (app) => (ready(app) ? app.keypoints.current.energies[hardest(app.keypoints.current)].length : 1),
  first: (app) => alternation.count(app) - 1,
  where(app, index) {
    if (!ready(app)) return '';
    const { current } = app.keypoints;
    const energies = current.energies[hardest(current)];
    return index ? `E is ${number(100 * (energies[index] / (energies[0] || 1)), 3)} % of what it was` : 'maps alone, nothing turned yet';
  },
  paint(app, index) {
    clay(app);
    if (!ready(app)) {
      app.release();
      return;
    }
    const known = skinOf(app.keypoints.current, app.sequence.sizes.vertices);
    app.hold(known.skin, index);
    app.stage.paint(['paint_vertices', distances(app, known, index), 0, topOf(app, known), ERROR]);
  },
  legend(app) {
    if (!ready(app)) return { kind: 'words', text: 'Known once the points are fitted.' };
    const known = skinOf(app.keypoints.current, app.sequence.sizes.vertices);
    const top = topOf(app, known);
    return { kind: 'scalar', map: ERROR, marks: [0, top / 2, top], unit: `distance from pose ${known.pose + 1}, the hardest, in radii of the whole; ${plural(app.keypoints.current.points.length, 'point')}` };
  },
};
