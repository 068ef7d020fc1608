/** The target: the second figure, and where the key points lie on it. */
import { Cancelled } from './engine.js';
import { collect } from './files.js';
import { OPENING } from './history.js';
import { fresh, unproposed } from './keypoints.js';
import { makeRoom } from './room.js';
import { latest } from './work.js';

/**
 * @typedef {object} Opened
 * @property {{kind: 'zoo', recipe: object}|{kind: 'files', files: {name: string, blob: Blob}[], options: object}} source
 * @property {object} sequence
 */

export class Target {
  /** @param {import('./app.js').App} app */
  constructor(app) {
    this.app = app;
    /** The sequence that the engine knows. */
    this.known = null;
    this.proposing = latest(() => this.#propose());
    /** The weights of the points on the target, once they were looked at: `{points, targets, weights}`. */
    this.field = null;
    this.weighing = latest(() => this.#weigh());
  }

  get sequence() {
    return this.app.doc.target?.sequence ?? null;
  }

  /**
   * @param {{places?: (vertices: number) => import('./keypoints.js').Point[], mark?: string|null}} [how] `places`: the
   *   points, where they are known; `mark`: of {@link import('./history.js').History.edit}
   */
  openCreature(recipe, how) {
    const source = { kind: 'zoo', recipe: { ...this.app.about.recipe, ...recipe } };
    return this.#open(source, async () => ({ recipe: source.recipe }), how);
  }

  /** @param {{name: string, blob: Blob}[]} files @param {object|null} options null: whatever the files are */
  async openFiles(files, options = null, how) {
    if (!options && (await this.app.opener.tookProject(files))) return true;
    const source = { kind: 'files', files, options: { ...this.app.about.options, ...options } };
    return this.#open(source, () => collect(files, source.options), how);
  }

  /** Turns the target, so that another axis of its files is up. What was placed on it stays. */
  turn(up) {
    const { source } = this.app.doc.target;
    const turned = { ...source, options: { ...source.options, up } };
    return this.#open(turned, () => collect(source.files, turned.options), { turned: true });
  }

  async #open(source, payload, { places, turned = false, mark = null } = {}) {
    const { app } = this;
    const sequence = await app.work.run('target', source.kind === 'zoo' ? 'making the creature' : 'reading', async (progress, signal) => {
      const message = await payload();
      if (signal.aborted) throw new Cancelled('Cancelled.');
      const transfer = (message.files ?? []).map((file) => file.bytes.buffer);
      return app.engine.call('target', message, { progress, transfer });
    });
    if (!sequence) return false;
    this.known = sequence;
    app.engine.keepTarget(sequence);
    const points = places?.(sequence.sizes.vertices) ?? (turned ? unproposed(app.doc.points) : app.doc.points.map(({ source: vertex }) => fresh(vertex)));
    app.edit({ target: { source, sequence }, points, ...(places && { count: points.length, run: null }) }, mark);
    makeRoom(app.history);
    return true;
  }

  /**
   * Opens two creatures of the zoo with the true pairs between them.
   * @param {string} source @param {string} target names
   */
  async openPair(source, target) {
    const recipes = [source, target].map((name) => ({ ...this.app.about.recipe, name }));
    const pairs = await this.#pairs(...recipes);
    if (pairs && (await this.app.opener.openCreature(recipes[0], { afresh: true }))) await this.#openWith(recipes[1], pairs);
  }

  /** Opens a creature beside the one that is open, with the true pairs between them. */
  async openTwin(recipe) {
    const target = { ...this.app.about.recipe, ...recipe };
    const pairs = await this.#pairs(this.app.source.recipe, target);
    if (pairs) await this.#openWith(target, pairs);
  }

  #pairs(source, target) {
    return this.app.work.run('pairs', 'finding the pairs', () => this.app.engine.call('landmarks', { source, target }));
  }

