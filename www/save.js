/** What can be taken away: the link, the picture, the parts as a GLB. */
import { h } from './dom.js';
import { writeLink } from './link.js';

const OWN_TARGET = 'Link copied. Your own target stays on this computer and cannot be in a link: whoever opens it sees the source with its key points.';
const OWN_FILE = 'Link copied. Your own file stays on this computer and cannot be in a link: whoever opens it sees the first creature with your settings.';

export async function copyLink(app, timeline) {
  const url = new URL(location.href);
  url.hash = writeLink(app, timeline);
  try {
    await navigator.clipboard.writeText(url.href);
    const own = app.source?.kind === 'files' ? OWN_FILE : app.doc.target?.source.kind === 'files' && OWN_TARGET;
    app.say(own || 'Link copied.', 'news');
  } catch {
    history.replaceState(null, '', url.hash);
    app.say('The browser did not let the page copy. The link is in the address bar.', 'news');
  }
}

export async function savePicture(app) {
  try {
    saveBlob(await app.stage.picture(), `${fileName(app)}.png`);
  } catch (error) {
    app.say(error.message);
  }
}

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
  const bytes = await app.exportParts();
  if (bytes) saveBlob(new Blob([bytes], { type: 'model/gltf-binary' }), `${fileName(app)}.glb`);
}

/** @param {Blob} blob */
export function saveBlob(blob, name) {
  const url = URL.createObjectURL(blob);
  h('a', { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

const fileName = ({ sequence }) => `sinew-${(sequence?.name ?? 'picture').replace(/\.[^.]*$/, '').replace(/[^\w-]+/g, '-')}`;
