/**
 * The stage views of the segmentation, in the order in which the method computes them. Each paints the creature
 * with what one step found and says what its colours mean.
 *
 * A view is `{id, label, title, paint(app, place), legend(app)}`; the legend describes itself as
 * `{kind: 'scalar'|'sets'|'parts'|'words', …}` for dock.js, and in place of words may have a list of words and swatches.
 * One with positions also has what stages.js says, and for strip.js `name` (of a position that is counted) and `start` (what
 * the first is called, where it is how things were before: it is not counted). One that draws over the picture has what
 * overlay.js says; `faces`: a click chooses a face; `needs(app)`: whether there is such a stage.
 */
import { number, percent, plural } from '../format.js';
import { dual, gradients } from './face-views.js';
import { MARK, paintParts as parts, scalar, swatch, topOf } from './paint.js';
import { cut, merging, refined } from './tree-views.js';

/** Deformation is shown over this many powers of ten. */
const DECADES = 3;

/** The share of faces for which a mask is set. */
const share = (mask) => mask.reduce((sum, value) => sum + value, 0) / Math.max(1, mask.length);

export const VIEWS = [
  gradients,
  {
    id: 'deformation',
    label: 'Deformation',
    title: 'How differently a face deforms from its neighbours, over their distance (Eq. 4)',
    paint(app) {
      const top = Math.log10(topOf(app.result.deformation));
      scalar(app, app.result.deformation.map((value) => Math.max(Math.log10(value), top - DECADES)), top - DECADES, top, 'viridis');
    },
    legend({ result }) {
      const top = topOf(result.deformation);
      const marks = Array.from({ length: DECADES + 1 }, (_, i) => top / 10 ** (DECADES - i));
      return { kind: 'scalar', map: 'viridis', marks, unit: 'deformation distance, logarithmic' };
    },
  },
  dual,
  {
    id: 'sets',
    label: 'A and B',
    title: 'The deformable faces A and the rest B (§3.2, step 1)',
    paint(app) {
      app.stage.boundaries = false;
      app.stage.paint(['paint_set', app.result.deformable]);
    },
    legend({ result }) {
      const a = share(result.deformable);
      return { kind: 'sets', a: `A, deformable: ${percent(a)} of the faces`, b: `B, near-rigid: ${percent(1 - a)}`, text: `ε = ${number(result.epsilon)}` };
    },
  },
  {
    id: 'distance',
    label: 'Distance from A',
    title: 'How far a face lies from the deformable set (Eq. 5): features are farthest',
    paint(app) {
      const top = topOf(app.result.distance);
      scalar(app, app.result.distance.map((value) => Math.min(value, top)), 0, top, 'cividis');
    },
    legend({ result }) {
      const top = topOf(result.distance);
      return { kind: 'scalar', map: 'cividis', marks: [0, top / 2, top], unit: 'distance from A' };
    },
  },
  {
    id: 'features',
    label: 'Features',
    title: 'The feature faces in the order in which they were found, each with its region of influence (§3.2)',
    name: 'Feature',
    count: ({ result }) => result?.features.length ?? 1,
    where: ({ result }, index) => (result.features[index]
      ? `${plural(result.features[index].region.length, 'face')} under its influence, partition ${result.features[index].partition + 1}` : 'none was found'),
    paint(app, index) {
      const { features, labels } = app.result;
      app.stage.boundaries = false;
      const mask = new Uint8Array(labels.length);
      for (const face of features[index]?.region ?? []) mask[face] = 1;
      app.stage.paint(['paint_set', mask]);
      app.stage.mark(Uint32Array.from(features.slice(0, index + 1), ({ face }) => face), MARK.point);
    },
    legend: ({ result }) => (result.features.length ? {
      kind: 'sets',
      a: 'Its region',
      b: ['The rest', swatch(MARK.point), 'Features so far'],
      text: `${result.features.length} in all, farthest first`,
    } : { kind: 'words', text: 'No feature was found.' }),
  },
  {
    id: 'clusters',
    label: 'Clusters',
    title: 'The partitions after each round of clustering (§3.3)',
    name: 'Round',
    count: ({ result }) => result?.rounds.length ?? 1,
    first: ({ result }) => (result?.rounds.length ?? 1) - 1,
    where: ({ result }, index) => (result.rounds[index] ? plural(new Set(result.rounds[index]).size, 'partition') : 'not needed'),
    paint: (app, index) => parts(app, app.result.rounds[index] ?? app.result.unsmoothed),
    legend: ({ result }) => ({
      kind: 'words',
      text: result.merges.length && result.rounds.length > 1 ? 'Every face goes to the feature nearest to it. The last round cuts large clusters further, for the merge tree.'
        : 'Every face goes to the feature nearest to it.',
    }),
  },
  merging,
  refined,
  cut,
  {
    id: 'parts',
    label: 'Parts',
    title: 'The near-rigid parts',
    paint: (app) => parts(app, app.result.labels),
    legend: () => ({ kind: 'parts' }),
  },
];

/** The view that shows the parts themselves. */
export const PARTS_VIEW = VIEWS.at(-1);
