/**
 * The state of the page and what can be done to it. Everything that shows something listens to the events named
 * after what changed: `source`, `result`, `parameters`, `step`, `view`, `busy`, `notice`, `panel`, `link`.
 */
import { Cancelled } from './engine.js';
import { collect, fetchSource } from './files.js';
import { VIEWS } from './steps/views.js';

const PARTS = VIEWS.at(-1);
/** A change of a parameter during a run that will take longer than this (seconds) stops the run. */
const WORTH_STOPPING = 1;

export class App extends EventTarget {
  /**
   * @param {import('./engine.js').Engine} engine
   * @param {import('./stage.js').Stage} stage
   */
  constructor(engine, stage) {
    super();
    this.engine = engine;
    this.stage = stage;
    /** Defaults and names, from the engine. */
    this.about = null;
    this.step = 'parts';
    this.view = 'parts';
    /** Which feature and which round of clustering the stage views show. */
    this.feature = 0;
    this.round = 0;
    /** @type {null|{kind: 'zoo', recipe: object}|{kind: 'files'|'src', files: {name: string, blob: Blob}[], options: object, url?: string}} */
    this.source = null;
    this.sequence = null;
    /** Parameters that differ from the engine's defaults. */
    this.changes = {};
    /** The number of parts that was asked for; null: the engine's own choice. */
    this.wanted = null;
    this.result = null;
    /** sRGB triples of the parts. */
    this.colours = new Uint8Array();
    this.busy = null;
    this.notice = null;
    this.panel = true;
    this.partsQueue = { running: false, next: undefined };
    /** How many openings are under way; meanwhile the engine and the page may differ about what is open. */
    this.opening = 0;
    /** Counts what was started, so that a late answer to an outdated question is dropped. */
    this.turn = 0;
    /** Counts segmentations. */
    this.runs = 0;
  }

  changed(...what) {
    for (const name of what) this.dispatchEvent(new Event(name));
  }

  on(names, listener) {
    for (const name of names.split(' ')) this.addEventListener(name, listener);
  }

  /** The parameters in force. */
  get parameters() {
    return { ...this.about.parameters, ...this.changes, parts: null };
  }

  // What is open.

  openCreature(recipe) {
    const source = { kind: 'zoo', recipe: { ...this.about.recipe, ...recipe } };
    return this.#open('zoo', source, async () => ({ recipe: source.recipe }));
  }

