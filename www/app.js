/**
 * The state of the page and what can be done to it. Everything that shows something listens to the events named
 * after what changed: `source`, `result`, `parameters`, `step`, `view`, `busy`, `notice`, `panel`, `link`, `doc`
 * (what can be undone), `painted` (the figures), `place` (in a stage), `points` (what follows from the key points), `target`,
 * `motion` (of the target), `selected`. Of the stages: `pose` (another one is shown),
 * `released` (the source moves by its poses again), `run-stage` (let the positions go by), `lessons`, `tour`.
 *
 * What can be undone is one small immutable object, {@link Doc}; all else follows from it or is only looked at.
 */
import { collect, fetchSource, originals, resting } from './files.js';
import { plural } from './format.js';
import { History, OPENING } from './history.js';
import { KeyPoints, MOST_POINTS } from './keypoints.js';
import { readProject } from './project.js';
import { placeIn, viewNow } from './stages.js';
import { PARTS_VIEW, stepNamed } from './steps/index.js';
import { PAIR_VIEWS } from './steps/point-views.js';
import { Target } from './target.js';
import { Transfer } from './transfer.js';
import { Work } from './work.js';

/** A change of a parameter during a run that will take longer than this (seconds) stops the run. */
const WORTH_STOPPING = 1;
/** Figures that were open before the last one are held for undo up to this many bytes. */
const MOST_HELD = 256 << 20;

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
const BLANK = { open: null, changes: {}, wanted: null, search: {}, run: null, points: [], count: 0, target: null, method: '' };

export class App extends EventTarget {
  /**
   * @param {import('./engine.js').Engine} engine
   * @param {import('./stage.js').Stage} stage
   */
  constructor(engine, stage) {
    super();
    this.engine = engine;
    this.stage = stage;
    /** The picture of the target, once there is one. @type {import('./stage.js').Stage|null} */
    this.second = null;
    /** Defaults and names, from the engine. */
    this.about = null;
    this.step = 'parts';
    /** The view of each step that is looked at. */
    this.views = {};
    /** Where in a stage one is, by its view: a feature, a merge, a round. */
    this.places = {};
    /** The face that is looked at closely; −1: one that the stage finds telling. */
    this.face = -1;
    /** A moment that a stage holds the source at, whatever the timeline says; null: none. */
    this.frozen = null;
    /** @type {History<Doc>} */
    this.history = new History(BLANK);
    this.result = null;
    /** sRGB triples of the parts. */
    this.colours = new Uint8Array();
    this.notice = null;
    /** The picture of the target by another method, while there is one. */
    this.third = null;
    this.panel = true;
    /** Whether the lessons beside the stages are unfolded. */
    this.lessons = false;
    /** The key point that is selected, by its place in the list; −1: none. */
    this.selected = -1;
    /** The key point that is pointed at. */
    this.hovered = -1;
    /** Whether a point is held: nothing moves on its own meanwhile. */
    this.held = false;
    this.partsQueue = { running: false, next: undefined };
    /** Whether the next opening is that of a link, which has begun with {@link reset}. */
    this.linked = false;
    /** How many openings are under way; meanwhile the engine and the page may differ about what is open. */
    this.opening = 0;
    /** Counts segmentations. */
    this.runs = 0;
    this.work = new Work({ changed: () => this.changed('busy'), say: (text) => this.say(text) });
    /** How a project is opened, and the tours; both come with the page. @type {((project: object) => Promise<void>)|null} */
    this.openProject = null;
    /** Stops the video that is being recorded. @type {AbortController|null} */
    this.recording = null;
    /** @type {import('./timeline.js').Timeline|null} */
    this.timeline = null;
    /** @type {import('./tour.js').Guide|null} */
    this.guide = null;
    this.keypoints = new KeyPoints(this);
    this.target = new Target(this);
    this.transfer = new Transfer(this);
    // The picture may come after the parts, or come again.
    stage.addEventListener('canvas', () => this.#takeColours());
  }

  changed(...what) {
    for (const name of what) this.dispatchEvent(new Event(name));
  }

  on(names, listener) {
    for (const name of names.split(' ')) this.addEventListener(name, listener);
  }

  get busy() {
    return this.work.busy;
  }

  get doc() {
    return this.history.now;
  }

  get source() {
    return this.doc.open?.source ?? null;
  }

  get sequence() {
    return this.doc.open?.sequence ?? null;
  }

  get changes() {
    return this.doc.changes;
  }

  get wanted() {
    return this.doc.wanted;
  }

  /** The parameters of the segmentation in force. */
  get parameters() {
    return { ...this.about.parameters, ...this.changes, parts: null };
  }

  /** The view of the step in force. */
  get view() {
    const { id, view } = owner(this.step);
    return this.views[id] ?? view;
  }

  /** Where one is in the stage that is shown. */
  get place() {
    return placeIn(this, viewNow(this));
  }

  // What can be undone.

  /** Changes what can be undone. @param {Partial<Doc>} patch @param {string|null} mark see {@link History.edit} */
  edit(patch, mark = null) {
    const before = this.doc;
    this.history.edit(patch, mark);
    this.#react(before);
  }

  /** Changes it without a step back: for what the page finds out by itself. See {@link History.amend} */
  amend(patch, holds) {
    const before = this.doc;
    this.history.amend(patch, holds);
    this.#react(before);
  }

  /** The page as a link has it, before something is opened. @param {Partial<Doc>} doc */
  reset(doc) {
    const { open } = this.doc;
    const blank = { ...BLANK, open, ...doc };
    this.history.rest();
    if (open) this.edit(blank, OPENING);
    else this.amend(blank);
    this.linked = true;
  }

  undo() {
    const before = this.doc;
    if (!this.opening && this.history.undo()) this.#return(before);
  }

  redo() {
    const before = this.doc;
    if (!this.opening && this.history.redo()) this.#return(before);
  }

  /** Goes on from a state that was left. @param {Doc} doc */
  takeUp(doc) {
    const before = this.doc;
    this.history.edit(doc);
    this.#return(before);
  }

  #return(before) {
    const { open, changes, wanted } = this.doc;
    // The engine has to know it before anything is asked about it.
    if (before.open !== open) this.engine.call('restore', { kept: open.sequence }, { own: true }).catch(() => {});
    this.#react(before);
    if (before.open !== open || before.changes !== changes) this.segment();
    else if (before.wanted !== wanted && this.result) this.#cut();
  }

