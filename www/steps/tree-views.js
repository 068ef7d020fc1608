/** The stages after clustering: the merge tree cut by cut, refinement, the band and the cut. See views.js for what a view is. */
import { number, percent, plural } from '../format.js';
import { MARK, paintParts, swatch } from './paint.js';

/** Part numbers of the finest parts after some merges, numbered from 0 in the order of their first faces. */
export function merged({ merges, rounds }, count) {
  const finest = rounds.at(-1);
  const root = Uint32Array.from({ length: finest.reduce((most, label) => Math.max(most, label + 1), 0) }, (_, i) => i);
  for (const { from, into } of merges.slice(0, count)) root[from] = into;
  // `into` is always the lower number, so that one pass in order finds every root.
  for (let i = 0; i < root.length; i++) root[i] = root[root[i]];
  const number = new Map();
  return finest.map((label) => {
    if (!number.has(root[label])) number.set(root[label], number.size);
    return number.get(root[label]);
  });
}

const finestOf = ({ rounds }) => new Set(rounds.at(-1)).size;

/** After how many merges there are as many parts as are shown. */
const mergesNow = ({ result }) => (result ? Math.max(0, finestOf(result) - new Set(result.unsmoothed).size) : 0);

/** How many labels are kept for walking to and fro; more are worked out again. */
const MOST_KEPT = 8_000_000;

const kept = new WeakMap();

/** The same, once for each run and number. */
function mergedOf(result, count) {
  if (!kept.has(result)) kept.set(result, new Map());
  const known = kept.get(result);
  if (!known.has(count)) {
    if (known.size * result.labels.length > MOST_KEPT) known.clear();
    known.set(count, merged(result, count));
  }
  return known.get(count);
}

export const merging = {
  id: 'merging',
  label: 'Merging',
  title: 'The finest parts, merged one by one: always the two neighbours that cost least rigidity',
  name: 'Merge',
  start: 'Before the first merge',
  needs: ({ result }) => result.merges.length > 0,
  count: ({ result }) => (result?.merges.length ?? 0) + 1,
  first: mergesNow,
  where(app, index) {
    const cost = app.result.merges[index - 1]?.cost;
    return `${plural(finestOf(app.result) - index, 'part')}${cost === undefined ? '' : `, the last merge cost ${number(cost, 2)}`}`;
  },
  paint: (app, index) => paintParts(app, app.result.merges.length ? mergedOf(app.result, index) : app.result.unsmoothed),
  legend: ({ result }) => ({
    kind: 'words',
    text: result.merges.length ? `From ${plural(finestOf(result), 'finest part')} down to one. The parts that are shown in the end come after ${plural(Math.max(0, finestOf(result) - new Set(result.unsmoothed).size), 'merge')}.`
      : 'By the letter of the paper there is no tree: the clusters are the parts.',
  }),
};

/** Faces whose part in `now` is not the one that most of their part in `before` became. */
function moved(before, now) {
  const shares = new Map();
  before.forEach((label, f) => {
    const key = label * 65536 + now[f];
    shares.set(key, (shares.get(key) ?? 0) + 1);
  });
  const best = new Map();
  for (const [key, size] of shares) {
    const label = Math.floor(key / 65536);
    if (size > (best.get(label)?.size ?? 0)) best.set(label, { size, into: key % 65536 });
  }
  const faces = [];
  before.forEach((label, f) => best.get(label).into !== now[f] && faces.push(f));
  return Uint32Array.from(faces);
}

const changes = new WeakMap();

function changed(result, name, find) {
  const key = result.labels;
  if (!changes.has(key)) changes.set(key, {});
  return (changes.get(key)[name] ??= find());
}

const refinedFaces = (app) => changed(app.result, 'refined', () => moved(mergedOf(app.result, mergesNow(app)), app.result.unsmoothed));
const cutFaces = ({ result }) => changed(result, 'cut', () => moved(result.unsmoothed, result.labels));

export const refined = {
  id: 'unsmoothed',
  label: 'Refined',
  title: 'The parts after each face went where a motion explains it best, before boundaries are smoothed',
  paint(app) {
    paintParts(app, app.result.unsmoothed);
    if (app.result.merges.length) app.stage.mark(refinedFaces(app), MARK.highlight);
  },
  legend: (app) => ({
    kind: 'words',
    text: app.result.merges.length
      ? [swatch(MARK.highlight), `${plural(refinedFaces(app).length, 'face')} went to a part whose motion explains ${refinedFaces(app).length === 1 ? 'it' : 'them'} better. Residual ${percent(app.result.residual_before_smoothing, 3)} of its size.`]
      : `The clusters. Residual ${percent(app.result.residual_before_smoothing, 3)} of its size.`,
  }),
};

/** Faces on one side of the boundaries between parts. */
function along({ dual }, labels) {
  const faces = new Set();
  for (let e = 0; e < dual.length; e += 2) {
    const [a, b] = [dual[e], dual[e + 1]];
    if (labels[a] !== labels[b]) faces.add(labels[a] < labels[b] ? a : b);
  }
  return Uint32Array.from(faces);
}

export const cut = {
  id: 'cut',
  label: 'Band and cut',
  title: 'The band around each boundary, and where the cheapest cut runs in it (§3.4)',
  count: () => 2,
  first: () => 1,
  where: (app, index) => (index ? 'After the cut' : 'Before the cut'),
  paint(app, index) {
    const { result, stage } = app;
    stage.boundaries = false;
    stage.paint(['paint_set', result.band]);
    stage.mark(along(result, index ? result.labels : result.unsmoothed), MARK.point);
  },
  legend: (app) => {
    const { result } = app;
    const band = result.band.reduce((sum, on) => sum + on, 0);
    if (!band) return { kind: 'words', text: 'Boundaries are not smoothed.' };
    return {
      kind: 'sets',
      a: `In a band: ${percent(band / result.band.length)} of the faces`,
      b: [`Stays: ${percent(1 - band / result.band.length)}`, swatch(MARK.point), 'Along the boundaries'],
      text: `${plural(cutFaces(app).length, 'face')} changed sides`,
    };
  },
};
