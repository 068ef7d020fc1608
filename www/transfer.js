/** The motion of the target: follows from the pairs, and can be taken away as a file. */
import { originals } from './files.js';
import { latest } from './work.js';

export class Transfer {
  /** @param {import('./app.js').App} app */
  constructor(app) {
    this.app = app;
    /** The engine's answer: `{handles, indices, weights, K, matrices, warnings, seconds}`; null: the target stands still. */
    this.motion = null;
    /** What was asked for the motion that the engine could write to a file, and the worker that knows it: a new one knows none. */
    this.told = {};
    /** Files that were made of this motion, by form. */
    this.files = new Map();
    this.move = latest(() => this.#move());
    /** Another method that is shown beside it, '' for none, and where it puts the vertices. */
    this.rival = '';
    this.other = null;
    this.compare = latest(() => this.#compare());
  }

  /** How the target moves. */
  get method() {
    return this.app.doc.method || this.app.about.transfer.method;
  }

  setMethod(method) {
    this.app.edit({ method: method === this.app.about.transfer.method ? '' : method });
  }

  /** Shows the target by another method than that in force in place of the source. @param {string} method '' for the source */
  setRival(method) {
    this.rival = method === this.method ? '' : method;
    this.#setOther(null);
    this.compare();
    this.app.changed('link');
  }

  /** The points that have a place on both sides. */
  get pairs() {
    return this.app.keypoints.used.filter(({ target }) => target != null).map(({ source, target }) => ({ source, target }));
  }

  /** The motion was that of another figure. */
  forget() {
    this.#set(null);
  }

  react(before, after) {
    // A method is not compared with itself.
    if (this.rival && this.rival === this.method) this.setRival('');
    const same = before.open === after.open && before.target === after.target && before.method === after.method && before.count === after.count && before.points === after.points;
    if (!same && after.target) this.move();
  }

  get #message() {
    const { app, pairs } = this;
    return {
      pairs: pairs.flatMap(({ source, target: vertex }) => [source, vertex]),
      parameters: { ...app.about.transfer, method: this.method },
      quick: app.held,
    };
  }

  /** Whether the target moves as its points and the method in force say. */
  get current() {
    const { pairs, parameters } = this.#message;
    const asked = this.motion?.asked;
    return asked?.parameters.method === parameters.method && asked.pairs.length === pairs.length && asked.pairs.every((vertex, i) => vertex === pairs[i]);
  }

  /** Whether it should move but nobody works on that, because it was cancelled or failed. */
  get behind() {
    const { app, pairs } = this;
    return Boolean(app.doc.target) && pairs.length > 0 && app.keypoints.hasMotion && !this.current && !app.work.jobs.some(({ lane }) => lane === 'motion');
  }

  /** Goes on with what was cancelled. */
  begin() {
    if (this.behind && !this.app.opener.underWay) this.move();
  }

  async #move() {
    const { app, pairs } = this;
    const { target, open } = app.doc;
    if (!target || !pairs.length || !app.keypoints.hasMotion) {
      if (this.motion) this.#set(null);
      return;
    }
    if (this.current && !this.motion.quick) return;
    const started = performance.now();
    const message = this.#message;
    const answer = await app.work.run('motion', 'moving the target', (progress) => this.#ask(message, progress));
    if (app.doc.target !== target || app.doc.open !== open) return;
    if (!answer) {
      this.#takeBack(message);
      return;
    }
    answer.took = (performance.now() - started) / 1000;
    answer.pairs = pairs.length;
    answer.quick = message.quick;
    this.#set(answer);
  }

  /** Asks the engine for a motion, which takes the place of the one that it knew. */
  async #ask(message, progress) {
    const { engine } = this.app;
    this.told = {};
    const answer = await engine.call('transfer', message, { progress });
    this.told = { asked: message, worker: engine.worker };
    answer.asked = message;
    return answer;
  }

  /** After a cancel or an error the method is again that of the motion that is shown, unless another was chosen meanwhile. */
  #takeBack({ parameters }) {
    const { app, motion } = this;
    const shown = motion?.asked.parameters.method;
    if (motion && shown !== this.method && parameters.method === this.method) app.amend({ method: shown === app.about.transfer.method ? '' : shown });
  }

  #set(motion) {
    this.motion = motion;
    this.files.clear();
    this.#setOther(null);
    this.app.changed('motion');
    if (this.app.view === 'fit') this.app.paint();
    this.compare();
  }

  async #compare() {
    const { app, rival, motion } = this;
    const { target } = app.doc;
    if (!rival || !motion || app.held) return;
    // Both as positions, so that the distance between them can be told.
    const ask = (method) => app.engine.call('positions_by', { pairs: this.#message.pairs, parameters: { ...app.about.transfer, method } });
    const answers = await app.work.run('rival', 'comparing', async () =>
      [await ask(rival), motion.positions ? motion : await ask(this.method)]);
    if (!answers || app.doc.target !== target || this.motion !== motion || this.rival !== rival) return;
    this.#setOther({ method: rival, positions: answers[0].positions, own: answers[1].positions });
  }

  #setOther(other) {
    if (this.other === other) return;
    this.other = other;
    this.app.changed('rival');
  }

  /**
   * The moving target as a GLB, made once.
   * @param {'exact'|'light'} form
   * @returns {Promise<{blob: Blob, error: number, rms: number, images: number}|undefined>} errors that the form adds, over
   *   the diagonal; how many images it has, −1: it is of clay
   */
  async file(form) {
    const { app, motion } = this;
    if (!motion) return undefined;
    if (!this.files.has(form)) {
      const answer = await app.work.run(`export ${form}`, 'writing the file', async (progress) => {
        const looks = await originals(app.doc.target.source);
        // Since something was cancelled, another worker may be there.
        if (this.told.asked !== motion.asked || this.told.worker !== app.engine.worker) await this.#ask(motion.asked, progress);
        return app.engine.call('export_transfer', { form, ...looks }, { progress });
      });
      if (!answer || this.motion !== motion) return undefined;
      const { bytes, error, rms, images } = answer;
      this.files.set(form, { blob: new Blob([bytes], { type: 'model/gltf-binary' }), error, rms, images });
      app.changed('files');
    }
    return this.files.get(form);
  }
}
