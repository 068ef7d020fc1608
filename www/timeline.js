/** The timeline: play, pause, scrub, speed, the reference pose. Time is counted in poses. */
import { h, icon, show, svg } from './dom.js';
import { number } from './format.js';

/** Poses a second where the files have no time. */
const UNTIMED_RATE = 3;
const SPEEDS = [0.25, 0.5, 1, 2];
/** Dragging is finer, but a key goes to the next pose. */
const ARROWS = { ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1 };
const CALM = matchMedia('(prefers-reduced-motion: reduce)');
/** Beyond this many, ticks would be a grey bar. */
const MOST_TICKS = 160;

export class Timeline {
  /** @param {HTMLElement} host @param {import('./app.js').App} app */
  constructor(host, app) {
    this.host = host;
    this.app = app;
    this.time = 0;
    this.speed = 1;
    this.reference = false;
    this.playing = false;
    this.rested = false;
    this.last = null;
    this.#build();
    app.on('source', () => this.#open());
    app.on('play', () => CALM.matches || this.setPlaying(true));
    app.on('rest', () => this.#rest());
    app.on('resume', () => this.#resume());
    app.on('released', () => this.#show());
    app.stage.addEventListener('tick', ({ now }) => this.#tick(now));
  }

  get poses() {
    return this.app.sequence?.sizes.poses ?? 0;
  }

  /** The time at which the end is reached; a loop closes one pose after the last. */
  get end() {
    return Math.max(0, this.app.sequence?.loop ? this.poses : this.poses - 1);
  }

  /** What is shown of the motion, to be set again when the same motion was opened anew. */
  get moment() {
    const { time, reference, playing } = this;
    return { time, reference, playing };
  }

  set moment(moment) {
    Object.assign(this, moment);
    this.#show();
  }

  toggle() {
    this.setPlaying(!this.playing);
  }

  setPlaying(playing) {
    this.playing = playing && this.poses > 1;
    if (this.playing) this.reference = false;
    this.last = null;
    this.#show();
    this.app.changed('link');
  }

  /** One pose on or back. */
  step(by) {
    this.setPlaying(false);
    this.seek(wrap(Math.round(this.time) + by, this.app.sequence?.loop ? this.end : this.end + 1));
  }

  seek(time) {
    this.reference = false;
    this.time = Math.min(Math.max(0, time), this.end);
    this.#show();
    this.app.changed('link');
  }

  toggleReference() {
    this.reference = !this.reference;
    if (this.reference) this.playing = false;
    this.#show();
    this.app.changed('link');
  }

  /** Shows the reference for as long as something is to be looked at closely. */
  #rest() {
    this.rested = this.playing;
    if (!this.reference) this.toggleReference();
  }

  /** Goes on if that was the visitor's last word. */
  #resume() {
    if (this.rested && this.reference) this.setPlaying(true);
    this.rested = false;
  }

  #build() {
    this.play = h('button', { type: 'button', class: 'icon-button strong', on: { click: () => this.toggle() } });
    this.ticks = svg('svg', { class: 'ticks', 'aria-hidden': 'true', preserveAspectRatio: 'none' });
    this.range = h('input', { type: 'range', min: 0, step: 0.01, 'aria-label': 'Time, in poses', on: {
      input: () => {
        this.playing = false;
        this.seek(this.range.valueAsNumber);
      },
      keydown: (event) => {
        const by = ARROWS[event.key];
        if (!by || event.ctrlKey || event.metaKey || event.altKey) return;
        event.preventDefault();
        this.step(by);
      },
    } });
    // No live region: while it plays, a screen reader would never fall silent.
    this.words = h('span', { class: 'number small faint time' });
    this.pick = h('select', { 'aria-label': 'Speed', class: 'small', on: { change: () => (this.speed = Number(this.pick.value)) } },
      ...SPEEDS.map((speed) => h('option', { value: speed, selected: speed === 1 }, `${number(speed)}×`)));
    this.still = h('button', { type: 'button', class: 'text-button small', title: 'Show the reference pose (R)', 'aria-pressed': 'false', on: { click: () => this.toggleReference() } }, 'Reference');
    show(this.host, this.play, h('div', { class: 'scrub' }, this.ticks, this.range), this.words, this.pick, this.still);
  }

  #open() {
    const { sequence } = this.app;
    this.host.hidden = this.poses === 0;
    this.range.max = this.end;
    this.time = 0;
    this.reference = false;
    this.playing = this.poses > 1 && !CALM.matches;
    this.seconds = times(sequence);
    const every = Math.ceil((this.poses || 1) / MOST_TICKS);
    this.ticks.setAttribute('viewBox', `0 0 ${this.end || 1} 1`);
    const marks = [];
    for (let pose = 0; pose < this.poses; pose += every) marks.push(svg('line', { x1: pose, x2: pose, y1: 0, y2: 1 }));
    show(this.ticks, ...marks);
    this.#show();
  }

  #tick(now) {
    const passed = this.last == null ? 0 : Math.min(0.1, (now - this.last) / 1000);
    this.last = now;
    if (!this.playing || this.poses < 2 || this.app.held) return;
    const length = this.seconds.at(-1);
    const second = wrap(at(this.seconds, this.time) + passed * this.speed, length);
    this.time = Math.min(inverse(this.seconds, second), this.end);
    this.#show();
  }

  #show() {
    const still = this.reference || this.poses === 0;
    const shown = this.app.sequence?.loop ? wrap(this.time, this.end || 1) : this.time;
    this.app.stage.time = this.app.frozen ?? (still ? -1 : shown);
    if (this.app.third) this.app.third.time = still ? -1 : shown;
    if (this.app.transfer.motion) this.app.second.time = still ? -1 : shown;
    this.range.valueAsNumber = this.time;
    const label = this.playing ? 'Pause (space)' : 'Play (space)';
    if (this.play.title !== label) {
      this.play.title = label;
      this.play.setAttribute('aria-label', label);
      show(this.play, icon(this.playing ? 'pause' : 'play'));
    }
    this.still.setAttribute('aria-pressed', String(still));
    const pose = Math.min(this.poses - 1, Math.round(shown)) % (this.poses || 1);
    const text = still ? `– / ${this.poses}` : `${pose + 1} / ${this.poses}`;
    if (this.words.textContent !== text) this.words.textContent = text;
    this.range.setAttribute('aria-valuetext', still ? 'reference pose' : `pose ${pose + 1} of ${this.poses}`);
  }
}

/** The second of each pose from the first one on, for a loop also of its end. */
function times({ times: given, timed, loop, sizes: { poses } }) {
  const seconds = Array.from({ length: poses }, (_, i) => (timed ? given[i] - given[0] : i / UNTIMED_RATE));
  if (loop) seconds.push((seconds.at(-1) ?? 0) + (poses > 1 ? seconds.at(-1) / (poses - 1) : 1));
  return seconds;
}

const wrap = (value, length) => (length > 0 ? ((value % length) + length) % length : 0);

/** A rising table at a fractional place. */
function at(table, place) {
  const low = Math.min(Math.floor(place), table.length - 2);
  return table[low] + (table[low + 1] - table[low]) * (place - low);
}

/** The fractional place of a value in a rising table. */
function inverse(table, value) {
  let low = 0;
  let high = table.length - 1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (table[middle] <= value) low = middle;
    else high = middle;
  }
  const span = table[high] - table[low];
  return low + (span > 0 ? (value - table[low]) / span : 0);
}
