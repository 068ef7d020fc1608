//! The number of parts, from the costs of the merge tree.

use super::Merge;
use super::finest::RIGID;

/// As many parts as explain this share of the non-rigid motion are always enough.
const EXPLAINED: f64 = 0.9935;

/// Splitting a body that bends evenly into K parts lowers its squared residual about like 1 / K to this power; parts
/// that do no better than that are not worth having.
const POWER: f64 = 1.2;

/// More parts than this are nobody's first look at a mesh, even at one that deforms everywhere.
const MOST: usize = 24;

/// The number of parts at which the merge tree is best cut: among the numbers that leave something of the motion to
/// explain, the one with the least `residual · K^1.2`.
///
/// `base` is the summed squared residual of the finest parts, `samples` the number of squares in it (faces × poses).
pub fn number_of_parts(merges: &[Merge], base: f64, samples: usize) -> usize {
    let curve = residuals(merges, base);
    let Some(&whole) = curve.first() else { return 1 };
    let rigid = RIGID * RIGID * samples as f64;
    let enough = ((1.0 - EXPLAINED) * whole).max(rigid);
    let last = curve.iter().position(|&r| r <= enough).unwrap_or(curve.len() - 1).min(MOST - 1);
    let price = |i: usize| curve[i] * ((i + 1) as f64).powf(POWER);
    1 + (0..=last).fold(0, |best, i| if price(i) < price(best) { i } else { best })
}

/// Summed squared residuals with 1, 2, 3 … parts.
fn residuals(merges: &[Merge], base: f64) -> Vec<f64> {
    let mut sum = base;
    let mut curve: Vec<f64> = vec![base];
    for merge in merges {
        sum += merge.cost;
        curve.push(sum);
    }
    curve.reverse();
    curve
}
