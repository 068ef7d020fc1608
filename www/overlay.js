/**
 * What a stage draws over the picture of the source: arrows, lines and dots at places of the figure, as it moves. Also
 * tells a stage when another pose is shown, for what it paints by pose.
 *
 * A view's `overlay(app)` gives `{lines: [{from, to, class, colour, width}], dots: [{at, class, colour, radius}],
 * words: [{at, text, class}]}` in coordinates of the world; its `follow(app, pose)` hears of poses.
 */
import { h, show, svg } from './dom.js';
import { viewNow } from './stages.js';

/** @param {import('./app.js').App} app @param {HTMLElement} host of the picture */
export function overlay(app, host) {
  const layer = svg('svg', { class: 'overlay', 'aria-hidden': 'true' },
    svg('defs', {}, svg('marker', { id: 'overlay-head', viewBox: '0 0 8 8', refX: 7, refY: 4, markerWidth: 4, markerHeight: 4, orient: 'auto-start-reverse' },
      svg('path', { d: 'M0 0.5 8 4 0 7.5z', fill: 'context-stroke' }))));
  const group = svg('g');
  layer.append(group);
  host.append(h('div', { class: 'overlay-host' }, layer));
  const { stage } = app;
  let pose = null;

  const draw = () => {
    const drawing = shown(app)?.overlay?.(app);
    if (!drawing || !stage.view) {
      if (group.childElementCount) show(group);
      return;
    }
    const { lines = [], dots = [], words = [] } = drawing;
    const points = [...lines.flatMap(({ from, to }) => [...from, ...to]), ...dots.flatMap(({ at }) => [...at]), ...words.flatMap(({ at }) => [...at])];
    const places = stage.project(Float32Array.from(points));
    let next = 0;
    const take = () => {
      const [x, y, depth] = places.subarray(3 * next, 3 * ++next);
      return { x: x.toFixed(1), y: y.toFixed(1), depth };
    };
    show(group,
      ...lines.map(({ class: kind, colour, width, arrow }) => {
        const [a, b] = [take(), take()];
        return a.depth > 0 && b.depth > 0 && svg('line', { x1: a.x, y1: a.y, x2: b.x, y2: b.y, class: kind, stroke: colour, 'stroke-width': width, 'marker-end': arrow && 'url(#overlay-head)' });
      }),
      ...dots.map(({ class: kind, colour, radius }) => {
        const a = take();
        return a.depth > 0 && svg('circle', { cx: a.x, cy: a.y, r: radius ?? 3, class: kind, fill: colour });
      }),
      ...words.map(({ class: kind, text }) => {
        const a = take();
        return a.depth > 0 && svg('text', { x: a.x, y: a.y, class: kind }, text);
      }));
  };

  const follow = () => {
    const view = shown(app);
    if (!view?.follow) {
      pose = null;
      return;
    }
    const now = poseShown(app);
    if (now === pose) return;
    pose = now;
    view.follow(app, now);
    app.changed('pose');
  };

  stage.addEventListener('drawn', draw);
  stage.addEventListener('tick', follow);
  app.on('view place step result source', () => {
    pose = null;
    draw();
  });
}

/** The view whose picture is shown. */
const shown = (app) => (app.sequence && app.result ? viewNow(app) : null);

/** The pose nearest to the moment that is shown; −1: the reference. */
export function poseShown({ stage, sequence }) {
  const { poses } = sequence.sizes;
  return stage.kept.time < 0 || !poses ? -1 : Math.round(stage.kept.time) % poses;
}
