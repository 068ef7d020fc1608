/**
 * The picture: a canvas with a Viewport of the wasm bundle on it, and the state from which it can be built again.
 *
 * Whatever is shown is written down here first and then handed to the Viewport, so that a lost device costs a
 * moment and nothing else: a fresh canvas, a fresh Viewport, the same state. Without any GPU there is no Viewport,
 * and everything but the picture still works.
 */
import { h } from './dom.js';
import { Pace } from './pace.js';
import init, { Viewport } from '../pkg/page.js';

/** How long to wait before the next attempt after a device was lost, in milliseconds. */
const REBUILD_AFTER = 400;
/** How often to look for a lost device while nothing is drawn, in milliseconds. */
const LOOK_FOR_LOSS_EVERY = 1000;
const MOST_REBUILDS = 5;
/** How long new paint takes to flow in, in milliseconds. */
const FLOWS = 900;
/** Where frames are slow: how long the picture must be still before it is drawn in full, in milliseconds. */
const SETTLES = 350;
const CALM = matchMedia('(prefers-reduced-motion: reduce)');

export class Stage extends EventTarget {
  /**
   * @param {HTMLElement} host what the canvas lies in
   * @param {Promise<WebAssembly.Module>} module of the page bundle
   * @param {string|null} forced a backend to use and no other
   */
  constructor(host, module, forced) {
    super();
    this.host = host;
    this.forced = forced;
    /** @type {Viewport|null} */
    this.view = null;
    this.backend = null;
    this.rebuilds = 0;
    this.pace = new Pace();
    /** When new paint began to flow in; null: it is there. */
    this.flowing = null;
    /** Whether the picture that is shown is drawn in full, even where frames are slow. */
    this.settled = false;
    this.kept = { mesh: null, time: -1, loop: false, paint: [['paint_clay']], boundaries: true, wireframe: false, marks: new Map(),
      camera: null, dark: false, insets: [0, 0, 0, 0] };
    this.started = this.#start(module);
  }

  async #start(module) {
    await init({ module_or_path: module });
    await this.#build();
    new ResizeObserver(() => this.#resize()).observe(this.host);
    matchMedia('(resolution: 1dppx)').addEventListener('change', () => this.#resize());
    setInterval(() => this.#watch(), LOOK_FOR_LOSS_EVERY);
    requestAnimationFrame((now) => this.#frame(now));
  }

  /** Tries the backends in turn, each on a canvas of its own. */
  async #build() {
    for (const backend of await backends(this.forced)) {
      const canvas = h('canvas', { tabindex: '0', role: 'img', 'aria-label': this.label ?? 'The creature' });
      const previous = this.canvas;
      if (previous) previous.replaceWith(canvas);
      else this.host.prepend(canvas);
      this.canvas = canvas;
      try {
        this.view = await Viewport.create(canvas, backend);
        this.backend = this.view.backend();
        break;
      } catch (error) {
        console.warn(`${backend} cannot be used here:`, error);
        this.view = null;
      }
    }
    if (this.view) this.#restore();
    this.dispatchEvent(new Event(this.view ? 'canvas' : 'no-gpu'));
  }

  #restore() {
    const kept = this.kept;
    this.#fit();
    this.view.set_theme(kept.dark);
    this.view.set_insets(...kept.insets);
    this.view.set_loop(kept.loop);
    if (kept.mesh) {
      this.view.set_mesh(kept.mesh.faces, kept.mesh.reference);
      this.view.set_poses(kept.mesh.poses);
      if (kept.camera) this.view.set_camera(kept.camera);
      else this.view.frame();
    }
    this.view.set_time(kept.time);
    this.view.set_boundaries(kept.boundaries);
    this.view.set_wireframe(kept.wireframe);
    apply(this.view, kept.paint);
    this.flowing = null;
    this.pace.begun = [];
    this.#simplify();
    for (const [style, faces] of kept.marks) this.view.mark_faces(faces, style);
  }

  #fit() {
    const { width, height } = this.host.getBoundingClientRect();
    if (width >= 1 && height >= 1) this.view?.resize(width, height, this.settled ? devicePixelRatio : this.pace.ratio);
  }

