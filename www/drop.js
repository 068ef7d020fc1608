/** Files dropped anywhere on the page. */
import { hasOwn, hasPlaced } from './doc.js';
import { dropped } from './files.js';

/** @param {HTMLElement} veil shown while something is dragged over the page */
export function drops(veil, app) {
  const words = veil.firstElementChild;
  let depth = 0;
  const hasFiles = (event) => event.dataTransfer?.types.includes('Files');
  const show = (change) => {
    depth = Math.max(0, depth + change);
    veil.hidden = depth === 0;
  };
  window.addEventListener('dragenter', (event) => hasFiles(event) && show(1));
  window.addEventListener('dragleave', (event) => hasFiles(event) && show(-1));
  window.addEventListener('dragover', (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    words.textContent = saying(app, event);
  });
  window.addEventListener('drop', async (event) => {
    if (!hasFiles(event)) return;
    event.preventDefault();
    show(-depth);
    try {
      const files = await dropped(event.dataTransfer);
      if (files.length) await (onTarget(app, event) ? app.target.openFiles(files) : app.opener.openFiles(files));
      else app.say('There was no file in what was dropped.');
    } catch {
      app.say('What was dropped could not be read.');
    }
  });
}

/** What dropping here does. */
function saying(app, event) {
  const what = 'a file, several files or a folder';
  if (onTarget(app, event)) return `Drop the figure that is to move: ${what}`;
  const placed = hasPlaced(app.doc);
  const back = placed || hasOwn(app.doc) ? `. Undo brings back what is open now${placed ? ', with its points' : ''}.` : '';
  return `${app.target.sequence ? 'Drop another figure to move like' : 'Drop it'}: ${what}${back}`;
}

/** Whether what is dropped is to be the target: in its step, and on its picture. */
function onTarget(app, { clientX, clientY }) {
  if (app.step === 'target') return true;
  const host = document.getElementById('second');
  return !host.hidden && host.contains(document.elementFromPoint(clientX, clientY));
}
