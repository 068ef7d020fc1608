/** Which axis of a figure is up: few formats say it, and a figure of which it is another lies on its side. */
import { select } from './controls.js';

/** As the engine calls them. */
export const AXES = ['y', 'z', 'x', '-y', '-z', '-x'];

/**
 * The choice of that axis.
 * @param {import('./app.js').App} app @param {'source'|'target'} side
 * @param {string} place where it stands; part of its id
 * @returns {HTMLElement|false} none for a creature, which stands upright
 */
export function upright(app, side, place) {
  const [figure, opens] = side === 'source' ? [app.doc.open, app.opener] : [app.doc.target, app.target];
  return Boolean(figure?.source.files) && select('Up', AXES.map((axis) => [axis, axis.toUpperCase().replace('-', '−')]),
    figure.sequence.up, (up) => opens.turn(up),
    { id: `${place}-up-${side}`, 'aria-label': `Up: the axis of the ${side} that points up`, title: 'The axis of the file that points up' });
}
