/**
 * The stage views of the segmentation, in the order in which the method computes them. Each paints the creature
 * with what one step found and says what its colours mean.
 *
 * A view is `{id, label, title, paint(app), legend(app)}`; the legend describes itself as
 * `{kind: 'scalar'|'sets'|'steps'|'parts'|'words', …}` for dock.js.
 */
import { number, percent, plural } from '../format.js';

/** Styles of `Viewport.mark_faces`. */
export const MARK = { highlight: 0, point: 1 };
/** Scalar maps end at this quantile: distances have heavy tails. */
const TOP = 0.98;
/** Deformation is shown over this many powers of ten. */
const DECADES = 3;

const tops = new WeakMap();

/** A high quantile of the finite values of a field: the end of its colour map. */
function topOf(field) {
  if (!tops.has(field)) {
    const finite = field.filter(Number.isFinite).sort();
    tops.set(field, finite[Math.floor(TOP * (finite.length - 1))] || finite.at(-1) || 1);
  }
  return tops.get(field);
}

function scalar(app, values, low, high, map) {
  app.stage.boundaries = false;
  app.stage.paint(['paint_scalar', values, low, high, map]);
}

/**
 * Paints parts. What colour each part has follows from the engine's own parts, then those in force: so it is the
 * same whatever was looked at before, and on both sides of a link.
 */
function parts(app, labels) {
  const { automatic, labels: current } = app.result;
  const chain = new Set([automatic.labels, current, labels]);
  app.stage.boundaries = true;
  app.stage.paint(['paint_clay'], ...[...chain].map((each) => ['paint_parts', each, countOf(each)]));
}

const countOf = (labels) => labels.reduce((most, label) => Math.max(most, label + 1), 0);

/** The share of faces for which a mask is set. */
const share = (mask) => mask.reduce((sum, value) => sum + value, 0) / Math.max(1, mask.length);

export const VIEWS = [
  {
    id: 'deformation',
    label: 'Deformation',
    title: 'How differently a face deforms from its neighbours, over their distance (Eq. 4)',
    paint(app) {
      const top = Math.log10(topOf(app.result.deformation));
      scalar(app, app.result.deformation.map((value) => Math.max(Math.log10(value), top - DECADES)), top - DECADES, top, 'viridis');
    },
    legend({ result }) {
      const top = topOf(result.deformation);
      const marks = Array.from({ length: DECADES + 1 }, (_, i) => top / 10 ** (DECADES - i));
      return { kind: 'scalar', map: 'viridis', marks, unit: 'deformation distance, logarithmic' };
    },
  },
  {
    id: 'sets',
    label: 'A and B',
    title: 'The deformable faces A and the rest B (§3.2, step 1)',
    paint(app) {
      app.stage.boundaries = false;
      app.stage.paint(['paint_set', app.result.deformable]);
    },
    legend({ result }) {
      const a = share(result.deformable);
      return { kind: 'sets', a: `A, deformable: ${percent(a)} of the faces`, b: `B, near-rigid: ${percent(1 - a)}`, text: `ε = ${number(result.epsilon)}` };
    },
  },
  {
    id: 'distance',
    label: 'Distance from A',
    title: 'How far a face lies from the deformable set (Eq. 5): features are farthest',
    paint(app) {
      const top = topOf(app.result.distance);
      scalar(app, app.result.distance.map((value) => Math.min(value, top)), 0, top, 'cividis');
    },
    legend({ result }) {
      const top = topOf(result.distance);
      return { kind: 'scalar', map: 'cividis', marks: [0, top / 2, top], unit: 'distance from A' };
    },
  },
  {
    id: 'features',
    label: 'Features',
    title: 'The feature faces in the order in which they were found, each with its region of influence (§3.2)',
    paint(app) {
      const { features, labels } = app.result;
      app.stage.boundaries = false;
      const mask = new Uint8Array(labels.length);
      const feature = features[app.feature];
      for (const face of feature?.region ?? []) mask[face] = 1;
      app.stage.paint(['paint_set', mask]);
      app.stage.mark(Uint32Array.from(features.slice(0, app.feature + 1), ({ face }) => face), MARK.point);
    },
    legend: ({ result, feature }) => ({
      kind: 'steps',
      name: 'Feature',
      index: feature,
      count: result.features.length,
      text: result.features[feature]
        ? `${plural(result.features[feature].region.length, 'face')} under its influence, partition ${result.features[feature].partition + 1}`
        : 'No feature was found.',
      go: 'setFeature',
    }),
  },
  {
    id: 'clusters',
    label: 'Clusters',
    title: 'The partitions after each round of clustering (§3.3)',
    paint: (app) => parts(app, app.result.rounds[app.round] ?? app.result.unsmoothed),
    legend: ({ result, round }) => ({
      kind: 'steps',
      name: 'Round',
      index: round,
      count: result.rounds.length,
      text: result.rounds[round] ? plural(new Set(result.rounds[round]).size, 'partition') : 'Clustering was not needed.',
      go: 'setRound',
    }),
  },
  {
    id: 'unsmoothed',
    label: 'Before smoothing',
    title: 'The parts before their boundaries were smoothed by a min cut (§3.4)',
    paint: (app) => parts(app, app.result.unsmoothed),
    legend: ({ result }) => ({
      kind: 'words',
      text: `Residual ${number(1000 * result.residual_before_smoothing)} ‰ of its size before smoothing, ${number(1000 * result.rigid_residual)} ‰ after`,
    }),
  },
  {
    id: 'parts',
    label: 'Parts',
    title: 'The near-rigid parts',
    paint: (app) => parts(app, app.result.labels),
    legend: () => ({ kind: 'parts' }),
  },
];

/** The view that shows the parts themselves. */
export const PARTS_VIEW = VIEWS.at(-1);
