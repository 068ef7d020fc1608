/**
 * Key points and their places in a link: `points=12,407,…` are vertices of the source, `pairs=33,~81,,…` those of the
 * target in the same order, with `~` before one that is only proposed and nothing where there is none.
 */
import { OPENING } from './history.js';
import { fresh, MOST_POINTS } from './keypoints.js';
import { TARGET, writeRecipe } from './link-recipe.js';

const PROPOSED = '~';
const AWAY = '-';
/** In place of `pairs`: the true places of all points that two creatures have in common. */
const LANDMARKS = 'landmarks';

/** Writes the state of key points, target and transfer into the fields of a link. */
export function writePoints(app, fields, own = false) {
  const { doc, source, about, selected } = app;
  for (const [name, value] of Object.entries(doc.search)) fields[`k.${name}`] = JSON.stringify(value);
  if (doc.method) fields.method = doc.method;
  const target = doc.target?.source;
  if (target?.kind === 'zoo') writeRecipe(fields, target.recipe, about.recipe, TARGET);
  // Vertex numbers mean nothing on another mesh than this.
  if (!doc.count || (source?.kind === 'files' && !own)) return;
  const used = doc.points.slice(0, doc.count);
  fields.points = used.map((point) => point.source).join();
  if (target?.kind === 'zoo' || (target && own)) fields.pairs = used.map(written).join();
  if (selected >= 0) fields.point = selected + 1;
}

function written({ target, state, crowded }) {
  if (state === 'none' && !crowded) return AWAY;
  return target == null ? '' : `${state === 'proposed' ? PROPOSED : ''}${target}`;
}

/** What {@link writePoints} wrote, as far as it makes sense. @returns {{points: import('./keypoints.js').Point[], selected: number}} */
export function placesOf(fields) {
  const sources = (fields.points ?? '').split(',').filter(Boolean).map(Number);
  const valid = sources.every((vertex) => Number.isInteger(vertex) && vertex >= 0) && new Set(sources).size === sources.length;
  if (!valid) return { points: [], selected: -1 };
  const pairs = (fields.pairs ?? '').split(',');
  const points = sources.slice(0, MOST_POINTS).map((vertex, i) => read(vertex, pairs[i] ?? ''));
  return {
    // Of two in one place the first is believed.
    points: points.map((point, i) => (point.target === null || points.findIndex(({ target }) => target === point.target) === i ? point : fresh(point.source))),
    landmarks: fields.pairs === LANDMARKS,
    selected: Number.isInteger(Number(fields.point)) ? Number(fields.point) - 1 : -1,
  };
}

function read(vertex, text) {
  if (text === AWAY) return Object.freeze({ ...fresh(vertex), state: 'none' });
  const proposed = text.startsWith(PROPOSED);
  const target = Number(text.slice(proposed ? 1 : 0));
  if (!text || !Number.isInteger(target) || target < 0) return fresh(vertex);
  return Object.freeze({ source: vertex, target, state: proposed ? 'proposed' : 'placed', confidence: proposed ? null : 1 });
}

/**
 * Puts the points of a link into the page, and opens the target that it names.
 * @param {object|null} recipe of the target
 * @param {{files: {name: string, blob: Blob}[], options: object}|null} target the visitor's own
 */
export async function goToPoints(app, { points, selected, landmarks }, recipe, target = null) {
  if (landmarks && recipe && app.source.kind === 'zoo') return app.target.openTwin(recipe);
  const { vertices } = app.sequence.sizes;
  const known = points.filter(({ source }) => source < vertices);
  if (known.length) app.amend({ points: known.map(({ source }) => fresh(source)), count: known.length });
  if (recipe || target?.files.length) {
    // The target is open first, so that nothing has to be proposed that the link knows.
    const places = (size) => known.map((point) => (point.target < size ? point : fresh(point.source)));
    const how = { places: known.length ? places : undefined, mark: OPENING };
    if (!(await (recipe ? app.target.openCreature(recipe, how) : app.target.openFiles(target.files, target.options, how)))) return;
  }
  if (known.length && selected >= 0) app.select(selected);
}
