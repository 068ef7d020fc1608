/**
 * The state of the page and what can be done to it. Everything that shows something listens to the events named
 * after what changed: `source`, `result`, `parameters`, `step`, `view`, `busy`, `notice`, `panel`, `link`, `doc`
 * (what can be undone), `painted` (the figures), `place` (in a stage), `points` (what follows from the key points), `target`,
 * `motion` (of the target), `selected`. Of the stages: `pose` (another one is shown),
 * `released` (the source moves by its poses again), `run-stage` (let the positions go by), `lessons`, `tour`.
 *
 * What can be undone is one small immutable object, see doc.js. What is done with the source, its parts, the key points,
 * the target and its motion have modules of their own.
 */
import { BLANK } from './doc.js';
import { History, OPENING } from './history.js';
import { KeyPoints, MOST_POINTS } from './keypoints.js';
import { Opener, onlyTurned } from './opener.js';
import { Parts } from './parts.js';
import { placeIn, viewNow } from './stages.js';
import { PARTS_VIEW, stepNamed } from './steps/index.js';
import { PAIR_VIEWS } from './steps/point-views.js';
import { Target } from './target.js';
import { Transfer } from './transfer.js';
import { Work } from './work.js';

export class App extends EventTarget {
  /**
   * @param {import('./engine.js').Engine} engine
   * @param {import('./stage.js').Stage} stage
   */
  constructor(engine, stage) {
    super();
    this.engine = engine;
    this.stage = stage;
    engine.trouble = (error) => this.say(error.message);
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
    /** @type {History<import('./doc.js').Doc>} */
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
    this.work = new Work({ changed: () => this.changed('busy'), say: (text) => this.say(text) });
    /** How a project is opened, and the tours; both come with the page. @type {((project: object) => Promise<void>)|null} */
    this.openProject = null;
    /** Stops the video that is being recorded. @type {AbortController|null} */
    this.recording = null;
    /** @type {import('./timeline.js').Timeline|null} */
    this.timeline = null;
    /** @type {import('./tour.js').Guide|null} */
    this.guide = null;
    this.opener = new Opener(this);
    this.parts = new Parts(this);
    this.keypoints = new KeyPoints(this);
    this.target = new Target(this);
    this.transfer = new Transfer(this);
    // The picture may come after the parts, or come again; where there is none, the colours come all the same.
    for (const event of ['canvas', 'no-gpu']) stage.addEventListener(event, () => this.parts.takeColours());
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

  /** Changes what can be undone. @param {Partial<import('./doc.js').Doc>} patch @param {string|null} mark see {@link History.edit} */
  edit(patch, mark = null) {
    const before = this.doc;
    this.history.edit(patch, mark);
    this.react(before);
  }

  /** Changes it without a step back: for what the page finds out by itself. See {@link History.amend} */
  amend(patch, holds) {
    const before = this.doc;
    this.history.amend(patch, holds);
    this.react(before);
  }

  /** The page as a link has it, before something is opened. @param {Partial<import('./doc.js').Doc>} doc */
  reset(doc) {
    const { open } = this.doc;
    const blank = { ...BLANK, open, ...doc };
    this.history.rest();
    if (open) this.edit(blank, OPENING);
    else this.amend(blank);
    this.opener.linked = true;
  }

  undo() {
    const before = this.doc;
    if (!this.opener.underWay && this.history.undo()) this.#return(before);
  }

  redo() {
    const before = this.doc;
    if (!this.opener.underWay && this.history.redo()) this.#return(before);
  }

  /** Goes on from a state that was left. @param {import('./doc.js').Doc} doc */
  takeUp(doc) {
    const before = this.doc;
    this.history.edit(doc);
    this.#return(before);
  }

  #return(before) {
    const { open, changes, wanted } = this.doc;
    // The engine has to know it before anything is asked about it.
    if (before.open !== open) this.engine.call('restore', { kept: open.sequence }, { own: true }).catch(() => {});
    const react = () => this.react(before);
    if (onlyTurned(before.open, open)) this.stay(react);
    else react();
    if (before.open !== open || before.changes !== changes) this.parts.segment();
    else if (before.wanted !== wanted && this.result) this.parts.cut();
  }

  /** Has something happen to the figure that is open, of which all that is looked at stays as it is. */
  stay(act) {
    const { places, face, selected, timeline } = this;
    const { moment } = timeline;
    act();
    Object.assign(this, { places, face });
    this.select(selected);
    timeline.moment = moment;
  }

  /** Sees to all that follows from a change. @param {import('./doc.js').Doc} before */
  react(before) {
    const { doc } = this;
    const entered = before.open !== doc.open;
    if (entered) this.#enter();
    this.selected = Math.min(this.selected, doc.count - 1);
    if (before.target !== doc.target) this.transfer.forget();
    this.target.react(before, doc);
    // The motion first: it is looked at, what the points weigh is read.
    this.transfer.react(before, doc);
    this.keypoints.react(before, doc);
    this.changed('doc', 'link');
    if (before.changes !== doc.changes) this.changed('parameters');
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

  /** The colour of a key point, an sRGB triple; undefined before it is known. */
  pinColour(index) {
    if (!this.pinColours?.length) this.pinColours = this.stage.pinColours(MOST_POINTS);
    return this.pinColours.length ? this.pinColours.slice(3 * index, 3 * index + 3) : undefined;
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
    if (this.looksAtPair) PAIR_VIEWS[0].paint(this);
    else if (stepNamed(this.step).points || this.result) view.paint(this, placeIn(this, view));
    else {
      this.stage.boundaries = false;
      this.stage.paint(['paint_clay']);
    }
    this.changed('painted');
  }

  /** Whether both figures are shown, as they are. */
  get looksAtPair() {
    const { pair, points } = stepNamed(this.step);
    return Boolean(pair && !points && this.target.sequence);
  }

  get looksAtParts() {
    return !this.looksAtPair && viewOf(this.step, this.view) === PARTS_VIEW;
  }

  // Work and words.

  cancel() {
    if (this.recording) {
      this.recording.abort();
      return;
    }
    // What is being downloaded, the engine knows nothing of.
    this.busy?.stop.abort();
    this.engine.cancel();
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
