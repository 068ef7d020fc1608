//! How the surface turns and stretches about each vertex (Eq. 6 to 14).

use crate::linalg::outer::outer;
use crate::linalg::polar;
use crate::linalg::rigid_fit::Moments;
use crate::mesh::face::vertex_normals;
use glam::{DMat3, DQuat, DVec3};

/// Numbers a vertex has per pose: the logarithm of its rotation and the six entries of its symmetric stretch.
const PER_POSE: usize = 9;

/// Share of the identity that is mixed into gradients, so that vertices in degenerate faces have one.
const RIDGE: f64 = 1e-6;

/// The mesh around its vertices.
#[derive(Clone, Copy, Debug)]
pub struct Ring<'a> {
    /// #F triples of vertices.
    pub faces: &'a [[u32; 3]],
    /// Edges as pairs of vertices.
    pub edges: &'a [[u32; 2]],
    /// Their weights w̃ (cotangents); negative ones count as 0.
    pub stiffness: &'a [f64],
    /// #V points.
    pub reference: &'a [DVec3],
}

/// Rotations and stretches of every vertex over the given poses, `[γ_logr logr/√m, γ_s s/√m]` of Eq. 15: #V rows of
/// `9 m` numbers. The rigid motion of the whole pose is taken out first; the stretch's distance from none is taken (a
/// shift that k-means does not see), off-diagonal entries once, by √2.
///
/// A vertex's edges lie nearly in a plane, so its normal counts as one more edge; it keeps its length.
pub fn features(ring: &Ring, poses: &[&[DVec3]], gamma_rotation: f64, gamma_shear: f64) -> Vec<f64> {
    let width = PER_POSE * poses.len();
    let share = (poses.len().max(1) as f64).sqrt();
    let (turn, shear) = (gamma_rotation / share, gamma_shear / share);
    let mut features = vec![0.0; width * ring.reference.len()];
    let normals = vertex_normals(ring.faces, ring.reference);
    for (t, pose) in poses.iter().enumerate() {
        let pose = without_rigid_motion(ring, pose);
        for (v, d) in gradients(ring, &normals, &pose).into_iter().enumerate() {
            let rotation = polar::rotation(d);
            let r = DQuat::from_mat3(&rotation).to_scaled_axis() * turn;
            let s = rotation.transpose() * d;
            let (s, off) = ((s + s.transpose()) * (0.5 * shear), std::f64::consts::SQRT_2);
            let row = [
                [r.x, r.y, r.z],
                [s.x_axis.x - shear, s.y_axis.y - shear, s.z_axis.z - shear],
                [off * s.x_axis.y, off * s.x_axis.z, off * s.y_axis.z],
            ];
            let at = v * width + t * PER_POSE;
            for (place, value) in features[at..at + PER_POSE].iter_mut().zip(row.as_flattened()) {
                *place = if value.is_finite() { *value } else { 0.0 };
            }
        }
    }
    features
}

/// The gradient about every vertex (Eq. 6).
fn gradients(ring: &Ring, normals: &[DVec3], pose: &[DVec3]) -> Vec<DMat3> {
    let n = ring.reference.len();
    let (mut from, mut to) = (vec![DMat3::ZERO; n], vec![DMat3::ZERO; n]);
    for (&[i, j], &w) in ring.edges.iter().zip(ring.stiffness) {
        if w > 0.0 {
            let [i, j] = [i as usize, j as usize];
            let (p, q) = (ring.reference[i] - ring.reference[j], pose[i] - pose[j]);
            let (pp, qp) = (outer(w * p, p), outer(w * q, p));
            for v in [i, j] {
                from[v] += pp;
                to[v] += qp;
            }
        }
    }
    let posed = vertex_normals(ring.faces, pose);
    let gradient = |v: usize| {
        let size = 0.5 * (from[v].x_axis.x + from[v].y_axis.y + from[v].z_axis.z);
        let ridge = DMat3::from_diagonal(DVec3::splat(RIDGE * size));
        let from = from[v] + outer(size * normals[v], normals[v]) + ridge;
        let gradient = (to[v] + outer(size * posed[v], normals[v]) + ridge) * from.inverse();
        if gradient.is_finite() { gradient } else { DMat3::IDENTITY }
    };
    (0..n).map(gradient).collect()
}

/// The pose moved rigidly next to the reference.
fn without_rigid_motion(ring: &Ring, pose: &[DVec3]) -> Vec<DVec3> {
    let mut used = vec![false; ring.reference.len()];
    ring.faces.iter().flatten().for_each(|&v| used[v as usize] = true);
    let mut moments = Moments::default();
    for (v, _) in used.iter().enumerate().filter(|u| *u.1) {
        moments.add(1.0, ring.reference[v], pose[v]);
    }
    let motion = moments.motion();
    let back = motion.rotation.transpose();
    pose.iter().map(|&q| back * (q - motion.translation)).collect()
}