  /** @param {{name: string, blob: Blob}[]} files */
  openFiles(files, options = {}) {
    const source = { kind: 'files', files, options: { ...this.about.options, ...options } };
    return this.#open('open', source, () => collect(files, source.options));
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

  async #open(operation, source, payload) {
    this.#giveWay();
    this.opening++;
    const sequence = await this.#run(operation === 'zoo' ? 'making the creature' : 'reading', async (progress) => {
      const message = await payload(progress);
      const transfer = (message.files ?? []).map((file) => file.bytes.buffer);
      return this.engine.call(operation, message, { progress, transfer });
    });
    this.opening--;
    if (!sequence) return false;
    this.engine.keep(sequence);
    Object.assign(this, { source, sequence, result: null, wanted: null, feature: 0, round: 0, notice: null });
    // Numbered shapes have no time of their own; a walk made by code closes on itself.
    sequence.timed = sequence.times.some((time, i) => time !== sequence.times[0] && i > 0);
    sequence.loop = source.kind === 'zoo' || !sequence.timed;
    this.stage.describe(`${sequence.name}, ${sequence.sizes.faces} faces`);
    this.stage.open(sequence, sequence.loop && sequence.sizes.poses > 1);
    this.changed('source', 'result', 'parameters', 'notice', 'link');
    await this.segment();
    return true;
  }

  // Segmentation.

  /** Segments what is open with the parameters in force. */
  async segment() {
    if (!this.sequence || this.opening) return;
    this.#giveWay();
    const { wanted, parameters } = this;
    const run = ++this.runs;
    const changes = { ...this.changes };
    const result = await this.#run('segmenting', (progress) =>
      this.engine.call('segment', { parameters }, { progress }));
    if (!result) {
      if (run === this.runs) this.#takeBack();
      return;
    }
    result.changes = changes;
    result.automatic = pickParts(result);
    result.curve = costCurve(result);
    this.result = result;
    if (wanted != null && parameters.method === 'tree') await this.#fetchParts(wanted);
    this.feature = Math.min(this.feature, Math.max(0, result.features.length - 1));
    this.round = Math.max(0, result.rounds.length - 1);
    this.#paintParts();
    if (this.#view() === PARTS) this.stage.flowFrom(Uint32Array.from(result.features, ({ face }) => face));
    this.changed('result', 'link');
  }

  /** After a cancel or an error the parameters are again those of the parts that are shown. */
  #takeBack() {
    if (!this.result) return;
    this.changes = { ...this.result.changes };
    this.changed('parameters', 'link');
  }

  /** Another number of parts; null: the engine's own choice. Of many calls in a row the last one counts. */
  async setParts(count) {
    if (!this.result || this.opening) return;
    this.wanted = count;
    this.changed('link');
    const queue = this.partsQueue;
    queue.next = count;
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
    const answer = await this.#run('cutting the tree', (progress) =>
      this.engine.call('parts', { parameters, parts: count }, { progress }));
    if (answer && this.result === result) Object.assign(result, pickParts(answer));
  }

  /** The open sequence in its coloured parts as the bytes of a GLB; undefined if that did not work. */
  exportParts() {
    const { result, colours } = this;
    if (!result || this.opening) return undefined;
    return this.#run('writing the file', () => this.engine.call('export', { labels: result.labels, colours }));
  }

  /** @param {string} name of a parameter @param {any} value null: the engine's default */
  setParameter(name, value) {
    if (value == null || value === this.about.parameters[name]) delete this.changes[name];
    else this.changes[name] = value;
    if (name === 'method') this.wanted = null;
    this.changed('parameters', 'link');
    return this.segment();
  }

  resetParameters() {
    this.changes = {};
    this.changed('parameters', 'link');
    return this.segment();
  }

  // What is looked at.

  setStep(step) {
    this.step = step;
    this.changed('step', 'link');
    this.paint();
  }

  setView(view) {
    this.view = view;
    this.changed('view', 'link');
    this.paint();
  }

  setFeature(index) {
    this.feature = clamp(index, 0, this.result.features.length - 1);
    this.changed('view');
    this.paint();
  }

  setRound(index) {
    this.round = clamp(index, 0, this.result.rounds.length - 1);
    this.changed('view');
    this.paint();
  }

  setPanel(open) {
    this.panel = open;
    this.changed('panel', 'link');
  }

  /** Paints the creature as the step and the view in force ask. */
  paint() {
    if (!this.sequence) return;
    this.stage.unmark();
    if (this.result) {
      this.#view().paint(this);
      return;
    }
    this.stage.boundaries = false;
    this.stage.paint(['paint_clay']);
  }

  #view() {
    return (this.step === 'parts' && VIEWS.find(({ id }) => id === this.view)) || PARTS;
  }

  /** Paints new parts, remembers what colour each has, and goes back to the view in force. */
  #paintParts() {
    this.stage.unmark();
    PARTS.paint(this);
    this.colours = this.stage.partColours;
    if (this.#view() !== PARTS) this.paint();
  }

  // Work and words.

  cancel() {
    this.engine.cancel();
  }

  /** Stops what runs if a newer question would have to wait for it. */
  #giveWay() {
    if (this.busy?.left > WORTH_STOPPING) this.cancel();
  }

  /** Tells the visitor something, calmly. */
  say(text, kind = 'error') {
    this.notice = { text: text.charAt(0).toUpperCase() + text.slice(1), kind };
    this.changed('notice');
  }

  dismiss() {
    this.notice = null;
    this.changed('notice');
  }

  /**
   * Runs something long: shows progress, says what went wrong, drops answers that came too late.
   * @returns {Promise<any>} undefined if it was cancelled, failed, or something newer was started
   */
  async #run(label, work) {
    const turn = ++this.turn;
    const busy = { label, stage: label, done: 0, left: NaN, started: performance.now() };
    this.busy = busy;
    this.changed('busy');
    const progress = ({ stage, done }) => {
      const elapsed = (performance.now() - busy.started) / 1000;
      Object.assign(busy, { stage, done, left: done > 0.02 ? (elapsed * (1 - done)) / done : NaN });
      if (this.busy === busy) this.changed('busy');
    };
    try {
      const answer = await work(progress);
      return turn === this.turn ? answer : undefined;
    } catch (error) {
      if (!(error instanceof Cancelled)) this.say(error.message);
      return undefined;
    } finally {
      if (this.busy === busy) {
        this.busy = null;
        this.changed('busy');
      }
    }
  }
}

const clamp = (value, low, high) => Math.min(Math.max(value, low), Math.max(low, high));

const pickParts = ({ labels, unsmoothed, parts, rigid_residual, residual_before_smoothing }) =>
  ({ labels, unsmoothed, parts, rigid_residual, residual_before_smoothing });

/** What it costs to go from one more part to `parts`: the merge tree read from its finest end. */
function costCurve({ merges, rounds }) {
  if (!merges.length || !rounds.length) return [];
  const finest = new Set(rounds.at(-1)).size;
  return merges.map(({ cost }, i) => ({ parts: finest - i - 1, cost }));
}
