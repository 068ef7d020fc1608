/**
 * How fast frames are drawn, and what follows from it. A machine that draws slowly gets a simpler picture, and half
 * of its time stays free for everything else: the worker may have to compute on the same processor.
 */

/** A frame that takes longer is slow: twelve in a second, in milliseconds. */
const SLOW = 1000 / 12;
/** How long frames must have been slow before the picture becomes simpler, in milliseconds. */
const FOR_LONG = 1000;
/** From here on a frame is followed by a rest as long as itself, in milliseconds. */
const TIRING = 80;
/** Frames that may wait for the graphics while all goes well. */
const AHEAD = 1;
/** A frame that takes longer than this was asleep, in milliseconds. */
const ASLEEP = 4000;

/** Pixels to a CSS pixel, at most, from the first to the last resort. With fewer than one, lines would be stairs. */
const RATIOS = [Infinity, Infinity, 1];

export class Pace {
  constructor() {
    /** How many things have been left out: shadows, then pixels. */
    this.level = 0;
    /** When the last frame began, and what the last finished one took. */
    this.last = 0;
    this.took = 0;
    /** When the frames began that are not finished, and when the last one was. */
    this.begun = [];
    this.done = 0;
    this.rests = 0;
    this.times = [];
  }

  /** Whether to draw without shadows. */
  get plain() {
    return this.level > 0;
  }

  /** Pixels to a CSS pixel. */
  get ratio() {
    return Math.min(devicePixelRatio, RATIOS[this.level]);
  }

  /**
   * Whether another frame may begin; to be asked on every tick.
   * @param {number} now @param {number} underWay frames that are not finished
   */
  allows(now, underWay) {
    while (this.begun.length > underWay) this.#finished(now, this.begun.shift());
    if (now - this.last > ASLEEP) this.begun = [];
    return this.begun.length <= (this.took > TIRING ? 0 : AHEAD) && now >= this.rests;
  }

  /**
   * A frame has begun.
   * @param {number} now @param {boolean} settled whether it is one that is drawn in full because nothing moves
   * @returns {boolean} whether the picture is to be simpler from now on
   */
  began(now, settled) {
    this.last = now;
    this.begun.push({ now, settled });
    const total = this.times.reduce((sum, time) => sum + time, 0);
    if (total < FOR_LONG || this.level === RATIOS.length - 1) return false;
    const middle = this.times.sort((a, b) => a - b)[this.times.length >> 1];
    this.times = [];
    if (middle <= SLOW) return false;
    if (this.level === 1 && devicePixelRatio <= 1) return false;
    this.level++;
    return true;
  }

  #finished(now, begun) {
    // A frame that waited for the one before it began when that was done.
    const took = now - Math.max(begun.now, this.done);
    this.done = now;
    this.took = took < ASLEEP ? took : 0;
    this.rests = this.took > TIRING ? now + this.took : 0;
    if (!begun.settled) this.times.push(this.took);
  }
}
