/**
 * What runs: several jobs may wait for the engine at once, each on a lane. A newer job on a lane makes the answers of
 * older ones on it worthless; they are dropped.
 */
import { Cancelled } from './engine.js';

/** A change during a run that will take longer than this (seconds) stops the run. */
export const WORTH_STOPPING = 1;

export class Work {
  /** @param {{changed: () => void, say: (text: string) => void}} hear */
  constructor({ changed, say }) {
    this.changed = changed;
    this.say = say;
    this.jobs = [];
    this.turns = new Map();
  }

  /** The job that the engine works on: it answers one after another. */
  get busy() {
    return this.jobs[0] ?? null;
  }

  /**
   * Runs something that may be long: shows progress, says what went wrong, drops answers that came too late.
   * @param {string} lane @param {string} label
   * @param {(progress: (p: {stage: string, done: number}) => void, signal: AbortSignal) => Promise<any>} work
   * @returns {Promise<any>} undefined if it was cancelled, failed, or something newer was started on the lane
   */
  async run(lane, label, work) {
    const turn = this.#next(lane);
    const job = { lane, label, stage: label, done: 0, left: NaN, started: performance.now(), stop: new AbortController() };
    this.jobs.push(job);
    this.changed();
    const progress = ({ stage, done }) => {
      const elapsed = (performance.now() - job.started) / 1000;
      Object.assign(job, { stage, done, left: done > 0.02 ? (elapsed * (1 - done)) / done : NaN });
      if (this.busy === job) this.changed();
    };
    try {
      const answer = await work(progress, job.stop.signal);
      return turn === this.turns.get(lane) ? answer : undefined;
    } catch (error) {
      if (!(error instanceof Cancelled) && turn === this.turns.get(lane)) this.say(error.message);
      return undefined;
    } finally {
      this.jobs = this.jobs.filter((other) => other !== job);
      this.changed();
    }
  }

  /** Makes whatever runs on some lanes worthless. */
  drop(...lanes) {
    for (const lane of lanes) this.#next(lane);
  }

  #next(lane) {
    for (const job of this.jobs) if (job.lane === lane) job.stop.abort();
    const turn = (this.turns.get(lane) ?? 0) + 1;
    this.turns.set(lane, turn);
    return turn;
  }
}

/** Of many calls in a row only the newest is made, as soon as the one that runs is done. */
export function latest(act) {
  let running = false;
  let again = false;
  return async function call() {
    again = true;
    if (running) return;
    running = true;
    try {
      while (again) {
        again = false;
        await act();
      }
    } finally {
      running = false;
    }
  };
}
