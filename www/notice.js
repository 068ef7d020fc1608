/** Calm notices: an error or a piece of news in words, which goes when it is dismissed. */
import { h, iconButton, show } from './dom.js';

/** News goes by itself, but not before it can have been read: after this long, and so much more for each letter, in milliseconds. */
const NEWS_STAYS = 4000;
const LETTER_STAYS = 80;

/** @param {HTMLElement} host @param {import('./app.js').App} app */
export function notices(host, app) {
  let timer;
  const stop = () => clearTimeout(timer);
  const count = () => {
    stop();
    const { notice } = app;
    if (notice?.kind !== 'news') return;
    timer = setTimeout(() => app.notice === notice && app.dismiss(), NEWS_STAYS + LETTER_STAYS * notice.text.length);
  };
  // What is pointed at, or has the focus, is being read.
  for (const event of ['pointerenter', 'focusin']) host.addEventListener(event, stop);
  for (const event of ['pointerleave', 'focusout']) host.addEventListener(event, count);
  app.on('notice', () => {
    const { notice } = app;
    host.hidden = !notice;
    count();
    if (!notice) return;
    host.dataset.kind = notice.kind;
    // News waits until a screen reader has finished its sentence.
    host.setAttribute('role', notice.kind === 'news' ? 'status' : 'alert');
    show(host, h('p', {}, notice.text), iconButton('close', 'Dismiss', () => app.dismiss()));
  });
}
