/**
 * The page's side of the worker.
 *
 * The page sends `{id, operation, …}` and hears `{id, progress: {stage, done}}` any number of times, then one of
 * `{id, result}`, `{id, error}` (a sentence; the engine goes on) or `{id, crash}` (the engine is broken). To cancel
 * is to end the worker. A new one starts from the module that is compiled already and gets back the open sequence,
 * which the page keeps; so a cancel or a crash costs one step and nothing else.
 */

/** What a cancelled call rejects with. */
export class Cancelled extends Error {}

const CRASHED = 'This step failed inside the engine, which has been started afresh. Nothing that was open is lost.';

const NEVER_RAN = 'The engine could not be started in this browser. Sinew needs WebAssembly and module workers.';

export class Engine {
  /** @param {Promise<WebAssembly.Module>} module */
  constructor(module) {
    this.module = module;
    this.pending = new Map();
    this.next = 0;
    this.kept = null;
    this.alive = false;
    /** What the engine says about itself: default parameters and options, creatures. */
    this.about = this.#start();
  }

  /**
   * @param {string} operation
   * @param {object} payload
   * @param {{progress?: (p: {stage: string, done: number}) => void, transfer?: Transferable[]}} [how]
   * @returns {Promise<any>}
   */
  call(operation, payload, { progress, transfer = [] } = {}) {
    const id = this.next++;
    const answer = new Promise((resolve, reject) => this.pending.set(id, { resolve, reject, progress }));
    this.worker.postMessage({ id, operation, ...payload }, transfer);
    return answer;
  }

  /** Says which sequence a new worker must know. */
  keep({ name, pose_names, times, faces, reference, poses, polygons }) {
    this.kept = { name, pose_names, times, faces, reference, poses, polygons };
  }

  /** Stops whatever runs. */
  cancel() {
    this.#restart(new Cancelled('Cancelled.'));
  }

  async #start() {
    const worker = new Worker(new URL('worker.js', import.meta.url), { type: 'module' });
    this.worker = worker;
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
    const about = this.call('start', { module });
    about.then(() => (this.alive = true), () => {});
    if (this.kept) this.call('restore', { kept: this.kept }).catch(() => {});
    for (const message of held) post(...message);
    return about;
  }

  #hear({ id, progress, result, error, crash }) {
    const call = this.pending.get(id);
    if (!call) return;
    if (progress) {
      call.progress?.(progress);
      return;
    }
    this.pending.delete(id);
    if (crash !== undefined) {
      this.pending.set(id, call);
      this.#broken(crash);
    } else if (error !== undefined) call.reject(new Error(error));
    else call.resolve(result);
  }

  #broken(cause) {
    console.error('The worker broke:', cause);
    this.#restart(new Error(CRASHED));
  }

  #restart(reason) {
    this.worker.terminate();
    if (!this.alive && !(reason instanceof Cancelled)) {
      // It never ran: another attempt would fail in the same way.
      for (const call of this.pending.values()) call.reject(new Error(NEVER_RAN));
      this.pending.clear();
      return;
    }
    const pending = [...this.pending.values()];
    this.pending.clear();
    this.#start().catch(() => {});
    for (const call of pending) call.reject(reason);
  }
}
