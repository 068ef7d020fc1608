/** A small tag near the pointer with the numbers of the face under it. */
import { facts } from './controls.js';
import { show } from './dom.js';
import { count, number } from './format.js';
import { stepNamed } from './steps/index.js';

const AWAY = 16;

/** @param {HTMLElement} host @param {import('./app.js').App} app */
export function tag(host, app) {
  return (at) => {
    host.hidden = !at || Boolean(stepNamed(app.step).points);
    if (host.hidden) return;
    const face = at.pick[0];
    const { result } = app;
    show(host, facts([
      ['Face', count(face)],
      result && ['Part', String(result.labels[face] + 1)],
      result && ['Deformation', number(result.deformation[face])],
      result && ['From A', number(result.distance[face])],
      result && ['Set', result.deformable[face] ? 'A, deformable' : 'B, near-rigid'],
    ]));
    const { clientWidth: width, clientHeight: height } = host.parentElement;
    const x = at.x + AWAY + host.offsetWidth > width ? at.x - AWAY - host.offsetWidth : at.x + AWAY;
    const y = at.y + AWAY + host.offsetHeight > height ? at.y - AWAY - host.offsetHeight : at.y + AWAY;
    host.style.transform = `translate(${Math.max(8, x)}px, ${Math.max(8, y)}px)`;
  };
}
