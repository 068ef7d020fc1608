/**
 * The lessons: small HTML files of our own. Each step has one as a whole, each stage one beside it: its question is the
 * heading of a fold, and controls stand beside the equations that they change.
 */
import { fold } from './controls.js';
import { h, show } from './dom.js';
import { lessonControl } from './steps/lesson-controls.js';
import { viewNow } from './stages.js';

const files = new Map();

/** @returns {Promise<Node[]>} */
export async function lesson(name) {
  try {
    if (!files.has(name)) files.set(name, read(name));
    const page = new DOMParser().parseFromString(await files.get(name), 'text/html');
    return [...page.body.childNodes].map((node) => document.importNode(node, true));
  } catch {
    files.delete(name);
    return [h('p', {}, 'The lesson could not be loaded.')];
  }
}

async function read(name) {
  const response = await fetch(new URL(`lessons/${name}.html`, import.meta.url));
  if (!response.ok) throw new Error(String(response.status));
  return response.text();
}

/**
 * The lesson of the stage that is shown, as a fold that stays open or closed from stage to stage.
 * @param {import('./app.js').App} app @param {string} step that it stands in
 */
export function stageLesson(app, step) {
  const body = h('div', { class: 'lesson' });
  const element = fold('', { content: [body] });
  element.classList.add('lesson-fold');
  const heading = element.querySelector('summary');
  let shown = null;
  let controls = [];
  const update = async () => {
    const view = app.step === step ? viewNow(app) : null;
    element.hidden = !view;
    element.open = app.lessons;
    if (!view || shown === view.id) return;
    shown = view.id;
    const nodes = await lesson(`stages/${view.id}`);
    if (shown !== view.id) return;
    const question = nodes.find((node) => node.nodeName === 'H3');
    heading.textContent = question?.textContent ?? view.label;
    show(body, ...nodes.filter((node) => node !== question));
    controls = [...body.querySelectorAll('[data-control]')].map((place) => {
      const control = lessonControl(app, place.dataset.control);
      place.replaceWith(control.element);
      return control;
    });
    refresh();
  };
  const refresh = () => element.open && app.step === step && controls.forEach(({ update: look }) => look());
  element.addEventListener('toggle', () => {
    if (element.open !== app.lessons) app.setLessons(element.open);
    refresh();
  });
  app.on('step view result lessons', update);
  app.on('place result parameters points doc pose', refresh);
  update();
  return element;
}
