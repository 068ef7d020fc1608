//! Figures that grow and shrink as a whole: taken out before rigid bones are sought, and put back in what follows them.

use super::surface::WeldedSurface;
use glam::{DAffine3, DVec3};

/// A figure within this share of its own size has that size: limbs that bend stretch a little skin.
const STEADY: f64 = 0.02;

/// How many times as large as at rest a surface is in a pose (#N positions in its unit ball): the median over its edges,
/// 1 if that is nearly so.
pub fn growth(surface: &WeldedSurface, pose: &[DVec3]) -> f64 {
    let ratio = |(a, b): (usize, usize)| {
        let rest = surface.positions[a].distance(surface.positions[b]);
        (rest > 0.0).then(|| pose[a].distance(pose[b]) / rest).filter(|ratio| ratio.is_finite())
    };
    let mut ratios: Vec<f64> = surface.links().filter_map(ratio).collect();
    if ratios.is_empty() {
        return 1.0;
    }
    let middle = ratios.len() / 2;
    let size = *ratios.select_nth_unstable_by(middle, f64::total_cmp).1;
    if size > 0.0 && (size - 1.0).abs() > STEADY { size } else { 1.0 }
}

/// A pose at the size of the rest pose.
pub fn shrunk(pose: Vec<DVec3>, growth: f64) -> Vec<DVec3> {
    if growth == 1.0 { pose } else { pose.into_iter().map(|p| p / growth).collect() }
}

/// A map to a pose at the size of the rest pose, as one to the pose itself.
pub fn grown(map: &DAffine3, growth: f64) -> DAffine3 {
    DAffine3 { matrix3: map.matrix3 * growth, translation: map.translation * growth }
}
