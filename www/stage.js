/**
 * The picture: a canvas with a Viewport of the wasm bundle on it, and the state from which it can be built again.
 *
 * Whatever is shown is written down here first and then handed to the Viewport, so that a lost device costs a
 * moment and nothing else: a fresh canvas, a fresh Viewport, the same state. Without any GPU there is no Viewport,
 * and everything but the picture still works. A page may have several pictures, each with a device of its own; they
 * are drawn in the same frames, or where drawing is slow they would show different moments of one motion.
 */
import { backends } from './backends.js';
import { h } from './dom.js';
import { move, nothing, paintAll, pinNumbers, tell, turn, turnOf } from './kept.js';
import { Pace } from './pace.js';
import init, { part_colours as partColours, pin_colours as pinColours, Viewport } from '../pkg/page.js';

export { link } from './linked.js';

/** How long to wait before the next attempt after a device was lost, in milliseconds. */
const REBUILD_AFTER = 400;
/** How often to look for a lost device while nothing is drawn, in milliseconds. */
const LOOK_FOR_LOSS_EVERY = 1000;
const MOST_REBUILDS = 5;
/** How long new paint takes to flow in, in milliseconds. */
const FLOWS = 900;
/** How near to a pin's head is on it, in CSS pixels. */
const REACH = 8;
/** Lines and pins in a picture of a size of its own are this many times as thick as one pixel to a pixel would make them. */
const PICTURE_SCALE = 2;
/** Whether pictures are being changed because time goes on, as it always does: nobody waits for that. */
let following = false;

/** Where frames are slow: how long the picture must be still before it is drawn in full, in milliseconds. */
const SETTLES = 350;
const CALM = matchMedia('(prefers-reduced-motion: reduce)');

/** The wasm; it and the frames are started once for all pictures. @type {Promise<any>|null} */
let bundle = null;
/** Whether it is there. */
let loaded = false;

