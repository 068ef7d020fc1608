/** The panel of the step in force; it can be put away. On a phone it is a sheet from below. */
import { h, iconButton, show } from './dom.js';
import { STEPS } from './steps/index.js';

/** @param {HTMLElement} host @param {import('./app.js').App} app @param {HTMLElement} above what stands over every step */
export function panel(host, app, above) {
  const close = iconButton('close', 'Put the panel away (P)', () => app.setPanel(false));
  const bodies = new Map(STEPS.map((step) => [step.id, h('div', { class: 'panel-body' }, step.build(app))]));
  show(host, close, above, ...bodies.values());
  const open = iconButton('panel', 'Show the panel (P)', () => app.setPanel(true), { class: 'icon-button panel-opener' });
  host.after(open);
  let shown = app.step;
  const update = () => {
    for (const [id, body] of bodies) body.hidden = id !== app.step;
    // Another step is read from its beginning, however far down the one before it was.
    if (shown !== app.step) host.scrollTop = 0;
    shown = app.step;
    host.setAttribute('aria-label', STEPS.find(({ id }) => id === app.step).title);
    host.hidden = !app.panel;
    open.hidden = app.panel;
    document.documentElement.dataset.panel = app.panel ? 'open' : 'away';
  };
  let figure = app.target.sequence;
  app.on('step panel', update);
  app.on('target', () => {
    // What a new target brings stands above the creatures from which it was chosen.
    if (app.target.sequence && figure !== app.target.sequence) host.scrollTop = 0;
    figure = app.target.sequence;
  });
  update();
}
