/** A guided tour as one takes it: the card over the panel, and the list of tours. */
import { hasOwn, isOwn } from './doc.js';
import { h, show } from './dom.js';
import { countOf, viewNow } from './stages.js';
import { METHODS } from './steps/methods.js';
import { tourNamed, TOURS } from './tours.js';

export class Guide {
  /**
   * @param {import('./app.js').App} app
   * @param {{play: () => void, rest: () => void}} time lets the figures move, or shows the reference
   */
  constructor(app, time) {
    this.app = app;
    this.time = time;
    /** @type {import('./tours.js').Tour|null} */
    this.tour = null;
    this.stop = 0;
    this.going = 0;
    /** Where the visitor was with files of their own; null: there were none. @type {{doc: import('./doc.js').Doc, step: string, views: object}|null} */
    this.left = null;
    /** The figures of the tour, as they are being opened. */
    this.opened = Promise.resolve();
  }

  /** Begins a tour at a stop, on its own figure. @param {import('./doc.js').Doc} [left] what it takes the place of */
  async begin(id, stop = 0, left = this.app.doc) {
    const { app } = this;
    const tour = tourNamed(id);
    if (!tour) return false;
    const { zoo, target, faces } = tour.open;
    if (hasOwn(left)) this.left = { doc: left, step: app.step, views: app.views };
    this.tour = tour;
    this.stop = Math.min(Math.max(0, stop), tour.stops.length - 1);
    app.setLessons(true);
    app.changed('tour');
    const turn = ++this.going;
    this.opened = target ? app.target.openPair(zoo, target) : app.opener.openCreature({ name: zoo, ...(faces && { faces }) }, { afresh: true });
    if ((await this.opened) === false) return false;
    if (turn !== this.going) return true;
    if (this.left) app.say('What you had open is there again when you leave the tour.', 'news');
    this.#arrive();
    return true;
  }

  /** Takes up a tour where a link has it, with what the link opens. */
  resume(id, stop) {
    this.tour = tourNamed(id);
    this.stop = this.tour ? Math.min(Math.max(0, stop), this.tour.stops.length - 1) : 0;
    this.app.changed('tour');
  }

  go(by) {
    const next = this.stop + by;
    if (!this.tour?.stops[next]) return;
    this.stop = next;
    this.#arrive();
  }

  /** Ends the tour, and goes back to the visitor's own files unless others are open by now. */
  async leave() {
    const { app, left } = this;
    this.going++;
    Object.assign(this, { tour: null, left: null });
    app.changed('tour', 'link');
    if (!left) return;
    await this.opened;
    const { open, target } = left.doc;
    if ([app.doc.open, app.doc.target].some((figure) => isOwn(figure) && figure !== open && figure !== target)) return;
    app.views = left.views;
    app.takeUp(left.doc);
    app.setStep(left.step);
  }

  /** Shows what the stop is about. */
  #arrive() {
    const { app } = this;
    const { step, view, place, method, moves, run } = this.tour.stops[this.stop];
    if (method !== undefined && (!method || METHODS.some(([id]) => id === method))) app.transfer.setMethod(method || app.about.transfer.method);
    if (app.step !== step) app.setStep(step);
    if (view && app.view !== view) app.setView(view);
    if (place !== undefined) app.setPlace(place === 'last' ? countOf(app, viewNow(app)) - 1 : place === 'first' ? 0 : place);
    if (moves) this.time.play();
    if (run) app.changed('run-stage');
    app.changed('tour', 'link');
  }
}

/** The card of the tour that is under way. @param {Guide} guide */
export function tourCard(guide) {
  const { app } = guide;
  const back = h('button', { type: 'button', class: 'text-button', id: 'tour-back', on: { click: () => guide.go(-1) } }, 'Back');
  const next = h('button', { type: 'button', class: 'button', id: 'tour-next', on: { click: () => (guide.stop + 1 < guide.tour.stops.length ? guide.go(1) : guide.leave()) } });
  const leave = h('button', { type: 'button', class: 'text-button', id: 'tour-leave', on: { click: () => guide.leave() } }, 'Leave');
  const name = h('h2', {});
  const where = h('p', { class: 'small faint number' });
  const text = h('p', { 'aria-live': 'polite' });
  const card = h('section', { class: 'tour', 'aria-label': 'Guided tour', hidden: true }, h('div', { class: 'tour-head' }, name, where), text, h('div', { class: 'actions' }, back, leave, next));
  app.on('tour', () => {
    const { tour, stop } = guide;
    card.hidden = !tour;
    if (!tour) return;
    name.textContent = tour.title;
    where.textContent = `${stop + 1} of ${tour.stops.length}`;
    text.textContent = tour.stops[stop].text;
    back.disabled = stop === 0;
    next.textContent = stop + 1 < tour.stops.length ? 'Next' : 'Done';
    card.scrollIntoView?.({ block: 'nearest' });
  });
  return card;
}

/** The list of tours. @param {HTMLDialogElement} sheet @param {Guide} guide */
export function openTours(sheet, guide) {
  show(sheet, h('h2', {}, 'Guided tours'),
    h('ul', { class: 'tours' }, ...TOURS.map(({ id, title, about, stops }) => h('li', {}, h('button', { type: 'button', class: 'tour-item', id: `tour-${id}`, on: { click: () => {
      sheet.close();
      if (!guide.app.panel) guide.app.setPanel(true);
      guide.begin(id);
    } } }, h('span', {}, title), h('span', { class: 'small faint' }, `${about} ${stops.length} stops.`))))),
    h('button', { type: 'button', class: 'chip-button', on: { click: () => sheet.close() } }, 'Close'));
  sheet.showModal();
}
