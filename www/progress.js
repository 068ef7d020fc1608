/** The bar for long work: its stage, the time left, and Cancel. */
import { h, show } from './dom.js';
import { duration } from './format.js';

/** Work that is done sooner shows no bar, in milliseconds. */
const PATIENCE = 250;

/** @param {HTMLElement} host @param {import('./app.js').App} app */
export function progressBar(host, app) {
  const words = h('span', { class: 'small' });
  const left = h('span', { class: 'small faint number' });
  const bar = h('progress', { max: 1, 'aria-label': 'Progress' });
  show(host, h('div', { class: 'progress-head' }, words, left,
    h('button', { type: 'button', class: 'text-button small', on: { click: () => app.cancel() } }, 'Cancel')), bar);
  let timer;
  app.on('busy', () => {
    const { busy } = app;
    document.documentElement.classList.toggle('busy', Boolean(busy));
    if (!busy) {
      clearTimeout(timer);
      timer = undefined;
      host.hidden = true;
      return;
    }
    words.textContent = sentence(busy.stage);
    left.textContent = busy.left > 1 ? `about ${duration(busy.left)} left` : '';
    if (busy.done > 0) bar.value = busy.done;
    else bar.removeAttribute('value');
    timer ??= setTimeout(() => (host.hidden = !app.busy), PATIENCE);
  });
}

const sentence = (stage) => stage.charAt(0).toUpperCase() + stage.slice(1);
