//! The distance metric (Eq. 4 and 5): how differently two neighbouring faces deform, and how far apart they are.

use super::statistics::{mean, over, quantile};
use crate::linalg::polar::frobenius_squared;
use crate::mesh::DualGraph;
use glam::DMat3;

/// Centroids closer than this (at unit diagonal) count as this far apart, so that Eq. 4 stays finite.
const CLOSEST: f64 = 1e-6;

/// Stretch that counts as rigid in any case: that of a rotation whose coordinates were rounded.
const LEAST_STRETCH: f64 = 0.01;

/// What the poses have shown so far: maxima over poses.
pub struct Deformation {
    /// #E deformation distances of Eq. 4, `max_t ‖Mᵢ − Mⱼ‖²_F / Geod`, with lengths at unit diagonal.
    pub distances: Vec<f64>,
    /// #F: how far each face is from moving rigidly by itself, `max_t ‖MᵀM − I‖_F`, `M` over the size of its piece.
    pub stretch: Vec<f64>,
}

impl Deformation {
    /// No pose yet.
    pub fn new(graph: &DualGraph) -> Self {
        Self { distances: vec![0.0; graph.edges().len()], stretch: vec![0.0; graph.face_count()] }
    }

    /// Adds a pose: #F gradients `m`, each on a piece that is `size` times as large as in the reference pose; `geodesic` are
    /// #E distances between centroids.
    pub fn add_pose(&mut self, m: &[DMat3], size: impl Fn(u32) -> f64, graph: &DualGraph, geodesic: &[f64]) {
        raise_distances(&mut self.distances, graph, geodesic, m);
        for ((stretch, m), f) in self.stretch.iter_mut().zip(m).zip(0..) {
            let s = frobenius_squared(m.transpose() * *m / size(f).powi(2) - DMat3::IDENTITY);
            if s > *stretch * *stretch && s.is_finite() {
                *stretch = s.sqrt();
            }
        }
    }
}

fn raise_distances(distances: &mut [f64], graph: &DualGraph, geodesic: &[f64], m: &[DMat3]) {
    for (e, edge) in graph.edges().iter().enumerate() {
        let [i, j] = edge.faces.map(|f| m[f as usize]);
        let d = frobenius_squared(i - j) / geodesic[e].max(CLOSEST);
        if d > distances[e] && d.is_finite() {
            distances[e] = d;
        }
    }
}

/// How the two terms of Eq. 5 are brought to one scale.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Scale {
    /// Each term over its average, as printed.
    Mean,
    /// Deformation over its average with everything above the 95 % quantile counted as that quantile: a few torn faces
    /// then do not make all other deformation look small.
    Winsorised,
}

/// #E weights of the dual graph, Eq. 5: `δ Geod/avg(Geod) + (1 − δ) Deform/avg(Deform)`. Where nothing deforms the
/// second term is 0.
pub fn edge_weights(geodesic: &[f64], deformation: &[f64], delta: f64, scale: Scale) -> Vec<f64> {
    let ceiling = match scale {
        Scale::Mean => f64::INFINITY,
        Scale::Winsorised => quantile(deformation, 0.95),
    };
    let mean_length = mean(geodesic.iter().copied());
    let mean_deformation = mean(deformation.iter().map(|d| d.min(ceiling)));
    let weight = |(&g, &d): (&f64, &f64)| delta * over(g, mean_length) + (1.0 - delta) * over(d, mean_deformation);
    geodesic.iter().zip(deformation).map(weight).collect()
}

/// #F weights (0 to 1) in the fits of rigid motions: a face that stretches far more than most (across a joint, or torn
/// between two bones) is explained by no rigid motion and shall not decide where one ends.
pub fn rigidity(stretch: &[f64]) -> Vec<f64> {
    let scale = (2.0 * quantile(stretch, 0.5)).max(LEAST_STRETCH);
    stretch.iter().map(|s| 1.0 / (1.0 + (s / scale).powi(2))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn weights_average_to_one_as_printed() {
        let weights = edge_weights(&[1.0, 2.0, 3.0], &[0.0, 5.0, 1.0], 0.15, Scale::Mean);
        assert!((weights.iter().sum::<f64>() / 3.0 - 1.0).abs() < 1e-12);
    }

    #[test]
    fn a_rigid_sequence_has_finite_weights() {
        let weights = edge_weights(&[1.0, 2.0], &[0.0, 0.0], 0.2, Scale::Mean);
        assert!(weights.iter().all(|w| w.is_finite()));
    }
}
