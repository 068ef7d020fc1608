/** Warnings of the importer and of the segmentation, in words. */
import { h } from '../dom.js';
import { MARK } from './views.js';

/** @param {{code: string, message: string, faces?: number[]}[]} list */
export function warnings(app, list = []) {
  return list.map(({ message, faces }) => h('p', { class: 'warning' }, message, ' ',
    faces?.length && h('button', { type: 'button', class: 'text-button', on: {
      click: () => app.stage.mark(Uint32Array.from(faces), MARK.highlight),
    } }, 'Show them')));
}
