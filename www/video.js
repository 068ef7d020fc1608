/** The loop as a video, where the browser can record a canvas. */

import { Cancelled } from './engine.js';

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
 * @param {import('./stage.js').Stage} stage @param {import('./timeline.js').Timeline} timeline
 * @param {(share: number) => void} progress
 * @param {AbortSignal} [signal] stops it
 * @returns {Promise<{blob: Blob, extension: string}>}
 */
export async function recordLoop(stage, timeline, progress, signal) {
  const type = videoType();
  if (!type || !stage.view) throw new Error('This browser cannot record the picture as a video.');
  if (!(timeline.seconds.at(-1) > 0)) throw new Error('It stands still: there is no motion to record.');
  const { time: before, playing, reference } = timeline;
  const stream = stage.canvas.captureStream(FRAMES);
  const recorder = new MediaRecorder(stream, { mimeType: type, videoBitsPerSecond: BITS });
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
  let pictures = 0;
  const count = () => pictures++;
  stage.addEventListener('drawn', count);
  await new Promise((resolve) => {
    const end = () => {
      const over = performance.now() - begun - length;
      if (pictures >= FEWEST || over > GRACE) resolve();
      else setTimeout(end, 100);
    };
    setTimeout(end, length);
    signal?.addEventListener('abort', resolve);
  });
  stage.removeEventListener('drawn', count);
  clearInterval(watch);
  recorder.stop();
  await stopped;
  for (const track of stream.getTracks()) track.stop();
  // The visitor goes on where they were.
  timeline.seek(before);
  if (reference) timeline.toggleReference();
  timeline.setPlaying(playing);
  if (signal?.aborted) throw new Cancelled('Cancelled.');
  if (!pieces.length) throw new Error('The recording came out empty.');
  return { blob: new Blob(pieces, { type }), extension: type.includes('mp4') ? 'mp4' : 'webm' };
}
