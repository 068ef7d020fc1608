//! Few joints a vertex.
//!
//! A vertex follows all handles, but players let it follow four joints (or eight). Which ones, and with what
//! weights, is chosen so that the vertex stays where it was: with y the places to which the joints of the choice alone
//! bring the vertex, less the place where it belongs, the squared error of weights w over all poses is w'Gw with
//! G = Σ y·y', to be made least where Σw = 1 and w ≥ 0. A little of the distance to the given weights is added, so that
//! neighbours with equal errors do not choose differently.

use glam::{DAffine3, DVec3};

/// Joints that are considered for a vertex: those with the largest weights.
const CANDIDATES: usize = 16;
/// How much the distance to the given weights counts, as a length over the diagonal: small against what is seen.
const HOLD: f64 = 1e-3;
/// Rounds of exchanging a joint for a better one.
const ROUNDS: usize = 4;

/// The joints of a vertex with their weights, largest first; weights that are left over are 0, of joint 0.
pub type Joints = Vec<(u16, f32)>;

/// At most `count` of the handles for a vertex at `x` with the given weights, one a handle, which sum to 1.
/// `maps` is pose × handle.
pub fn choose(x: DVec3, weights: &[f64], maps: &[&[DAffine3]], diagonal: f64, count: usize) -> Joints {
    let mut candidates: Vec<usize> = (0..weights.len()).filter(|&h| weights[h] > 1e-9).collect();
    candidates.sort_by(|&a, &b| weights[b].total_cmp(&weights[a]).then(a.cmp(&b)));
    if candidates.len() <= count {
        return rounded(candidates.iter().map(|&h| (h, weights[h])).collect(), count);
    }
    candidates.truncate(CANDIDATES);
    let held = maps.len().max(1) as f64 * (HOLD * diagonal.max(1e-300)).powi(2);
    let form = Form::new(x, weights, &candidates, maps, held);
    let mut chosen: Vec<usize> = (0..count).collect();
    let mut best = form.solve(&chosen);
    for _ in 0..ROUNDS {
        let Some(better) = exchange(&form, &chosen, &best) else { break };
        (chosen, best) = better;
    }
    rounded(chosen.iter().zip(best.weights).map(|(&c, w)| (candidates[c], w)).collect(), count)
}

/// The best exchange of one of the two least joints for one that was left out.
fn exchange(form: &Form, chosen: &[usize], best: &Solved) -> Option<(Vec<usize>, Solved)> {
    let mut least: Vec<usize> = (0..chosen.len()).collect();
    least.sort_by(|&a, &b| best.weights[a].total_cmp(&best.weights[b]).then(a.cmp(&b)));
    let mut found: Option<(Vec<usize>, Solved)> = None;
    for &out in least.iter().take(2) {
        for other in (0..form.count).filter(|c| !chosen.contains(c)) {
            let mut tried = chosen.to_vec();
            tried[out] = other;
            let solved = form.solve(&tried);
            if solved.error < (1.0 - 1e-6) * found.as_ref().map_or(best.error, |(_, s)| s.error) {
                found = Some((tried, solved));
            }
        }
    }
    found
}

/// As 32-bit floats that sum to 1.
fn rounded(mut joints: Vec<(usize, f64)>, count: usize) -> Joints {
    joints.retain(|joint| joint.1 > 1e-6);
    joints.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    let sum: f64 = joints.iter().map(|joint| joint.1).sum();
    let mut joints: Joints = joints.iter().map(|&(h, w)| (h as u16, (w / sum) as f32)).collect();
    let others: f64 = joints.iter().skip(1).map(|joint| f64::from(joint.1)).sum();
    match joints.first_mut() {
        Some(first) => first.1 = (1.0 - others) as f32,
        None => joints.push((0, 1.0)),
    }
    joints.resize(count, (0, 0.0));
    joints
}

/// The squared error over all poses as a quadratic form in the weights of the candidates.
struct Form {
    count: usize,
    /// `count` × `count`, positive definite.
    matrix: Vec<f64>,
}

/// Weights of chosen candidates, and their error (with a constant added).
struct Solved {
    weights: Vec<f64>,
    error: f64,
}

impl Form {
    fn new(x: DVec3, weights: &[f64], candidates: &[usize], maps: &[&[DAffine3]], held: f64) -> Self {
        let count = candidates.len();
        let mut matrix = vec![0.0; count * count];
        let mut y = vec![DVec3::ZERO; count];
        for pose in maps {
            let place: DVec3 = weights.iter().zip(*pose).map(|(&w, map)| w * map.transform_point3(x)).sum();
            for (y, &h) in y.iter_mut().zip(candidates) {
                *y = pose[h].transform_point3(x) - place;
            }
            for i in 0..count {
                for j in 0..=i {
                    matrix[i * count + j] += y[i].dot(y[j]);
                }
            }
        }
        // held · |w − given|², written as a form where Σw = 1; the last 1 changes only the constant.
        let square: f64 = weights.iter().map(|w| w * w).sum();
        for i in 0..count {
            for j in 0..=i {
                let own = if i == j { 1.0 } else { 0.0 };
                matrix[i * count + j] += held * (own - weights[candidates[i]] - weights[candidates[j]] + square + 1.0);
                matrix[j * count + i] = matrix[i * count + j];
            }
        }
        Self { count, matrix }
    }

