/** The stages of the search for key points: candidates, the greedy choice, replacement. See views.js for what a view is. */
import { ofSize, plural } from '../format.js';
import { MARK, swatch } from './paint.js';

const ERROR = 'cividis';

/** Both figures, or the one there is, in clay. */
export function clay({ stage, second }) {
  for (const figure of [stage, second]) {
    if (!figure) continue;
    figure.boundaries = false;
    figure.paint(['paint_clay']);
  }
}

/** Points that were not searched for have no history. */
const unknown = { kind: 'words', text: 'These points were not searched for here: find them to see how.' };

export const spread = {
  id: 'spread',
  label: 'Candidates',
  title: 'Candidates, each as far over the surface as can be from those before it (§3.1)',
  name: 'Candidate',
  count: ({ doc: { run } }) => run?.candidates.length ?? 1,
  first: ({ doc: { run } }) => (run?.candidates.length ?? 1) - 1,
  where: ({ doc: { run } }, index) => (run ? `vertex ${run.candidates[index]}` : ''),
  paint(app, index) {
    clay(app);
    const { run } = app.doc;
    if (!run) return;
    app.stage.mark(facesAt(app.sequence.faces, run.candidates.slice(0, index + 1)), MARK.point);
    app.stage.mark(facesAt(app.sequence.faces, [run.candidates[index]]), MARK.newest);
  },
  pins: () => [],
  legend: ({ doc: { run } }) => (!run ? unknown : {
    kind: 'words',
    text: [swatch(MARK.point), `${plural(run.candidates.length, 'candidate')}: key points are chosen among these.\u2003`, swatch(MARK.newest), 'The newest'],
  }),
};

export const candidates = {
  id: 'candidates',
  label: 'Choice',
  title: 'What each candidate would bring as the next point (§3.5)',
  name: 'Step',
  count: ({ doc: { run } }) => run?.steps.length ?? 1,
  first: ({ doc: { run } }) => (run?.steps.length ?? 1) - 1,
  where({ doc: { run } }, index) {
    const step = run?.steps[index];
    return step ? `point ${pointOf(index)} is vertex ${step.chosen}: error ${ofSize(step.error)}` : '';
  },
  paint(app, index) {
    clay(app);
    const { run } = app.doc;
    const step = run?.steps[index];
    if (!step) return;
    const [low, high] = rangeOf(step.errors);
    app.stage.paint(['paint_vertices', candidateField(app, run, step), low, high, ERROR]);
    app.stage.mark(facesAt(app.sequence.faces, step.candidates), MARK.point);
  },
  pins({ doc: { run } }, index) {
    if (!run?.steps.length) return [];
    const added = [run.candidates[0], ...run.steps.slice(0, index + 1).map(({ chosen }) => chosen)];
    return added.map((vertex, i) => ({ index: i, pin: { vertex, colour: i, selected: i === index + 1 } }));
  },
  legend(app) {
    const { run } = app.doc;
    const index = app.place;
    const step = run?.steps[index];
    if (!step) return run ? { kind: 'words', text: 'There was nothing to choose from.' } : unknown;
    const [low, high] = rangeOf(step.errors);
    return {
      kind: 'scalar',
      map: ERROR,
      marks: [low, (low + high) / 2, high],
      exact: true,
      unit: [swatch(MARK.point), `${plural(step.candidates.length, 'candidate')} tried as point ${pointOf(index)}; around each, the error that it leaves`],
    };
  },
};

/** The points before the first replacement, and after each of them. */
function sets(run) {
  const all = [[...run.key_points]];
  for (const { from, to } of run.replacements.toReversed()) all.unshift(all[0].map((vertex) => (vertex === to ? from : vertex)));
  return all;
}

export const replacement = {
  id: 'replacement',
  label: 'Replacement',
  title: 'Each point may give way to a candidate that serves better now (§3.5, second stage)',
  name: 'Replacement',
  start: 'As they were chosen',
  count: ({ doc: { run } }) => (run?.replacements.length ?? 0) + 1,
  first: ({ doc: { run } }) => run?.replacements.length ?? 0,
  where({ doc: { run } }, index) {
    const swap = run?.replacements[index - 1];
    return swap ? `vertex ${swap.from} gave way to ${swap.to}: error ${ofSize(swap.error)}` : '';
  },
  paint(app, index) {
    clay(app);
    const swap = app.doc.run?.replacements[index - 1];
    if (!swap) return;
    app.stage.mark(facesAt(app.sequence.faces, [swap.from]), MARK.newest);
  },
  pins({ doc: { run } }, index) {
    if (!run) return [];
    const swap = run.replacements[index - 1];
    return sets(run)[index].map((vertex, i) => ({ index: i, pin: { vertex, colour: i, selected: vertex === swap?.to } }));
  },
  legend: ({ doc: { run } }) => (!run ? unknown : { kind: 'words', text: run.replacements.length
    ? [swatch(MARK.newest), `The place that was left. ${plural(run.replacements.length, 'replacement')} in all, each for the better.`]
    : 'No candidate served better than a point that was chosen.' }),
};

/** The number of the point that a step of the search added: it begins with the first candidate. */
export const pointOf = (step) => step + 2;

function rangeOf(values) {
  let [low, high] = [Infinity, -Infinity];
  for (const value of values) if (Number.isFinite(value)) [low, high] = [Math.min(low, value), Math.max(high, value)];
  return high > low ? [low, high] : [low || 0, (low || 0) + 1e-6];
}

const nearests = new WeakMap();

/** For each vertex the candidate nearest to it, as its place in the list. */
function nearestOf(app, run) {
  if (!nearests.has(run)) nearests.set(run, nearest(app.sequence.reference, [...run.candidates]));
  return nearests.get(run);
}

/**
 * For each vertex the nearest of some, as its place among them. A vertex lies near the one before it, as a rule, so the one
 * nearest to that is tried first; then only those that are less than twice as far from it can be nearer.
 */
function nearest(reference, some) {
  const distance = (a, b) => Math.sqrt((reference[3 * a] - reference[3 * b]) ** 2 + (reference[3 * a + 1] - reference[3 * b + 1]) ** 2
    + (reference[3 * a + 2] - reference[3 * b + 2]) ** 2);
  const around = some.map((own) => some.map((vertex, place) => ({ vertex, place, away: distance(own, vertex) })).sort((a, b) => a.away - b.away));
  const owners = new Uint32Array(reference.length / 3);
  let owner = 0;
  for (let v = 0; v < owners.length; v++) {
    const first = distance(v, some[owner]);
    let least = first;
    for (const { vertex, place, away } of around[owner]) {
      if (away >= 2 * first) break;
      const here = distance(v, vertex);
      if (here < least) [least, owner] = [here, place];
    }
    owners[v] = owner;
  }
  return owners;
}

/** #V: the error of the candidate that a vertex lies nearest to; NaN where that was not tried. */
function candidateField(app, run, step) {
  const errors = new Map();
  step.candidates.forEach((vertex, i) => errors.set(vertex, step.errors[i]));
  const list = Array.from(run.candidates, (vertex) => errors.get(vertex) ?? NaN);
  const field = new Float32Array(app.sequence.sizes.vertices);
  nearestOf(app, run).forEach((owner, v) => (field[v] = list[owner]));
  return field;
}

/** The faces around some vertices. */
function facesAt(faces, vertices) {
  const wanted = new Set(vertices);
  const found = [];
  for (let i = 0; i < faces.length; i++) if (wanted.has(faces[i])) found.push(Math.floor(i / 3));
  return Uint32Array.from(found);
}
