//! The transfer by the letter: affine motions of the key points, blended by the target's own biharmonic weights.
//!
//! Jie Yang, Lin Gao, Yu-Kun Lai, Paul L. Rosin, Shihong Xia. *Biharmonic deformation transfer with automatic key point
//! selection*. Graphical Models 98, 2018, §3.6.

use super::Method;
use super::alignment::Alignment;
use super::surface::WeldedSurface;
use crate::mesh::laplacian::Laplacian;
use crate::skinning::{FitParameters, Fitter, Ring, Rows, SkinnedMesh, clusters, features};
use glam::{DAffine3, DVec3};

/// γ_logr and γ_s of Eq. 15, the shares of rotations and of stretches in the groups.
const GAMMAS: [f64; 2] = [1.0, 0.1];

/// Poses over which groups are found, the most.
const POSES: usize = 12;

/// Fits the motions of key points of a surface to its poses (Eq. 3–5, 15), whose weights are #N rows × #H, row-major.
///
/// `points` are their places; `poses` tell which vertices move alike, all in the unit ball.
pub fn fitter(surface: &WeldedSurface, points: &[u32], weights: &[f64], poses: &[Vec<DVec3>]) -> Fitter {
    let Laplacian { edges, cotangents: stiffness, .. } = Laplacian::new(&surface.faces, &surface.positions);
    let ring = Ring { faces: &surface.faces, edges: &edges, stiffness: &stiffness, reference: &surface.positions };
    let step = poses.len().div_ceil(POSES).max(1);
    let seen: Vec<&[DVec3]> = poses.iter().step_by(step).map(Vec::as_slice).collect();
    let [turn, shear] = GAMMAS;
    let features = features(&ring, &seen, turn, shear);
    let groups = clusters(weights, &features, points, &surface.mass);
    let mesh = SkinnedMesh {
        reference: &surface.positions,
        edges: &edges,
        stiffness: &stiffness,
        mass: &surface.mass,
        handles: points,
        weights: &Rows::new(weights, points.len()),
        groups: &groups,
        ball: (DVec3::ZERO, 1.0),
    };
    Fitter::new(&mesh, &FitParameters::default())
}

/// The motion of a key point on the target, of its motion on the source; `pair` are the two points, all in unit balls.
pub fn carried(method: Method, alignment: Alignment, pair: (DVec3, DVec3), map: &DAffine3) -> DAffine3 {
    let Alignment { turn, size, shift } = alignment;
    let linear = turn * map.matrix3 * turn.transpose();
    let translation = match method {
        // The same motion of space, in the target's frame and scale.
        Method::Direct => size * (turn * map.translation) + shift - linear * shift,
        // The same deformation about the key point, which is displaced as far.
        _ => {
            let displacement = size * (turn * (map.transform_point3(pair.0) - pair.0));
            pair.1 + displacement - linear * pair.1
        }
    };
    DAffine3::from_mat3_translation(linear, translation)
}