/** The pictures that are drawn. @type {Set<Stage>} */
const open = new Set();

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
    /** Whether the host has another size than the canvas was made for. */
    this.unfit = false;
    /** Whether the host has room for a picture. */
    this.visible = false;
    /** Counts what is to be seen, time and camera aside; of it what is on the screen, and what the frames show that are not yet. */
    this.wanted = 0;
    this.shown = -1;
    this.waiting = [];
    /** The count since when it is the mesh that is open, and since when it was the last one of which it was told that it is seen. */
    this.opened = 0;
    this.told = 0;
    /** What is shown, see kept.js. */
    this.kept = nothing();
    this.closing = new AbortController();
    this.started = this.#start(module);
  }

  async #start(module) {
    if (!bundle) {
      bundle = init({ module_or_path: module });
      requestAnimationFrame(Stage.#frame);
    }
    await bundle;
    loaded = true;
    await this.#build();
    if (this.closing.signal.aborted) return;
    const watch = setInterval(() => this.#watch(), LOOK_FOR_LOSS_EVERY);
    const sizes = new ResizeObserver(() => this.#resize());
    sizes.observe(this.host);
    this.#watchRatio();
    open.add(this);
    this.closing.signal.addEventListener('abort', () => {
      open.delete(this);
      clearInterval(watch);
      sizes.disconnect();
    });
  }

  /** Hears of it when the window moves to a screen with other pixels, or the visitor zooms. */
  #watchRatio() {
    const { signal } = this.closing;
    matchMedia(`(resolution: ${devicePixelRatio}dppx)`).addEventListener('change', () => {
      this.#resize();
      this.#watchRatio();
    }, { once: true, signal });
  }

  /** Ends it: frees the device, takes the canvas away. */
  close() {
    this.closing.abort();
    this.view?.free();
    this.view = null;
    this.canvas?.remove();
  }

  /** Tries the backends in turn, each on a canvas of its own. */
  async #build() {
    if (this.closing.signal.aborted) return;
    for (const backend of await backends(this.forced)) {
      const canvas = h('canvas', { tabindex: '0', role: 'img', 'aria-label': this.label ?? 'The creature' });
      const previous = this.canvas;
      if (previous) previous.replaceWith(canvas);
      else this.host.prepend(canvas);
      this.canvas = canvas;
      try {
        const view = await Viewport.create(canvas, backend);
        if (this.closing.signal.aborted) {
          view.free();
          return;
        }
        this.view = view;
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

  /** Builds the picture again from what is written down. */
  #restore() {
    // Nothing of it is drawn before all is there: a dark page would light up.
    this.#size();
    tell(this.view, this.kept, () => this.#frameAll());
    this.flowing = null;
    this.pace.begun = [];
    this.#simplify();
    this.waiting = [];
    this.wanted++;
  }

  /**
   * Gives the canvas as many pixels as the host and the pace ask for. That clears it: it is drawn again at once, or
   * the visitor would see nothing until the next frame, which may be long in coming.
   */
  #fit() {
    if (this.#size()) this.#drawAgain();
  }

  #drawAgain() {
    this.wanted++;
    this.#draw(performance.now());
  }

  /** @returns {boolean} whether it has other pixels now */
  #size() {
    const { width, height } = this.host.getBoundingClientRect();
    this.visible = width >= 1 && height >= 1;
    // Its size, should the host have another one for a while.
    if (this.visible) for (const [side, length] of Object.entries({ width, height })) this.canvas?.style.setProperty(`--${side}`, `${length}px`);
    return this.visible && Boolean(this.view?.resize(width, height, this.settled ? devicePixelRatio : this.pace.ratio));
  }

  /** While the graphics are behind, the old picture stays as large as it is, in the middle, rather than one more being asked for. */
  #resize() {
    this.unfit = this.view?.under_way() > 1;
    this.canvas?.toggleAttribute('data-unfit', this.unfit);
    const other = !this.unfit && this.#size();
    // From where another size was seen, this one might not be.
    this.#frameUnlessMoved();
    if (other) this.#drawAgain();
  }

  /** Every picture hears of the time before any is drawn, and none is drawn before all can be. */
  static #frame(now) {
    requestAnimationFrame(Stage.#frame);
    following = true;
    for (const stage of open) stage.dispatchEvent(Object.assign(new Event('tick'), { now }));
    following = false;
    const seen = [...open].filter((stage) => stage.view && stage.visible);
    const free = seen.map((stage) => stage.#prepare(now));
    if (free.every(Boolean)) seen.forEach((stage) => stage.#next(now));
  }

  /** @returns {boolean} whether another frame may begin */
  #prepare(now) {
    this.#flow(now);
    const underWay = this.view.under_way();
    while (this.waiting.length > underWay) this.shown = this.waiting.shift();
    this.#tell();
    return this.pace.allows(now, underWay);
  }

  #next(now) {
    if (this.unfit) this.#resize();
    this.#settle(now);
    this.#draw(now);
    // What was asked for may be what was there.
    if (!this.waiting.length && !this.view.stale()) this.shown = this.wanted;
    this.#tell();
  }

  /** Says of a mesh, once, that it is on the screen. */
  #tell() {
    if (this.told === this.opened || this.behind) return;
    this.told = this.opened;
    this.dispatchEvent(new Event('shown'));
  }

  /** Draws if anything has changed. Without a change nothing is spent. */
  #draw(now) {
    if (!this.view.render()) return;
    this.waiting.push(this.wanted);
    if (this.pace.began(now, this.settled)) this.#simplify();
    if (this.kept.mesh) this.dispatchEvent(new Event('drawn'));
  }

  /** Whether all that was asked to be shown is on the screen; time and camera may have moved on. */
  get drawn() {
    return !!this.view && this.visible && this.shown === this.wanted && this.flowing == null;
  }

  /** Whether the mesh that is seen is the one before. */
  get behind() {
    return !!this.view && this.shown < this.opened;
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
    if (!following) this.wanted++;
    this.#hand(changes, act);
  }

  /** The same for what moves on all the time. */
  #hand(changes, act) {
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
    if (this.view && this.kept.mesh && !this.kept.camera) this.#frameAll();
  }

  /** Fits the whole motion into the picture, and not the reference alone where that is shown. */
  #frameAll() {
    this.view.set_time(Math.max(0, this.kept.time));
    this.view.frame();
    this.view.set_time(this.kept.time);
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
    const changes = { mesh, loop, skin: null, time: -1, camera: null, marks: new Map(), pins: [], paint: [['paint_clay']] };
    this.#set(changes, (view) => {
      view.set_loop(loop);
      view.set_mesh(mesh.faces, mesh.reference);
      view.set_poses(mesh.poses);
      view.paint_clay();
      // The whole motion is to be in the picture, not the reference alone.
      view.set_time(0);
      view.frame();
      view.set_time(-1);
    });
    this.opened = this.wanted;
  }

  /** What moves the mesh instead of its poses; null: its poses. */
  get skin() {
    return this.kept.skin;
  }

  /**
   * Each vertex follows K of the handles (16 at most); `matrices` has a 3×4 matrix, row by row, for each pose and handle.
   * @param {{handles: number, indices: Uint16Array, weights: Float32Array, K: number, matrices: Float32Array}|null} skin
   */
  set skin(skin) {
    const first = !this.kept.skin !== !skin;
    this.#set({ skin }, (view) => this.kept.mesh && move(view, this.kept));
    // While a point is dragged the figure moves, and not the camera.
    if (first) this.#frameUnlessMoved();
    this.#keepCamera();
  }

  /** Other poses for the same mesh, or none, in place of a skin. @param {Float32Array} poses */
  set poses(poses) {
    if (!this.kept.mesh || (this.kept.mesh.poses === poses && !this.kept.skin)) return;
    const first = Boolean(this.kept.skin) || !this.kept.mesh.poses.length !== !poses.length;
    this.#set({ mesh: { ...this.kept.mesh, poses }, skin: null }, (view) => view.set_poses(poses));
    if (first) this.#frameUnlessMoved();
    this.#keepCamera();
  }

  /** Other matrices for the same skin. @param {Float32Array} matrices */
  set maps(matrices) {
    if (!this.kept.skin) return;
    this.#set({ skin: { ...this.kept.skin, matrices } }, (view) => view.set_maps(matrices));
    this.#keepCamera();
  }

  /** The camera's numbers are relative to how far the figure moves: they change with that, though the camera does not. */
  #keepCamera() {
    if (this.view && this.kept.camera) this.kept.camera = this.view.camera();
  }

  /** Whether the last pose goes over into the first. */
  set loop(loop) {
    this.#set({ loop }, (view) => view.set_loop(loop));
  }

  /**
   * Paints with the Viewport's `paint_` methods, one after another; the last is seen, and parts take their colours
   * from the parts that were painted before them.
   * @param {...[string, ...any]} paint
   */
  paint(...paint) {
    this.#set({ paint }, (view) => paintAll(view, paint));
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
    this.#hand({}, (view) => view.hover(face));
  }

  set time(time) {
    this.#hand({ time }, (view) => view.set_time(time));
  }

  set boundaries(on) {
    this.#set({ boundaries: on }, (view) => view.set_boundaries(on));
  }

  set wireframe(on) {
    this.#set({ wireframe: on }, (view) => view.set_wireframe(on));
  }

  /** Whether fields on the vertices have lines of equal value. */
  set contours(on) {
    this.#set({ contours: on }, (view) => view.set_contours(on));
  }

  set dark(dark) {
    this.#set({ dark }, (view) => view.set_theme(dark));
  }

  /**
   * Which margins controls cover, and those of the room of which this picture shows a part, in CSS pixels: its light is
   * that of the whole room, so that pictures beside each other have no seam.
   * @param {number[]} insets left, top, right, bottom @param {number[]|null} room the same; below 0 where it goes beyond
   */
  lie(insets, room) {
    this.#set({ insets, room: room ?? [] }, (view) => {
      view.set_insets(...insets);
      view.set_room(Float32Array.from(room ?? []));
    });
    this.#frameUnlessMoved();
  }

  /** Moves the camera: `orbit`, `pan`, `zoom` or `frame` of the Viewport. */
  move(method, ...values) {
    if (!this.view) return;
    if (method === 'frame') this.#frameAll();
    else this.view[method](...values);
    const camera = this.view.camera();
    Object.assign(this.kept, method === 'frame' ? { camera: null } : { camera, turn: turnOf(camera) });
    this.#tellCamera(method, values);
  }

  /** Turns and comes nearer until some faces are seen. @param {Uint32Array} faces */
  look(faces) {
    if (!this.view || !faces.length) return;
    this.view.frame_faces(faces);
    this.camera = this.view.camera();
  }

  /** Six numbers that show any figure in the same way: target x, y, z, yaw, pitch, distance, in radii of its motion. */
  get camera() {
    return this.view?.camera() ?? this.kept.camera;
  }

  set camera(numbers) {
    const camera = Float32Array.from(numbers);
    this.#hand({ camera, turn: turnOf(camera) }, (view) => view.set_camera(camera));
    this.#tellCamera('camera', [camera]);
  }

  #tellCamera(method, values) {
    this.dispatchEvent(Object.assign(new Event('camera'), { method, values }));
  }

  /** The directions that the camera looks in, as yaw and pitch; null before there is one. */
  get turn() {
    return this.view ? turnOf(this.view.camera()) : this.kept.turn;
  }

  /** Looks in other directions, at as much of the figure as before. */
  set turn(turned) {
    if (!turned) return;
    this.#hand({ turn: turned }, (view) => turn(view, turned));
    if (this.view && this.kept.camera) this.kept.camera = this.view.camera();
    this.#frameUnlessMoved();
  }

  /** The middle of the part of the canvas that no panel covers, CSS pixels. */
  get middle() {
    const [left, top, right, bottom] = this.kept.insets;
    const { width, height } = this.host.getBoundingClientRect();
    return [(width + left - right) / 2, (height + top - bottom) / 2];
  }

  // Pins.

  /**
   * Points on the surface, in the order of their numbers. A pin sticks in a `vertex`, or in a `face` at the point with
   * `weights` of its corners. `colour` is its place in the list unless given; `state` is `fixed`, `proposed` or
   * `missing`; it may be `selected` and `hovered`.
   * @param {{vertex?: number, face?: number, weights?: number[], colour?: number, state?: string, selected?: boolean, hovered?: boolean}[]} pins
   */
  set pins(pins) {
    this.#set({ pins }, (view) => view.set_pins(pinNumbers(pins)));
  }

  get pins() {
    return this.kept.pins;
  }

  /** What `pick` gave as an anchor for a pin. */
  anchor([face, ...rest]) {
    return { face, weights: rest.slice(0, 3) };
  }

  /**
   * Where the pins' heads are, CSS pixels on the canvas; `visible` where the surface does not hide them.
   * @returns {{x: number, y: number, depth: number, visible: boolean, radius: number}[]}
   */
  pinPositions() {
    if (!this.view || !this.kept.mesh) return [];
    const numbers = this.view.pin_positions();
    return this.kept.pins.map((_, i) => {
      const [x, y, depth, visible, radius] = numbers.subarray(5 * i, 5 * i + 5);
      return { x, y, depth, visible: visible > 0 && depth > 0, radius };
    });
  }

  /** The index of the pin under a point of the canvas, or near it. */
  pickPin(x, y, reach = REACH) {
    return this.kept.mesh && this.view ? this.view.pick_pin(x, y, reach) : undefined;
  }

  /** sRGB triples of the first colours of pins, each the same however many there are; empty before they are known. */
  pinColours(count) {
    return loaded ? pinColours(count) : new Uint8Array();
  }

  /** sRGB triples of the groups that are painted. */
  get groupColours() {
    return this.view?.group_colours() ?? new Uint8Array();
  }

  /** Where some vertices are now, three coordinates each; nothing without a GPU. @param {Uint32Array} numbers */
  vertices(numbers) {
    return this.kept.mesh && this.view ? this.view.vertices(numbers) : new Float32Array();
  }

  /** Where points are on the canvas: x, y and depth each. @param {Float32Array} points three coordinates each */
  project(points) {
    return this.view ? this.view.project(points) : new Float32Array(points.length);
  }

  /** What lies under a point of the canvas: `[face, b0, b1, b2, x, y, z]`. */
  pick(x, y) {
    return this.kept.mesh && this.view ? this.view.pick(x, y) : undefined;
  }

  /** The colours of the parts that were painted, sRGB triples, with a picture or without; empty before either is known. */
  get partColours() {
    if (this.view) return this.view.part_colours();
    const { mesh, paint } = this.kept;
    const parts = paint.findLast(([method]) => method === 'paint_parts');
    return loaded && mesh && parts ? partColours(mesh.faces, parts[1]) : new Uint8Array();
  }

  /** 256 sRGB triples of a colour map. */
  colourMap(name) {
    return this.view?.colour_map(name) ?? null;
  }

  /**
   * The picture as it is now, or the figure alone in a picture of another size, as a PNG.
   * @param {[number, number]|null} size width and height in pixels
   * @param {number[]|null} room of which that picture is a part, as for {@link lie}, in pixels
   * @returns {Promise<Blob>}
   */
  async picture(size = null, room = null) {
    if (!this.view) throw new Error('There is no picture to save without a GPU.');
    this.#simplify(true);
    const camera = this.view.camera();
    if (size) {
      this.view.set_insets(0, 0, 0, 0);
      this.view.set_room(Float32Array.from(room ?? [], (margin) => margin / PICTURE_SCALE));
      this.view.resize(size[0] / PICTURE_SCALE, size[1] / PICTURE_SCALE, PICTURE_SCALE);
      if (!this.kept.camera) this.#frameAll();
    }
    this.view.redraw();
    this.view.render();
    const blob = await new Promise((resolve) => this.canvas.toBlob(resolve, 'image/png'));
    if (size) {
      this.view.set_insets(...this.kept.insets);
      this.view.set_room(Float32Array.from(this.kept.room));
      this.#fit();
      this.view.set_camera(camera);
      this.view.redraw();
    }
    if (!blob) throw new Error('The browser could not save the picture.');
    return blob;
  }
}
