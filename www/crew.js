/**
 * A crew: workers that share out one operation of the engine. They share no memory, so each runs all of it, on the same
 * meshes, and what is costly is divided: at a meeting each does some of the items, and all get the results of all. See
 * src/crew.rs for what the engine asks of a crew.
 *
 * The leader is the engine's own worker. It starts helpers (helper.js) when an operation begins and ends them with it. It
 * never needs them: items of helpers that are not there yet, late or broken are done by the leader.
 */

/** The most workers in a crew. */
const MOST = 8;

/** A helper that is at a meeting is waited for so many times as long as the leader's longest item took, and no less than… */
const PATIENCE = 2;
const LEAST_PATIENCE = 20;

/**
 * How many workers are worth it on this machine, if there is enough to do: one for two of its threads. Two threads of one
 * core get little more done than one, and what is not divided every member does.
 */
export const most = () => Math.min(Math.max(navigator.hardwareConcurrency >> 1, 1), MOST);

/** Nobody else. */
export const ALONE = { size: 1 };

export class Leader {
  /**
   * @param {object} task what a helper is to do: `{module, kept, operation, payload}`
   * @param {number} size members, this one included
   */
  constructor(task, size) {
    this.size = size;
    /** How many results came from helpers. */
    this.helped = 0;
    this.meeting = -1;
    /** What helpers handed in for meetings to come. */
    this.early = [];
    this.helpers = Array.from({ length: size - 1 }, (_, i) => this.#start(i + 1, task));
  }

  /** Ends the helpers. */
  end() {
    for (const helper of this.helpers) helper.worker.terminate();
  }

  meet(count) {
    this.meeting++;
    this.found = [];
    this.count = count;
    this.longest = 0;
    const early = this.early;
    this.early = [];
    for (const message of early) this.#hear(message);
  }

  async next() {
    await turn();
    let waited = 0;
    for (;;) {
      if (this.#complete()) {
        const news = { meeting: this.meeting, results: this.found };
        for (const { worker } of this.helpers) worker.postMessage(news);
        return undefined;
      }
      const { item, sure } = this.#choose();
      if (sure || waited > Math.max(LEAST_PATIENCE, PATIENCE * this.longest)) {
        this.began = performance.now();
        return item;
      }
      const since = performance.now();
      await new Promise((resolve) => {
        this.woken = resolve;
        setTimeout(resolve, LEAST_PATIENCE);
      });
      waited += performance.now() - since;
    }
  }

  put(item, result, enough) {
    this.longest = Math.max(this.longest, performance.now() - this.began);
    this.#take(item, result, enough);
  }

  results() {
    return this.found;
  }

  #start(rank, task) {
    const worker = new Worker(new URL('helper.js', import.meta.url), { type: 'module' });
    const helper = { rank, worker, meeting: -1 };
    worker.addEventListener('message', ({ data }) => this.#hear({ helper, ...data }));
    worker.addEventListener('error', (event) => {
      // The leader does without.
      event.preventDefault();
      helper.meeting = -Infinity;
    });
    worker.postMessage({ ...task, rank, size: this.size });
    return helper;
  }

  /** A helper has come to a meeting, or hands in a result. */
  #hear({ helper, meeting, item, result, enough }) {
    helper.meeting = Math.max(helper.meeting, meeting);
    if (item === undefined || meeting < this.meeting) return;
    if (meeting > this.meeting) this.early.push({ helper, meeting, item, result, enough });
    else if (!this.found[item] && item < this.count) {
      this.helped++;
      this.#take(item, result, enough);
      this.woken?.();
    }
  }

  #take(item, result, enough) {
    this.found[item] = result;
    if (enough && item < this.count) {
      this.count = item + 1;
      this.found.length = this.count;
    }
  }

  #missing() {
    return Array.from({ length: this.count }, (_, item) => item).filter((item) => !this.found[item]);
  }

  #complete() {
    return this.#missing().length === 0;
  }

  /**
   * The item that is best done next, and whether to do it at once: one's own and those of helpers that are not here are; of
   * the others the last one, if its owner will not come to it soon.
   */
  #choose() {
    const owner = (item) => item % this.size;
    const here = (item) => owner(item) > 0 && this.helpers[owner(item) - 1].meeting >= this.meeting;
    const missing = this.#missing();
    const free = missing.find((item) => owner(item) === 0) ?? missing.find((item) => !here(item));
    if (free !== undefined) return { item: free, sure: true };
    const last = missing[missing.length - 1];
    return { item: last, sure: missing.some((item) => item < last && owner(item) === owner(last)) };
  }
}

/** A helper's side. */
export class Member {
  /** @param {number} rank from 1 @param {number} size */
  constructor(rank, size) {
    Object.assign(this, { rank, size });
    this.meeting = -1;
    this.news = new Map();
  }

  /** The leader has the results of a meeting. */
  hear({ meeting, results }) {
    this.news.set(meeting, results);
    this.woken?.();
  }

  meet(count) {
    this.news.delete(this.meeting);
    this.meeting++;
    this.count = count;
    this.item = this.rank;
    self.postMessage({ meeting: this.meeting });
  }

  async next() {
    await turn();
    if (!this.news.has(this.meeting) && this.item < this.count) {
      const { item } = this;
      this.item += this.size;
      return item;
    }
    while (!this.news.has(this.meeting)) await new Promise((resolve) => (this.woken = resolve));
    return undefined;
  }

  put(item, result, enough) {
    if (enough) this.count = item;
    self.postMessage({ meeting: this.meeting, item, result, enough }, [result.buffer]);
  }

  results() {
    return this.news.get(this.meeting);
  }
}

const { port1, port2 } = new MessageChannel();
const turns = [];
port1.onmessage = () => turns.shift()();

/** Lets messages come in. */
function turn() {
  return new Promise((resolve) => {
    turns.push(resolve);
    port2.postMessage(null);
  });
}
