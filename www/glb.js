/**
 * Reading and writing the two chunks of a GLB (glTF 2.0, binary form), as far as the page needs it: to put its own state
 * into a file that any viewer opens, and to find it there again.
 */

const MAGIC = 0x46546c67;
const JSON_CHUNK = 0x4e4f534a;
const BINARY_CHUNK = 0x004e4942;
const HEADER = 12;

const padded = (size) => Math.ceil(size / 4) * 4;

/** @param {Uint8Array} bytes @returns {{document: any, binary: Uint8Array}|null} null: this is no such file */
export function readGlb(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  if (bytes.length < HEADER + 8 || view.getUint32(0, true) !== MAGIC || view.getUint32(4, true) !== 2) return null;
  const length = view.getUint32(HEADER, true);
  if (view.getUint32(HEADER + 4, true) !== JSON_CHUNK || HEADER + 8 + length > bytes.length) return null;
  try {
    const document = JSON.parse(new TextDecoder().decode(bytes.subarray(HEADER + 8, HEADER + 8 + length)));
    const at = HEADER + 8 + length;
    const size = at + 8 <= bytes.length && view.getUint32(at + 4, true) === BINARY_CHUNK ? view.getUint32(at, true) : 0;
    return { document, binary: bytes.subarray(at + 8, Math.min(bytes.length, at + 8 + size)) };
  } catch {
    return null;
  }
}

/** The same of a file, without reading more than its JSON. @param {Blob} blob @returns {Promise<{document: any, binary: Blob}|null>} */
export async function readHead(blob) {
  const start = new DataView(await blob.slice(0, HEADER + 8).arrayBuffer());
  if (start.byteLength < HEADER + 8 || start.getUint32(0, true) !== MAGIC || start.getUint32(HEADER + 4, true) !== JSON_CHUNK) return null;
  const at = HEADER + 8 + start.getUint32(HEADER, true);
  const document = JSON.parse(await blob.slice(HEADER + 8, at).text());
  return { document, binary: blob.slice(at + 8) };
}

/** @returns {Blob} */
function writeGlb(document, binaries) {
  const text = new TextEncoder().encode(JSON.stringify(document));
  const json = new Uint8Array(padded(text.length)).fill(0x20);
  json.set(text);
  const size = binaries.reduce((sum, { length }) => sum + padded(length), 0);
  const head = new DataView(new ArrayBuffer(HEADER + 8));
  [MAGIC, 2, HEADER + 16 + json.length + size, json.length, JSON_CHUNK].forEach((word, i) => head.setUint32(4 * i, word, true));
  const middle = new DataView(new ArrayBuffer(8));
  [size, BINARY_CHUNK].forEach((word, i) => middle.setUint32(4 * i, word, true));
  const parts = binaries.flatMap((bytes) => [bytes, new Uint8Array(padded(bytes.length) - bytes.length)]);
  return new Blob([head, json, middle, ...parts], { type: 'model/gltf-binary' });
}

/** Adds bytes as buffer views of the first buffer; `describe(document, views)` says in it what they are. @returns {Blob} */
export function withBytes({ document, binary }, extra, describe) {
  const views = [];
  const binaries = [binary];
  let offset = padded(binary.length);
  document.bufferViews ??= [];
  for (const bytes of extra) {
    views.push(document.bufferViews.length);
    document.bufferViews.push({ buffer: 0, byteOffset: offset, byteLength: bytes.length });
    binaries.push(bytes);
    offset += padded(bytes.length);
  }
  document.buffers = [{ ...document.buffers?.[0], byteLength: offset }];
  describe(document, views);
  return writeGlb(document, binaries);
}
