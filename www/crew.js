/**
 * A crew: workers that share out one operation of the engine. They share no memory, so each runs all of it, on the same
 * meshes, and what is costly is divided: at a meeting each does some of the items, and all get the results of all. See
 * src/crew.rs for what the engine asks of a crew.
 *
 * The leader is the engine's own worker. It starts helpers (helper.js) when an operation begins and ends them with it. It
 * does not depend on them: items of helpers that are not there yet, late or broken are done by the leader.
 */

/** The most workers in a crew. */
const MOST = 8;

/** A helper that is at a meeting is waited for so many times as long as the leader's longest item took, and no less than… */
const PATIENCE = 2;
const LEAST_PATIENCE = 20;

/** Helpers are waited for at most so many milliseconds before the work begins. */
const GATHERING = 150;

/**
 * How many workers are worth it on this machine, if there is enough to do: one for two of its threads, for two threads of
 * one core get little more done than one, and what is not divided every member does. Two threads may be two cores.
 */
export function most() {
  // A browser may keep it to itself.
  const threads = navigator.hardwareConcurrency || 1;
  return Math.min(Math.max(threads >> 1, 2), threads, MOST);
}

/** Nobody else. */
const alone = (tell) => ({ size: 1, helped: 0, tell, gather: () => {}, end: () => {} });

/**
 * A crew of so many members for a task, or nobody else where helpers cannot be started.
 * @param {(done: number, count: number) => void} tell hears how many items of a meeting are done
 */
export function crewOf(size, task, tell) {
  if (size <= 1) return alone(tell);
  try {
    return new Leader(task(), size, tell);
  } catch {
    return alone(tell);
  }
}

class Leader {
  /**
   * @param {{module: WebAssembly.Module, kept: object, operation: string, payload: object}} task what a helper is to do
   * @param {number} size members, this one included
   * @param {(done: number, count: number) => void} tell see {@link crewOf}
   */
  constructor(task, size, tell) {
    Object.assign(this, { size, tell });
    /** How many results came from helpers. */
    this.helped = 0;
    this.meeting = -1;
    /** What helpers handed in for meetings to come. */
    this.early = [];
    this.helpers = [];
    try {
      for (let rank = 1; rank < size; rank++) this.#start(rank, task);
    } catch (error) {
      this.end();
      throw error;
    }
  }

  /** Waits for the helpers to run: a browser starts them only while their leader rests. */
  async gather() {
    const begun = performance.now();
    while (this.helpers.some((helper) => helper.meeting === undefined) && performance.now() - begun < GATHERING) await this.#rest();
  }

  /** Ends the helpers. */
  end() {
    for (const helper of this.helpers) helper.worker.terminate();
  }

  // What the engine calls, here and in Member: src/web/worker/crew.rs.

  meet(count) {
    this.meeting++;
    this.found = [];
    this.asked = count;
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
      await this.#rest();
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
    const helper = { worker, meeting: undefined };
    this.helpers.push(helper);
    worker.addEventListener('message', ({ data }) => this.#hear({ helper, ...data }));
    worker.addEventListener('error', (event) => {
      event.preventDefault();
      this.#lose(helper);
    });
    worker.postMessage({ ...task, rank, size: this.size });
  }

  /** Waits for news, not for long. */
  #rest() {
    return new Promise((resolve) => {
      this.woken = resolve;
      setTimeout(resolve, LEAST_PATIENCE);
    });
  }

  /** Does without a helper. */
  #lose(helper) {
    helper.worker.terminate();
    helper.meeting = -Infinity;
  }

  /** A helper runs (its meeting is -1), has come to a meeting of `asked` items, or hands in the result of one. */
  #hear(message) {
    const { helper, meeting, asked, item, result, enough } = message;
    if (helper.meeting === -Infinity) return;
    helper.meeting = Math.max(helper.meeting ?? -1, meeting);
    if (meeting > this.meeting) this.early.push(message);
    else if (meeting === this.meeting && meeting >= 0) {
      // One who has come to something else is on another way.
      if (asked !== this.asked) this.#lose(helper);
      else if (item < this.count && !this.found[item]) {
        this.helped++;
        this.#take(item, result, enough);
      }
    }
    this.woken?.();
  }

  #take(item, result, enough) {
    this.found[item] = result;
    if (enough && item < this.count) {
      this.count = item + 1;
      this.found.length = this.count;
    }
    this.tell(this.count - this.#missing().length, this.count);
  }

  #missing() {
    return Array.from({ length: this.count }, (_, item) => item).filter((item) => !this.found[item]);
  }

  #complete() {
    return this.#missing().length === 0;
  }

  /**
   * The item that is best done next, and whether to do it at once: one's own, and those of helpers that are neither here nor
   * on the way from the last meeting, are; of the others the last one, if its owner will not come to it soon.
   */
  #choose() {
    const owner = (item) => item % this.size;
    const near = (item) => owner(item) > 0 && this.helpers[owner(item) - 1].meeting >= this.meeting - 1;
    const missing = this.#missing();
    const free = missing.find((item) => !near(item));
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
    this.asked = count;
    this.count = count;
    this.item = this.rank;
    self.postMessage({ meeting: this.meeting, asked: count });
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
    self.postMessage({ meeting: this.meeting, asked: this.asked, item, result, enough }, [result.buffer]);
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
