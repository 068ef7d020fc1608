/** Puts the page together: engine, stage, controls; then opens what the address asks for, or the first creature. */
import { App } from './app.js';
import { bench } from './bench.js';
import { beside } from './beside.js';
import { dock } from './dock.js';
import { hasOwn, hasPlaced } from './doc.js';
import { iconButton, show } from './dom.js';
import { drops } from './drop.js';
import { Engine } from './engine.js';
import { chosen } from './files.js';
import { handling } from './handling.js';
import { keys } from './keys.js';
import { goToPoints } from './link-points.js';
import { recipeOf, TARGET } from './link-recipe.js';
import { applyLink, followState, optionsOf, placeOf, readLink, tourOf, unknownOf } from './link.js';
import { keepOffline } from './offline.js';
import { notices } from './notice.js';
import { overlay } from './overlay.js';
import { panel } from './panel.js';
import { pointers } from './pointer.js';
import { progressBar } from './progress.js';
import { rail } from './rail.js';
import { saveParts, savePicture } from './save.js';
import { addressOf, share } from './share.js';
import { LOW, NARROW } from './screens.js';
import { Stage } from './stage.js';
import { Studio } from './studio.js';
import { tag } from './tag.js';
import { theme } from './theme.js';
import { Timeline } from './timeline.js';
import { Guide, openTours, tourCard } from './tour.js';
import { compile } from './wasm.js';

const query = new URLSearchParams(location.search);
const bundle = (name) => compile(new URL(`../pkg/${name}_bg.wasm`, import.meta.url));
const element = (id) => document.getElementById(id);
/** In a frame of somebody else's page: `?embed` with the controls of the picture, `?embed=bare` with none. */
const embedded = query.has('embed');
if (embedded) document.documentElement.dataset.embed = query.get('embed') === 'bare' ? 'bare' : 'controls';

// Both downloads start at once; the creature is made while the picture is still being set up.
const engine = new Engine(bundle('worker'));
const stage = new Stage(element('stage'), bundle('page'), query.get('backend'));
const app = new App(engine, stage);
const ready = { segmented: false, pictured: false };

stage.addEventListener('drawn', () => {
  if (ready.pictured) return;
  ready.pictured = true;
  performance.mark('first-picture');
});
stage.addEventListener('no-gpu', () => {
  ready.pictured = true; // There will be none.
  element('no-gpu').hidden = false;
  if (stage.canvas) stage.canvas.hidden = true;
});
stage.addEventListener('trouble', ({ error }) => app.say(error.message));
// What is done in one movement of the hand is one step back; what the next one does is another.
window.addEventListener('change', () => app.history.rest());
// A slider that is let go says so once more after this.
window.addEventListener('pointerup', () => setTimeout(() => app.history.rest()));
stage.started.catch((error) => {
  ready.pictured = true;
  element('no-gpu').hidden = false;
  console.error(error);
});

const timeline = new Timeline(element('timeline'), app);
app.openProject = openProject;
app.timeline = timeline;
const guide = new Guide(app, { play: () => app.play() });
app.guide = guide;
const turnTheme = theme((dark) => {
  stage.dark = dark;
  if (app.second) app.second.dark = dark;
  if (app.third) app.third.dark = dark;
});
notices(element('notice'), app);
progressBar(element('progress'), app);
const hands = { source: handling(app, 'source', () => stage), target: handling(app, 'target', () => app.second) };
pointers(stage, { point: tag(element('tag'), app), hand: hands.source });
drops(element('veil'), app);
const showKeys = keys({ app, stage, timeline, sheet: element('keys'), hands });
const undo = iconButton('undo', 'Undo (Ctrl Z)', () => app.undo(), { id: 'undo' });
const redo = iconButton('redo', 'Redo (Ctrl Shift Z)', () => app.redo(), { id: 'redo' });
show(element('tools'), undo, redo,
  iconButton('tours', 'Guided tours', () => openTours(element('tours'), guide), { id: 'open-tours' }),
  iconButton('link', 'Share: a link, a frame, a file', () => share(element('share'), app, timeline), { id: 'open-share' }),
  iconButton('picture', 'Save the picture', () => savePicture(app), { class: 'icon-button roomy' }),
  iconButton('save', 'Save the parts as GLB', () => saveParts(app), { class: 'icon-button roomy' }),
  iconButton('frame', 'All of it in the picture (F)', () => stage.move('frame')),
  iconButton('sun', 'Light or dark', turnTheme),
  iconButton('keys', 'Keys (?)', showKeys, { class: 'icon-button roomy' }));
// What was placed by hand on figures of one's own is nowhere else.
window.addEventListener('beforeunload', (event) => hasOwn(app.doc) && hasPlaced(app.doc) && event.preventDefault());
app.on('doc', showReturns);
showReturns();

function showReturns() {
  undo.disabled = !app.history.past.length;
  redo.disabled = !app.history.future.length;
}

// Two frames later what was painted is on the screen.
app.on('result', () => app.result && requestAnimationFrame(() => requestAnimationFrame(() => (ready.segmented = true))));
app.addEventListener('result', () => setTimeout(keepOffline, 1500), { once: true });
if (embedded) {
  const whole = element('whole');
  whole.hidden = query.get('embed') === 'bare';
  whole.href = location.href;
  whole.addEventListener('click', () => (whole.href = addressOf(app, timeline)));
}

/** A picture whose points cannot be taken hold of. */
const UNTOUCHED = { grab: () => null, tap: () => false, cursor: () => '' };

