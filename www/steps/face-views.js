/** The stages that look at one face: its frame before and after, and the graph around it. See views.js for what a view is. */
import { number, plural } from '../format.js';
import { differences, frame, gradient, parted, poseOf } from '../gradient.js';
import { poseShown } from '../overlay.js';

/** Squared difference of two gradients that differ by a turn of 60°, the end of the colours: 4 (1 − cos 60°). */
const SIXTH = 2;
/** Beyond this many faces the picture is not painted by pose: that would make it stutter. */
const MOST_FACES = 120_000;
/** So many faces of the graph are drawn around the one that is looked at. */
const NEIGHBOURHOOD = 70;
/** Length of an arrow, over the diagonal. */
const ARROW = 0.1;
/** Colours of the three axes of a face's frame, told apart by every eye. */
export const AXES = ['#c2452d', '#0b7285', '#7a5195'];
/** Weights of dual edges are shown over this range, in averages: from the least to what is surely deformable. */
const WEIGHTS = [0.1, 10];
/** Where ε could lie. */
const CREASE = 1.5;

const typical = new WeakMap();

/** The face that is looked at: the visitor's, or one beside a joint, which has something to show. */
export function faceOf({ face, result, sequence }) {
  if (face >= 0 && face < sequence.sizes.faces) return face;
  if (!typical.has(result)) {
    const { weight } = result;
    const order = Uint32Array.from(weight.keys()).sort((a, b) => weight[a] - weight[b] || a - b);
    typical.set(result, order[Math.floor(0.9 * (order.length - 1))] ?? 0);
  }
  return typical.get(result);
}

/** What the gradient of a face is in a pose. @returns {{m: number[], angle: number, stretches: number[]}|null} */
export function gradientOf(app, face, pose) {
  const m = gradient(app.sequence, poseOf(app.sequence, pose), face);
  return m && { m, ...parted(m) };
}

/** Corners of a face where they are shown now, three coordinates each. */
const cornersNow = ({ stage, sequence: { faces } }, face) => stage.vertices(faces.slice(3 * face, 3 * face + 3));

const centre = (corners) => [0, 1, 2].map((k) => (corners[k] + corners[3 + k] + corners[6 + k]) / 3);

const tooMany = ({ sequence }) => sequence.sizes.faces > MOST_FACES;

function paintDifferences(app, pose) {
  const { stage, sequence } = app;
  stage.boundaries = false;
  if (tooMany(app)) stage.paint(['paint_clay']);
  else stage.paint(['paint_scalar', differences(sequence, poseOf(sequence, pose), faceOf(app)), 0, SIXTH, 'viridis']);
}

export const gradients = {
  id: 'gradients',
  label: 'Gradients',
  title: 'The deformation gradient of one face: how its frame turns and stretches (Eq. 1–3). Click a face to look at it.',
  faces: true,
  paint: (app) => paintDifferences(app, poseShown(app)),
  follow: paintDifferences,
  legend(app) {
    const face = faceOf(app);
    if (tooMany(app)) return { kind: 'words', text: `Arrows: the frame of face ${face}, dashed in the reference. There are too many faces to paint them pose by pose.` };
    return {
      kind: 'scalar',
      map: 'viridis',
      marks: [0, SIXTH / 2, SIXTH],
      unit: `‖Mᵢ − Mⱼ‖² to face ${face}, in this pose; 2 is a turn of 60°. Arrows: its frame, dashed in the reference`,
    };
  },
  overlay(app) {
    const face = faceOf(app);
    const corners = cornersNow(app, face);
    if (!corners.length) return null;
    const middle = centre(corners);
    const now = frame([0, 1, 2], corners, 0);
    const before = frame(app.sequence.faces, app.sequence.reference, face);
    // Both at one length, so that what differs is seen: the reference's edges set it.
    const scale = (ARROW * app.sequence.diagonal) / Math.max(1e-12, Math.hypot(...before.slice(0, 3)), Math.hypot(...before.slice(3, 6)));
    const arrow = (axes, axis, kind) => ({ from: middle, to: middle.map((x, k) => x + scale * axes[3 * axis + k]), class: kind, colour: AXES[axis], arrow: true });
    const lines = [0, 1, 2].flatMap((axis) => [arrow(before, axis, 'axis before'), arrow(now, axis, 'axis')]);
    return { lines, dots: [{ at: middle, class: 'node chosen', radius: 4 }] };
  },
};

