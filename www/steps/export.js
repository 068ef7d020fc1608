/** The step Export: what can be taken away, how large it is, and what it loses. */
import { fold } from '../controls.js';
import { h, icon, show } from '../dom.js';
import { bytes, number } from '../format.js';
import { lesson } from '../lesson.js';
import { pairsFile, reportFile, saveBlob, saveParts, savePicture } from '../save.js';

export const exportStep = {
  id: 'export',
  title: 'Export',
  pair: true,
  enter: (app) => measure(app),
  summary: () => '',
  build,
};

/** Targets of up to this many vertices times poses are written at once, to know their size. */
const SMALL = 4_000_000;

const FORMS = [
  ['exact', 'GLB, exact', 'Every pose as a shape of its own. As it is here, to the last digit.'],
  ['light', 'GLB, light', 'A skin with joints: small, and what game engines expect.'],
];

/** @param {import('../app.js').App} app */
function build(app) {
  const moving = h('div', { class: 'stack' });
  const still = h('div', { class: 'stack' });
  const update = () => {
    const { motion, files } = app.transfer;
    show(moving, ...(motion ? [
      ...FORMS.map(([form, name, about]) => item(name, detail(about, files.get(form)), () => saveForm(app, form), `export-${form}`)),
      item('Pairs', 'The key points of both as vertex numbers, JSON.', () => saveBlob(pairsFile(app), `${baseName(app)}-pairs.json`), 'export-pairs'),
      item('Report', 'Parameters, errors and times, JSON.', () => saveBlob(reportFile(app), `${baseName(app)}-report.json`), 'export-report'),
    ] : [h('p', { class: 'small faint' }, app.doc.target ? 'The target does not move yet: its points have no place.' : 'With a target that moves, it can be taken away here.')]));
  };
  show(still,
    item('Parts as GLB', 'The moving source with a material for each part.', () => saveParts(app), 'export-parts'),
    item('Picture', 'What is shown now, PNG.', () => savePicture(app), 'export-picture'));
  app.on('motion', () => {
    update();
    if (app.step === 'export') measure(app);
  });
  app.on('files target doc', update);
  update();
  return h('div', { class: 'step' }, h('h2', {}, 'Export'), h('h3', {}, 'The target in motion'), moving, h('h3', {}, 'The source'), still,
    fold('Which one to take', { load: () => lesson('export') }));
}

function detail(about, file) {
  if (!file) return about;
  const off = file.error > 0 ? ` Off by ${number(1000 * file.rms, 2)} ‰ of its size, ${number(1000 * file.error, 2)} ‰ at most.` : '';
  return `${about}${off} ${bytes(file.blob.size)}.`;
}

function item(name, about, click, id) {
  return h('button', { type: 'button', class: 'export-item', id, on: { click } }, icon('save'),
    h('span', {}, h('span', { class: 'export-name' }, name), h('span', { class: 'small faint' }, about)));
}

async function saveForm(app, form) {
  const file = await app.transfer.file(form);
  if (file) saveBlob(file.blob, `${baseName(app)}-${form}.glb`);
}

/** Writes both forms, so that their sizes are known. */
async function measure(app) {
  const { motion } = app.transfer;
  if (!motion || app.target.sequence.sizes.vertices * app.sequence.sizes.poses > SMALL) return;
  for (const [form] of FORMS) await app.transfer.file(form);
}

const clean = (name) => name.replace(/\.[^.]*$/, '').replace(/[^\w-]+/g, '-');
const baseName = ({ sequence, target }) => `sinew-${clean(target.sequence?.name ?? 'target')}-like-${clean(sequence.name)}`;
