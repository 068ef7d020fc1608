/** The loop as a video, where the browser can record a canvas. */

import { Cancelled } from './engine.js';

const TYPES = ['video/webm;codecs=vp9', 'video/webm;codecs=vp8', 'video/webm', 'video/mp4'];
const FRAMES = 30;
const BITS = 8_000_000;
/** A longer motion is not recorded beyond this, in seconds. */
const LONGEST = 30;

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
  await new Promise((resolve) => {
    setTimeout(resolve, length);
    signal?.addEventListener('abort', resolve);
  });
  clearInterval(watch);
  recorder.stop();
  await stopped;
  for (const track of stream.getTracks()) track.stop();
  if (signal?.aborted) throw new Cancelled('Cancelled.');
  if (!pieces.length) throw new Error('The recording came out empty.');
  return { blob: new Blob(pieces, { type }), extension: type.includes('mp4') ? 'mp4' : 'webm' };
}
