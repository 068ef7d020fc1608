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
  for (const body of bodies.values()) body.querySelector('h2').tabIndex = -1;
  // What has the focus may be hidden by what it does: then the focus would fall to the beginning of the page.
  let focused = null;
  document.addEventListener('focusin', ({ target }) => (focused = target));
  document.addEventListener('focusout', ({ target }) => target.checkVisibility() && (focused = null));
  const keepFocus = () => {
    if (!focused || focused.checkVisibility()) return;
    if (focused === open) close.focus();
    else if (host.contains(focused)) (host.hidden ? open : bodies.get(app.step).querySelector('h2')).focus();
  };
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
    keepFocus();
  };
  let figure = app.target.sequence;
  app.on('step panel', update);
  app.on('target', () => {
    // What a new target brings stands above the creatures from which it was chosen.
    if (app.target.sequence && figure !== app.target.sequence) host.scrollTop = 0;
    figure = app.target.sequence;
  });
  app.on('doc', keepFocus);
  update();
}