const graphs = new WeakMap();

/** The dual graph as compressed rows: for face f, `links[offsets[f]]` … are pairs of a neighbour and an edge. */
function graphOf(result) {
  if (!graphs.has(result)) {
    const { dual, labels } = result;
    const offsets = new Uint32Array(labels.length + 1);
    for (const face of dual) offsets[face + 1]++;
    for (let f = 0; f < labels.length; f++) offsets[f + 1] += offsets[f];
    const next = offsets.slice();
    const links = new Uint32Array(2 * dual.length);
    for (let e = 0; e < dual.length / 2; e++) {
      const [a, b] = [dual[2 * e], dual[2 * e + 1]];
      links.set([b, e], 2 * next[a]++);
      links.set([a, e], 2 * next[b]++);
    }
    graphs.set(result, { offsets, links });
  }
  return graphs.get(result);
}

/** The edges between the faces around one: `[from, to, edge]`, from near to far. */
function neighbourhood(result, face) {
  const { offsets, links } = graphOf(result);
  const known = new Map([[face, 0]]);
  const queue = [face];
  const edges = new Map();
  for (const f of queue) {
    for (let i = offsets[f]; i < offsets[f + 1]; i++) {
      const [other, edge] = [links[2 * i], links[2 * i + 1]];
      if (!known.has(other)) {
        if (known.size >= NEIGHBOURHOOD) continue;
        known.set(other, known.get(f) + 1);
        queue.push(other);
      }
      edges.set(edge, [f, other, edge]);
    }
  }
  return { faces: [...known.keys()], edges: [...edges.values()] };
}

/** The weights of the edges of a face. */
export function edgesOf(result, face) {
  const { offsets, links } = graphOf(result);
  return Array.from({ length: offsets[face + 1] - offsets[face] }, (_, i) => {
    const at = 2 * (offsets[face] + i);
    return { face: links[at], weight: result.dual_weights[links[at + 1]] };
  });
}

const logs = new WeakMap();

function logOf(field) {
  if (!logs.has(field)) logs.set(field, field.map((value) => Math.log10(Math.max(value, 1e-9))));
  return logs.get(field);
}

export const dual = {
  id: 'dual',
  label: 'Dual graph',
  title: 'Faces as nodes, joined where they share an edge, by how differently they deform (Eq. 5). Click a face to look at its part of the graph.',
  faces: true,
  paint(app) {
    app.stage.boundaries = false;
    app.stage.paint(['paint_scalar', logOf(app.result.weight), ...WEIGHTS.map(Math.log10), 'viridis']);
  },
  legend: (app) => ({
    kind: 'scalar',
    map: 'viridis',
    marks: [WEIGHTS[0], 1, WEIGHTS[1]],
    unit: `heaviest edge of each face, in averages, logarithmic; ${plural(app.result.dual.length / 2, 'edge')} in all, in red where heavier than ε`,
  }),
  overlay(app) {
    const { result, stage, sequence } = app;
    const { faces, edges } = neighbourhood(result, faceOf(app));
    const corners = stage.vertices(Uint32Array.from(faces.flatMap((f) => [...sequence.faces.subarray(3 * f, 3 * f + 3)])));
    if (!corners.length) return null;
    const seen = stage.project(corners);
    const nodes = new Map();
    faces.forEach((f, i) => {
      const [ax, ay, , bx, by, , cx, cy] = seen.subarray(9 * i, 9 * i + 9);
      // Faces that are turned away would be drawn over what hides them.
      const front = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax) < 0;
      if (front) nodes.set(f, centre(corners.subarray(9 * i, 9 * i + 9)));
    });
    const lines = edges.filter(([a, b]) => nodes.has(a) && nodes.has(b)).map(([a, b, edge]) => {
      const weight = result.dual_weights[edge];
      return { from: nodes.get(a), to: nodes.get(b), class: weight > result.epsilon ? 'link heavy' : 'link', width: (1 + 1.6 * Math.min(2, Math.sqrt(weight / CREASE))).toFixed(2) };
    });
    const dots = [...nodes].map(([f, at]) => ({ at, class: f === faceOf(app) ? 'node chosen' : 'node', radius: f === faceOf(app) ? 4 : 2 }));
    return { lines, dots };
  },
};

/** What a face's edges say, in words. */
export const edgeWords = (result, face) => edgesOf(result, face).map(({ face: other, weight }) => `to face ${other}: ${number(weight)}`);