  #openWith(recipe, pairs) {
    const places = () => Array.from(pairs.source, (vertex, i) =>
      Object.freeze({ source: vertex, target: pairs.target[i], state: 'placed', confidence: 1, given: true }));
    // The places come with the source.
    return this.openCreature(recipe, { places, mark: OPENING });
  }

  close() {
    this.app.edit({ target: null, points: this.app.doc.points.map(({ source }) => fresh(source)) });
  }

  /** How many of the points in use are where: `{placed, proposed, missing}`. */
  get tally() {
    const tally = { placed: 0, proposed: 0, missing: 0 };
    for (const { state } of this.app.keypoints.used) tally[state === 'none' ? 'missing' : state]++;
    return tally;
  }

  /** The point whose place is most worth a click: of those that are proposed the one that is least sure; −1: none is. */
  get next() {
    const doubts = this.app.keypoints.used.map(({ state, confidence }) => (state === 'proposed' ? 1 - (confidence ?? 1) : -1));
    const most = Math.max(...doubts);
    return most < 0 ? -1 : doubts.indexOf(most);
  }

  /** The point that a click on the target places. */
  get wanted() {
    const { app, next } = this;
    if (app.selected >= 0) return app.selected;
    return next >= 0 ? next : app.keypoints.used.findIndex(({ state, crowded }) => state !== 'placed' && !crowded);
  }

  /** Puts a point where a vertex of the target is. */
  place(index, vertex, mark = null) {
    const { app } = this;
    const { points, count } = app.doc;
    if (!points[index]) return;
    const here = (target) => target != null && this.#spot(target) === this.#spot(vertex);
    if (points.some(({ target, state }, i) => i !== index && i < count && state === 'placed' && here(target))) return;
    // Where another one was only proposed, or is not in use, that one is looked for elsewhere.
    const free = points.map((point) => (here(point.target) ? fresh(point.source) : point));
    app.edit({ points: free.with(index, Object.freeze({ source: points[index].source, target: vertex, state: 'placed', confidence: 1 })) }, mark);
  }

  /** Takes a point away from the target. */
  remove(index) {
    const { points } = this.app.doc;
    if (points[index]?.target == null) return;
    this.app.edit({ points: points.with(index, Object.freeze({ ...fresh(points[index].source), state: 'none' })) });
    this.proposing();
  }

  accept(index) {
    const { points } = this.app.doc;
    if (points[index]?.state !== 'proposed') return;
    this.app.edit({ points: points.with(index, placed(points[index])) });
    this.proposing();
  }

  acceptAll() {
    this.app.edit({ points: this.app.doc.points.map((point) => (point.state === 'proposed' ? placed(point) : point)) });
    this.app.play();
  }

  /** Asks for all places again that are not certain, also those that were taken away. */
  proposeAgain() {
    const { points } = this.app.doc;
    this.app.edit({ points: points.map((point) => (point.state === 'placed' ? point : fresh(point.source))) });
    this.proposing();
  }

  /** Sees to it that the weights on the target are known. */
  weigh() {
    const { paired, field } = this;
    const same = field && paired.length === field.targets.length && paired.every(({ target }, i) => target === field.targets[i]);
    if (paired.length && !same) this.weighing();
  }

  get paired() {
    return this.app.keypoints.used.filter(({ target }) => target != null);
  }

  async #weigh() {
    const { app, paired } = this;
    const { target } = app.doc;
    const targets = paired.map((point) => point.target);
    if (!target || !targets.length || new Set(targets).size < targets.length) return;
    const weights = await app.work.run('weights', 'weights', (progress) =>
      app.engine.call('target_weights', { points: targets }, { progress }));
    if (!weights || app.doc.target !== target) return;
    this.field = { points: paired.map(({ source }) => source), targets, weights };
    if (app.view === 'weights') app.paint();
  }

  react(before, after) {
    const { app } = this;
    if (before.target !== after.target) {
      const sequence = after.target?.sequence ?? null;
      if (sequence !== this.known) {
        this.known = sequence;
        app.engine.keepTarget(sequence);
        const told = sequence ? app.engine.call('restore_target', { kept: sequence }) : app.engine.call('drop_target', {});
        told.catch(() => {});
      }
      this.field = null;
      app.changed('target');
    }
    if (app.view === 'weights') this.weigh();
    const used = after.points.slice(0, after.count);
    // A link says where points are proposed, and not how sure that is.
    if (after.target && used.some(({ state, confidence }) => state === 'missing' || confidence === null)) this.proposing();
  }

  async #propose() {
    const { app } = this;
    const { target } = app.doc;
    const { used } = app.keypoints;
    if (!target || used.every(({ state }) => state === 'placed')) return;
    const sources = used.map(({ source }) => source);
    const known = used.map(({ state, target: vertex }) => (state === 'placed' ? vertex : -1));
    const answer = await app.work.run('pairs', 'looking for the points', () => app.engine.call('propose', { points: sources, known }));
    if (!answer || app.doc.target !== target) return;
    const found = new Map(sources.map((source, i) => [source, { target: answer.targets[i], confidence: answer.confidences[i] }]));
    const points = app.doc.points.map((point) => proposed(point, found.get(point.source)));
    app.amend({ points: this.#apart(points) });
  }

  /** Where a vertex lies: others may lie there as well. */
  #spot(vertex) {
    return this.sequence.reference.subarray(3 * vertex, 3 * vertex + 3).join();
  }

  /** No two points lie in one place: those in use come first, of them those that were placed, then the surest. */
  #apart(points) {
    const { count } = this.app.doc;
    const rank = (i) => (i >= count ? -1 : points[i].state === 'placed' ? 2 : points[i].confidence);
    const taken = new Set();
    const apart = [...points];
    for (const i of [...points.keys()].sort((a, b) => rank(b) - rank(a))) {
      const { source, target } = points[i];
      if (target == null) continue;
      const spot = this.#spot(target);
      if (taken.has(spot)) apart[i] = i < count ? crowded(source) : fresh(source);
      taken.add(spot);
    }
    return apart;
  }
}

/** A point for which the target has no vertex left. */
const crowded = (source) => Object.freeze({ ...fresh(source), state: 'none', crowded: true });

const placed = (point) => Object.freeze({ ...point, state: 'placed', confidence: 1 });

/** A point with what is proposed for it, unless that was decided by hand. */
function proposed(point, proposal) {
  if (!proposal || point.state === 'placed' || (point.state === 'none' && !point.crowded)) return point;
  const target = point.confidence === null ? point.target : proposal.target;
  return Object.freeze({ source: point.source, target, state: 'proposed', confidence: proposal.confidence });
}
