/** Keyboard: what each key does, and the sheet that lists them. */
import { h, show } from './dom.js';
import { viewsOf, walk } from './stages.js';
import { stepNamed } from './steps/index.js';

const ORBIT = 24;
const ZOOM = 1.15;
const DIRECTIONS = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/**
 * @param {{app: import('./app.js').App, stage: import('./stage.js').Stage, timeline: import('./timeline.js').Timeline, sheet: HTMLDialogElement,
 *   hands: {source: object, target: object}}} page `hands`: see handling.js
 */
export function keys({ app, stage, timeline, sheet, hands }) {
  const hand = () => (app.step === 'keypoints' ? hands.source : hands.target);
  const middle = () => [stage.host.clientWidth / 2, stage.host.clientHeight / 2];
  const shortcuts = [
    [['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown'], '← →', 'One stage back, on', (key) => {
      // With the picture in hand, and where there are no stages, arrows turn the creature.
      const [dx, dy] = DIRECTIONS[key];
      const turns = dy || document.activeElement?.tagName === 'CANVAS' || !viewsOf(app.step).length;
      if (turns) stage.move('orbit', dx * ORBIT, dy * ORBIT);
      else walk(app, dx);
    }],
    [[], '↑ ↓, and ← → in the picture', 'Turn the creature', () => {}],
    [[], 'Shift ← → ↑ ↓', 'Move the selected point', () => {}],
    [['+', '=', '-'], '+ −', 'Nearer, farther', (key) => stage.move('zoom', key === '-' ? 1 / ZOOM : ZOOM, ...middle())],
    [['f'], 'F', 'All of it in the picture', () => stage.move('frame')],
    [[' '], 'Space', 'Play, pause', () => timeline.toggle()],
    [[',', '.'], ', .', 'One pose back, on', (key) => timeline.step(key === '.' ? 1 : -1)],
    [['r'], 'R', 'The reference pose', () => timeline.toggleReference()],
    [['p'], 'P', 'The panel', () => app.setPanel(!app.panel)],
    [['w'], 'W', 'The triangles', () => (stage.wireframe = !stage.kept.wireframe)],
    [['Enter'], 'Enter', 'Accept the selected point', () => app.target.accept(app.selected)],
    [['a'], 'A', 'Accept all points', () => app.target.tally.proposed && app.target.acceptAll()],
    [['n'], 'N', 'Select the next point', () => app.doc.count && app.select((app.selected + 1) % app.doc.count)],
    [['Delete', 'Backspace'], 'Delete', 'Take the selected point away', () => remove(app)],
    [['Escape'], 'Esc', 'Cancel what runs, close what is said', () => escape(app)],
    [['?'], '?', 'This sheet', () => open(sheet, shortcuts)],
  ];
  window.addEventListener('keydown', (event) => {
    if (document.querySelector('dialog[open]')) return;
    if ((event.ctrlKey || event.metaKey) && !event.altKey && returns(app, event)) return;
    if (event.ctrlKey || event.metaKey || event.altKey || mine(event)) return;
    if (event.shiftKey && event.key in DIRECTIONS && app.selected >= 0 && stepNamed(app.step).points) {
      event.preventDefault();
      hand().nudge(...DIRECTIONS[event.key]);
      return;
    }
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const shortcut = shortcuts.find(([names]) => names.includes(key));
    if (!shortcut) return;
    event.preventDefault();
    shortcut[3](key);
  });
  return () => open(sheet, shortcuts);
}

/** Undo and redo. @returns {boolean} whether the key was one of them */
function returns(app, event) {
  const key = event.key.toLowerCase();
  const back = key === 'z' && !event.shiftKey;
  const on = (key === 'z' && event.shiftKey) || key === 'y';
  if (!back && !on) return false;
  event.preventDefault();
  if (back) app.undo();
  else app.redo();
  return true;
}

function remove(app) {
  if (app.selected < 0) return;
  if (app.step === 'keypoints') app.keypoints.remove(app.selected);
  else if (stepNamed(app.step).points) app.target.remove(app.selected);
}

function escape(app) {
  if (app.busy) app.cancel();
  else if (app.notice) app.dismiss();
  else if (app.keypoints.adding) app.keypoints.setAdding(false);
  else app.select(-1);
}

/** Whether the control that has the focus wants this key for itself. */
function mine({ target, key, repeat }) {
  if (!(target instanceof Element)) return false;
  if (target.closest('select')) return key !== 'Escape';
  if (target.closest('input[type=range], input[type=radio]')) return key.startsWith('Arrow') || (key === ' ' && chooses(target));
  // Pressing the step that is shown opens its panel, and does nothing where that is open; but Enter may still be held from choosing it.
  if (target.closest('[aria-current=step]') && document.documentElement.dataset.panel !== 'away') return repeat && key === 'Enter';
  if (target.closest('button, summary, a, input, label')) return key === ' ' || key === 'Enter';
  return false;
}

/** Whether Space would choose this: only what is not chosen yet has a use for it. */
const chooses = (input) => input.type === 'radio' && !input.checked;

function open(sheet, shortcuts) {
  const close = h('button', { type: 'button', class: 'button', on: { click: () => sheet.close() } }, 'Close');
  show(sheet, h('h2', {}, 'Keys'),
    h('dl', { class: 'keys' }, ...[...shortcuts, [[], 'Ctrl Z, Ctrl Shift Z', 'Undo, redo']].flatMap(([, names, what]) => [h('dt', {}, h('kbd', {}, names)), h('dd', {}, what)])),
    h('p', { class: 'small faint' }, 'Drag to turn, drag with the right button or Shift to move, wheel or pinch to come nearer.'), close);
  sheet.showModal();
}
