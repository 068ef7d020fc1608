//! The number of parts, from the costs of the merge tree (beyond the paper).
//!
//! Three questions, asked of the squared residual that is left with 1, 2, 3 … parts:
//! how many parts explain nearly all of the motion; do so many pay, or does the mesh bend so softly that more parts only
//! dice it finer; and does joining two more parts suddenly cost much more, as when a joint of a skeleton is lost?

use super::Merge;
use super::finest::RIGID;

/// As many parts as leave this share of the non-rigid motion (squared) unexplained are enough.
const UNEXPLAINED: f64 = 0.003;

/// Splitting a body that bends evenly into K parts lowers its squared residual at least like 1 / K to this power; parts
/// that do no better than that are not worth having.
const POWER: f64 = 1.2;

/// More parts than this are nobody's first look at a mesh that bends everywhere.
const MOST: usize = 24;

/// Parts have at least so many faces on average, as far as the mesh is in one piece: the centroid of a single face moves
/// rigidly whatever the face does, so that tiny parts explain everything and say nothing.
const FACES_OF_A_PART: usize = 4;

/// A joint is where one more merge costs so many times as much as the next cheaper one (squared residuals): a clear one
/// anywhere up to [`MOST_JOINTS`] parts, or up to as many as there are pieces, a fair one only a little beyond the number
/// that is enough.
const CLEAR_JOINT: f64 = 16.0;
const FAIR_JOINT: f64 = 2.5;
const MOST_JOINTS: usize = 80;
const LITTLE_BEYOND: f64 = 1.75;

/// The number of parts at which the merge tree is best cut.
///
/// `base` is the summed squared residual of the finest parts at unit diagonal, over so many `faces` and `poses`, the mesh
/// being in so many connected `pieces`.
pub fn number_of_parts(merges: &[Merge], base: f64, [faces, poses, pieces]: [usize; 3]) -> usize {
    let visible = RIGID * RIGID * (faces * poses) as f64;
    let most = (faces / FACES_OF_A_PART).max(pieces).max(1);
    let enough = enough_parts(&residuals(merges, base), visible, most.min(MOST));
    // Where the finest parts are the pieces, what they leave is what the first merge is compared with.
    let left = (merges.len() < pieces).then_some(base);
    // costs[k − 1] is the cost of merging from k + 1 to k parts.
    let costs: Vec<f64> = merges.iter().rev().map(|m| m.cost).chain(left).collect();
    let jump = |parts: usize| match costs.get(parts - 1) {
        Some(&next) if parts > 1 && costs[parts - 2] > visible => costs[parts - 2] / next.max(0.01 * visible),
        _ => 0.0,
    };
    let clear = (enough + 1..=most.min(MOST_JOINTS.max(pieces))).rev().find(|&k| jump(k) >= CLEAR_JOINT);
    let beyond = most.min((LITTLE_BEYOND * enough as f64) as usize);
    let fair = || {
        (enough + 1..=beyond)
            .filter(|&k| jump(k) >= FAIR_JOINT)
            .reduce(|best, k| if jump(k) > jump(best) { k } else { best })
    };
    clear.or_else(fair).unwrap_or(enough)
}

/// Among the numbers of parts up to `most` that leave something to explain, the one with the least `residual · K^1.2`.
fn enough_parts(residuals: &[f64], visible: f64, most: usize) -> usize {
    let Some(&whole) = residuals.first() else { return 1 };
    let enough = (UNEXPLAINED * whole).max(visible);
    let last = residuals.iter().position(|&r| r <= enough).unwrap_or(residuals.len() - 1).min(most - 1);
    let price = |i: usize| residuals[i] * ((i + 1) as f64).powf(POWER);
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

#[cfg(test)]
mod tests {
    use super::*;

    /// Faces, poses and pieces of a mesh.
    const BIG: [usize; 3] = [1000, 1, 1];

    /// Merges with the given rms costs (at unit diagonal, over a thousand samples), the last to go first.
    fn tree(costs: &[f64]) -> Vec<Merge> {
        costs.iter().rev().map(|c| Merge { from: 1, into: 0, cost: 1000.0 * c * c }).collect()
    }

    #[test]
    fn a_few_faces_are_not_a_part_each() {
        let merges = tree(&[0.1, 0.09, 0.08, 0.07, 0.06, 0.05, 0.04]);
        assert!(number_of_parts(&merges, 0.0, [8, 1000, 1]) <= 2);
        assert_eq!(number_of_parts(&merges, 0.0, [8, 1000, 8]), 8, "eight cards fly on their own");
        let shards = tree(&[0.1; 299]);
        assert_eq!(number_of_parts(&shards, 0.0, [3600, 1, 300]), 300, "and so do all the pieces of what burst");
    }

    #[test]
    fn joints_are_found_however_little_hangs_on_the_last() {
        // Five parts; the fifth moves a hundredth as far as the others.
        assert_eq!(number_of_parts(&tree(&[0.1, 0.09, 0.08, 0.001, 1e-7, 1e-8]), 1e-16, BIG), 5);
    }

    #[test]
    fn soft_bending_is_not_diced() {
        let mut costs = vec![0.1, 0.055, 0.044];
        costs.extend((0..60).map(|i| 0.01 * 0.96f64.powi(i)));
        assert_eq!(number_of_parts(&tree(&costs), 1e-5, BIG), 4);
    }

    #[test]
    fn what_moves_as_one_is_one() {
        assert_eq!(number_of_parts(&tree(&[1e-6, 1e-9, 1e-12]), 0.0, BIG), 1);
        assert_eq!(number_of_parts(&[], 0.0, [0, 0, 0]), 1);
    }
}
