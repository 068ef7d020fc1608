/**
 * Going through the stages under the picture: one back, one on, and within a stage a scrubber over its positions that also
 * runs by itself.
 */
import { h, icon, iconButton, show } from './dom.js';
import { countOf, placeIn, viewNow, walk } from './stages.js';

/** How long a position is shown while they run, in milliseconds; together they take no longer than this. */
const EACH = 700;
const ALL = 14_000;
const CALM = matchMedia('(prefers-reduced-motion: reduce)');

/** @param {import('./app.js').App} app */
export function stageStrip(app) {
  let running = null;
  const stop = () => {
    clearInterval(running);
    running = null;
    look();
  };
  const run = () => {
    const view = viewNow(app);
    const count = countOf(app, view);
    if (placeIn(app, view) >= count - 1) app.setPlace(0);
    const by = Math.max(1, Math.ceil((count * EACH) / ALL / 4));
    running = setInterval(() => {
      const place = placeIn(app, view);
      if (viewNow(app) !== view || place >= count - 1) stop();
      else app.setPlace(Math.min(count - 1, place + by));
    }, Math.max(80, Math.min(EACH, (ALL * by) / count)));
    look();
  };
  const step = (by) => {
    if (running) stop();
    walk(app, by);
  };
  const back = iconButton('previous', 'One stage back (←)', () => step(-1), { id: 'stage-back' });
  const on = iconButton('next', 'One stage on (→)', () => step(1), { id: 'stage-on' });
  const play = h('button', { type: 'button', class: 'icon-button', id: 'stage-play', on: { click: () => (running ? stop() : run()) } });
  const range = h('input', { type: 'range', id: 'stage-place', min: 0, step: 1, on: {
    input: () => {
      if (running) stop();
      app.setPlace(range.valueAsNumber);
    },
  } });
  const words = h('output', { class: 'small faint number', for: 'stage-place' });
  const element = h('div', { class: 'strip' }, play, range, words);

  function look() {
    const label = running ? 'Hold still' : 'Run through this stage';
    if (play.title === label) return;
    play.title = label;
    play.setAttribute('aria-label', label);
    show(play, icon(running ? 'pause' : 'play'));
  }

  look();
  app.on('run-stage', () => !CALM.matches && countOf(app, viewNow(app)) > 1 && (app.setPlace(0), running ?? run()));
  app.on('view step source', () => running && stop());
  return {
    back,
    on,
    element,
    update() {
      const view = viewNow(app);
      const count = countOf(app, view);
      // Its place is kept, so that the picture does not jump from stage to stage.
      element.classList.toggle('off', count < 2);
      if (count < 2) return;
      const place = placeIn(app, view);
      range.max = count - 1;
      range.valueAsNumber = place;
      range.setAttribute('aria-label', view.label);
      words.textContent = [counted(view, place, count), view.where?.(app, place)].filter(Boolean).join(' · ');
      range.setAttribute('aria-valuetext', words.textContent);
    },
  };
}

/** Which position it is, in words. How things were before the first is shown too, but is none of those that are counted. */
function counted({ name, start }, place, count) {
  if (start) return place ? `${name} ${place} of ${count - 1}` : start;
  return name && `${name} ${place + 1} of ${count}`;
}