    /// The best weights of the chosen candidates; where some would be negative, the most negative one goes first.
    fn solve(&self, chosen: &[usize]) -> Solved {
        let mut active: Vec<usize> = (0..chosen.len()).collect();
        loop {
            let part: Vec<usize> = active.iter().map(|&a| chosen[a]).collect();
            let solution = self.ones(&part);
            let sum: f64 = solution.iter().sum();
            let lowest = (0..active.len()).min_by(|&a, &b| solution[a].total_cmp(&solution[b]));
            match lowest {
                Some(lowest) if active.len() > 1 && !(solution[lowest] >= 0.0 && sum > 0.0) => {
                    active.remove(lowest);
                }
                _ => {
                    let mut weights = vec![0.0; chosen.len()];
                    for (&a, w) in active.iter().zip(&solution) {
                        weights[a] = if active.len() == 1 { 1.0 } else { w / sum };
                    }
                    return Solved { weights, error: 1.0 / sum };
                }
            }
        }
    }

    /// Solves G w = 1 for part of the candidates, by elimination (G is positive definite).
    fn ones(&self, part: &[usize]) -> Vec<f64> {
        let n = part.len();
        let mut rows: Vec<f64> = part
            .iter()
            .flat_map(|&i| part.iter().map(move |&j| self.matrix[i * self.count + j]).chain([1.0]))
            .collect();
        let width = n + 1;
        for k in 0..n {
            for i in k + 1..n {
                let factor = rows[i * width + k] / rows[k * width + k];
                for j in k..width {
                    rows[i * width + j] -= factor * rows[k * width + j];
                }
            }
        }
        let mut solution = vec![0.0; n];
        for i in (0..n).rev() {
            let known: f64 = (i + 1..n).map(|j| rows[i * width + j] * solution[j]).sum();
            solution[i] = (rows[i * width + n] - known) / rows[i * width + i];
        }
        solution
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DQuat;
    use proptest::prelude::*;

    fn error(x: DVec3, weights: &[f64], maps: &[&[DAffine3]], joints: &Joints) -> f64 {
        let squares = maps.iter().map(|pose| {
            let place: DVec3 = weights.iter().zip(*pose).map(|(&w, map)| w * map.transform_point3(x)).sum();
            let shown: DVec3 =
                joints.iter().map(|&(h, w)| f64::from(w) * pose[usize::from(h)].transform_point3(x)).sum();
            place.distance_squared(shown)
        });
        squares.sum()
    }

    fn cut_short(weights: &[f64], count: usize) -> Joints {
        let mut order: Vec<(usize, f64)> = weights.iter().copied().enumerate().collect();
        order.sort_by(|a, b| b.1.total_cmp(&a.1));
        order.truncate(count);
        rounded(order, count)
    }

    proptest! {
        #[test]
        fn is_no_worse_than_leaving_out_the_smallest(
            raw in prop::collection::vec(0.0..1.0f64, 5..20), seed in prop::array::uniform3(-1.0..1.0f64), power in 1..6,
        ) {
            let sum: f64 = raw.iter().map(|w| w.powi(power)).sum();
            let weights: Vec<f64> = raw.iter().map(|w| w.powi(power) / sum).collect();
            let poses: Vec<Vec<DAffine3>> = (0..3).map(|p| (0..weights.len()).map(|h| {
                let angle = seed[0] * (p * 7 + h) as f64;
                let turn = DQuat::from_euler(glam::EulerRot::XYZ, angle.sin(), (seed[1] * angle).cos(), 0.3 * angle.cos());
                DAffine3::from_rotation_translation(turn, DVec3::new(angle.cos(), seed[2], angle.sin()))
            }).collect()).collect();
            let maps: Vec<&[DAffine3]> = poses.iter().map(Vec::as_slice).collect();
            let x = DVec3::new(0.4, 0.1, -0.3);
            for count in [4, 8] {
                let joints = choose(x, &weights, &maps, 1.0, count);
                prop_assert_eq!(joints.len(), count);
                prop_assert!(joints.iter().all(|j| j.1 >= 0.0 && usize::from(j.0) < weights.len()));
                let total: f64 = joints.iter().map(|j| f64::from(j.1)).sum();
                prop_assert!((total - 1.0).abs() < 1e-6);
                let (here, there) = (error(x, &weights, &maps, &joints), error(x, &weights, &maps, &cut_short(&weights, count)));
                // Up to what the distance to the given weights is allowed to cost.
                prop_assert!(here <= there + 3.0 * HOLD * HOLD, "{here} against {there}");
            }
        }
    }

    #[test]
    fn few_weights_are_kept_as_they_are() {
        let weights = [0.0, 0.25, 0.0, 0.125, 0.5, 0.0, 0.125];
        let pose = vec![DAffine3::IDENTITY; 7];
        let joints = choose(DVec3::X, &weights, &[&pose], 1.0, 4);
        assert_eq!(joints, [(4, 0.5), (1, 0.25), (3, 0.125), (6, 0.125)]);
        let joints = choose(DVec3::X, &[0.0, 1.0], &[], 1.0, 4);
        assert_eq!(joints, [(1, 1.0), (0, 0.0), (0, 0.0), (0, 0.0)]);
    }
}
