/** The views of the steps about key points, for both figures. See views.js for what a view is. */
import { number, plural } from '../format.js';
import { MARK } from './views.js';

const WEIGHT = 'viridis';
const ERROR = 'cividis';

/** Both figures, or the one there is, in clay. */
function clay({ stage, second }) {
  for (const figure of [stage, second]) {
    if (!figure) continue;
    figure.boundaries = false;
    figure.paint(['paint_clay']);
  }
}

/** The point whose field is shown. */
const shownPoint = (app) => Math.max(0, app.selected);

/** One column of a table with `count` columns. */
const column = (values, count, index) => Float32Array.from({ length: values.length / count }, (_, row) => values[row * count + index]);

const points = {
  id: 'points',
  label: 'Points',
  title: 'The key points',
  paint: clay,
  legend: () => ({ kind: 'points' }),
};

const weights = {
  id: 'weights',
  label: 'Weights',
  title: 'How far the selected point carries the surface (bounded biharmonic weights, Eq. 1)',
  paint(app) {
    clay(app);
    const { current } = app.keypoints;
    const index = shownPoint(app);
    if (current) app.stage.paint(['paint_vertices', column(current.weights, current.points.length, index), 0, 1, WEIGHT]);
    const { field } = app.target;
    const handle = field?.points.indexOf(app.keypoints.used[index]?.source) ?? -1;
    if (handle >= 0) app.second?.paint(['paint_vertices', column(field.weights, field.points.length, handle), 0, 1, WEIGHT]);
    app.target.weigh();
  },
  legend: (app) => ({
    kind: 'scalar',
    map: WEIGHT,
    marks: [0, 0.5, 1],
    exact: true,
    unit: app.doc.count ? `weight of point ${shownPoint(app) + 1}` : 'no point yet',
    step: app.doc.count > 1 && {
      name: 'point',
      go: (by) => app.select((shownPoint(app) + by + app.doc.count) % app.doc.count),
    },
  }),
};

const groups = {
  id: 'groups',
  label: 'Groups',
  title: 'Vertices that turn together, by k-means on the weights (Eq. 15)',
  paint(app) {
    clay(app);
    const { current } = app.keypoints;
    if (!current) return;
    app.stage.boundaries = true;
    app.stage.paint(['paint_groups', current.groups, countOf(current.groups)]);
  },
  legend: ({ keypoints: { current } }) => ({
    kind: 'words',
    text: current ? `${plural(countOf(current.groups), 'group')} of vertices that share a rotation (§3.3)` : 'No point yet.',
  }),
};

const candidates = {
  id: 'candidates',
  label: 'Candidates',
  title: 'What each candidate would bring as the next point (§3.5)',
  paint(app) {
    clay(app);
    const { run } = app.doc;
    const step = run?.steps[app.keypoints.shown];
    if (!step) return;
    const [low, high] = rangeOf(step.errors);
    app.stage.paint(['paint_vertices', candidateField(app, run, step), low, high, ERROR]);
    app.stage.mark(facesAt(app.sequence.faces, step.candidates), MARK.point);
  },
  legend(app) {
    const { run } = app.doc;
    const step = run?.steps[app.keypoints.shown];
    if (!step) return { kind: 'words', text: run ? 'There was nothing to choose from.' : 'These points were not searched for here: find them to see the candidates.' };
    const [low, high] = rangeOf(step.errors);
    return {
      kind: 'scalar',
      map: ERROR,
      marks: [low, (low + high) / 2, high],
      exact: true,
      unit: `error with this as point ${pointOf(run, app.keypoints.shown)}, ${plural(step.candidates.length, 'candidate')} tried`,
      step: { name: 'step', at: `${app.keypoints.shown + 1} of ${run.steps.length}`, go: (by) => app.keypoints.show(app.keypoints.shown + by) },
    };
  },
};

/** The number of the point that a step of the search added: the first has nothing to be compared with. */
export const pointOf = (run, step) => step + 1 + Math.max(0, run.key_points.length - run.steps.length);

const countOf = (labels) => labels.reduce((most, label) => Math.max(most, label + 1), 0);

function rangeOf(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) if (Number.isFinite(value)) [low, high] = [Math.min(low, value), Math.max(high, value)];
  return high > low ? [low, high] : [low || 0, (low || 0) + 1e-6];
}

const nearests = new WeakMap();

/** For each vertex the candidate nearest to it, as its place in the list. */
function nearestOf(app, run) {
  if (!nearests.has(run)) {
    const { reference } = app.sequence;
    const list = [...run.candidates];
    const owners = new Uint32Array(reference.length / 3);
    for (let v = 0; v < owners.length; v++) {
      let best = Infinity;
      list.forEach((c, i) => {
        const distance = (reference[3 * v] - reference[3 * c]) ** 2 + (reference[3 * v + 1] - reference[3 * c + 1]) ** 2
          + (reference[3 * v + 2] - reference[3 * c + 2]) ** 2;
        if (distance < best) [best, owners[v]] = [distance, i];
      });
    }
    nearests.set(run, owners);
  }
  return nearests.get(run);
}

/** #V: the error of the candidate that a vertex lies nearest to; NaN where that was not tried. */
function candidateField(app, run, step) {
  const errors = new Map();
  step.candidates.forEach((vertex, i) => errors.set(vertex, step.errors[i]));
  const list = Array.from(run.candidates, (vertex) => errors.get(vertex) ?? NaN);
  return Float32Array.from(nearestOf(app, run), (owner) => list[owner]);
}

/** One face at each of some vertices. */
function facesAt(faces, vertices) {
  const wanted = new Set(vertices);
  const found = [];
  for (let i = 0; i < faces.length && wanted.size; i++) if (wanted.delete(faces[i])) found.push(Math.floor(i / 3));
  return Uint32Array.from(found);
}

export const KEY_POINT_VIEWS = [points, weights, groups, candidates];
export const PAIR_VIEWS = [points, weights];
