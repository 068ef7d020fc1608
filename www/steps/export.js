/** The step Export: what can be taken away, how large it is, and what it loses. */
import { fold, select } from '../controls.js';
import { h, icon, show } from '../dom.js';
import { bytes, ofSize, plural } from '../format.js';
import { lesson } from '../lesson.js';
import { writeProject } from '../project.js';
import { fileName, pairName, pairsFile, partsFile, pointsFile, reportFile, saveBlob, saveParts, savePicture, saveRigid, shownFigures } from '../save.js';
import { recordLoop, videoType } from '../video.js';

export const exportStep = {
  id: 'export',
  title: 'Export',
  pair: true,
  enter(app) {
    app.transfer.begin();
    measure(app);
  },
  summary: () => '',
  build,
};

/** Targets of up to this many vertices times poses are written at once, to know their size. */
const SMALL = 4_000_000;

/** Sizes of a picture in pixels; null: as it is on the screen. */
const SIZES = [['As shown', null], ['Full HD', [1920, 1080]], ['4K', [3840, 2160]], ['Square', [2048, 2048]], ['Slide', [1600, 1200]]];

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
      ...FORMS.filter(([form]) => form === 'exact' || motion.handles).map(([form, name, about]) => item(name, detail(about, files.get(form)), () => saveForm(app, form), `export-${form}`)),
      look(app, files.values().next().value),
      item('Pairs', 'The key points of both as vertex numbers, JSON.', () => saveBlob(pairsFile(app), `${pairName(app)}-pairs.json`), 'export-pairs'),
      item('Report', 'Parameters, errors and times, JSON.', () => saveBlob(reportFile(app), `${pairName(app)}-report.json`), 'export-report'),
    ] : [h('p', { class: 'small faint' }, app.doc.target ? `The target does not move yet${app.transfer.pairs.length ? '' : ': its points have no place'}.` : 'With a target that moves, it can be taken away here.')]));
  };
  show(still,
    item('Parts as GLB', 'The moving source with a material for each part.', () => saveParts(app), 'export-parts'),
    item('Rigid skin', 'A joint for each part and every vertex on one of them, as engines like it; in its own materials. It says how far off that is.', () => saveRigid(app), 'export-rigid'),
    item('Parts as numbers', 'The part of each face, sizes and residuals, JSON.', () => app.parts.ready() && saveBlob(partsFile(app), `${fileName(app)}-parts.json`), 'export-labels'),
    item('Key points', 'Vertices, errors and how they were chosen, JSON.', () => (app.doc.count ? saveBlob(pointsFile(app), `${fileName(app)}-points.json`) : app.say('There are no key points yet. The step Key points finds them.', 'news')), 'export-points'));
  const size = select('Picture size', SIZES.map(([name, pixels]) => [name, pixels ? `${name}, ${pixels.join(' × ')}` : name]), SIZES[0][0], () => {});
  const video = videoType() && item('Video', 'The motion from beginning to end, as it plays now and as large as it is shown.', () => saveVideo(app), 'export-video');
  const pictures = h('div', { class: 'stack' }, size,
    item('Picture', 'What is shown now, PNG.', () => savePicture(app, SIZES.find(([name]) => name === size.querySelector('select').value)[1]), 'export-picture'),
    video,
    item('Project', 'Everything as one file, to go on later or elsewhere.', () => saveProject(app), 'export-project'));
  app.on('motion', () => {
    update();
    if (app.step === 'export') measure(app);
  });
  const offerVideo = () => video && (video.hidden = app.timeline.poses < 2);
  app.on('files target doc', update);
  app.on('source', offerVideo);
  update();
  offerVideo();
  return h('div', { class: 'step' }, h('h2', {}, 'Export'), h('h3', {}, 'The target in motion'), moving, h('h3', {}, 'The source'), still, h('h3', {}, 'Pictures, and all of it'), pictures,
    fold('Which one to take', { load: () => lesson('export') }));
}

/** What the target looks like in its files. */
function look({ doc }, file) {
  const { kind, files = [] } = doc.target.source;
  const dressed = kind === 'files' && files.some(({ name }) => /\.(glb|gltf|zip|mtl)$/i.test(name));
  const words = file && file.images >= 0 ? `In its own materials${file.images ? ` and ${plural(file.images, 'texture')}` : ''}.`
    : dressed ? (file ? 'Its file has no materials: it is of clay.' : 'In its own materials and textures.')
      : 'Of clay: materials and textures are carried over from glTF, and from OBJ with its .mtl.';
  return h('p', { class: 'small faint' }, words);
}

function detail(about, file) {
  if (!file) return about;
  const off = file.error > 0 ? ` Off by ${ofSize(file.rms)} of its size, ${ofSize(file.error)} at most.` : '';
  return `${about}${off} ${bytes(file.blob.size)}.`;
}

function item(name, about, click, id) {
  return h('button', { type: 'button', class: 'export-item', id, on: { click } }, icon('save'),
    h('span', {}, h('span', { class: 'export-name' }, name), h('span', { class: 'small faint' }, about)));
}

async function saveForm(app, form) {
  const file = await app.transfer.file(form);
  if (file) saveBlob(file.blob, `${pairName(app)}-${form}.glb`);
}

async function saveVideo(app) {
  app.recording = new AbortController();
  const made = await app.work.run('video', 'recording the motion', (progress) =>
    recordLoop(shownFigures(app), app.timeline, (done) => progress({ stage: 'recording the motion', done }), app.recording.signal));
  app.recording = null;
  if (made) saveBlob(made.blob, `${fileName(app)}.${made.extension}`);
}

async function saveProject(app) {
  const blob = await writeProject(app, app.timeline);
  if (blob) saveBlob(blob, `${fileName(app)}-project.glb`);
}

/** Writes both forms, so that their sizes are known. */
async function measure(app) {
  const { motion } = app.transfer;
  if (!motion || app.target.sequence.sizes.vertices * app.sequence.sizes.poses > SMALL) return;
  for (const [form] of FORMS) if (form === 'exact' || motion.handles) await app.transfer.file(form);
}
