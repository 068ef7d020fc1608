//! The transfer by the letter: affine motions of the key points, blended by the target's own biharmonic weights.
//!
//! Jie Yang, Lin Gao, Yu-Kun Lai, Paul L. Rosin, Shihong Xia. *Biharmonic deformation transfer with automatic key point
//! selection*. Graphical Models 98, 2018, §3.6.

use super::Method;
use super::alignment::Alignment;
use super::surface::Surface;
use glam::{DAffine3, DMat3, DVec3};
use nalgebra::{Cholesky, DMatrix, Dyn};

/// How much linear parts are held to the mean deformation around their point.
const HOLD: f64 = 0.01;

/// Fits affine motions of the handles of weights to poses, by least squares of the vertices' positions.
pub struct Fit {
    basis: Vec<f64>,
    handles: usize,
    hold: Vec<f64>,
    system: Option<Cholesky<f64, Dyn>>,
}

impl Fit {
    /// Prepares weights on a surface, #N rows × #H.
    pub fn new(surface: &Surface, weights: &[f64], handles: usize) -> Self {
        let width = 4 * handles;
        let mut basis = Vec::with_capacity(surface.len() * width);
        for (v, p) in surface.positions.iter().enumerate() {
            for &w in &weights[v * handles..(v + 1) * handles] {
                basis.extend([w * p.x, w * p.y, w * p.z, w]);
            }
        }
        let rows = DMatrix::from_row_slice(surface.len(), width, &basis);
        let mut weighted = rows.clone();
        let mut hold = vec![1e-9; handles];
        for (v, &m) in surface.mass.iter().enumerate() {
            weighted.row_mut(v).scale_mut(m);
            for (h, w) in hold.iter_mut().zip(&weights[v * handles..(v + 1) * handles]) {
                *h += HOLD * m * w * w;
            }
        }
        let mut system = weighted.tr_mul(&rows);
        for (i, h) in hold.iter().enumerate() {
            (0..3).for_each(|k| system[(4 * i + k, 4 * i + k)] += h);
            system[(4 * i + 3, 4 * i + 3)] += 1e-12;
        }
        Self { basis, handles, hold, system: system.cholesky() }
    }

    /// The maps of the handles in one pose.
    pub fn maps(&self, surface: &Surface, pose: &[DVec3]) -> Vec<DAffine3> {
        let width = 4 * self.handles;
        let mut side = DMatrix::zeros(width, 3);
        let mut motions = vec![crate::linalg::rigid_fit::Moments::default(); self.handles];
        for (v, row) in self.basis.chunks_exact(width.max(1)).enumerate() {
            let (m, q) = (surface.mass[v], pose[v]);
            for (i, b) in row.iter().enumerate() {
                (0..3).for_each(|k| side[(i, k)] += m * b * q[k]);
            }
            for (moments, quad) in motions.iter_mut().zip(row.chunks_exact(4)) {
                moments.add(m * quad[3] * quad[3], surface.positions[v], q);
            }
        }
        for (i, moments) in motions.iter().enumerate() {
            let turn = moments.motion().rotation.to_cols_array_2d();
            for (row, column) in turn.iter().enumerate() {
                (0..3).for_each(|k| side[(4 * i + row, k)] += self.hold[i] * column[k]);
            }
        }
        let Some(system) = &self.system else { return vec![DAffine3::IDENTITY; self.handles] };
        system.solve_mut(&mut side);
        let column = |r: usize| DVec3::new(side[(r, 0)], side[(r, 1)], side[(r, 2)]);
        (0..self.handles)
            .map(|i| {
                let linear = DMat3::from_cols(column(4 * i), column(4 * i + 1), column(4 * i + 2));
                DAffine3::from_mat3_translation(linear, column(4 * i + 3))
            })
            .map(|map| if map.is_finite() { map } else { DAffine3::IDENTITY })
            .collect()
    }
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
