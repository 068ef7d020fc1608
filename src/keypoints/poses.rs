//! A few poses that stand for many.

use super::surface::Surface;

/// Poses that take part in the search; all take part in the errors that are reported.
pub const MOST_POSES: usize = 12;

/// Vertices by which poses are compared.
const COMPARED: usize = 500;

/// Up to [`MOST_POSES`] poses that are far from the reference and from each other, in ascending order.
pub fn spread(surface: &Surface) -> Vec<usize> {
    let count = surface.poses.len();
    if count <= MOST_POSES {
        return (0..count).collect();
    }
    let step = surface.used.len().div_ceil(COMPARED).max(1);
    let compared: Vec<usize> = surface.used.iter().step_by(step).map(|&v| v as usize).collect();
    let distance =
        |a: &[glam::DVec3], b: &[glam::DVec3]| compared.iter().map(|&v| a[v].distance_squared(b[v])).sum::<f64>();
    let mut nearest: Vec<f64> = surface.poses.iter().map(|pose| distance(pose, &surface.reference)).collect();
    let mut chosen = Vec::new();
    while chosen.len() < MOST_POSES {
        let farthest = (1..count).fold(0, |best, t| if nearest[t] > nearest[best] { t } else { best });
        chosen.push(farthest);
        for (near, pose) in nearest.iter_mut().zip(&surface.poses) {
            *near = near.min(distance(pose, &surface.poses[farthest]));
        }
        nearest[farthest] = -1.0;
    }
    chosen.sort_unstable();
    chosen.dedup();
    chosen
}
