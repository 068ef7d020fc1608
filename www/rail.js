/** The step rail: which step is shown, and in one word what each has come to. */
import { h, show } from './dom.js';
import { STEPS } from './steps/index.js';

/** @param {HTMLElement} host @param {import('./app.js').App} app */
export function rail(host, app) {
  const items = STEPS.map((step) => {
    const summary = h('span', { class: 'small faint' });
    const button = h('button', { type: 'button', class: 'step-button', id: `step-${step.id}`, on: { click: () => go(app, step.id) } },
      h('span', { class: 'step-title' }, step.title), summary);
    return { step, summary, button };
  });
  const update = () => {
    for (const { step, summary, button } of items) {
      summary.textContent = step.summary(app);
      if (step.id === app.step) button.setAttribute('aria-current', 'step');
      else button.removeAttribute('aria-current');
    }
  };
  app.on('step source result doc motion', update);
  app.on('step', () => items.find(({ step }) => step.id === app.step)?.button.scrollIntoView({ block: 'nearest', inline: 'center' }));
  show(host, h('ol', {}, ...items.map(({ button }) => h('li', {}, button))));
  update();
}

/** A step that is chosen shows its panel. */
function go(app, step) {
  if (step !== app.step) app.setStep(step);
  if (!app.panel) app.setPanel(true);
}
