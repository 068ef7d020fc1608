/**
 * Deformation gradients (Eq. 1–3) of the page's own, for the face that is looked at: the engine keeps what follows from
 * them. A matrix is nine numbers, column by column.
 *
 * R. W. Sumner, J. Popović, Deformation transfer for triangle meshes, ACM Transactions on Graphics 23(3), 2004.
 */

/** `[v2 − v1, v3 − v1, n/√|n|]` of a face over 3·#V coordinates. */
export function frame(faces, positions, face) {
  const at = (corner) => 3 * faces[3 * face + corner];
  const [a, b, c] = [at(0), at(1), at(2)];
  const e = [0, 1, 2].map((k) => positions[b + k] - positions[a + k]);
  const f = [0, 1, 2].map((k) => positions[c + k] - positions[a + k]);
  const n = cross(e, f);
  const root = Math.sqrt(Math.hypot(...n)) || 1;
  return [...e, ...f, ...n.map((x) => x / root)];
}

export const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** The inverse; null where there is none to speak of. */
export function inverse(m) {
  const [a, b, c] = [m.slice(0, 3), m.slice(3, 6), m.slice(6, 9)];
  const rows = [cross(b, c), cross(c, a), cross(a, b)];
  const det = a[0] * rows[0][0] + a[1] * rows[0][1] + a[2] * rows[0][2];
  if (!(Math.abs(det) > 1e-30)) return null;
  return [0, 1, 2].flatMap((k) => rows.map((row) => row[k] / det));
}

export const product = (a, b) => [0, 1, 2].flatMap((j) => [0, 1, 2].map((i) =>
  a[i] * b[3 * j] + a[3 + i] * b[3 * j + 1] + a[6 + i] * b[3 * j + 2]));

/** `M = Ṽ V⁻¹`; null for a face without area. */
export function gradient({ faces, reference }, positions, face) {
  const back = inverse(frame(faces, reference, face));
  return back && product(frame(faces, positions, face), back);
}

/** Σ of the squared differences: the numerator of Eq. 4. */
export const apart = (a, b) => a.reduce((sum, value, i) => sum + (value - b[i]) ** 2, 0);

/** The rotation in a gradient and its three stretches, largest first: Higham's iteration, then the symmetric rest. */
export function parted(m) {
  let r = m;
  for (let round = 0; round < 30; round++) {
    const back = inverse(r);
    if (!back) break;
    const next = r.map((x, i) => 0.5 * (x + back[3 * (i % 3) + Math.floor(i / 3)]));
    const still = apart(next, r) < 1e-24;
    r = next;
    if (still) break;
  }
  const turned = [0, 1, 2].flatMap((j) => [0, 1, 2].map((i) => r[3 * i + j]));
  const angle = Math.acos(Math.min(1, Math.max(-1, (r[0] + r[4] + r[8] - 1) / 2)));
  return { rotation: r, angle, stretches: eigenvalues(product(turned, m)) };
}

/** Of a symmetric matrix, largest first. */
function eigenvalues(s) {
  const mean = (s[0] + s[4] + s[8]) / 3;
  const off = s[3] ** 2 + s[6] ** 2 + s[7] ** 2;
  const p = Math.sqrt(((s[0] - mean) ** 2 + (s[4] - mean) ** 2 + (s[8] - mean) ** 2 + 2 * off) / 6);
  if (p < 1e-12) return [mean, mean, mean];
  const b = s.map((x, i) => (x - (i % 4 === 0 ? mean : 0)) / p);
  const half = 0.5 * (b[0] * (b[4] * b[8] - b[7] ** 2) - b[3] * (b[3] * b[8] - b[7] * b[6]) + b[6] * (b[3] * b[7] - b[4] * b[6]));
  const phi = Math.acos(Math.min(1, Math.max(-1, half))) / 3;
  const first = mean + 2 * p * Math.cos(phi);
  const last = mean + 2 * p * Math.cos(phi + (2 * Math.PI) / 3);
  return [first, 3 * mean - first - last, last];
}

const inverses = new WeakMap();

/** #F·9: the inverse frames of the reference; the identity where there is none. */
function inversesOf(sequence) {
  if (!inverses.has(sequence)) {
    const count = sequence.faces.length / 3;
    const all = new Float32Array(9 * count);
    for (let f = 0; f < count; f++) all.set(inverse(frame(sequence.faces, sequence.reference, f)) ?? [1, 0, 0, 0, 1, 0, 0, 0, 1], 9 * f);
    inverses.set(sequence, all);
  }
  return inverses.get(sequence);
}

/** #F: how far the gradient of each face is from that of one of them, squared (the numerator of Eq. 4), in one pose. */
export function differences(sequence, positions, face) {
  const { faces } = sequence;
  const back = inversesOf(sequence);
  const own = gradient(sequence, positions, face) ?? [1, 0, 0, 0, 1, 0, 0, 0, 1];
  const values = new Float32Array(faces.length / 3);
  const m = new Float64Array(9);
  for (let f = 0; f < values.length; f++) {
    const [a, b, c] = [3 * faces[3 * f], 3 * faces[3 * f + 1], 3 * faces[3 * f + 2]];
    for (let k = 0; k < 3; k++) {
      m[k] = positions[b + k] - positions[a + k];
      m[3 + k] = positions[c + k] - positions[a + k];
    }
    const [nx, ny, nz] = [m[1] * m[5] - m[2] * m[4], m[2] * m[3] - m[0] * m[5], m[0] * m[4] - m[1] * m[3]];
    const root = Math.sqrt(Math.hypot(nx, ny, nz)) || 1;
    m[6] = nx / root;
    m[7] = ny / root;
    m[8] = nz / root;
    let sum = 0;
    for (let j = 0; j < 3; j++) {
      const [x, y, z] = [back[9 * f + 3 * j], back[9 * f + 3 * j + 1], back[9 * f + 3 * j + 2]];
      for (let i = 0; i < 3; i++) sum += (m[i] * x + m[3 + i] * y + m[6 + i] * z - own[3 * j + i]) ** 2;
    }
    values[f] = sum;
  }
  return values;
}

/** 3·#V coordinates of a pose; −1: the reference. */
export function poseOf({ reference, poses }, pose) {
  return pose < 0 || !poses.length ? reference : poses.subarray(pose * reference.length, (pose + 1) * reference.length);
}
