//! A few poses that stand for many.

use glam::DVec3;

/// Up to `most` poses that are far from the reference and from each other, as their numbers in ascending order.
///
/// `reference` is #V points and so is each of `poses`, of which `vertices` are compared. The farthest is taken, in squares,
/// then the farthest from that and the reference, and so on; where there are no more than `most`, all are. Those that are
/// no farther than `least` from what was taken are left out.
pub fn spread(reference: &[DVec3], poses: &[Vec<DVec3>], vertices: &[usize], most: usize, least: f64) -> Vec<usize> {
    if poses.len() <= most {
        return (0..poses.len()).collect();
    }
    let distance = |a: &[DVec3], b: &[DVec3]| vertices.iter().map(|&v| a[v].distance_squared(b[v])).sum::<f64>();
    let mut nearest: Vec<f64> = poses.iter().map(|pose| distance(pose, reference)).collect();
    let mut chosen = Vec::with_capacity(most);
    while chosen.len() < most {
        let farthest = (1..poses.len()).fold(0, |best, t| if nearest[t] > nearest[best] { t } else { best });
        if nearest[farthest] <= least {
            break;
        }
        chosen.push(farthest);
        for (near, pose) in nearest.iter_mut().zip(poses) {
            *near = near.min(distance(pose, &poses[farthest]));
        }
        nearest[farthest] = f64::NEG_INFINITY;
    }
    chosen.sort_unstable();
    chosen
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_most_is_taken_and_of_equals_the_first() {
        let at = |x: f64| vec![DVec3::ZERO, DVec3::X * x];
        let poses: Vec<Vec<DVec3>> = [0.0, 1.0, 5.0, 5.0, 4.0, -3.0].map(at).to_vec();
        let spread = |most, least| spread(&at(0.0), &poses, &[0, 1], most, least);
        assert_eq!(spread(2, 0.0), [2, 5]);
        assert_eq!(spread(5, 0.0), [1, 2, 4, 5]);
        assert_eq!(spread(5, f64::NEG_INFINITY), [0, 1, 2, 4, 5]);
        assert_eq!(spread(6, 0.0), [0, 1, 2, 3, 4, 5]);
    }
}
