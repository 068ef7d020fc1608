/** The parts of the source: segmenting it, taking more or fewer parts, their colours, and taking them away as a file. */
import { originals } from './files.js';
import { PARTS_VIEW } from './steps/index.js';
import { WORTH_STOPPING } from './work.js';

export class Parts {
  /** @param {import('./app.js').App} app */
  constructor(app) {
    this.app = app;
    /** The number of parts that is asked for while another is being cut. */
    this.queue = { running: false, next: undefined };
    /** Counts segmentations. */
    this.runs = 0;
  }

  /** Whether the parts are being looked for, or what they are to be of. */
  get searching() {
    return this.app.opener.underWay > 0 || this.app.work.jobs.some(({ lane }) => lane === 'source');
  }

  /** Finds the parts if there are none, because that was cancelled. */
  begin() {
    const { app } = this;
    if (app.sequence && !app.result && !this.searching) this.segment();
  }

  /** Segments what is open with the parameters in force. */
  async segment() {
    const { app } = this;
    if (!app.sequence || app.opener.underWay) return;
    this.#giveWay();
    const { parameters, changes } = app;
    const run = ++this.runs;
    const result = await app.work.run('source', 'segmenting', (progress) =>
      app.engine.call('segment', { parameters }, { progress }));
    if (!result) {
      if (run === this.runs) this.#takeBack();
      return;
    }
    result.changes = changes;
    result.automatic = pickParts(result);
    result.curve = costCurve(result);
    app.result = result;
    if (app.wanted != null && parameters.method === 'tree') await this.#fetch(app.wanted);
    this.#paint();
    if (app.looksAtParts) app.stage.flowFrom(Uint32Array.from(result.features, ({ face }) => face));
    app.changed('result', 'link');
  }

  /** After a cancel or an error the parameters are again those of the parts that are shown. */
  #takeBack() {
    const { app } = this;
    if (!app.result) return;
    app.amend({ changes: app.result.changes });
    app.changed('parameters');
  }

  /** Another number of parts; null: the engine's own choice. Of many calls in a row the last one counts. */
  setCount(count) {
    const { app } = this;
    if (!app.result || app.opener.underWay) return undefined;
    app.edit({ wanted: count }, 'parts');
    return this.cut();
  }

  /** Cuts the tree into as many parts as are wanted. */
  async cut() {
    const { app, queue } = this;
    queue.next = app.wanted;
    if (queue.running) return;
    queue.running = true;
    while (queue.next !== undefined) {
      const next = queue.next;
      queue.next = undefined;
      await this.#fetch(next);
      this.#paint();
      app.changed('result');
    }
    queue.running = false;
  }

  async #fetch(count) {
    const { app } = this;
    const { result, parameters } = app;
    if (count == null || count === result.automatic.parts.length) {
      Object.assign(result, result.automatic);
      return;
    }
    const answer = await app.work.run('source', 'cutting the tree', (progress) =>
      app.engine.call('parts', { parameters, parts: count }, { progress }));
    if (!answer || app.result !== result) return;
    Object.assign(result, pickParts(answer));
    // A link may ask for more than the finest parts, or for fewer than there are pieces: what is shown is what there is.
    if (app.wanted === count && count !== result.parts.length) app.amend({ wanted: result.parts.length });
  }

  /** The open sequence as a skin with a joint for each part: `{bytes, error, rms}`, over the diagonal. */
  exportRigid() {
    const { app } = this;
    const { result } = app;
    if (!this.ready()) return undefined;
    return app.work.run('export rigid', 'writing the file', async () =>
      app.engine.call('export_rigid', { labels: result.labels, ...await originals(app.source) }));
  }

  /** The open sequence in its coloured parts as the bytes of a GLB; undefined if that did not work. */
  export() {
    const { app } = this;
    const { result, colours } = app;
    if (!this.ready()) return undefined;
    return app.work.run('export', 'writing the file', () => app.engine.call('export', { labels: result.labels, colours }));
  }

  /** Whether there are parts to be taken away, and a word where there are not. */
  ready() {
    const { app } = this;
    if (!app.result) app.say(this.searching ? 'The parts are still being looked for.' : 'There are no parts yet. The step Parts finds them.', 'news');
    return Boolean(app.result) && !app.opener.underWay;
  }

  /** @param {string} name of a parameter @param {any} value null: the engine's default */
  setParameter(name, value) {
    const { app } = this;
    const isDefault = value == null || value === app.about.parameters[name];
    const changes = isDefault ? without(app.changes, name) : { ...app.changes, [name]: value };
    app.edit(name === 'method' ? { changes, wanted: null } : { changes });
    return this.segment();
  }

  resetParameters() {
    this.app.edit({ changes: {} });
    return this.segment();
  }

  /** Paints new parts, remembers what colour each has, and goes back to the view in force. */
  #paint() {
    const { app } = this;
    app.stage.unmark();
    PARTS_VIEW.paint(app);
    app.colours = app.stage.partColours;
    if (!app.looksAtParts) app.paint();
  }

  /** Asks a new picture for the colours of what is there already. */
  takeColours() {
    const { app } = this;
    if (!app.result) return;
    this.#paint();
    app.changed('result', 'points');
  }

  /** Stops a segmentation that runs if a newer question would have to wait for it. */
  #giveWay() {
    const { busy } = this.app;
    if (busy?.lane === 'source' && busy.left > WORTH_STOPPING) this.app.cancel();
  }
}

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