  #react(before) {
    const { doc } = this;
    const entered = before.open !== doc.open;
    if (entered) this.#enter();
    this.selected = Math.min(this.selected, doc.count - 1);
    if (before.target !== doc.target) this.transfer.forget();
    this.target.react(before, doc);
    // The motion first: it is looked at, what the points weigh is read.
    if (entered) this.transfer.move();
    else this.transfer.react(before, doc);
    this.keypoints.react(before, doc);
    this.changed('doc', 'link');
    if (before.changes !== doc.changes) this.changed('parameters');
  }

  // What is open.

  /** @param {object} recipe @param {{afresh?: boolean}} [how] `afresh`: without the points of the same creature */
  openCreature(recipe, how) {
    const source = { kind: 'zoo', recipe: { ...this.about.recipe, ...recipe } };
    return this.#open('zoo', source, async () => ({ recipe: source.recipe }), how);
  }

  /** @param {{name: string, blob: Blob}[]} files @param {object|null} options null: whatever the files are */
  async openFiles(files, options = null) {
    if (!options && (await this.tookProject(files))) return true;
    // Poses dropped after a mesh that stands still may be that mesh's: the engine tells.
    const { source: before, sequence } = this;
    const still = !options && before?.files && !sequence.sizes.poses ? before.files : null;
    const source = { kind: 'files', files, still, options: { ...this.about.options, ...options } };
    return this.#open('open', source, () => collect(files, source.options, still));
  }

  /** Opens files as a project, if they are one. @returns {Promise<boolean>} whether they were */
  async tookProject(files) {
    const project = await readProject(files);
    if (project) await this.openProject?.(project);
    return Boolean(project && this.openProject);
  }

  openAddress(url, options = {}) {
    const source = { kind: 'src', url, files: null, options: { ...this.about.options, ...options } };
    return this.#open('open', source, async (progress) => {
      source.files = await fetchSource(url, progress);
      return collect(source.files, source.options);
    });
  }

  /** Reads the open files again with other options. */
  reopen(options) {
    const { kind, files, url, options: before } = this.source;
    const source = { kind, files, url, options: { ...before, ...options } };
    return this.#open('open', source, () => collect(files, source.options));
  }

  async #open(operation, source, payload, { afresh = false } = {}) {
    if (this.busy?.left > WORTH_STOPPING) this.engine.cancel({ all: true });
    this.opening++;
    const sequence = await this.work.run('source', operation === 'zoo' ? 'making the creature' : 'reading', async (progress) => {
      const message = await payload(progress);
      const transfer = [...(message.files ?? []), ...(message.still ?? [])].map((file) => file.bytes.buffer);
      return this.engine.call(operation, message, { progress, transfer });
    });
    this.opening--;
    if (!sequence) return false;
    // From now on they are one drop, the mesh first.
    if (sequence.joined) source.files = [...resting(source.still), ...source.files];
    delete source.still;
    // Numbered shapes have no time of their own; a walk made by code closes on itself.
    sequence.timed = sequence.times.some((time, i) => time !== sequence.times[0] && i > 0);
    sequence.loop = source.kind === 'zoo' || !sequence.timed;
    this.#replace({ source, sequence }, afresh);
    if (sequence.joined) this.say(`${plural(sequence.sizes.poses, 'pose')} of the mesh that was open.`, 'news');
    else this.#sayWhatWent();
    await this.segment();
    return true;
  }

  /** Puts what was opened in place of what was open. @param {Open} open */
  #replace(open, afresh) {
    const before = this.doc;
    // A target stays: what is new is to move it as well. So do points in which there is work, where they mean the same.
    const { changes, target, method } = before;
    // How many points were given says nothing of how many are wanted.
    const search = before.run ? this.keypoints.asked : before.search;
    const patch = !afresh && this.keypoints.worked && sameMesh(this.sequence, open.sequence) ? { open, wanted: null, run: null }
      : { ...BLANK, open, changes, search, target, method };
    if (!this.linked) this.history.rest();
    this.linked = false;
    if (before.open) this.history.edit(patch, OPENING);
    else this.history.restart({ ...BLANK, ...patch }, OPENING);
    this.#makeRoom();
    this.#react(before);
  }

  /** Shows the figure that is open from now on. */
  #enter() {
    const { sequence } = this;
    this.engine.keep(sequence);
    this.work.drop('points', 'search', 'pairs', 'motion', 'export');
    Object.assign(this, { result: null, places: {}, face: -1, frozen: null, notice: null, selected: -1 });
    this.stage.describe(`${sequence.name}, ${sequence.sizes.faces} faces`);
    this.stage.open(sequence, sequence.loop && sequence.sizes.poses > 1);
    this.keypoints.forget();
    this.transfer.forget();
    this.changed('source', 'result', 'parameters', 'notice', 'doc', 'link');
  }

  /** Lets undo go back over the last figure, and over those before it as far as there is room. */
  #makeRoom() {
    const held = new Set([this.doc.open]);
    let bytes = 0;
    this.history.trim(({ open }) => {
      if (!held.has(open)) bytes += open.sequence.poses.byteLength;
      held.add(open);
      return held.size <= 2 || bytes <= MOST_HELD;
    });
  }

  /** Says what an opening took away, if that was the visitor's own, and that it is not lost. */
  #sayWhatWent() {
    const { open, points } = this.doc;
    const back = this.history.past.at(-1);
    if (!back) return;
    const placed = back.points !== points && hasPlaced(back);
    if (isOwn(back.open) && back.open.source.files !== open.source.files) {
      this.say(`${back.open.sequence.name} was closed. Undo brings it back${placed ? ' with its points' : ''}.`, 'news');
    } else if (placed) this.say('The points that were placed do not belong to this mesh. Undo brings them back.', 'news');
  }

  // Segmentation.

  /** Segments what is open with the parameters in force. */
  async segment() {
    if (!this.sequence || this.opening) return;
    this.#giveWay();
    const { parameters, changes } = this;
    const run = ++this.runs;
    const result = await this.work.run('source', 'segmenting', (progress) =>
      this.engine.call('segment', { parameters }, { progress }));
    if (!result) {
      if (run === this.runs) this.#takeBack();
      return;
    }
    result.changes = changes;
    result.automatic = pickParts(result);
    result.curve = costCurve(result);
    this.result = result;
    if (this.wanted != null && parameters.method === 'tree') await this.#fetchParts(this.wanted);
    this.#paintParts();
    if (this.#looksAtParts) this.stage.flowFrom(Uint32Array.from(result.features, ({ face }) => face));
    this.changed('result', 'link');
  }

  /** After a cancel or an error the parameters are again those of the parts that are shown. */
  #takeBack() {
    if (!this.result) return;
    this.amend({ changes: this.result.changes });
    this.changed('parameters');
  }

  /** Another number of parts; null: the engine's own choice. Of many calls in a row the last one counts. */
  setParts(count) {
    if (!this.result || this.opening) return undefined;
    this.edit({ wanted: count }, 'parts');
    return this.#cut();
  }

  async #cut() {
    const queue = this.partsQueue;
    queue.next = this.wanted;
    if (queue.running) return;
    queue.running = true;
    while (queue.next !== undefined) {
      const next = queue.next;
      queue.next = undefined;
      await this.#fetchParts(next);
      this.#paintParts();
      this.changed('result');
    }
    queue.running = false;
  }

  async #fetchParts(count) {
    const { result, parameters } = this;
    if (count == null || count === result.automatic.parts.length) {
      Object.assign(result, result.automatic);
      return;
    }
    const answer = await this.work.run('source', 'cutting the tree', (progress) =>
      this.engine.call('parts', { parameters, parts: count }, { progress }));
    if (answer && this.result === result) Object.assign(result, pickParts(answer));
  }

  /** The open sequence as a skin with a joint for each part: `{bytes, error, rms}`, over the diagonal. */
  exportRigid() {
    const { result } = this;
    if (!result || this.opening) return undefined;
    return this.work.run('export rigid', 'writing the file', async () =>
      this.engine.call('export_rigid', { labels: result.labels, ...await originals(this.source) }));
  }

  /** The open sequence in its coloured parts as the bytes of a GLB; undefined if that did not work. */
  exportParts() {
    const { result, colours } = this;
    if (!result || this.opening) return undefined;
    return this.work.run('export', 'writing the file', () => this.engine.call('export', { labels: result.labels, colours }));
  }

  /** @param {string} name of a parameter @param {any} value null: the engine's default */
  setParameter(name, value) {
    const isDefault = value == null || value === this.about.parameters[name];
    const changes = isDefault ? without(this.changes, name) : { ...this.changes, [name]: value };
    this.edit(name === 'method' ? { changes, wanted: null } : { changes });
    return this.segment();
  }

  resetParameters() {
    this.edit({ changes: {} });
    return this.segment();
  }

  // What is looked at.

  setStep(step) {
    const before = this.step;
    this.step = step;
    this.history.rest();
    stepNamed(step).enter?.(this);
    this.changed('step', 'link');
    if (rests(this) !== rests(this, before)) this.changed(rests(this) ? 'rest' : 'resume');
    this.paint();
  }

  setView(view) {
    this.views[owner(this.step).id] = view;
    this.changed('view', 'link');
    this.paint();
  }

  /** Goes to a position in the stage that is shown. */
  setPlace(index) {
    this.places = { ...this.places, [this.view]: index };
    this.changed('place', 'link');
    this.paint();
  }

  /** Chooses the face that is looked at closely. */
  chooseFace(face) {
    this.face = face;
    this.changed('place', 'link');
    this.paint();
  }

  setPanel(open) {
    this.panel = open;
    this.changed('panel', 'link');
  }

  setLessons(open) {
    this.lessons = open;
    this.changed('lessons', 'link');
  }

  /** @param {number} index −1: none */
  select(index) {
    const selected = clamp(index, -1, this.doc.count - 1);
    if (selected === this.selected) return;
    this.selected = selected;
    this.history.rest();
    this.changed('selected');
    if (stepNamed(this.step).points) this.paint();
  }

  hoverPoint(index) {
    if (index === this.hovered) return;
    this.hovered = index;
    this.changed('hovered');
  }

  /** The colour of a key point, an sRGB triple; undefined where there is no GPU. */
  pinColour(index) {
    if (!this.pinColours?.length) this.pinColours = this.stage.view ? this.stage.pinColours(MOST_POINTS) : null;
    return this.pinColours?.slice(3 * index, 3 * index + 3);
  }

  /** Lets the figures move. */
  play() {
    this.changed('play');
  }

  /** Moves the source by a skin of a stage's own, or by `poses`, and holds it at a moment. */
  hold(skin, time) {
    if (skin.poses) this.stage.poses = skin.poses;
    else if (this.stage.skin !== skin) this.stage.skin = skin;
    this.frozen = time;
    this.stage.time = time;
  }

  /** Lets the source move by its poses again. */
  release() {
    if (this.frozen === null) return;
    this.frozen = null;
    this.stage.poses = this.sequence.poses;
    this.changed('released');
  }

  /** Paints both figures as the step and the view in force ask. */
  paint() {
    if (!this.sequence) return;
    this.stage.unmark();
    const view = viewOf(this.step, this.view);
    // A stage may move the source in its own way; any other lets it go.
    if (!view.moves) this.release();
    if (stepNamed(this.step).pair && this.target.sequence && !stepNamed(this.step).points) PAIR_VIEWS[0].paint(this);
    else if (stepNamed(this.step).points || this.result) view.paint(this, placeIn(this, view));
    else {
      this.stage.boundaries = false;
      this.stage.paint(['paint_clay']);
    }
    this.changed('painted');
  }

  get #looksAtParts() {
    return viewOf(this.step, this.view) === PARTS_VIEW;
  }

  /** Paints new parts, remembers what colour each has, and goes back to the view in force. */
  #paintParts() {
    this.stage.unmark();
    PARTS_VIEW.paint(this);
    this.colours = this.stage.partColours;
    if (!this.#looksAtParts) this.paint();
  }

  /** Asks a new picture for the colours of what is there already. */
  #takeColours() {
    if (!this.result) return;
    this.#paintParts();
    this.changed('result', 'points');
  }

  // Work and words.

  cancel() {
    if (this.recording) this.recording.abort();
    else this.engine.cancel();
  }

  /** Stops a segmentation that runs if a newer question would have to wait for it. */
  #giveWay() {
    if (this.busy?.lane === 'source' && this.busy.left > WORTH_STOPPING) this.cancel();
  }

  /** Tells the visitor something, calmly. */
  say(text, kind = 'error') {
    // A sentence begins with a capital, a file is called what it is called.
    const named = /^\S+\.\w/.test(text);
    this.notice = { text: named ? text : text.charAt(0).toUpperCase() + text.slice(1), kind };
    this.changed('notice');
  }

  dismiss() {
    this.notice = null;
    this.changed('notice');
  }
}

