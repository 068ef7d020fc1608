/**
 * Where the figures stand: the source alone, or the target beside it in a picture of its own, seen from the same
 * side or, where that makes both larger, below it. On a phone the two can be switched.
 */
import { choice } from './controls.js';
import { nameOf } from './doc.js';
import { h, iconButton, show } from './dom.js';
import { isGltf } from './files.js';
import { pins } from './pins.js';
import { NARROW } from './screens.js';
import { link } from './stage.js';
import { stepNamed } from './steps/index.js';
import { upright } from './upright.js';

/** How far a figure stays away from the other's picture and from the outer edge, in pixels; on a phone, less. */
const APART = { inner: 28, outer: 28 };
const APART_NARROW = { inner: 20, outer: 12 };
/** How much larger both figures together must become for one to stand above the other. */
const WORTH_STACKING = 1.05;
/** More points than this say no more of how large a figure is. */
const MOST_LOOKED_AT = 20_000;

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
    this.names = ['', ''];
    /** Where a figure may lie on its side, because its files do not say what is up. */
    this.corners = hosts.map(() => h('div', { class: 'corner small' }));
    hosts.forEach((host, i) => host.append(this.captions[i], this.corners[i]));
    this.linked = true;
    this.unlink = null;
    /** What a phone shows: `both`, `source` or `target`. */
    this.shown = 'both';
    this.#furnish('source', app.stage);
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
      this.#furnish('target', app.second);
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

  /** Gives a picture its pins and its name. @param {'source'|'target'} side */
  #furnish(side, stage) {
    pins(this.app, side, stage, this.hosts[side === 'source' ? 0 : 1]);
    stage.addEventListener('shown', () => this.#caption());
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

  /** Whether both figures are larger one above the other in a free part of some size, which is higher than wide then. */
  #stacks(width, height) {
    if (height <= width) return false;
    const { sequence, target } = this.app;
    const shapes = [[sequence.reference, sequence.poses], [target.sequence.reference]].map(shapeOf);
    const size = (across, down) => shapes.reduce((product, [wide, high]) => product * Math.min(across / wide, down / high), 1);
    return size(width, height / 2) > WORTH_STACKING * size(width / 2, height);
  }

  #name() {
    const { app } = this;
    this.names = [app.doc.open, app.doc.target].map(nameOf);
    for (const caption of this.captions) caption.hidden = !this.two;
    this.#caption();
    [app.doc.open, app.doc.target].forEach((figure, i) =>
      show(this.corners[i], figure && (!isGltf(figure) || figure.source.options.up) && upright(app, i ? 'target' : 'source', 'picture')));
    this.#showSeam();
  }

  /** A figure is named once it is seen: where drawing is slow, the one before it is there a while longer. */
  #caption() {
    [this.app.stage, this.app.second].forEach((stage, i) => {
      if (!stage?.behind) this.captions[i].textContent = this.names[i];
    });
  }

  #showSeam() {
    this.seam.hidden = !this.two;
    if (!this.two) return;
    const label = this.linked ? 'The cameras move together: let each go its way' : 'Let the cameras move together';
    show(this.seam,
      NARROW.matches && choice('Figure', [['source', this.names[0]], ['both', 'Both'], ['target', this.names[1]]], this.shown, (value) => {
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
    const opener = document.querySelector('.panel-opener')?.getBoundingClientRect();
    const below = document.querySelector('.below').getBoundingClientRect();
    const narrow = NARROW.matches;
    const free = {
      left: narrow ? 0 : covers('rail').right,
      right: narrow ? whole.right : side ? side.left : opener?.width ? opener.left : whole.right,
      top: narrow ? document.querySelector('.brand').getBoundingClientRect().bottom : whole.top,
      bottom: below.height ? below.top : whole.bottom,
    };
    if (this.two && narrow) free.top += this.seam.getBoundingClientRect().height;
    const both = this.two && this.hosts.every((host) => !host.hidden);
    const stacked = both && this.#stacks(free.right - free.left, free.bottom - free.top);
    document.documentElement.toggleAttribute('data-stacked', stacked);
    // What lies between two figures side by side would lie on the upper one.
    if (stacked) free.top = Math.max(free.top, this.seam.getBoundingClientRect().bottom);
    const middle = stacked ? (free.top + free.bottom) / 2 : (free.left + free.right) / 2;
    this.hosts[0].parentElement.style.setProperty('--split', `${Math.round(middle)}px`);
    const { inner, outer } = narrow ? APART_NARROW : APART;
    this.hosts.forEach((host, i) => {
      if (host.hidden) return;
      const box = host.getBoundingClientRect();
      const margins = [free.left - box.left, free.top - box.top, box.right - free.right, box.bottom - free.bottom];
      const insets = margins.map((margin) => Math.max(0, Math.round(margin)));
      if (both) {
        // What is in the middle of the window stays clear of the other figure, pins at the edge of it can be taken hold of.
        for (const edge of [0, 2]) insets[edge] += outer;
        const seam = (stacked ? 1 : 0) + (i ? 0 : 2);
        insets[seam] += inner - (stacked ? 0 : outer);
      }
      for (const stage of i ? [this.app.second] : [this.app.stage, this.app.third]) stage?.lie(insets, both ? margins : null);
      this.captions[i].style.setProperty('left', `${stacked ? insets[0] : (insets[0] + box.width - insets[2]) / 2}px`);
      this.captions[i].style.setProperty('top', `${insets[1]}px`);
      this.corners[i].style.setProperty('left', `${insets[0]}px`);
      this.corners[i].style.setProperty('top', `${insets[1]}px`);
    });
  }
}

/** About how wide and how high a figure is, from whichever side it is seen. @param {Float32Array[]} shapes its poses */
function shapeOf(shapes) {
  const [low, high] = [0, 1].map((end) => [0, 1, 2].map((axis) => Math[end ? 'max' : 'min'](...shapes.map((points) => extentOf(points)[end][axis]))));
  const [x, y, z] = high.map((value, axis) => Math.max(value - low[axis], 0));
  const wide = Math.hypot(x, z);
  // Seen from a little above.
  return [wide || 1, y + 0.2 * wide || 1];
}

const extents = new WeakMap();

/** The lowest and the highest coordinates of points. */
function extentOf(points) {
  if (!extents.has(points)) {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    const step = 3 * Math.ceil(points.length / 3 / MOST_LOOKED_AT);
    for (let i = 0; i < points.length; i += step) {
      for (let axis = 0; axis < 3; axis++) {
        low[axis] = Math.min(low[axis], points[i + axis]);
        high[axis] = Math.max(high[axis], points[i + axis]);
      }
    }
    extents.set(points, [low, high]);
  }
  return extents.get(points);
}
