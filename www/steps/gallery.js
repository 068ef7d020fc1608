/** Pairs of creatures that show what a transfer can do, with the true places of their points. */
import { h } from '../dom.js';
import { title } from '../format.js';

export const PAIRS = [['horse', 'camel'], ['person', 'dinosaur'], ['snake', 'hand']];

const SPOKEN = { horse: 'A camel that walks like a horse', person: 'A dinosaur that walks like a person', snake: 'A hand that winds like a snake' };

/** @param {import('../app.js').App} app */
export function gallery(app) {
  const known = PAIRS.filter((pair) => pair.every((name) => app.about.creatures.includes(name)));
  return h('div', { class: 'gallery' }, ...known.map(([source, target]) =>
    h('button', { type: 'button', class: 'pair-card', id: `pair-${source}-${target}`, title: SPOKEN[source], on: { click: () => openPair(app, source, target) } },
      h('span', { class: 'pair-pictures' }, picture(source), picture(target)),
      h('span', { class: 'small' }, `${title(source)} → ${title(target)}`))));
}

const picture = (name) => h('img', { src: new URL(`../pictures/${name}.webp`, import.meta.url).href, alt: '', width: 72, height: 54, loading: 'lazy', draggable: 'false' });

async function openPair(app, source, target) {
  await app.target.openPair(source, target);
  if (app.doc.target) app.setStep('transfer');
}