  #resize() {
    this.#fit();
    this.#frameUnlessMoved();
  }

  #frame(now) {
    requestAnimationFrame((later) => this.#frame(later));
    this.dispatchEvent(Object.assign(new Event('tick'), { now }));
    if (!this.view) return;
    this.#flow(now);
    if (!this.pace.allows(now, this.view.under_way())) return;
    this.#settle(now);
    // Without a change nothing is drawn, and nothing is spent.
    if (!this.view.render()) return;
    if (this.pace.began(now, this.settled)) this.#simplify();
    if (this.kept.mesh) this.dispatchEvent(new Event('drawn'));
  }

  /** Draws as simply as the pace asks, or with all there is. */
  #simplify(settled = false) {
    this.settled = settled;
    this.view.set_plain(this.pace.plain && !settled);
    this.#fit();
  }

  /** Where frames are slow, a picture that has come to rest is drawn in full after all. */
  #settle(now) {
    if (!this.pace.plain) return;
    const still = !this.view.stale();
    if (still !== this.settled && (!still || now - this.pace.last > SETTLES)) this.#simplify(still);
  }

  #flow(now) {
    if (this.flowing == null) return;
    const share = Math.min(1, (now - (this.flowing ||= now)) / FLOWS);
    // Slower towards the end.
    this.view.set_flow(1 - (1 - share) ** 1.6);
    if (share >= 1) this.flowing = null;
  }

  #watch() {
    if (!this.view?.lost()) return;
    this.view.free();
    this.view = null;
    if (++this.rebuilds > MOST_REBUILDS) {
      this.dispatchEvent(new Event('no-gpu'));
      return;
    }
    setTimeout(() => this.#build(), REBUILD_AFTER);
  }

  /** Writes changes down and hands them on; a Viewport that cannot follow says why in a sentence. */
  #set(changes, act) {
    Object.assign(this.kept, changes);
    if (!this.view) return;
    try {
      act(this.view);
    } catch (error) {
      this.dispatchEvent(Object.assign(new Event('trouble'), { error }));
    }
  }

  /** Until the visitor moves the camera, it keeps the whole motion in the free part of the picture. */
  #frameUnlessMoved() {
    if (this.view && this.kept.mesh && !this.kept.camera) this.view.frame();
  }

  /** What assistive technology says of the picture. */
  describe(label) {
    this.label = label;
    this.canvas?.setAttribute('aria-label', label);
  }

  /**
   * Shows another mesh, in clay and framed.
   * @param {{faces: Uint32Array, reference: Float32Array, poses: Float32Array}} mesh
   */
  open(mesh, loop) {
    this.flowing = null;
    const changes = { mesh, loop, time: -1, camera: null, marks: new Map(), paint: [['paint_clay']] };
    this.#set(changes, (view) => {
      view.set_loop(loop);
      view.set_mesh(mesh.faces, mesh.reference);
      view.set_poses(mesh.poses);
      view.set_time(-1);
      view.paint_clay();
      view.frame();
    });
  }

  /**
   * Paints with the Viewport's `paint_` methods, one after another; the last is seen, and parts take their colours
   * from the parts that were painted before them.
   * @param {...[string, ...any]} paint
   */
  paint(...paint) {
    this.#set({ paint }, (view) => apply(view, paint));
  }

  /** Lets what is painted flow in from some faces, unless the visitor wants nothing to move. @param {Uint32Array} faces */
  flowFrom(faces) {
    if (!this.view || CALM.matches || !faces.length) return;
    this.view.flow_from(faces);
    this.flowing = 0;
  }

  /** Marks exactly these faces with a style. */
  mark(faces, style) {
    this.kept.marks.set(style, faces);
    this.#set({}, (view) => view.mark_faces(faces, style));
  }

  /** Takes all marks away. */
  unmark() {
    for (const style of this.kept.marks.keys()) this.mark(new Uint32Array(), style);
    this.kept.marks.clear();
  }

  hover(face) {
    this.#set({}, (view) => view.hover(face));
  }

  set time(time) {
    this.#set({ time }, (view) => view.set_time(time));
  }

  set boundaries(on) {
    this.#set({ boundaries: on }, (view) => view.set_boundaries(on));
  }

  set wireframe(on) {
    this.#set({ wireframe: on }, (view) => view.set_wireframe(on));
  }

  set dark(dark) {
    this.#set({ dark }, (view) => view.set_theme(dark));
  }

  set insets(insets) {
    this.#set({ insets }, (view) => view.set_insets(...insets));
    this.#frameUnlessMoved();
  }

  /** Moves the camera: `orbit`, `pan`, `zoom` or `frame` of the Viewport. */
  move(method, ...values) {
    if (!this.view) return;
    this.view[method](...values);
    this.kept.camera = method === 'frame' ? null : this.view.camera();
    this.dispatchEvent(new Event('camera'));
  }

  get camera() {
    return this.view?.camera() ?? this.kept.camera;
  }

  set camera(camera) {
    this.#set({ camera: Float32Array.from(camera) }, (view) => view.set_camera(Float32Array.from(camera)));
  }

  /** What lies under a point of the canvas: `[face, b0, b1, b2, x, y, z]`. */
  pick(x, y) {
    return this.kept.mesh && this.view ? this.view.pick(x, y) : undefined;
  }

  /** The colours of the parts, sRGB triples; empty where there is no GPU. */
  get partColours() {
    return this.view?.part_colours() ?? new Uint8Array();
  }

  /** 256 sRGB triples of a colour map. */
  colourMap(name) {
    return this.view?.colour_map(name) ?? null;
  }

  /** The picture as it is now, as a PNG. @returns {Promise<Blob>} */
  async picture() {
    if (!this.view) throw new Error('There is no picture to save without a GPU.');
    this.#simplify(true);
    this.view.redraw();
    this.view.render();
    const blob = await new Promise((resolve) => this.canvas.toBlob(resolve, 'image/png'));
    if (!blob) throw new Error('The browser could not save the picture.');
    return blob;
  }
}

function apply(view, paint) {
  for (const [method, ...values] of paint) view[method](...values);
}

/** The backends worth trying. WebGPU is probed without a canvas: one that fails would be spoilt for WebGL2. */
async function backends(forced) {
  if (forced) return [forced];
  const adapter = await navigator.gpu?.requestAdapter().catch(() => null);
  return adapter ? ['webgpu', 'webgl2'] : ['webgl2'];
}
