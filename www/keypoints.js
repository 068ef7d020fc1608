/**
 * The key points of the source: finding them, using fewer or more of them, moving them by hand, and what follows from
 * those in use: their weights, the groups, the error.
 */
import { makeRoom } from './room.js';
import { stepNamed } from './steps/index.js';
import { BEGINNING } from './steps/search-parameters.js';
import { latest } from './work.js';

/** More than this many make neither a better motion nor a readable picture. */
export const MOST_POINTS = 60;

/**
 * @typedef {object} Point a key point and what is known of its place on the target; never changed, only replaced
 * @property {number} source vertex
 * @property {number|null} target vertex
 * @property {'missing'|'none'|'proposed'|'placed'} state `none`: taken away by hand, so not to be proposed
 * @property {number|null} confidence of a proposal; null: not known yet
 * @property {boolean} [crowded] `none` because the target has too few vertices
 * @property {boolean} [given] placed, but not by the visitor: it came with the creatures
 */

/** What the fit of given points depends on. */
const FITTING = ['lambda', 'gamma-rotation', 'gamma-shear', 'hold'];

/** @returns {Point} */
export const fresh = (source) => Object.freeze({ source, target: null, state: 'missing', confidence: 0 });

/** Points without what was only proposed for them. @param {Point[]} points */
export const unproposed = (points) => points.map((point) => (point.state === 'proposed' ? fresh(point.source) : point));

export class KeyPoints {
  /** @param {import('./app.js').App} app */
  constructor(app) {
    this.app = app;
    /** What follows from the points in use and the parameters they were found by: `{points, parameters, weights, groups, error, energies, radius}`. */
    this.fitted = null;
    /** Whether the next click on the source adds a point. */
    this.adding = false;
    this.fit = latest(() => this.#fit());
  }

  /** The points in use. @returns {Point[]} */
  get used() {
    const { points, count } = this.app.doc;
    return points.slice(0, count);
  }

  /** The parameters in force. */
  get parameters() {
    return { ...this.app.about.keypoints, ...BEGINNING, ...this.app.doc.search };
  }

  /** Whether the points in use are the first of those that the selection chose. */
  get untouched() {
    const { run } = this.app.doc;
    return Boolean(run) && this.used.every(({ source }, i) => source === run.key_points[i]);
  }

  /** Whether somebody worked on the points, so that they are not simply found again: on the source, or by a target. */
  get worked() {
    const { points, target } = this.app.doc;
    return points.length > 0 && (Boolean(target) || !this.untouched);
  }

  /** What the next search is to find: as many points as are in use, unless a rule decides. */
  get asked() {
    const { search, run, count } = this.app.doc;
    const known = run?.key_points.length ?? this.parameters.points ?? count;
    return !count || count === known ? search : { ...search, points: count };
  }

  /** The error with the points in use; undefined while it is not known. */
  get error() {
    const { run } = this.app.doc;
    return this.untouched ? run.errors[this.used.length - 1] : this.#current?.error;
  }

  /** What follows from the points in use, if it is known already. */
  get current() {
    return this.#current;
  }

  get #current() {
    const { used, fitted } = this;
    if (!fitted || fitted.points.length !== used.length || used.some(({ source }, i) => source !== fitted.points[i])) return null;
    const parameters = this.#fitting;
    return FITTING.every((name) => fitted.parameters[name] === parameters[name]) ? fitted : null;
  }

