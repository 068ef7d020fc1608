/** The pins of one figure, and the numbers on them. The picture draws the pins; the numbers are text over it. */
import { h, show } from './dom.js';
import { placeIn, viewNow } from './stages.js';
import { stepNamed } from './steps/index.js';

/** A head must have this radius for a number to be readable on it, in pixels. */
const READABLE = 6;

/**
 * Which pins a figure has now: for each the point it belongs to.
 * @param {import('./app.js').App} app @param {'source'|'target'} side
 * @returns {{index: number, pin: object}[]}
 */
export function pinsOf(app, side) {
  if (!stepNamed(app.step).points) return [];
  const view = viewNow(app);
  if (view?.pins) return side === 'source' ? view.pins(app, placeIn(app, view)) : [];
  const paired = Boolean(app.target.sequence) && app.step !== 'keypoints';
  return app.keypoints.used.map((point, index) => ({ point, index }))
    .filter(({ point }) => side === 'source' || point.target != null)
    .map(({ point, index }) => ({ index, pin: {
      vertex: side === 'source' ? point.source : point.target,
      colour: index,
      state: stateOf(point, side, paired),
      selected: index === app.selected,
      hovered: index === app.hovered,
    } }));
}

function stateOf({ state }, side, paired) {
  if (side === 'target') return state === 'placed' ? 'fixed' : 'proposed';
  return paired && (state === 'missing' || state === 'none') ? 'missing' : 'fixed';
}

/** Keeps the pins of a figure up to date. */
export function pins(app, side, stage, host) {
  const layer = h('div', { class: 'pin-numbers', 'aria-hidden': 'true' });
  host.append(layer);
  let known = '';
  let mesh = null;
  /** What is to be numbered with the next frame: before it, the pins are not to be seen. @type {ReturnType<typeof pinsOf>|null} */
  let coming = null;
  const update = () => {
    const list = pinsOf(app, side);
    const key = JSON.stringify(list);
    if (key === known && mesh === stage.kept.mesh) return;
    known = key;
    mesh = stage.kept.mesh;
    stage.pins = list.map(({ pin }) => pin);
    coming = list;
  };
  const place = () => {
    if (coming) show(layer, ...coming.map(({ index, pin }) => h('span', { class: pin.selected ? 'selected number' : 'number', 'data-state': pin.state }, String(index + 1))));
    coming = null;
    if (!layer.childElementCount) return;
    const places = stage.pinPositions();
    [...layer.children].forEach((number, i) => {
      const at = places[i];
      const seen = at && at.radius >= READABLE;
      number.hidden = !seen;
      if (!seen) return;
      number.classList.toggle('behind', !at.visible);
      number.style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px) translate(-50%, -50%)`;
    });
  };
  app.on('doc points target step view place selected hovered source', update);
  stage.addEventListener('drawn', place);
  update();
}
