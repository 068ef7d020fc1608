/**
 * What there is to see: pairs of creatures that show what a transfer can do, with the true places of their points, and
 * creatures in motions of their own. Every card is a link that can be copied.
 */
import { h } from '../dom.js';
import { title } from '../format.js';

const PAIRS = [
  ['horse', 'camel', 'A camel that walks like a horse'],
  ['person', 'dinosaur', 'A dinosaur that walks like a person'],
  ['snake', 'hand', 'A hand that winds like a snake'],
  ['giraffe', 'cat', 'A cat that walks like a giraffe'],
  ['dog', 'giraffe', 'A giraffe that walks like a dog'],
  ['horse', 'dog', 'A dog that walks like a horse'],
];

const SIGHTS = [
  ['horse', 'gallop', 'A horse that gallops'],
  ['elephant', 'wave', 'An elephant that curls its trunk'],
  ['bird', 'fly', 'An eagle that flies'],
  ['octopus', 'swim', 'An octopus that swims by jets'],
  ['cat', 'collapse', 'A cat whose legs give way'],
  ['cactus', 'bend', 'A cactus that hears music'],
  ['robot', 'wave', 'A robot of separate pieces that waves'],
  ['cloth', 'wave', 'A flag, which has no rigid parts'],
];

/** All of it. @param {import('../app.js').App} app */
export function gallery(app) {
  return h('div', { class: 'gallery' }, ...pairCards(app, 'pair'),
    ...SIGHTS.filter(([name]) => app.about.creatures.includes(name)).map(sightCard));
}

/** The pairs alone. @param {import('../app.js').App} app */
export const pairGallery = (app) => h('div', { class: 'gallery' }, ...pairCards(app, 'target-pair'));

/** @param {string} kind what the ids of the cards begin with: the page has the pairs twice */
function pairCards(app, kind) {
  const known = (name) => app.about.creatures.includes(name);
  return PAIRS.filter(([source, target]) => known(source) && known(target)).map((pair) => pairCard(app, kind, ...pair));
}

function pairCard(app, kind, source, target, spoken) {
  const open = (event) => {
    // With a key held down it is a link like any other.
    if (event.ctrlKey || event.metaKey || event.shiftKey) return;
    event.preventDefault();
    openPair(app, source, target);
  };
  return h('a', { class: 'pair-card', id: `${kind}-${source}-${target}`, title: spoken, on: { click: open },
    href: `#v1;zoo=${source};step=transfer;target=${target};pairs=landmarks` },
    h('span', { class: 'pair-pictures' }, picture(source), picture(target)),
    h('span', { class: 'small' }, `${title(source)} → ${title(target)}`));
}

function sightCard([name, motion, spoken]) {
  return h('a', { class: 'pair-card', id: `sight-${name}-${motion}`, title: spoken, href: `#v1;zoo=${name};motion=${motion}` },
    h('span', { class: 'pair-pictures' }, picture(`${name}-${motion}`)),
    h('span', { class: 'small' }, spoken));
}

const picture = (name) => h('img', { src: new URL(`../pictures/${name}.png`, import.meta.url).href, alt: '', width: 84, height: 63, loading: 'lazy', draggable: 'false' });

async function openPair(app, source, target) {
  await app.target.openPair(source, target);
  if (app.doc.target) app.setStep('transfer');
}
