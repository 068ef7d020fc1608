/** Files from an address: what `?src=` names, and what lies beside it that it names in turn. */
import { Cancelled } from './engine.js';
import { megabytes } from './format.js';

/** What a link may bring, in bytes. */
const MOST_DOWNLOAD = 256 << 20;
/** An OBJ names its materials near its beginning; no more of it is looked through, in bytes. */
const HEAD = 256 << 10;

/**
 * Downloads what `?src=` names; of a .gltf also the buffers and images beside it, of an .obj its materials and their
 * pictures.
 * @param {string} address https, or of this very site
 * @param {{progress: (p: {stage: string, done: number}) => void, signal: AbortSignal,
 *   needed: (file: {name: string, bytes: Uint8Array}) => Promise<string[]>}} how `needed`: what an OBJ or its list of
 *   materials names, as it is written there
 */
export async function fetchSource(address, { needed, ...how }) {
  const budget = { left: MOST_DOWNLOAD };
  const url = allowed(address, location.href);
  const get = async (address, base, name) => {
    const file = await download(allowed(address, base), budget, how);
    return { ...file, name: name ?? file.name };
  };
  const main = await get(url.href);
  if (/\.gltf$/i.test(url.pathname)) return [main, ...(await besideGltf(main, url, get, how.signal))];
  if (/\.obj$/i.test(url.pathname)) return [main, ...(await besideObj(main, url, get, how.signal, needed))];
  return [main];
}

async function besideGltf(main, url, get, signal) {
  let document;
  try {
    document = JSON.parse(await main.blob.text());
  } catch {
    throw new Error(`“${main.name}” is not a glTF file.`);
  }
  const files = [];
  for (const uri of addresses(document?.buffers)) files.push(await get(uri, url, decoded(uri)));
  for (const uri of addresses(document?.images)) files.push(...(await ifThere(() => get(uri, url, decoded(uri)), signal)));
  return files;
}

/** The addresses in a list of a glTF document. */
function addresses(list) {
  const found = Array.isArray(list) ? list.map((entry) => entry?.uri) : [];
  return new Set(found.filter((uri) => typeof uri === 'string' && !uri.startsWith('data:')));
}

async function besideObj(main, url, get, signal, needed) {
  const files = [];
  const known = new Set();
  /** Gets what a file names; the names are paths from where that file lies. */
  const named = async ({ name, blob }, folder) => {
    const found = [];
    for (const path of await needed({ name, bytes: new Uint8Array(await blob.slice(0, HEAD).arrayBuffer()) })) {
      const address = addressOf(path);
      // A line may name one file, with spaces in its name, or several: where it was one, its words are none.
      if (!address || known.has(folder + address) || found.some(([, , whole]) => whole.split(/\s+/).includes(path))) continue;
      known.add(folder + address);
      for (const file of await ifThere(() => get(folder + address, url, decoded(folder + address)), signal)) {
        files.push(file);
        found.push([file, (folder + address).replace(/[^/]*$/, ''), path]);
      }
    }
    return found;
  };
  for (const [materials, folder] of await named(main, '')) if (/\.mtl$/i.test(materials.name)) await named(materials, folder);
  return files;
}

/** The address of a path as programs write them into files; of one from the root of somebody's disk only the last name can be meant. */
function addressOf(path) {
  const parts = path.split(/[\\/]+/);
  const rooted = /^([\\/]|[a-z]:)/i.test(path);
  return (rooted ? parts.slice(-1) : parts).map(encodeURIComponent).join('/');
}

/** A file, or none: without its look a figure has its shape and motion all the same. */
async function ifThere(get, signal) {
  try {
    return [await get()];
  } catch (error) {
    if (signal.aborted) throw error;
    return [];
  }
}

/** What a part of an address stands for; itself where it is no valid encoding. */
function decoded(part) {
  try {
    return decodeURIComponent(part);
  } catch {
    return part;
  }
}

function allowed(address, base) {
  const url = URL.canParse(address, base) ? new URL(address, base) : null;
  if (!url || (url.protocol !== 'https:' && url.origin !== location.origin)) {
    throw new Error('The link names a file that is neither on this site nor on an https address, so it was not opened.');
  }
  return url;
}

async function download(url, budget, { progress, signal }) {
  const name = decoded(url.pathname.split('/').pop()) || url.hostname;
  const stage = `downloading ${name}`;
  progress({ stage, done: 0 });
  try {
    const response = await fetch(url, { signal, credentials: url.origin === location.origin ? 'same-origin' : 'omit', referrerPolicy: 'no-referrer' });
    if (!response.ok) throw new Error(`“${name}” could not be loaded from ${url.hostname} (answer ${response.status}).`);
    const size = Number(response.headers.get('content-length')) || 0;
    const pieces = [];
    let got = 0;
    for (const reader = response.body.getReader(); ;) {
      const { done, value } = await reader.read();
      if (done) break;
      got += value.length;
      budget.left -= value.length;
      if (budget.left < 0) {
        reader.cancel();
        throw new Error(`“${name}” is larger than ${megabytes(MOST_DOWNLOAD)}, so it was not loaded from the link.`);
      }
      pieces.push(value);
      progress({ stage, done: size ? Math.min(1, got / size) : 0 });
    }
    return { name, blob: new Blob(pieces) };
  } catch (error) {
    if (signal.aborted) throw new Cancelled('Cancelled.');
    // Whatever the network says of it is no sentence for a person.
    if (error instanceof TypeError) throw new Error(`“${name}” could not be loaded from ${url.hostname}. The host may not allow other sites to read it.`);
    throw error;
  }
}
