/** What the stages paint with. */
import { h } from '../dom.js';

/** Styles of `Viewport.mark_faces`. */
export const MARK = { highlight: 0, point: 1, newest: 2 };
/** Their colours, as in src/view/frame.rs. */
const INKS = ['oklch(0.66 0.2 36)', 'oklch(0.6 0.15 255)', 'oklch(0.82 0.16 95)'];
/** Scalar maps end at this quantile: distances have heavy tails. */
const TOP = 0.98;
const tops = new WeakMap();

/** A high quantile of the finite values of a field: the end of its colour map. */
export function topOf(field) {
  if (!tops.has(field)) {
    const finite = field.filter(Number.isFinite).sort();
    tops.set(field, finite[Math.floor(TOP * (finite.length - 1))] || finite.at(-1) || 1);
  }
  return tops.get(field);
}

/** The colour of a mark, before the words that say in a legend what it means. */
export const swatch = (style) => h('span', { class: 'chip', style: { background: INKS[style] } });

export function scalar(app, values, low, high, map) {
  app.stage.boundaries = false;
  app.stage.paint(['paint_scalar', values, low, high, map]);
}

/**
 * Paints parts. What colour each part has follows from the engine's own parts, then those in force: so it is the
 * same whatever was looked at before, and on both sides of a link.
 */
export function paintParts(app, labels) {
  const { automatic, labels: current } = app.result;
  const chain = new Set([automatic.labels, current, labels]);
  app.stage.boundaries = true;
  app.stage.paint(['paint_clay'], ...[...chain].map((each) => ['paint_parts', each, labelCount(each)]));
}

export const labelCount = (labels) => labels.reduce((most, label) => Math.max(most, label + 1), 0);