/** Whether points have to be found on the target: that is easier while nothing moves. */
const rests = (app, step = app.step) => step === 'target' && (!app.target.sequence || app.target.tally.placed < app.doc.count);

/** The step whose views a step has: one without any has those of the parts. */
const owner = (step) => (stepNamed(step).views ? stepNamed(step) : stepNamed('parts'));

/** The view that a step shows; a step without views of its own shows the parts. */
const viewOf = (step, view) => stepNamed(step).views?.find(({ id }) => id === view) ?? PARTS_VIEW;

const clamp = (value, low, high) => Math.min(Math.max(value, low), Math.max(low, high));

/** Whether a figure was opened from files of the visitor's own. @param {Open|null} figure */
export const isOwn = (figure) => figure?.source.kind === 'files';

/** Whether the source or the target is the visitor's own. @param {Doc} doc */
export const hasOwn = ({ open, target }) => isOwn(open) || isOwn(target);

/** Whether points have a place on the target that the visitor decided on. @param {Doc} doc */
export const hasPlaced = ({ points }) => points.some(({ state, given }) => state === 'placed' && !given);

/** Whether a vertex of one is the same vertex of the other. */
const sameMesh = (a, b) => Boolean(a) && a.sizes.vertices === b.sizes.vertices && a.faces.length === b.faces.length
  && a.faces.every((vertex, i) => vertex === b.faces[i]);

/** An object without one of its fields. */
function without(object, name) {
  const { [name]: _, ...rest } = object;
  return rest;
}

const pickParts = ({ labels, unsmoothed, band, parts, rigid_residual, residual_before_smoothing }) =>
  ({ labels, unsmoothed, band, parts, rigid_residual, residual_before_smoothing });

/** What it costs to go from one more part to `parts`: the merge tree read from its finest end. */
function costCurve({ merges, rounds }) {
  if (!merges.length || !rounds.length) return [];
  const finest = new Set(rounds.at(-1)).size;
  return merges.map(({ cost }, i) => ({ parts: finest - i - 1, cost }));
}
