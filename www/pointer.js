/** Mouse, pen and touch on a canvas: orbit, pan, zoom, taking hold of pins, and pointing at a face. */

/** A touch that moves less than this is a tap, in pixels. */
const TAP = 6;
const WHEEL = 0.0016;

/**
 * @param {import('./stage.js').Stage} stage
 * @param {object} hear
 * @param {(at: {x: number, y: number, pick: Float32Array}|null) => void} hear.point what lies under the pointer
 * @param {ReturnType<typeof import('./handling.js').handling>} hear.hand what can be taken hold of
 */
export function pointers(stage, { point, hand }) {
  const held = new Map();
  let start = null;
  let asked = null;
  let grip = null;
  let dragged = null;
  // In a frame, what goes up and down is the page around it, until the picture is taken in hand.
  const framed = 'embed' in document.documentElement.dataset;
  const inHand = () => document.hasFocus() && document.activeElement === stage.canvas;

  const place = (event) => {
    const box = stage.canvas.getBoundingClientRect();
    return { x: event.clientX - box.left, y: event.clientY - box.top };
  };

  /** Picking costs a walk through the mesh: once a frame is enough. */
  const ask = (at) => {
    if (!asked) requestAnimationFrame(() => {
      const { x, y } = asked;
      asked = null;
      if (held.size) return;
      stage.canvas.style.cursor = hand.cursor(x, y);
      const pick = stage.pick(x, y);
      stage.hover(pick ? pick[0] : -1);
      point(pick ? { x, y, pick } : null);
    });
    asked = at;
  };

  const drag = (at) => {
    if (!dragged) requestAnimationFrame(() => {
      const { x, y } = dragged;
      dragged = null;
      grip?.move(x, y);
    });
    dragged = at;
  };

  const leave = () => {
    stage.hover(-1);
    point(null);
  };

  const down = (event) => {
    stage.canvas.setPointerCapture(event.pointerId);
    held.set(event.pointerId, place(event));
    start = place(event);
    leave();
    if (held.size === 1 && !event.shiftKey && event.button === 0) grip = hand.grab(start.x, start.y, event.pointerType === 'touch');
    else letGo();
  };

  const letGo = () => {
    grip?.drop();
    grip = null;
  };

  const move = (event) => {
    const now = place(event);
    const before = held.get(event.pointerId);
    if (!before) {
      if (event.pointerType !== 'touch') ask(now);
      return;
    }
    const [dx, dy] = [now.x - before.x, now.y - before.y];
    if (grip) {
      if (Math.hypot(now.x - start.x, now.y - start.y) > TAP / 2) drag(now);
    } else if (held.size === 1) {
      const pans = event.shiftKey || event.buttons & 2 || event.buttons & 4;
      stage.move(pans ? 'pan' : 'orbit', dx, dy);
    } else if (held.size === 2) {
      const other = [...held].find(([id]) => id !== event.pointerId)[1];
      const spread = (a) => Math.max(1, Math.hypot(a.x - other.x, a.y - other.y));
      stage.move('pan', dx / 2, dy / 2);
      stage.move('zoom', spread(now) / spread(before), (now.x + other.x) / 2, (now.y + other.y) / 2);
    }
    held.set(event.pointerId, now);
  };

  const up = (event) => {
    const now = place(event);
    held.delete(event.pointerId);
    const moved = start && Math.hypot(now.x - start.x, now.y - start.y);
    if (grip) {
      if (dragged) grip.move(now.x, now.y);
      letGo();
    } else if (event.type === 'pointerup' && held.size === 0 && moved < TAP && !(event.button === 0 && hand.tap(now.x, now.y))) ask(now);
  };

  const wheel = (event) => {
    if (framed && !event.ctrlKey && !event.metaKey && !inHand()) return;
    event.preventDefault();
    const { x, y } = place(event);
    const lines = event.deltaMode === WheelEvent.DOM_DELTA_LINE ? 16 : 1;
    // A pinch on a touchpad arrives as a wheel with Control held, in much smaller numbers.
    stage.move('zoom', Math.exp(-event.deltaY * lines * WHEEL * (event.ctrlKey ? 6 : 1)), x, y);
  };

  /** Two fingers, or one on a pin, are for the picture; see `touch-action` in the styles. */
  const touch = (event) => {
    if (event.touches.length > 1 || grip) event.preventDefault();
  };

  const listen = () => {
    const { canvas } = stage;
    if (!canvas) return;
    canvas.addEventListener('pointerdown', down);
    canvas.addEventListener('pointermove', move);
    canvas.addEventListener('pointerup', up);
    canvas.addEventListener('pointercancel', up);
    canvas.addEventListener('pointerleave', leave);
    canvas.addEventListener('wheel', wheel, { passive: false });
    if (framed) canvas.addEventListener('touchstart', touch, { passive: false });
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
  };
  stage.addEventListener('canvas', listen);
}
