//! The distance metric (Eq. 4 and 5): how differently two neighbouring faces deform, and how far apart they are.

use super::gradients::Gradients;
use crate::linalg::polar::frobenius_squared;
use crate::mesh::DualGraph;
use glam::DVec3;

/// Centroids closer than this (at unit diagonal) count as this far apart, so that Eq. 4 stays finite.
const CLOSEST: f64 = 1e-6;

/// Adds one pose to the #E deformation distances of Eq. 4, `max_t ‖Mᵢ − Mⱼ‖²_F / Geod`, with lengths at unit diagonal.
pub fn raise_by_pose(
    distances: &mut [f64],
    gradients: &Gradients<'_>,
    graph: &DualGraph,
    geodesic: &[f64],
    positions: &[DVec3],
) {
    let m = gradients.all(positions);
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
    let over = |x: f64, mean: f64| if mean > 0.0 { x / mean } else { 0.0 };
    let mean_length = mean(geodesic.iter().copied());
    let mean_deformation = mean(deformation.iter().map(|d| d.min(ceiling)));
    let weight = |(&g, &d): (&f64, &f64)| delta * over(g, mean_length) + (1.0 - delta) * over(d, mean_deformation);
    geodesic.iter().zip(deformation).map(weight).collect()
}

/// The value below which the share `q` (0 to 1) of the values lies; 0 for none.
pub fn quantile(values: &[f64], q: f64) -> f64 {
    if values.is_empty() {
        return 0.0;
    }
    let mut sorted = values.to_vec();
    let rank = ((sorted.len() - 1) as f64 * q).round() as usize;
    *sorted.select_nth_unstable_by(rank, f64::total_cmp).1
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let n = values.len();
    if n == 0 { 0.0 } else { values.sum::<f64>() / n as f64 }
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

    #[test]
    fn quantiles_are_order_statistics() {
        assert_eq!(quantile(&[3.0, 1.0, 2.0], 0.5), 2.0);
        assert_eq!(quantile(&[3.0, 1.0, 2.0], 1.0), 3.0);
        assert_eq!(quantile(&[], 0.5), 0.0);
    }
}
