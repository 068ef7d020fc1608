/** The list of the key points in use: selects, and says of each where it is. */
import { h, iconButton, show } from '../dom.js';
import { percent } from '../format.js';

const STATES = { placed: 'placed', proposed: 'proposed', missing: 'not placed yet', none: 'taken away' };

/**
 * @param {import('../app.js').App} app
 * @param {'source'|'target'} side whether rows say where a point is on the source or on the target
 */
export function pointList(app, side) {
  const list = h('ol', { class: 'points' });
  const update = () => show(list, ...app.keypoints.used.map((point, index) => row(app, side, point, index)));
  const select = () => {
    [...list.children].forEach((item, index) => {
      const chosen = index === app.selected;
      item.classList.toggle('selected', chosen);
      item.firstChild.setAttribute('aria-pressed', String(chosen));
      if (chosen) item.scrollIntoView({ block: 'nearest' });
    });
  };
  const both = () => {
    update();
    select();
  };
  app.on('doc source target canvas', both);
  app.on('selected', select);
  both();
  return list;
}

function row(app, side, point, index) {
  const id = `${side}-point-${index + 1}`;
  const next = side === 'target' && index === app.target.next && point.state !== 'placed';
  return h('li', { class: next ? 'next' : null, 'data-state': side === 'target' ? point.state : 'placed' },
    h('button', { type: 'button', id, class: 'point', on: {
      click: () => app.select(index === app.selected ? -1 : index),
      pointerenter: () => app.hoverPoint(index),
      pointerleave: () => app.hoverPoint(-1),
    } }, dot(app, index), h('span', {}, side === 'source' ? `Vertex ${point.source}` : words(point, next))),
    side === 'target' && point.state === 'proposed' && iconButton('check', `Accept point ${index + 1} (Enter)`, () => app.target.accept(index), { id: `${id}-accept` }),
    side === 'target' && point.target != null && iconButton('close', `Take point ${index + 1} off the target (Delete)`, () => app.target.remove(index), { id: `${id}-remove` }),
    side === 'source' && iconButton('close', `Remove point ${index + 1} (Delete)`, () => app.keypoints.remove(index), { id: `${id}-remove` }));
}

function words(point, next) {
  if (point.crowded) return 'no vertex left for it';
  if (next) return point.state === 'proposed' ? 'proposed: click next' : 'click next';
  return point.state === 'proposed' && point.confidence !== null ? `${STATES.proposed}, ${percent(point.confidence, 0)} sure` : STATES[point.state];
}

/** The number of a point in its colour. */
export function dot(app, index) {
  const colour = app.pinColour(index);
  return h('span', { class: 'pin-dot number', style: colour && { 'background-color': `rgb(${colour.join()})` } }, String(index + 1));
}
