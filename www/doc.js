/**
 * What can be undone, as one small immutable object: all else on the page follows from it or is only looked at. Big things
 * in it are only referred to.
 */
import { title } from './format.js';

/**
 * @typedef {object} Open
 * @property {{kind: 'zoo', recipe: object}|{kind: 'files'|'src', files: {name: string, blob: Blob}[], options: object, url?: string}} source
 * @property {object} sequence
 */

/**
 * @typedef {object} Doc what can be undone
 * @property {Open|null} open the source
 * @property {object} changes parameters of the segmentation that differ from the engine's defaults
 * @property {number|null} wanted the number of parts that was asked for; null: the engine's own choice
 * @property {object} search parameters of the selection of key points that differ from the engine's defaults
 * @property {object|null} run the selection's answer
 * @property {import('./keypoints.js').Point[]} points key points in order; the first `count` are in use
 * @property {number} count
 * @property {import('./target.js').Opened|null} target
 * @property {string} method how the target moves
 */

/** @type {Doc} */
export const BLANK = { open: null, changes: {}, wanted: null, search: {}, run: null, points: [], count: 0, target: null, method: '' };

/** A creature has a name, a file its own. @param {Open|null} figure */
export function nameOf(figure) {
  if (!figure) return '';
  const { source, sequence: { name } } = figure;
  return source.kind === 'zoo' ? title(name) : name.replace(/\.(glb|gltf|obj|off|ply|stl|zip)$/i, '');
}

/** Whether a figure was opened from files of the visitor's own. @param {Open|null} figure */
export const isOwn = (figure) => figure?.source.kind === 'files';

/** Whether the source or the target is the visitor's own. @param {Doc} doc */
export const hasOwn = ({ open, target }) => isOwn(open) || isOwn(target);

/** Whether points have a place on the target that the visitor decided on. @param {Doc} doc */
export const hasPlaced = ({ points }) => points.some(({ state, given }) => state === 'placed' && !given);
