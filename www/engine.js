/**
 * The page's side of the worker.
 *
 * The page sends `{id, operation, …}` and hears `{id, progress: {stage, done}}` any number of times, then one of
 * `{id, result, helped}` (and how many results came from helpers so far), `{id, error}` (a sentence; the engine goes on) or
 * `{id, crash, memory}` (the engine is broken, and how many bytes it had). To cancel is to end the worker. A new one starts
 * from the module that is compiled already, gets back the open meshes, which the page keeps, and then the questions that
 * were waiting; so a cancel or a crash costs one step and nothing else. What breaks it while it starts is not tried again
 * by itself.
 */

import { bytes } from './format.js';

/** What a cancelled call rejects with. */
export class Cancelled extends Error {}

const CRASHED = 'This step failed inside the engine, which has been started afresh. Nothing that was open is lost.';

const FULL = (size) => `This step ran out of memory: the engine had taken ${size} and got no more. It has been started afresh, and nothing that was open is lost. Take fewer poses, or a simpler mesh.`;

/** An engine that has taken more than this and breaks has run out of memory, as a rule. */
const MUCH = 2 ** 30;

const NEVER_RAN = 'The engine could not be started in this browser. Sinew needs WebAssembly and module workers.';

const NOT_AGAIN = 'The engine could not be started again. The browser may be short of memory: try once more, or load the page anew.';

/** What is said where the engine breaks over what it is given back. */
const LOST = {
  restore: 'The engine broke when it took back the figure that is open, and goes on without it. Open it again, or a simpler one.',
  restore_target: 'The engine broke when it took back the target, and goes on without it. Open it again, or a simpler one.',
};

export class Engine {
  /** @param {Promise<WebAssembly.Module>} module */
  constructor(module) {
    this.module = module;
    this.pending = new Map();
    this.next = 0;
    /** What a new worker must know: by the operation that gives it back. @type {Map<string, object>} */
    this.kept = new Map();
    /** Hears of what went wrong outside of any question. @type {(error: Error) => void} */
    this.trouble = () => {};
    /** Whether the worker that is there has started, and whether any ever has. */
    this.alive = false;
    this.ran = false;
    /** How many results the worker got from helpers, see crew.js. */
    this.helped = 0;
    /** What the engine says about itself: default parameters and options, creatures. */
    this.about = this.#start();
  }

  /**
   * @param {string} operation
   * @param {object} payload
   * @param {{progress?: (p: {stage: string, done: number}) => void, transfer?: Transferable[], own?: boolean}} [how]
   *   `own`: the engine's own business with a new worker
   * @returns {Promise<any>}
   */
  call(operation, payload, { progress, transfer = [], own = false } = {}) {
    if (!this.worker) this.#start().catch(() => {});
    const id = this.next++;
    // What is handed over cannot be asked again.
    const message = transfer.length ? null : { operation, ...payload };
    const answer = new Promise((resolve, reject) => this.pending.set(id, { resolve, reject, progress, message, own }));
    this.worker.postMessage({ id, operation, ...payload }, transfer);
    return answer;
  }

  /** Says which source a new worker must know. */
  keep(sequence) {
    this.kept.set('restore', parcel(sequence));
  }

  /** Says which target a new worker must know; null: none. */
  keepTarget(sequence) {
    if (sequence) this.kept.set('restore_target', parcel(sequence));
    else this.kept.delete('restore_target');
  }

  /** Stops what runs; with `all` also what waits. */
  cancel({ all = false } = {}) {
    if (this.pending.size) this.#restart(new Cancelled('Cancelled.'), all);
  }

  async #start() {
    const worker = new Worker(new URL('worker.js', import.meta.url), { type: 'module' });
    this.worker = worker;
    this.alive = false;
    worker.addEventListener('message', ({ data }) => worker === this.worker && this.#hear(data));
    worker.addEventListener('error', (event) => {
      event.preventDefault();
      if (worker === this.worker) this.#broken(event.message);
    });
    // Calls made before the module is compiled must come after “start”: hold them back.
    const post = worker.postMessage.bind(worker);
    const held = [];
    worker.postMessage = (...message) => held.push(message);
    const module = await this.module;
    worker.postMessage = post;
    if (worker !== this.worker) throw new Cancelled('Cancelled.');
    const about = this.call('start', { module }, { own: true });
    about.then(() => (this.alive = this.ran = true), () => {});
    for (const [operation, kept] of this.kept) this.call(operation, { kept }, { own: true }).catch(() => {});
    for (const message of held) post(...message);
    return about;
  }

  #hear({ id, progress, result, helped, error, crash, memory }) {
    if (crash !== undefined) {
      this.#broken(crash, memory, this.pending.get(id));
      return;
    }
    const call = this.pending.get(id);
    if (!call) return;
    if (progress) {
      call.progress?.(progress);
      return;
    }
    this.pending.delete(id);
    if (error !== undefined) call.reject(new Error(error));
    else {
      this.helped = helped;
      call.resolve(result);
    }
  }

  #broken(cause, memory = 0, call = null) {
    console.error('The worker broke:', cause);
    if (!this.alive) this.#giveUp(new Error(this.ran ? NOT_AGAIN : NEVER_RAN));
    else if (call?.own) this.#goOnWithout(call.message.operation);
    else this.#restart(new Error(memory > MUCH ? FULL(bytes(memory)) : CRASHED));
  }

  /** Another attempt would fail in the same way: the next one is made when something is asked. */
  #giveUp(error) {
    this.worker.terminate();
    this.worker = null;
    for (const call of this.pending.values()) call.reject(error);
    this.pending.clear();
    this.trouble(error);
  }

  /** What was kept breaks the engine, and would do so again and again. */
  #goOnWithout(operation) {
    this.kept.delete(operation);
    const error = new Error(LOST[operation]);
    this.#restart(error, true);
    this.trouble(error);
  }

  #restart(reason, all = false) {
    this.worker.terminate();
    const calls = [...this.pending].sort(([a], [b]) => a - b);
    this.pending.clear();
    this.#start().catch(() => {});
    for (const [, call] of calls) if (call.own) call.reject(new Cancelled('Started again.'));
    // The worker answers in order: the first is the one that ran. The others are asked again.
    const [first, ...waiting] = calls.filter(([, call]) => !call.own);
    first?.[1].reject(reason);
    for (const [id, call] of waiting) {
      if (all || !call.message) call.reject(reason);
      else {
        this.pending.set(id, call);
        this.worker.postMessage({ id, ...call.message });
      }
    }
  }
}

const parcel = ({ name, pose_names, times, faces, reference, poses, polygons }) =>
  ({ name, pose_names, times, faces, reference, poses, polygons });
