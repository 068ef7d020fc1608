/**
 * Where the figures stand: the source alone, or the target beside it in a picture of its own, seen from the same
 * side. On a phone the two are switched.
 */
import { choice } from './controls.js';
import { h, iconButton, show } from './dom.js';
import { title } from './format.js';
import { pins } from './pins.js';
import { NARROW } from './screens.js';
import { link } from './stage.js';
import { stepNamed } from './steps/index.js';

/** How far a figure stays away from the other's picture, in pixels. */
const INNER = 28;

export class Studio {
  /**
   * @param {import('./app.js').App} app
   * @param {{hosts: [HTMLElement, HTMLElement], seam: HTMLElement, make: (host: HTMLElement) => import('./stage.js').Stage}} how
   *   `make` makes a picture in a host, `hear` what a visitor does to it
   */
  constructor(app, { hosts, seam, make }) {
    this.app = app;
    this.hosts = hosts;
    this.seam = seam;
    this.make = make;
    this.captions = hosts.map((host) => h('p', { class: 'caption small', hidden: true }));
    hosts.forEach((host, i) => host.append(this.captions[i]));
    this.linked = true;
    this.unlink = null;
    /** What a phone shows: `both`, `source` or `target`. */
    this.shown = 'both';
    pins(app, 'source', app.stage, hosts[0]);
    app.on('target step', () => this.#arrange());
    app.on('source', () => this.#name());
    app.on('motion', () => this.#move());
    app.on('panel step result source target', () => requestAnimationFrame(() => this.keepClear()));
    const sizes = new ResizeObserver(() => this.keepClear());
    for (const element of [hosts[0].parentElement, document.querySelector('.below')]) sizes.observe(element);
    NARROW.addEventListener('change', () => this.#arrange());
    this.#arrange();
  }

  /** Whether both figures are shown. */
  get two() {
    return Boolean(this.app.target.sequence && stepNamed(this.app.step).pair);
  }

  setLinked(on) {
    this.linked = on;
    this.unlink?.();
    this.unlink = on && this.app.second ? link(this.app.stage, this.app.second) : null;
    this.#showSeam();
    this.app.changed('link');
  }

  /** Opens the target in its picture, which is made when it is first needed. */
  #arrange() {
    const { app } = this;
    const { sequence } = app.target;
    if (sequence && !app.second) {
      this.hosts[1].hidden = false;
      app.second = this.make(this.hosts[1]);
      app.second.dark = app.stage.kept.dark;
      pins(app, 'target', app.second, this.hosts[1]);
      app.changed('second');
    }
    if (sequence && sequence !== this.open) {
      app.second.describe(`${sequence.name}, ${sequence.sizes.faces} faces, the target`);
      app.second.open({ faces: sequence.faces, reference: sequence.reference, poses: new Float32Array() }, false);
      this.setLinked(this.linked);
    }
    this.open = sequence;
    if (sequence) this.#move();
    this.#layOut();
    this.#name();
    app.paint();
  }

  /** The target moves as the engine says, and stands still where it says nothing. */
  #move() {
    const { second, transfer: { motion }, stage } = this.app;
    if (!second || !this.open) return;
    if (motion?.positions) second.poses = motion.positions;
    else second.skin = motion && { handles: motion.handles, indices: motion.indices, weights: motion.weights, K: motion.K, matrices: motion.matrices };
    second.loop = stage.kept.loop;
    second.time = motion ? stage.kept.time : -1;
  }

  #layOut() {
    const { two } = this;
    const shown = NARROW.matches ? this.shown : 'both';
    document.documentElement.dataset.figures = two ? shown : 'source';
    this.hosts[0].hidden = two && shown === 'target';
    this.hosts[1].hidden = !two || shown === 'source';
    this.#showSeam();
    this.keepClear();
  }

  #name() {
    const { app } = this;
    const names = [app.sequence, app.target.sequence].map((sequence) => (sequence ? title(sequence.name.replace(/\.[^.]*$/, '')) : ''));
    this.captions.forEach((caption, i) => {
      caption.hidden = !this.two;
      caption.textContent = names[i];
    });
    this.#showSeam(names);
  }

  #showSeam(names = this.captions.map((caption) => caption.textContent)) {
    this.seam.hidden = !this.two;
    if (!this.two) return;
    const label = this.linked ? 'The cameras move together: let each go its way' : 'Let the cameras move together';
    show(this.seam,
      NARROW.matches && choice('Figure', [['source', names[0]], ['both', 'Both'], ['target', names[1]]], this.shown, (value) => {
        this.shown = value;
        this.#layOut();
      }, 'segments'),
      iconButton('cameras', label, () => this.setLinked(!this.linked), { id: 'cameras', 'aria-pressed': String(this.linked) }));
  }

  /** Gives each figure its part of the window, and tells it which margins the controls cover. */
  keepClear() {
    const whole = this.hosts[0].parentElement.getBoundingClientRect();
    const covers = (id) => {
      const element = document.getElementById(id);
      return !element.hidden && element.getBoundingClientRect();
    };
    const side = covers('panel');
    const below = document.querySelector('.below').getBoundingClientRect();
    const narrow = NARROW.matches;
    const free = {
      left: narrow ? 0 : covers('rail').right,
      right: side && !narrow ? side.left : whole.right,
      top: narrow ? document.querySelector('.brand').getBoundingClientRect().bottom : whole.top,
      bottom: below.height ? below.top : whole.bottom,
    };
    if (this.two && narrow) free.top += this.seam.getBoundingClientRect().height;
    const middle = (free.left + free.right) / 2;
    this.hosts[0].parentElement.style.setProperty('--split', `${Math.round(middle)}px`);
    this.hosts.forEach((host, i) => {
      if (host.hidden) return;
      const box = host.getBoundingClientRect();
      const insets = [free.left - box.left, free.top - box.top, box.right - free.right, box.bottom - free.bottom].map((inset) => Math.max(0, Math.round(inset)));
      // What is in the middle of the window stays clear of the other figure.
      if (this.two && !this.hosts[1 - i].hidden) insets[i ? 0 : 2] += INNER;
      const stage = i ? this.app.second : this.app.stage;
      if (stage) stage.insets = insets;
      this.captions[i].style.setProperty('left', `${(insets[0] + box.width - insets[2]) / 2}px`);
      this.captions[i].style.setProperty('top', `${insets[1]}px`);
    });
  }
}
