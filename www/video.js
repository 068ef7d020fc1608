/** The loop as a video, where the browser can record a canvas. */

import { Cancelled } from './engine.js';
import { boxesOf, together } from './together.js';

const TYPES = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm', 'video/mp4'];
const FRAMES = 30;
const BITS = 8_000_000;
/** A longer motion is not recorded beyond this, in seconds. */
const LONGEST = 30;
/** Where the graphics are slow, so many pictures are waited for, but not longer than this beyond the end, in milliseconds. */
const FEWEST = 3;
const GRACE = 15_000;

/** The kind of video that this browser writes; undefined if it writes none. */
export const videoType = () => (globalThis.MediaRecorder && HTMLCanvasElement.prototype.captureStream ? TYPES.find((type) => MediaRecorder.isTypeSupported(type)) : undefined);

/**
 * Plays the motion once from its beginning and records it.
 * @param {import('./stage.js').Stage[]} figures side by side
 * @param {import('./timeline.js').Timeline} timeline
 * @param {(share: number) => void} progress
 * @param {AbortSignal} [signal] stops it
 * @returns {Promise<{blob: Blob, extension: string}>}
 */
export async function recordLoop(figures, timeline, progress, signal) {
  const type = videoType();
  if (!type || !figures.length || !figures.every(({ view }) => view)) throw new Error('This browser cannot record the picture as a video.');
  if (!(timeline.seconds.at(-1) > 0)) throw new Error('It stands still: there is no motion to record.');
  const { time: before, playing, reference } = timeline;
  const film = filmOf(figures);
  const pieces = await filmed(film, type, timeline, progress, signal).finally(film.end);
  // The visitor goes on where they were.
  timeline.seek(before);
  if (reference) timeline.toggleReference();
  timeline.setPlaying(playing);
  if (signal?.aborted) throw new Cancelled('Cancelled.');
  if (!pieces.length) throw new Error('The recording came out empty.');
  return { blob: new Blob(pieces, { type }), extension: type.includes('mp4') ? 'mp4' : 'webm' };
}

/** Plays the motion once, and returns the pieces of what was recorded meanwhile. */
async function filmed(film, type, timeline, progress, signal) {
  const recorder = new MediaRecorder(film.stream, { mimeType: type, videoBitsPerSecond: BITS });
  const pieces = [];
  recorder.addEventListener('dataavailable', ({ data }) => data.size && pieces.push(data));
  const stopped = new Promise((resolve, reject) => {
    recorder.addEventListener('stop', resolve);
    recorder.addEventListener('error', ({ error }) => reject(error ?? new Error('The recording failed.')));
  });
  const length = Math.min(LONGEST, timeline.seconds.at(-1) / timeline.speed) * 1000;
  timeline.seek(0);
  recorder.start(500);
  timeline.setPlaying(true);
  const begun = performance.now();
  const watch = setInterval(() => progress(Math.min(1, (performance.now() - begun) / length)), 200);
  await new Promise((resolve) => {
    const end = () => {
      const over = performance.now() - begun - length;
      if (film.pictures >= FEWEST || over > GRACE) resolve();
      else setTimeout(end, 100);
    };
    setTimeout(end, length);
    signal?.addEventListener('abort', resolve);
  });
  clearInterval(watch);
  recorder.stop();
  await stopped;
  return pieces;
}

/** Puts figures together whenever one is drawn, until it ends. */
function filmOf(figures) {
  const { canvas, put } = together(boxesOf(figures, figures[0].pace.ratio));
  const stop = new AbortController();
  const film = {
    /** Pictures of the first figure so far. */
    pictures: 0,
    stream: canvas.captureStream(FRAMES),
    end() {
      stop.abort();
      for (const track of film.stream.getTracks()) track.stop();
    },
  };
  figures.forEach((figure, i) => {
    figure.addEventListener('drawn', () => {
      put(figure.canvas, i);
      if (i === 0) film.pictures++;
    }, { signal: stop.signal });
    // One that stands still would not be drawn.
    figure.view.redraw();
  });
  return film;
}
