/** Keyboard: what each key does, and the sheet that lists them. */
import { h, show } from './dom.js';

const ORBIT = 24;
const ZOOM = 1.15;

/**
 * @param {{app: import('./app.js').App, stage: import('./stage.js').Stage, timeline: import('./timeline.js').Timeline, sheet: HTMLDialogElement}} page
 */
export function keys({ app, stage, timeline, sheet }) {
  const middle = () => [stage.host.clientWidth / 2, stage.host.clientHeight / 2];
  const shortcuts = [
    [['ArrowLeft', 'ArrowRight', 'ArrowUp', 'ArrowDown'], '← → ↑ ↓', 'Turn the creature', (key) => {
      const [dx, dy] = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] }[key];
      stage.move('orbit', dx * ORBIT, dy * ORBIT);
    }],
    [['+', '=', '-'], '+ −', 'Nearer, farther', (key) => stage.move('zoom', key === '-' ? 1 / ZOOM : ZOOM, ...middle())],
    [['f'], 'F', 'All of it in the picture', () => stage.move('frame')],
    [[' '], 'Space', 'Play, pause', () => timeline.toggle()],
    [[',', '.'], ', .', 'One pose back, on', (key) => timeline.step(key === '.' ? 1 : -1)],
    [['r'], 'R', 'The reference pose', () => timeline.toggleReference()],
    [['p'], 'P', 'The panel', () => app.setPanel(!app.panel)],
    [['w'], 'W', 'The triangles', () => (stage.wireframe = !stage.kept.wireframe)],
    [['Escape'], 'Esc', 'Cancel what runs, close what is said', () => (app.busy ? app.cancel() : app.dismiss())],
    [['?'], '?', 'This sheet', () => open(sheet, shortcuts)],
  ];
  window.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || sheet.open || mine(event)) return;
    const key = event.key.length === 1 ? event.key.toLowerCase() : event.key;
    const shortcut = shortcuts.find(([names]) => names.includes(key));
    if (!shortcut) return;
    event.preventDefault();
    shortcut[3](key);
  });
  return () => open(sheet, shortcuts);
}

/** Whether the control that has the focus wants this key for itself. */
function mine({ target, key }) {
  if (!(target instanceof Element)) return false;
  if (target.closest('select')) return key !== 'Escape';
  if (target.closest('input[type=range], input[type=radio]')) return key.startsWith('Arrow') || (key === ' ' && chooses(target));
  if (target.closest('button, summary, a, input, label')) return key === ' ' || key === 'Enter';
  return false;
}

/** Whether Space would choose this: only what is not chosen yet has a use for it. */
const chooses = (input) => input.type === 'radio' && !input.checked;

function open(sheet, shortcuts) {
  const close = h('button', { type: 'button', class: 'button', on: { click: () => sheet.close() } }, 'Close');
  show(sheet, h('h2', {}, 'Keys'),
    h('dl', { class: 'keys' }, ...shortcuts.flatMap(([, names, what]) => [h('dt', {}, h('kbd', {}, names)), h('dd', {}, what)])),
    h('p', { class: 'small faint' }, 'Drag to turn, drag with the right button or Shift to move, wheel or pinch to come nearer.'), close);
  sheet.showModal();
}
