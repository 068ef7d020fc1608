/**
 * The state of the page in the hash of its address: `#v1;zoo=horse;step=parts;…`. Only what differs from the
 * default is written. Files of the visitor's own cannot travel in a link.
 */
import { placesOf, writePoints } from './link-points.js';
import { parse, writeRecipe } from './link-recipe.js';
import { viewNow } from './stages.js';
import { STEPS } from './steps/index.js';
import { METHODS } from './steps/methods.js';
import { isValid } from './steps/parameters.js';
import { isValidSearch } from './steps/search-parameters.js';
import { AXES } from './upright.js';

const VERSION = 'v1';
/** Browsers limit how often the address may be replaced, in milliseconds. */
const WRITE_EVERY = 400;

/** What is named by fields of a link, in words. */
const CALLED = { zoo: 'a creature', target: 'a target', step: 'a step', motion: 'a motion' };

/** @returns {Record<string, string>} empty if there is no state, or one of another version */
export function readLink(hash) {
  const [version, ...fields] = hash.replace(/^#/, '').split(';');
  if (version !== VERSION) return {};
  return Object.fromEntries(fields.map((field) => field.split('=')).filter((pair) => pair.length === 2)
    .map(([name, value]) => [name, decode(value)]));
}

function decode(text) {
  try {
    return decodeURIComponent(text);
  } catch {
    return '';
  }
}

/** The state of the page as a hash. `own`: the visitor's own files go with it, so that vertex numbers mean something. */
export function writeLink(app, timeline, { own = false } = {}) {
  const fields = {};
  const { source, about } = app;
  if (source?.kind === 'zoo') writeRecipe(fields, source.recipe, about.recipe);
  if (source?.kind === 'src' || (own && source?.kind === 'files')) {
    for (const [name, value] of Object.entries(source.options)) {
      if (JSON.stringify(value) !== JSON.stringify(about.options[name])) fields[`import.${name}`] = worded(value);
    }
  }
  for (const [name, value] of Object.entries(app.changes)) fields[`p.${name}`] = JSON.stringify(value);
  if (app.wanted != null) fields.parts = app.wanted;
  if (app.step !== 'parts') fields.step = app.step;
  const { views } = app;
  for (const step of STEPS) if (step.views && views[step.id] && views[step.id] !== step.view && (step.id === app.step || !STEPS.find(({ id }) => id === app.step).views)) fields.view = views[step.id];
  const view = viewNow(app);
  if (view && app.places[view.id] !== undefined) fields.at = app.places[view.id];
  if (view?.faces && app.face >= 0) fields.face = app.face;
  if (app.lessons) fields.lesson = 'open';
  if (app.guide?.tour) fields.tour = `${app.guide.tour.id}.${app.guide.stop}`;
  writePoints(app, fields, own);
  if (!app.panel) fields.panel = 'away';
  if (timeline.reference) fields.t = 'reference';
  else if (!timeline.playing && timeline.poses > 1) fields.t = timeline.time.toFixed(2);
  if (app.step === 'transfer' && app.transfer.rival) fields.beside = app.transfer.rival;
  // A picture that was turned and then framed is still turned.
  const { camera: moved, turn } = app.stage.kept;
  const camera = moved ?? (turn && app.stage.camera);
  if (camera) fields.look = [...camera].map((value) => Number(value.toPrecision(4))).join();
  const text = Object.entries(fields).map(([name, value]) => `;${name}=${encodeURIComponent(value).replaceAll('%2C', ',')}`).join('');
  return `#${VERSION}${text}`;
}

/** Puts what a link says into the page, as far as it makes sense there; what opens is the caller's business. */
export function applyLink(fields, app) {
  const [changes, search] = [{}, {}];
  for (const [name, value] of Object.entries(fields)) {
    const parsed = parse(value);
    if (name.startsWith('p.') && isValid(name.slice(2), parsed)) changes[name.slice(2)] = parsed;
    if (name.startsWith('k.') && isValidSearch(name.slice(2), parsed)) search[name.slice(2)] = parsed;
  }
  app.reset({ changes, search, method: METHODS.some(([id]) => id === fields.method) ? fields.method : '' });
  app.transfer.setRival(METHODS.some(([id]) => id === fields.beside) ? fields.beside : '');
  app.lessons = fields.lesson === 'open';
  app.step = STEPS.some(({ id }) => id === fields.step) ? fields.step : 'parts';
  app.views = {};
  for (const { id, views } of STEPS) if (views?.some((view) => view.id === fields.view)) app.views[id] = fields.view;
  app.changed('parameters', 'step', 'view', 'lessons');
}

/** What a link names that is not known here, as a sentence; null if there is nothing. */
export function unknownOf(fields, { creatures, motions }) {
  const known = { zoo: creatures, target: creatures, step: STEPS.map(({ id }) => id), motion: motions[creatures.indexOf(fields.zoo)] };
  const unknown = Object.entries(known).filter(([key, names]) => fields[key] && names && !names.includes(fields[key]));
  if (!unknown.length) return null;
  return `The link asks for what is not known here: ${unknown.map(([key]) => `${CALLED[key]} “${fields[key]}”`).join(', ')}. The rest of it is shown.`;
}

/** The import options that a link names. */
export function optionsOf(fields, { options }) {
  const wanted = {};
  for (const name of Object.keys(options)) {
    const text = fields[`import.${name}`];
    if (text !== undefined) wanted[name] = parse(text, text);
  }
  if (!AXES.includes(wanted.up)) delete wanted.up;
  return wanted;
}

/** Number of parts, time and camera that a link names, each undefined if it does not. */
export function placeOf(fields) {
  const camera = fields.look?.split(',').map(Number);
  const time = Number(fields.t);
  return {
    parts: Number.isInteger(Number(fields.parts)) && fields.parts > 0 ? Number(fields.parts) : undefined,
    reference: fields.t === 'reference',
    time: fields.t !== undefined && Number.isFinite(time) ? time : undefined,
    points: placesOf(fields),
    at: numberOf(fields.at),
    face: numberOf(fields.face),
    camera: camera?.length >= 6 && camera.every(Number.isFinite) ? camera : undefined,
  };
}

/** A whole number that is not negative; undefined for anything else. */
const numberOf = (text) => (/^\d{1,9}$/.test(text ?? '') ? Number(text) : undefined);

/** The tour of a link, as its name and stop. @returns {[string, number]|null} */
export function tourOf({ tour = '' }) {
  const [id, stop] = tour.split('.');
  return id ? [id, numberOf(stop) ?? 0] : null;
}

/** A value that {@link parse} reads; a word stands without quotation marks, as people write it. */
const worded = (value) => (/^-?[a-z]+$/i.test(value) && parse(value) === undefined ? value : JSON.stringify(value));

/** Keeps the address up to date. */
export function followState(app, timeline) {
  let timer;
  const write = () => {
    timer = undefined;
    if (app.sequence) history.replaceState(null, '', writeLink(app, timeline));
  };
  const later = () => (timer ??= setTimeout(write, WRITE_EVERY));
  app.on('link', later);
  app.stage.addEventListener('camera', later);
}
