/**
 * Everything as one file: the moving source in its parts as a GLB that any viewer plays, and in its `extras` the state of
 * the page as a link has it, with the visitor's own files as they were. Dropped on the page, it opens as it was left.
 */
import { readGlb, readHead, withBytes } from './glb.js';
import { writeLink } from './link.js';

const VERSION = 1;
const MOST_FILES = 100_000;

/** @param {import('./app.js').App} app @returns {Promise<Blob|null>} */
export async function writeProject(app, timeline) {
  const bytes = await app.parts.export();
  const glb = bytes && readGlb(bytes);
  if (!glb) return null;
  const own = [['source', app.source], ['target', app.doc.target?.source]].filter(([, source]) => source?.files);
  const files = own.flatMap(([role, source]) => source.files.map(({ name, blob }) => ({ role, name, blob })));
  const extra = await Promise.all(files.map(async ({ blob }) => new Uint8Array(await blob.arrayBuffer())));
  return withBytes(glb, extra, (document, views) => {
    document.extras = {
      ...document.extras,
      sinew: {
        version: VERSION,
        state: writeLink(app, timeline, { own: true }),
        options: Object.fromEntries(own.map(([role, source]) => [role, source.options])),
        files: files.map(({ role, name }, i) => ({ role, name, view: views[i] })),
      },
    };
  });
}

/**
 * The project in what was dropped, if it is one.
 * @param {{name: string, blob: Blob}[]} files
 * @returns {Promise<{state: string, source: {files: {name: string, blob: Blob}[], options: object}, target: object}|null>}
 */
export async function readProject(files) {
  if (files.length !== 1 || !/\.glb$/i.test(files[0].name)) return null;
  // What cannot be read now is read again by the importer, which says what is wrong.
  const head = await readHead(files[0].blob).catch(() => null);
  const kept = head?.document.extras?.sinew;
  if (kept?.version !== VERSION || typeof kept.state !== 'string' || !Array.isArray(kept.files)) return null;
  const { bufferViews = [] } = head.document;
  const side = (role) => ({
    options: kept.options?.[role] ?? {},
    files: kept.files.slice(0, MOST_FILES).filter((file) => file.role === role && typeof file.name === 'string').map(({ name, view }) => {
      const { byteOffset = 0, byteLength = 0 } = bufferViews[view] ?? {};
      return { name, blob: head.binary.slice(byteOffset, byteOffset + byteLength) };
    }),
  });
  return { state: kept.state, source: side('source'), target: side('target') };
}
