/** The lessons: small HTML files of our own, fetched when they are unfolded. */
import { h } from './dom.js';

/** @returns {Promise<Node[]>} */
export async function lesson(name) {
  try {
    const response = await fetch(new URL(`lessons/${name}.html`, import.meta.url));
    if (!response.ok) throw new Error(String(response.status));
    const page = new DOMParser().parseFromString(await response.text(), 'text/html');
    return [...page.body.childNodes].map((node) => document.importNode(node, true));
  } catch {
    return [h('p', {}, 'The lesson could not be loaded.')];
  }
}