/** The picture of the target, made when it is first needed. */
function makeSecond(host, hand = hands.target) {
  const second = new Stage(host, bundle('page'), query.get('backend'));
  second.addEventListener('trouble', ({ error }) => app.say(error.message));
  second.started.catch((error) => console.error(error));
  pointers(second, { point: () => {}, hand });
  return second;
}

async function start() {
  app.about = await engine.about;
  openAddress();
  rail(element('rail'), app);
  const studio = new Studio(app, { hosts: [element('stage'), element('second')], seam: element('seam'), make: makeSecond });
  beside(app, element('stage'), (host) => makeSecond(host, UNTOUCHED));
  panel(element('panel'), app, tourCard(guide));
  dock(element('dock'), app);
  overlay(app, element('stage'));
  followState(app, timeline);
  studio.keepClear();
  // By the time this is heard, the address may have been brought up to date with what is still open.
  window.addEventListener('hashchange', ({ newURL }) => openAddress(new URL(newURL).hash));
}

/** Opens what an address asks for and starts on the first creature otherwise. Does not wait for the parts. */
function openAddress(hash = location.hash) {
  const fields = readLink(hash);
  const tour = tourOf(fields);
  const unknown = unknownOf(fields, app.about);
  const opened = tour && !fields.zoo ? beginTour(fields, tour) : enter(fields, () => {
    const address = query.get('src');
    return address ? app.opener.openAddress(address, optionsOf(fields, app.about)) : app.opener.openCreature(recipeOf(fields, app.about) ?? {});
  }).then(orFirst);
  if (tour && fields.zoo) app.guide.resume(...tour);
  opened.then(() => unknown && app.notice?.kind !== 'error' && app.say(unknown, 'news')).catch((error) => app.say(error.message));
}

/** Puts the state of a link into the page and opens its source with `open`. @param {object} [own] target of the visitor's own */
function enter(fields, open, own) {
  const place = placeOf(fields);
  applyLink(fields, app);
  app.setPanel(fields.panel !== 'away' && !NARROW.matches && !LOW.matches && !embedded);
  const arrive = () => goTo(place, recipeOf(fields, app.about, TARGET), own);
  app.addEventListener('source', arrive, { once: true });
  return open().finally(() => app.removeEventListener('source', arrive));
}

async function beginTour(fields, [id, stop]) {
  const left = app.doc;
  applyLink(fields, app);
  app.setPanel(!embedded);
  if (!(await app.guide.begin(id, stop, left))) await app.opener.openCreature({});
}

/** Opens a file that is a whole project. */
async function openProject({ state, source, target }) {
  const fields = readLink(state);
  const options = { ...app.about.options, ...source.options };
  await enter(fields, () => (source.files.length ? app.opener.openFiles(source.files, options) : app.opener.openCreature(recipeOf(fields, app.about) ?? {})),
    { files: target.files, options: { ...app.about.options, ...target.options } });
}

/** Where nothing could be opened, or that was cancelled: the first creature, with a word about what went wrong. */
async function orFirst() {
  if (app.sequence || app.opener.underWay) return;
  const { notice } = app;
  await app.opener.openCreature({});
  if (notice) app.say(notice.text);
}

/** The number of parts, the points, the moment and the camera of a link. */
function goTo({ parts, time, reference, camera, points, at, face }, target, own) {
  if (parts !== undefined) app.amend({ wanted: parts });
  if (at !== undefined) app.places = { [app.view]: at };
  if (face !== undefined) app.face = face;
  goToPoints(app, points, target, own);
  if (camera) stage.camera = camera;
  // Points are placed more easily on what stands still.
  if (reference || (app.step === 'target' && time === undefined)) timeline.toggleReference();
  // A moment that there is not is none to stop at.
  if (time <= timeline.end) {
    timeline.setPlaying(false);
    timeline.seek(time);
  }
}

/** For tests and for measuring. */
window.sinew = {
  get ready() {
    return ready.segmented && ready.pictured;
  },
  state: () => ({
    backend: stage.backend,
    source: app.sequence && { name: app.sequence.name, ...app.sequence.sizes },
    parts: app.result?.parts.length ?? null,
    residual: app.result?.rigid_residual ?? null,
    step: app.step,
    view: app.view,
    playing: timeline.playing,
    busy: app.busy && { stage: app.busy.stage, done: app.busy.done },
    error: app.notice?.kind === 'error' ? app.notice.text : null,
    time: timeline.reference ? -1 : timeline.time,
    place: app.place,
    tour: app.guide.tour && [app.guide.tour.id, app.guide.stop],
    panel: app.panel,
    flowing: stage.flowing != null,
    points: app.doc.count,
    pointError: app.keypoints.error ?? null,
    target: app.target.sequence && { name: app.target.sequence.name, ...app.target.sequence.sizes },
    tally: app.target.tally,
    next: app.target.next,
    selected: app.selected,
    moves: app.transfer.motion && { method: app.transfer.method, pairs: app.transfer.motion.pairs, handles: app.transfer.motion.handles, beside: app.transfer.other?.method ?? null, seconds: app.transfer.motion.took },
    undo: app.history.past.length,
    redo: app.history.future.length,
    drawn: stage.drawn && (!app.second || app.second.host.hidden || app.second.drawn) && (app.third?.drawn ?? true),
    plain: stage.pace.plain,
    frame: Math.round(stage.pace.took),
  }),
  open: (files) => app.opener.openFiles(chosen(files)),
  /** The page's state, to look into. */
  app,
  bench: () => bench(app),
};

start().catch((error) => app.say(error.message));
