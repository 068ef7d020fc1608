/** Calm notices: an error or a piece of news in words, which goes when it is dismissed. */
import { h, iconButton, show } from './dom.js';

/** News goes by itself after this long, in milliseconds. */
const NEWS_STAYS = 5000;

/** @param {HTMLElement} host @param {import('./app.js').App} app */
export function notices(host, app) {
  let timer;
  app.on('notice', () => {
    clearTimeout(timer);
    const { notice } = app;
    host.hidden = !notice;
    if (!notice) return;
    host.dataset.kind = notice.kind;
    show(host, h('p', {}, notice.text), iconButton('close', 'Dismiss', () => app.dismiss()));
    if (notice.kind === 'news') timer = setTimeout(() => app.notice === notice && app.dismiss(), NEWS_STAYS);
  });
}
