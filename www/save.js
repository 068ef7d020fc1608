/** What can be taken away: the link, the picture, the parts as a GLB. */
import { h } from './dom.js';
import { writeLink } from './link.js';

const OWN_FILE = 'Link copied. Your own file stays on this computer and cannot be in a link: whoever opens it sees the first creature with your settings.';

export async function copyLink(app, timeline) {
  const url = new URL(location.href);
  url.hash = writeLink(app, timeline);
  try {
    await navigator.clipboard.writeText(url.href);
    app.say(app.source?.kind === 'files' ? OWN_FILE : 'Link copied.', 'news');
  } catch {
    history.replaceState(null, '', url.hash);
    app.say('The browser did not let the page copy. The link is in the address bar.', 'news');
  }
}

export async function savePicture(app) {
  try {
    save(await app.stage.picture(), `${fileName(app)}.png`);
  } catch (error) {
    app.say(error.message);
  }
}

/** The moving creature with a material for each part. */
export async function saveParts(app) {
  const bytes = await app.exportParts();
  if (bytes) save(new Blob([bytes], { type: 'model/gltf-binary' }), `${fileName(app)}.glb`);
}

function save(blob, name) {
  const url = URL.createObjectURL(blob);
  h('a', { href: url, download: name }).click();
  setTimeout(() => URL.revokeObjectURL(url), 10_000);
}

const fileName = ({ sequence }) => `sinew-${(sequence?.name ?? 'picture').replace(/\.[^.]*$/, '').replace(/[^\w-]+/g, '-')}`;
