/** What the pointer and the keyboard do to the points of a figure: select, place, drag along the surface. */
import { pinsOf } from './pins.js';
import { viewNow } from './stages.js';
import { stepNamed } from './steps/index.js';

/** How far beside a pin one may point, in pixels. */
const REACH = 8;
const FINGER = 16;
/** How far the keyboard looks for the next vertex, in pixels. */
const NUDGES = [6, 9, 13, 18, 26, 36];

/**
 * @param {import('./app.js').App} app @param {'source'|'target'} side
 * @param {() => import('./stage.js').Stage} picture
 */
export function handling(app, side, picture) {
  const active = () => stepNamed(app.step).points && app.keypoints.used.length > 0;
  const movable = () => (side === 'source' ? app.step === 'keypoints' && !viewNow(app)?.pins : Boolean(app.target.sequence));

  const put = (index, vertex, mark) => {
    if (side === 'source') app.keypoints.move(index, vertex, mark);
    else app.target.place(index, vertex, mark);
  };

  /** The place in the list of pins of the one that is pointed at; −1: none is. */
  const pinAt = (x, y, touch) => (active() ? picture().pickPin(x, y, touch ? FINGER : REACH) ?? -1 : -1);
  const pointOf = (pin) => pinsOf(app, side)[pin]?.index ?? -1;

  /** The point behind the surface that was pressed on: a tap selects it, but in front of it is no place to drag it to. */
  let behind = -1;

  return {
    /** Whether something here can be taken hold of; then what is done with it. */
    grab(x, y, touch) {
      const pin = pinAt(x, y, touch);
      const index = pointOf(pin);
      const hidden = index >= 0 && !picture().pinPositions()[pin]?.visible;
      behind = hidden ? index : -1;
      if (index < 0 || hidden) return null;
      app.select(index);
      if (!movable()) return { move() {}, drop() {} };
      const mark = `drag ${side} ${index} ${performance.now()}`;
      let moved = false;
      app.held = true;
      return {
        move(toX, toY) {
          const vertex = vertexAt(picture(), toX, toY);
          if (vertex < 0) return;
          moved = true;
          put(index, vertex, mark);
        },
        drop() {
          app.held = false;
          app.history.rest();
          if (!moved || side !== 'target') return;
          app.target.proposing();
          // While it was held, each motion began where the last one ended.
          if (app.transfer.motion?.quick) app.transfer.move();
        },
      };
    },

    /** A click beside all pins. @returns {boolean} whether it did something */
    tap(x, y) {
      if (behind >= 0) {
        app.select(behind);
        return true;
      }
      if (side === 'source' && viewNow(app)?.faces) {
        const pick = picture().pick(x, y);
        if (pick) app.chooseFace(pick[0]);
        return Boolean(pick);
      }
      if (side === 'source' && app.step === 'keypoints' && app.keypoints.adding) {
        const vertex = vertexAt(picture(), x, y);
        if (vertex < 0) return true;
        app.keypoints.add(vertex);
        app.keypoints.setAdding(false);
        return true;
      }
      if (side !== 'target' || app.step !== 'target') return false;
      const vertex = vertexAt(picture(), x, y);
      const index = app.target.wanted;
      if (vertex < 0 || index < 0) return false;
      app.target.place(index, vertex);
      app.select(-1);
      app.target.proposing();
      return true;
    },

    /** What the pointer would do here. */
    cursor(x, y) {
      const index = pointOf(pinAt(x, y, false));
      app.hoverPoint(index);
      if (index >= 0) return 'pointer';
      const places = side === 'source' ? app.step === 'keypoints' && app.keypoints.adding : app.step === 'target' && app.target.wanted >= 0;
      return places ? 'crosshair' : '';
    },

    /** Moves the selected point a little way over the surface, in a direction of the picture. */
    nudge(dx, dy) {
      if (!movable() || app.selected < 0) return false;
      const list = pinsOf(app, side);
      const place = list.findIndex(({ index }) => index === app.selected);
      const at = picture().pinPositions()[place];
      if (!at) return false;
      for (const far of NUDGES) {
        const vertex = vertexAt(picture(), at.x + dx * far, at.y + dy * far);
        if (vertex < 0 || vertex === list[place].pin.vertex) continue;
        put(app.selected, vertex, `nudge ${side} ${app.selected}`);
        return true;
      }
      return false;
    },
  };
}

/** The vertex nearest to what is under a point of the picture; −1: nothing is. */
function vertexAt(stage, x, y) {
  const pick = stage.pick(x, y);
  if (!pick) return -1;
  const [face, ...weights] = pick;
  const corner = [0, 1, 2].reduce((best, i) => (weights[i] > weights[best] ? i : best), 0);
  return stage.kept.mesh.faces[3 * face + corner];
}