  /** The parameters that the points in use are fitted with: those that they were found by, also while others are tried. */
  get #fitting() {
    const { run, search } = this.app.doc;
    return { ...this.app.about.keypoints, ...BEGINNING, ...(run?.search ?? search) };
  }

  get hasMotion() {
    return (this.app.sequence?.sizes.poses ?? 0) > 0;
  }

  /** Finds them if there are none, or what follows from them if that was cancelled. */
  begin() {
    const { app } = this;
    if (!app.sequence || app.opener.underWay) return;
    if (app.doc.points.length) this.fit();
    else if (this.hasMotion && !this.searching) this.find();
  }

  /** Whether they are being looked for. */
  get searching() {
    return this.app.work.jobs.some(({ lane }) => lane === 'search');
  }

  /** Finds them anew in place of those that are there. */
  again() {
    this.app.edit({ search: { ...this.asked } });
    return this.find();
  }

  /**
   * Finds key points with the parameters in force. A step back goes to what was before the parameters changed.
   * @param {{more?: boolean}} [how] `more`: those that are there stay, and others are added to them
   */
  async find({ more = false } = {}) {
    const { app } = this;
    const { search, open } = app.doc;
    const run = await app.work.run('search', 'finding key points', (progress) =>
      app.engine.call('keypoints', { parameters: this.parameters }, { progress }));
    if (app.doc.search !== search || app.doc.open !== open) return;
    if (!run) {
      if (app.doc.run) app.amend({ search: app.doc.run.search });
      return;
    }
    run.search = search;
    delete app.places.candidates;
    const { doc } = app;
    const points = more ? this.#filled(run.key_points) : this.#knownOf(run.key_points);
    // They are there a step back or on as well, unless others are: what was changed meanwhile is not about them.
    app.amend({ run, points, count: points.length }, (state) =>
      state.open === open && state.search === search && state.run === doc.run && state.points === doc.points);
    makeRoom(app.history);
  }

  /** Points at some vertices, with what is known of them. */
  #knownOf(vertices) {
    const known = new Map(this.app.doc.points.map((point) => [point.source, point]));
    return Array.from(vertices, (vertex) => known.get(vertex) ?? fresh(vertex));
  }

  /** The points that are there, and after them those of `vertices` that are farthest from all before, until there are as many. */
  #filled(vertices) {
    const { points } = this.app.doc;
    const { reference } = this.app.sequence;
    const at = (vertex) => reference.subarray(3 * vertex, 3 * vertex + 3);
    const chosen = points.map(({ source }) => source);
    const free = Array.from(vertices, (vertex) => ({ vertex, away: Math.min(...chosen.map((other) => distance(at(vertex), at(other)))) }));
    while (chosen.length < vertices.length) {
      const farthest = free.reduce((best, each) => (each.away > best.away ? each : best));
      chosen.push(farthest.vertex);
      for (const each of free) each.away = Math.min(each.away, distance(at(each.vertex), at(farthest.vertex)));
    }
    return this.#knownOf(chosen);
  }

  /** @param {string} name of a parameter @param {any} value null: the engine's default */
  setParameter(name, value) {
    const { app } = this;
    const { [name]: _, ...search } = this.asked;
    if (value != null && value !== app.about.keypoints[name]) search[name] = value;
    // A bound or a rule takes the place of a number.
    if (name === 'error' || name === 'stop') search.points = null;
    app.edit({ search });
    return this.find();
  }

  /** When to stop: `count`, or a rule of the engine's. */
  setStop(rule) {
    if (rule !== 'count') return this.setParameter('stop', rule);
    const { stop, points, ...search } = this.app.doc.search;
    this.app.edit({ search });
    return this.find();
  }

  resetParameters() {
    this.app.edit({ search: {} });
    return this.find();
  }

  /**
   * Uses more or fewer points; more than there are have to be found first. A search chooses points that are good together,
   * so it may give up any; those that were worked on stay nevertheless.
   */
  setCount(wanted) {
    const { app } = this;
    const count = Math.min(Math.max(1, wanted), MOST_POINTS);
    if (count === app.doc.count) return undefined;
    if (count <= app.doc.points.length) {
      app.edit({ count }, 'count');
      return undefined;
    }
    app.edit({ search: { ...app.doc.search, points: count } }, 'count');
    return this.find({ more: this.worked });
  }

  /** Moves a point; its place on the target is asked anew. One that is not in use makes way. */
  move(index, vertex, mark = null) {
    const { app } = this;
    const { points, count } = app.doc;
    if (this.used.some(({ source }) => source === vertex)) return;
    const others = points.filter(({ source }, i) => i < count || source !== vertex);
    app.edit({ points: others.with(index, fresh(vertex)) }, mark);
  }

  /** Adds a point after those in use and selects it. */
  add(vertex) {
    const { app } = this;
    const { points, count } = app.doc;
    if (count >= MOST_POINTS) return;
    const others = points.filter(({ source }, i) => i < count || source !== vertex);
    if (others.slice(0, count).some(({ source }) => source === vertex)) return;
    app.edit({ points: others.toSpliced(count, 0, fresh(vertex)), count: count + 1 });
    app.select(count);
  }

  remove(index) {
    const { app } = this;
    const { points, count } = app.doc;
    if (index < 0 || index >= count) return;
    app.edit({ points: points.toSpliced(index, 1), count: count - 1 });
  }

  /** Goes back to the points as they were found. */
  restore() {
    const points = this.#knownOf(this.app.doc.run.key_points);
    this.app.edit({ points, count: points.length });
  }

  setAdding(on) {
    this.adding = on;
    this.app.changed('selected');
  }

  /** Another source: what follows from the points has to be found out anew. */
  forget() {
    this.fitted = null;
    this.adding = false;
    this.app.changed('points');
    this.fit();
    if (stepNamed(this.app.step).points) queueMicrotask(() => this.begin());
  }

  react(before, after) {
    if (before.points === after.points && before.count === after.count && before.run === after.run) return;
    this.app.changed('points');
    if (!this.#current) this.fit();
  }

  async #fit() {
    const { app } = this;
    const points = this.used.map(({ source }) => source);
    if (!points.length || this.#current) return;
    const { run } = app.doc;
    const parameters = this.#fitting;
    const known = run?.rounds && this.untouched && points.length === run.key_points.length;
    const answer = known ? run : await app.work.run('points', 'weights', (progress) =>
      app.engine.call('fit', { points, parameters }, { progress }));
    if (!answer) return;
    const { weights, groups, energies, rounds, fit_errors, radius } = answer;
    this.fitted = { points, parameters, weights, groups, energies, rounds, fit_errors, radius, error: known ? run.errors.at(-1) : answer.error };
    app.changed('points');
    app.paint();
  }
}

const distance = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
