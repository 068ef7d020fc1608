/**
 * Walking through the stages of a step: its views in the order in which the method computes them, and within a view its
 * positions (feature by feature, merge by merge, round by round). What is shown is what the run kept.
 *
 * A view with positions has `count(app)`, `first(app)` (where one begins; 0 without it) and `where(app, index)` (in words).
 */
import { STEPS, stepNamed } from './steps/index.js';

/** The views of a step, in order; none for a step without stages. */
export const viewsOf = (step) => stepNamed(step).views ?? [];

/** The view that a step shows. */
export const viewNow = (app) => viewsOf(app.step).find(({ id }) => id === app.view) ?? null;

/** How many positions a view has. */
export const countOf = (app, view) => Math.max(1, view?.count?.(app) ?? 1);

/** Where one is in a view. */
export function placeIn(app, view) {
  const last = countOf(app, view) - 1;
  const wanted = app.places[view?.id] ?? view?.first?.(app) ?? 0;
  return Math.min(Math.max(0, wanted), last);
}

/** One position on or back; beyond the last one, the next stage. @returns {boolean} whether there was one */
export function walk(app, by) {
  const views = viewsOf(app.step);
  const now = viewNow(app);
  if (!now) return false;
  const place = placeIn(app, now) + by;
  if (place >= 0 && place < countOf(app, now)) {
    app.setPlace(place);
    return true;
  }
  const next = views[views.indexOf(now) + by];
  if (!next) return false;
  if (countOf(app, next) > 1) app.places[next.id] = by > 0 ? 0 : countOf(app, next) - 1;
  app.setView(next.id);
  return true;
}

/** The view of that name and the step it belongs to. */
export function ownerOf(id) {
  const step = STEPS.find(({ views }) => views?.some((view) => view.id === id));
  return step ? { step, view: step.views.find((view) => view.id === id) } : null;
}
