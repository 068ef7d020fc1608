/**
 * The mesh doctor: what is wrong with a figure, what was done about it and what it means. A click on a finding shows
 * its faces on bare clay, from where they are seen; another click brings back what was looked at before.
 */
import { h, show } from './dom.js';
import { MARK } from './steps/paint.js';

/** Notes of the importer that the doctor tells as well. */
const TOLD = new Set(['welded', 'collapsed-faces']);

/** What happens in poses is looked at in motion, all else in the reference. */
const IN_POSES = new Set(['turned-over', 'vanishing', 'exploding-poses']);

/** In words, for those who do not see the dots. */
const SEVERITIES = { grave: 'grave', care: 'worth a look', harmless: 'harmless' };

/** The notes of the importer that the doctor does not tell. @param {{code: string}[]} notes */
export const untold = (notes) => notes.filter(({ code }) => !TOLD.has(code));

/** How many things about a sequence are worth a look. */
export const worthALook = ({ warnings, diagnosis }) =>
  untold(warnings).length + (diagnosis?.findings.filter(({ severity }) => severity !== 'harmless').length ?? 0);

/**
 * @param {import('./app.js').App} app @param {'source'|'target'} side
 * @returns {{element: HTMLElement, update(): void}} `update` shows what is open now
 */
export function doctor(app, side) {
  const element = h('section', { class: 'doctor', 'aria-label': 'Mesh doctor' });
  const figure = () => (side === 'source' ? app.stage : app.second);
  /** The finding that is shown, and what was seen before. */
  let shown = null;
  let painting = false;

  const forget = () => {
    if (!shown) return;
    shown.item.setAttribute('aria-expanded', 'false');
    shown.words.hidden = true;
    const { stage, wireframe, still } = shown;
    shown = null;
    stage.unmark();
    stage.wireframe = wireframe;
    if (still) app.changed('resume');
  };

  const leave = () => {
    const { stage, camera, turn } = shown;
    forget();
    if (camera) stage.camera = camera;
    else {
      stage.turn = turn;
      stage.move('frame');
    }
    app.paint();
  };

  const look = (finding, item, words) => {
    if (shown?.item === item) return leave();
    const stage = figure();
    const { camera, wireframe } = shown ?? { camera: stage.kept.camera, wireframe: stage.kept.wireframe };
    const turn = shown?.turn ?? stage.turn;
    forget();
    item.setAttribute('aria-expanded', 'true');
    words.hidden = false;
    const still = side === 'source' && finding.faces.length > 0 && !IN_POSES.has(finding.code);
    shown = { item, words, stage, camera, turn, wireframe, still };
    if (!finding.faces.length) {
      painting = true;
      app.paint();
      painting = false;
      return undefined;
    }
    if (still) app.changed('rest');
    stage.boundaries = false;
    stage.wireframe = true;
    stage.paint(['paint_clay']);
    stage.mark(finding.faces, MARK.highlight);
    stage.look(finding.faces);
    return undefined;
  };

  const row = (finding) => {
    const id = `doctor-${side}-${finding.code}`;
    const words = h('div', { class: 'doctor-words small', id: `${id}-words`, hidden: true },
      h('p', {}, finding.done), h('p', {}, finding.means));
    const item = h('button', { type: 'button', class: 'doctor-item', id, 'aria-expanded': 'false', 'aria-controls': words.id,
      title: finding.faces.length ? 'Show where' : 'What it means', on: { click: () => look(finding, item, words) } },
    h('span', { class: `doctor-dot ${finding.severity}`, 'aria-hidden': 'true' }), finding.what,
    h('span', { class: 'hidden' }, `, ${SEVERITIES[finding.severity]}`));
    return h('li', {}, item, words);
  };

  // Whoever paints the figures anew takes the marks away.
  app.on('painted result', () => painting || forget());

  return {
    element,
    update() {
      const sequence = side === 'source' ? app.sequence : app.target.sequence;
      const diagnosis = sequence?.diagnosis;
      forget();
      element.hidden = !diagnosis;
      if (!diagnosis) return;
      show(element, h('h3', {}, 'Mesh doctor'),
        h('p', { class: 'small faint' }, diagnosis.summary),
        diagnosis.findings.length > 0 && h('ul', { class: 'doctor-list' }, ...diagnosis.findings.map(row)));
    },
  };
}
