/** Sharing: a link to exactly this, a frame for another page, or everything as one file. */
import { h, show } from './dom.js';
import { writeLink } from './link.js';
import { writeProject } from './project.js';
import { fileName, saveBlob } from './save.js';

/** Size of a frame in somebody's page. */
const FRAME = [800, 560];

/** The address of what is shown. @param {string|null} embed null: the page itself */
export function addressOf(app, timeline, embed = null) {
  const url = new URL(location.href);
  url.searchParams.delete('embed');
  if (embed !== null) url.searchParams.set('embed', embed);
  url.hash = writeLink(app, timeline);
  return url.href;
}

/** @param {string} embed `controls` or `bare` */
export function embedCode(app, timeline, embed) {
  const attributes = { src: addressOf(app, timeline, embed), title: `Sinew: ${app.sequence?.name ?? 'a mesh that bends'}`, width: FRAME[0], height: FRAME[1], loading: 'lazy', allow: 'clipboard-write; fullscreen', style: 'border:0;max-width:100%' };
  return `<iframe ${Object.entries(attributes).map(([name, value]) => `${name}="${escaped(String(value))}"`).join(' ')}></iframe>`;
}

const escaped = (text) => text.replace(/[&<>"]/g, (sign) => `&#${sign.charCodeAt(0)};`);

/** What of the visitor's own a link leaves out, in words. */
function missing({ source, doc }) {
  if (source?.kind === 'files') return 'Your own file stays on this computer and cannot be in a link: whoever opens it sees the first creature with your settings. Send the file below instead.';
  if (doc.target?.source.kind === 'files') return 'Your own target stays on this computer and cannot be in a link: whoever opens it sees the source with its key points. Send the file below instead.';
  return '';
}

/** @param {HTMLDialogElement} sheet @param {import('./app.js').App} app */
export function share(sheet, app, timeline) {
  const field = h('input', { type: 'text', id: 'share-link', class: 'field', readonly: true, value: addressOf(app, timeline), on: { focus: () => field.select() } });
  const said = h('p', { class: 'small faint', role: 'status' });
  const copy = (text, words) => async () => {
    try {
      await navigator.clipboard.writeText(text());
      said.textContent = words;
    } catch {
      field.value = text();
      field.focus();
      said.textContent = 'The browser did not let the page copy. It is in the field above: copy it from there.';
    }
  };
  const button = (id, text, click, kind = 'chip-button') => h('button', { type: 'button', class: kind, id, on: { click } }, text);
  const project = async () => {
    said.textContent = 'Writing …';
    const blob = await writeProject(app, timeline);
    said.textContent = blob ? 'Saved. Drop it on this page to go on where you are now; any glTF viewer shows the moving parts.' : 'It could not be written: the parts are not known yet.';
    if (blob) saveBlob(blob, `${fileName(app)}-project.glb`);
  };
  const left = missing(app);
  show(sheet, h('h2', {}, 'Share'),
    h('div', {}, h('label', { for: 'share-link', class: 'small faint' }, left ? 'A link, without what is your own' : 'A link to exactly this'), field),
    left && h('p', { class: 'warning' }, left),
    h('div', { class: 'actions' },
      button('copy-link', 'Copy link', copy(() => addressOf(app, timeline), 'Link copied.'), 'chip-button first'),
      button('copy-embed', 'Copy frame with controls', copy(() => embedCode(app, timeline, 'controls'), 'Code copied: paste it into a page.')),
      button('copy-bare', 'Copy frame, picture only', copy(() => embedCode(app, timeline, 'bare'), 'Code copied: paste it into a page.'))),
    h('div', {}, h('p', { class: 'small faint' }, 'Everything as one file: your figures, the points, what you look at.'),
      h('div', { class: 'actions' }, button('save-project', 'Save project as GLB', project))),
    said,
    h('button', { type: 'button', class: 'chip-button', on: { click: () => sheet.close() } }, 'Close'));
  sheet.showModal();
}
