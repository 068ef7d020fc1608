/**
 * Undo and redo: a line of snapshots of one small immutable state. Big things in a snapshot (a mesh, a result) are
 * only referred to.
 */

const MOST = 200;

/** The mark of all that belongs to one opening of a figure. */
export const OPENING = 'opening';

/** @template {object} State */
export class History {
  /** @param {State} now */
  constructor(now) {
    this.now = now;
    this.past = [];
    this.future = [];
    this.mark = null;
  }

  /**
   * Goes on to another state.
   * @param {Partial<State>} patch
   * @param {string|null} mark steps in a row with the same mark, such as those of one drag, are one step back
   */
  edit(patch, mark = null) {
    if (mark === null || mark !== this.mark) this.past.push(this.now);
    if (this.past.length > MOST) this.past.shift();
    this.mark = mark;
    this.future = [];
    this.now = Object.freeze({ ...this.now, ...patch });
  }

  /**
   * Corrects the state that is in force, without a step back, and the others that it is true of as well.
   * @param {Partial<State>} patch
   * @param {(state: State) => boolean} holds whether it is true of a state before or after
   */
  amend(patch, holds = () => false) {
    const amended = (state) => Object.freeze({ ...state, ...patch });
    const where = (state) => (holds(state) ? amended(state) : state);
    Object.assign(this, { now: amended(this.now), past: this.past.map(where), future: this.future.map(where) });
  }

  /** Ends a row of steps that are one step back. */
  rest() {
    this.mark = null;
  }

  /**
   * Forgets everything but a state that is in force from now on, and what was before the opening that led to it.
   * @param {State} now @param {string|null} mark as of {@link edit}
   */
  restart(now, mark = null) {
    const past = this.mark === OPENING ? this.past : [];
    Object.assign(this, { now: Object.freeze(now), past, future: [], mark });
  }

  /** Forgets the newest state that is not worth its room, and all before it. @param {(state: State) => boolean} worth asked from the newest on */
  trim(worth) {
    this.past.splice(0, this.past.findLastIndex((state) => !worth(state)) + 1);
  }

  undo() {
    return this.#go(this.past, this.future);
  }

  redo() {
    return this.#go(this.future, this.past);
  }

  #go(from, to) {
    if (!from.length) return false;
    to.push(this.now);
    this.now = from.pop();
    this.mark = null;
    return true;
  }
}
