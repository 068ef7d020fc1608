/** Warnings of the importer and of the segmentation, in words. */
import { h } from '../dom.js';
import { MARK } from './paint.js';

/**
 * @param {{code: string, message: string, faces?: number[]}[]} list
 * @param {import('../stage.js').Stage|null} figure the picture of the mesh concerned
 */
export function warnings(app, list = [], figure = app.stage) {
  return list.map(({ message, faces }) => h('p', { class: 'warning' }, said(message), ' ',
    faces?.length && h('button', { type: 'button', class: 'text-button', on: {
      click: () => figure?.mark(Uint32Array.from(faces), MARK.highlight),
    } }, 'Show them')));
}

/** A sentence, without what only the command line understands: that stands in brackets, marked as code. */
const said = (message) => (message.charAt(0).toUpperCase() + message.slice(1)).replace(/ \(`[^`]*`\)/g, '');
