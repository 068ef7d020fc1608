/** What can be taken away as a file: pictures, meshes, numbers. */
import { h } from './dom.js';
import { ofSize } from './format.js';
import { boxesOf, halves, together } from './together.js';

/** The picture as it is, or of a size of its own in pixels. @param {[number, number]|null} size */
export async function savePicture(app, size = null) {
  try {
    saveBlob(await pictureOf(shownFigures(app), size), `${fileName(app)}.png`);
  } catch (error) {
    app.say(error.message);
  }
}

/** The figures that are seen, from left to right; another method's lies over the source. */
export const shownFigures = ({ stage, second, third }) =>
  [third ?? stage, second].filter((figure) => figure?.host.getBoundingClientRect().width >= 1);

/** What figures show together, as a PNG. @param {import('./stage.js').Stage[]} figures @param {[number, number]|null} size */
export async function pictureOf(figures, size = null) {
  if (figures.length === 1) return figures[0].picture(size);
  const boxes = size ? halves(size) : boxesOf(figures, devicePixelRatio);
  // All are asked at once: they are to show the same moment.
  const pictures = await Promise.all(figures.map((figure, i) => figure.picture(size && boxes[i].slice(2), size && marginsOf(boxes[i], size))));
  const { canvas, put } = together(boxes);
  for (const [i, picture] of pictures.entries()) put(await createImageBitmap(picture), i);
  const blob = await new Promise((resolve) => canvas.toBlob(resolve, 'image/png'));
  if (!blob) throw new Error('The browser could not save the picture.');
  return blob;
}

/** How far the edges of a whole are from those of a box in it, inwards. */
const marginsOf = ([x, y, width, height], whole) => [-x, -y, x + width - whole[0], y + height - whole[1]];

const json = (value) => new Blob([`${JSON.stringify(value, null, 2)}\n`], { type: 'application/json' });

/** The pairs in the form that the command line reads. */
export const pairsFile = (app) => json(app.transfer.pairs);

/** Parameters, errors and times of what is shown. */
export function reportFile(app) {
  const { sequence, target, keypoints, transfer, doc } = app;
  const seconds = (list) => Object.fromEntries(list ?? []);
  return json({
    source: { name: sequence.name, ...sequence.sizes },
    target: { name: target.sequence.name, vertices: target.sequence.sizes.vertices, faces: target.sequence.sizes.faces },
    key_points: keypoints.used.map(({ source }) => source),
    errors: doc.run && keypoints.untouched ? Array.from(doc.run.errors).slice(0, doc.count) : undefined,
    error: keypoints.error,
    pairs: keypoints.used.filter((point) => point.target != null)
      .map((point) => ({ source: point.source, target: point.target, state: point.state, confidence: point.confidence })),
    parameters: { keypoints: keypoints.parameters, transfer: { ...app.about.transfer, method: transfer.method } },
    seconds: { keypoints: seconds(doc.run?.seconds), transfer: seconds(transfer.motion?.seconds) },
    warnings: [...(doc.run?.warnings ?? []), ...(transfer.motion?.warnings ?? [])].map(({ message }) => message),
  });
}

/** The moving creature with a material for each part. */
export async function saveParts(app) {
  const bytes = await app.parts.export();
  if (bytes) saveBlob(new Blob([bytes], { type: 'model/gltf-binary' }), `${fileName(app)}.glb`);
}

/** The creature as a skin with a joint for each part, and what that loses in words. */
export async function saveRigid(app) {
  const made = await app.parts.exportRigid();
  if (!made) return;
  saveBlob(new Blob([made.bytes], { type: 'model/gltf-binary' }), `${fileName(app)}-rigid.glb`);
  app.say(`The rigid skin is off by ${ofSize(made.rms)} of its size, by ${ofSize(made.error)} at most.`, 'news');
}

/** The parts: labels of the faces, sizes, residuals, parameters. */
export function partsFile({ sequence, result, parameters, wanted }) {
  return json({
    source: { name: sequence.name, ...sequence.sizes },
    parameters: { ...parameters, parts: wanted, epsilon: result.epsilon, gamma: result.gamma },
    parts: result.parts,
    rigid_residual: result.rigid_residual,
    labels: Array.from(result.labels),
    seconds: Object.fromEntries(result.seconds),
    warnings: result.warnings.map(({ message }) => message),
  });
}

/** The key points: vertices, errors, how they were chosen. */
export function pointsFile({ sequence, doc, keypoints }) {
  const { run, count } = doc;
  return json({
    source: { name: sequence.name, ...sequence.sizes },
    parameters: keypoints.parameters,
    key_points: keypoints.used.map(({ source }) => source),
    errors: run && keypoints.untouched ? Array.from(run.errors).slice(0, count) : undefined,
    error: keypoints.error,
    candidates: run && Array.from(run.candidates),
    replacements: run?.replacements,
    seconds: run && Object.fromEntries(run.seconds),
  });
}

/** @param {Blob} blob */
export function saveBlob(blob, name) {
  const url = URL.createObjectURL(blob);
  h('a', { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

/** What a file is called after the source, without its ending. */
export const fileName = ({ sequence }) => `sinew-${plainName(sequence, 'picture')}`;

/** The same for what comes of both figures. */
export const pairName = ({ sequence, target }) => `sinew-${plainName(target.sequence, 'target')}-like-${plainName(sequence, 'source')}`;

/** The letters and digits of a name, in whatever language it is. */
const plainName = (sequence, otherwise) =>
  (sequence?.name ?? '').replace(/\.[^.]*$/, '').replace(/[^\p{L}\p{M}\p{N}_]+/gu, '-').replace(/^-|-$/g, '') || otherwise;
