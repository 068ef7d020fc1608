/** Files as the visitor gives them: dropped or chosen. */
import { megabytes } from './format.js';

/** More than this cannot be held by a page, in bytes. */
const MOST_BYTES = 1 << 30;

/** What is often dropped in vain, and where it is made. */
const FOREIGN = /\.(fbx|blend|dae|usd[acz]?|3ds|max|ma|mb|c4d|bvh|abc|x3d|vrm|pmx)$/i;
/** What only says how a mesh looks; it is found by its name. */
const FOR_LOOKS = /\.(mtl|png|jpe?g)$/i;
const READABLE = /\.(glb|gltf|obj|off|ply|stl|zip)$/i;

/**
 * The message that opens files.
 * @param {{name: string, blob: Blob}[]} files
 * @param {object} options
 * @param {{name: string, blob: Blob}[]} [still] what was open before, if its poses may be among the files
 */
export async function collect(files, options, still) {
  refuse(files);
  const total = [...files, ...(still ?? [])].reduce((sum, { blob }) => sum + blob.size, 0);
  if (total > MOST_BYTES) throw new Error(`These files have ${megabytes(total)}; Sinew opens up to ${megabytes(MOST_BYTES)}.`);
  return { files: await readAll(files), options, ...(still && { still: await readAll(still) }) };
}

/** Says at once what the engine would have to guess: a file of another kind, or none at all. */
function refuse(files) {
  if (!files.length) throw new Error('There is no file in that folder.');
  const empty = files.find(({ name, blob }) => READABLE.test(name) && !blob.size);
  if (empty) throw new Error(`“${empty.name}” is empty.`);
  const foreign = files.find(({ name }) => FOREIGN.test(name));
  if (foreign && !files.some(({ name }) => READABLE.test(name))) {
    throw new Error(`“${foreign.name}” cannot be read here. Export it as glTF (.glb) from the program that made it; Blender opens and writes most kinds.`);
  }
}

/** What the engine reads the look of a figure from: the files that it was opened from, as far as they are still there. */
export async function originals(source) {
  const none = { files: [], options: {} };
  if (!source?.files) return none;
  return collect(source.files, source.options).catch(() => none);
}

/** Whether a figure was opened from a glTF, which has clips as no other format has. A file may also be in an archive. */
export const isGltf = ({ source: { files }, sequence }) =>
  sequence.clips.length > 0 || files?.some(({ name }) => /\.(glb|gltf)$/i.test(name));

const readAll = (files) => Promise.all(files.map(async ({ name, blob }) => {
  try {
    return { name, bytes: new Uint8Array(await blob.arrayBuffer()) };
  } catch {
    throw new Error(`“${name}” can no longer be read; it may have been moved or changed.`);
  }
}));

/** The same files, the meshes among them under names that put them before their poses. */
export const resting = (files) =>
  files.map(({ name, blob }) => ({ name: FOR_LOOKS.test(name) ? name : name.replace(/(\.[^./]*)?$/, ' rest$1'), blob }));

/** Everything in a drop, folders included. Must be called before the event handler returns. */
export function dropped(transfer) {
  const entries = [...transfer.items].filter((item) => item.kind === 'file')
    .map((item) => item.webkitGetAsEntry?.() ?? item.getAsFile());
  return Promise.all(entries.filter(Boolean).map(walk)).then((found) => found.flat());
}

async function walk(entry) {
  if (entry instanceof File) return [{ name: entry.name, blob: entry }];
  if (entry.isFile) {
    const file = await new Promise((resolve, reject) => entry.file(resolve, reject));
    return [{ name: entry.fullPath.replace(/^\//, ''), blob: file }];
  }
  const reader = entry.createReader();
  const found = [];
  // A reader hands out a folder in batches; an empty batch is the end.
  for (;;) {
    const batch = await new Promise((resolve, reject) => reader.readEntries(resolve, reject));
    if (!batch.length) return found.flat();
    found.push(...(await Promise.all(batch.map(walk))));
  }
}

/** The files of a file button. */
export const chosen = (list) => [...list].map((file) => ({ name: file.webkitRelativePath || file.name, blob: file }));
