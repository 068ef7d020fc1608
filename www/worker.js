/**
 * The worker: starts the engine from the compiled module that the page sends first, then answers its messages,
 * one at a time and in order. See engine.js for the messages.
 */
import init, { Engine } from '../pkg/worker.js';
import { crewOf, most } from './crew.js';
import { shared } from './shared.js';

/** Progress is told at most this often, in milliseconds. */
const PROGRESS_EVERY = 60;

/** The share of an operation that its meeting takes, where it has a single one. */
const MEETING = 0.9;

/** The methods that move vertices, not a skin. */
const BY_FACES = new Set(['gradients', 'posed']);

let engine;
/** The engine's code, for helpers. @type {WebAssembly.Module} */
let code;
/** What the engine has of the browser's memory. @type {WebAssembly.Memory} */
let memory;

const operations = {
  start: async ({ module }) => {
    code = module;
    ({ memory } = await init({ module_or_path: module }));
    engine = new Engine();
    return Engine.about();
  },
  open: ({ files, still, options }) => (still ? engine.open_more(still, files, options) : engine.open(files, options)),
  needed: ({ file }) => Engine.needed(file),
  zoo: ({ recipe }) => engine.zoo(recipe),
  restore: ({ kept }) => engine.restore(kept),
  segment: ({ parameters }, progress) => engine.segment(parameters, progress),
  parts: ({ parameters, parts }, progress) => engine.parts(parameters, parts, progress),
  export: ({ labels, colours }) => engine.export(labels, colours),
  export_rigid: ({ labels, files, options }) => engine.export_rigid(labels, files, options),
  target: ({ files, recipe, options }) => (recipe ? engine.target_zoo(recipe) : engine.target(files, options)),
  restore_target: ({ kept }) => engine.restore_target(kept),
  drop_target: () => engine.drop_target(),
  propose: ({ points, known }) => engine.propose(points, known),
  landmarks: ({ source, target }) => Engine.landmarks(source, target),
  transfer: ({ pairs, parameters, quick }, progress) => (BY_FACES.has(parameters.method)
    ? engine.transfer_faces(pairs, parameters, progress) : engine.transfer(pairs, parameters, quick, progress)),
  positions_by: ({ pairs, parameters }, progress) => engine.positions_by(pairs, parameters, progress),
  export_transfer: ({ form, files, options }) => engine.export_transfer(form, files, options),
};

for (const operation of Object.keys(shared)) {
  operations[operation] = (payload, progress) => together(operation, payload, progress);
}

/** How many results came from helpers. */
let helped = 0;

/** Runs an operation with as many helpers as it is worth; `crew` in the payload is the most members there may be. */
async function together(operation, payload, progress) {
  const { target, stage, members, run } = shared[operation];
  const size = members(engine, payload, payload.crew ?? most());
  const tell = (done, count) => stage && progress(stage, (MEETING * done) / count);
  const crew = crewOf(size, () => ({ module: code, kept: engine.kept(target), operation, payload }), tell);
  try {
    await crew.gather();
    return await run(engine, payload, progress, crew);
  } finally {
    helped += crew.helped;
    crew.end();
  }
}

let queue = Promise.resolve();
/** The message that is being answered. */
let current;
self.addEventListener('message', ({ data }) => {
  queue = queue.then(() => answer(data));
});

async function answer({ id, operation, ...payload }) {
  current = id;
  try {
    const result = await operations[operation](payload, progressOf(id));
    self.postMessage({ id, result, helped }, buffersOf(result));
  } catch (error) {
    // The engine throws sentences. Anything else, such as “unreachable”, means that it is broken for good.
    if (typeof error === 'string') self.postMessage({ id, error });
    else crashed(String(error));
  }
}

// What breaks between two turns of an operation is caught nowhere else.
self.addEventListener('error', (event) => {
  event.preventDefault();
  crashed(event.message);
});

function crashed(crash) {
  self.postMessage({ id: current, crash, memory: memory?.buffer.byteLength ?? 0 });
}

function progressOf(id) {
  let last = -Infinity;
  return (stage, done) => {
    const now = performance.now();
    if (now - last < PROGRESS_EVERY) return;
    last = now;
    self.postMessage({ id, progress: { stage, done } });
  };
}

/** The buffers of all typed arrays in a result, so that they move instead of being copied. */
function buffersOf(value, found = new Set()) {
  if (ArrayBuffer.isView(value)) found.add(value.buffer);
  else if (value && typeof value === 'object') for (const entry of Object.values(value)) buffersOf(entry, found);
  return [...found];
}
