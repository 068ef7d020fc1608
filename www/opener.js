/** Opening a source: a creature, files, an address; and what becomes of what was open before. */
import { BLANK, hasPlaced, isOwn } from './doc.js';
import { fetchSource } from './download.js';
import { Cancelled } from './engine.js';
import { collect, resting } from './files.js';
import { plural } from './format.js';
import { OPENING } from './history.js';
import { unproposed } from './keypoints.js';
import { readProject } from './project.js';
import { makeRoom } from './room.js';
import { WORTH_STOPPING } from './work.js';

export class Opener {
  /** @param {import('./app.js').App} app */
  constructor(app) {
    this.app = app;
    /** How many openings are under way; meanwhile the engine and the page may differ about what is open. */
    this.underWay = 0;
    /** Whether the next opening is that of a link, which has begun with {@link import('./app.js').App.reset}. */
    this.linked = false;
  }

  /** @param {object} recipe @param {{afresh?: boolean}} [how] `afresh`: without the points of the same creature */
  openCreature(recipe, how) {
    const source = { kind: 'zoo', recipe: { ...this.app.about.recipe, ...recipe } };
    return this.#open('zoo', source, async () => ({ recipe: source.recipe }), how);
  }

  /** @param {{name: string, blob: Blob}[]} files @param {object|null} options null: whatever the files are */
  async openFiles(files, options = null) {
    if (!options && (await this.tookProject(files))) return true;
    // Poses dropped after a mesh that stands still may be that mesh's: the engine tells.
    const { source: before, sequence } = this.app;
    const still = !options && before?.files && !sequence.sizes.poses ? before : null;
    const source = { kind: 'files', files, still, options: { ...this.app.about.options, ...options } };
    const asked = still ? { ...source.options, up: still.options.up } : source.options;
    return this.#open('open', source, () => collect(files, asked, still?.files));
  }

  /** Opens files as a project, if they are one. @returns {Promise<boolean>} whether they were */
  async tookProject(files) {
    const project = await readProject(files);
    if (project) await this.app.openProject?.(project);
    return Boolean(project && this.app.openProject);
  }

  openAddress(url, options = {}) {
    const source = { kind: 'src', url, files: null, options: { ...this.app.about.options, ...options } };
    const needed = (file) => this.app.engine.call('needed', { file }, { transfer: [file.bytes.buffer] });
    return this.#open('open', source, async (progress, signal) => {
      source.files = await fetchSource(url, { progress, signal, needed });
      return collect(source.files, source.options);
    });
  }

  /** Reads the open files again with other options. @param {{turned?: boolean}} [how] see {@link turn} */
  reopen(options, how) {
    const { kind, files, url, options: before } = this.app.source;
    const source = { kind, files, url, options: { ...before, ...options } };
    return this.#open('open', source, () => collect(files, source.options), how);
  }

  /** Turns the figure, so that another axis of its files is up. All that was done with it stays, and what is looked at. */
  turn(up) {
    return this.reopen({ up }, { turned: true });
  }

  async #open(operation, source, payload, { afresh = false, turned = false } = {}) {
    const { app } = this;
    if (app.busy?.left > WORTH_STOPPING) app.engine.cancel({ all: true });
    this.underWay++;
    const sequence = await app.work.run('source', operation === 'zoo' ? 'making the creature' : 'reading', async (progress, signal) => {
      const message = await payload(progress, signal);
      // The engine is to open nothing that the page no longer waits for.
      if (signal.aborted) throw new Cancelled('Cancelled.');
      const transfer = [...(message.files ?? []), ...(message.still ?? [])].map((file) => file.bytes.buffer);
      return app.engine.call(operation, message, { progress, transfer });
    });
    this.underWay--;
    if (!sequence) return false;
    // From now on they are one drop, the mesh first.
    if (sequence.joined) {
      source.files = [...resting(source.still.files), ...source.files];
      source.options.up = source.still.options.up;
    }
    delete source.still;
    // Numbered shapes have no time of their own; a walk made by code closes on itself.
    sequence.timed = sequence.times.some((time, i) => time !== sequence.times[0] && i > 0);
    sequence.loop = source.kind === 'zoo' || !sequence.timed;
    this.#replace({ source, sequence }, afresh, turned);
    if (sequence.joined) app.say(`${plural(sequence.sizes.poses, 'pose')} of the mesh that was open.`, 'news');
    else if (!turned) this.#sayWhatWent();
    await app.parts.segment();
    return true;
  }

  /** Puts what was opened in place of what was open. @param {Open} open */
  #replace(open, afresh, turned) {
    const { app } = this;
    const before = app.doc;
    if (turned) {
      // Errors and weights are the same either way up; the maps of a fit are not, and are found again.
      const run = before.run && { ...before.run, rounds: null };
      app.stay(() => app.edit({ open, run, points: unproposed(before.points) }));
      makeRoom(app.history);
      return;
    }
    // A target stays: what is new is to move it as well. So do points in which there is work, where they mean the same.
    const { changes, target, method } = before;
    // How many points were given says nothing of how many are wanted.
    const search = before.run ? app.keypoints.asked : before.search;
    const patch = !afresh && app.keypoints.worked && sameMesh(app.sequence, open.sequence) ? { open, wanted: null, run: null }
      : { ...BLANK, open, changes, search, target, method };
    if (!this.linked) app.history.rest();
    this.linked = false;
    if (before.open) app.history.edit(patch, OPENING);
    else app.history.restart({ ...BLANK, ...patch }, OPENING);
    makeRoom(app.history);
    app.react(before);
  }

  /** Says what an opening took away, if that was the visitor's own, and that it is not lost. */
  #sayWhatWent() {
    const { app } = this;
    const { open, points } = app.doc;
    const back = app.history.past.at(-1);
    if (!back) return;
    const placed = back.points !== points && hasPlaced(back);
    if (isOwn(back.open) && back.open.source.files !== open.source.files) {
      app.say(`${back.open.sequence.name} was closed. Undo brings it back${placed ? ' with its points' : ''}.`, 'news');
    } else if (placed) app.say('The points that were placed do not belong to this mesh. Undo brings them back.', 'news');
  }
}

/** Whether they are one figure, of which other axes are up. @param {Open|null} a @param {Open|null} b */
export function onlyTurned(a, b) {
  const rest = (figure) => JSON.stringify({ ...figure.source.options, up: null });
  return Boolean(a?.source.files) && a.source.files === b?.source.files && rest(a) === rest(b);
}

/** Whether a vertex of one is the same vertex of the other. */
const sameMesh = (a, b) => Boolean(a) && a.sizes.vertices === b.sizes.vertices && a.faces.length === b.faces.length
  && a.faces.every((vertex, i) => vertex === b.faces[i]);
