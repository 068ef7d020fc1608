/** The views of the steps about key points, for both figures. See views.js for what a view is. */
import { plural } from '../format.js';
import { alternation } from './alternation-view.js';
import { labelCount as countOf } from './paint.js';
import { candidates, clay, replacement, spread } from './search-views.js';

const WEIGHT = 'viridis';

/** The point whose field is shown. */
const shownPoint = (app) => Math.max(0, app.selected);

/** One column of a table with `count` columns. */
const column = (values, count, index) => Float32Array.from({ length: values.length / count }, (_, row) => values[row * count + index]);

const points = {
  id: 'points',
  label: 'Points',
  title: 'The key points',
  paint: clay,
  legend: () => ({ kind: 'points' }),
};

const weights = {
  id: 'weights',
  label: 'Weights',
  title: 'How far the selected point carries the surface (bounded biharmonic weights, Eq. 1)',
  paint(app) {
    clay(app);
    const { current } = app.keypoints;
    const index = shownPoint(app);
    if (current) app.stage.paint(['paint_vertices', column(current.weights, current.points.length, index), 0, 1, WEIGHT]);
    const { field } = app.target;
    const handle = field?.points.indexOf(app.keypoints.used[index]?.source) ?? -1;
    if (handle >= 0) app.second?.paint(['paint_vertices', column(field.weights, field.points.length, handle), 0, 1, WEIGHT]);
    app.target.weigh();
  },
  legend: (app) => ({
    kind: 'scalar',
    map: WEIGHT,
    marks: [0, 0.5, 1],
    exact: true,
    unit: app.doc.count ? `weight of point ${shownPoint(app) + 1}` : 'no point yet',
    step: app.doc.count > 1 && {
      name: 'point',
      go: (by) => app.select((shownPoint(app) + by + app.doc.count) % app.doc.count),
    },
  }),
};

const groups = {
  id: 'groups',
  label: 'Groups',
  title: 'Vertices that turn together, by k-means on the weights (Eq. 15)',
  paint(app) {
    clay(app);
    const { current } = app.keypoints;
    if (!current) return;
    app.stage.boundaries = true;
    app.stage.paint(['paint_groups', current.groups, countOf(current.groups)]);
  },
  legend: ({ keypoints: { current } }) => ({
    kind: 'words',
    text: current ? `${plural(countOf(current.groups), 'group')} of vertices that share a rotation (§3.3)` : 'No point yet.',
  }),
};

export const KEY_POINT_VIEWS = [spread, candidates, replacement, weights, groups, alternation, points];
export const PAIR_VIEWS = [points, weights];
