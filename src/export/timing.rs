//! When the poses of an animation are shown.

use glam::DVec3;

/// Seconds between poses whose own times cannot be used.
pub const STEP: f32 = 1.0 / 12.0;

/// The times of the poses from 0 on, if they rise; else evenly spaced ones.
pub fn from_zero(times: impl Iterator<Item = f64> + Clone) -> Vec<f32> {
    let first = times.clone().next().unwrap_or(0.0);
    let times: Vec<f32> = times.map(|time| (time - first) as f32).collect();
    let rise = times.windows(2).all(|pair| pair[0] < pair[1]) && times.iter().all(|t| t.is_finite());
    if rise { times } else { (0..times.len()).map(|i| i as f32 * STEP).collect() }
}

/// A last pose that is no farther from the first than this, in shares of the longest step, is the first again.
const AGAIN: f64 = 1e-2;

/// Whether the step from the last of the poses to the first is no longer than the others (and not none), so that the
/// motion is a loop. `step(a, b)` is how far apart poses `a` and `b` are.
pub fn closes(poses: usize, step: impl Fn(usize, usize) -> f64) -> bool {
    if poses < 3 {
        return false;
    }
    let longest = (1..poses).map(|pose| step(pose - 1, pose)).fold(0.0, f64::max);
    let back = step(poses - 1, 0);
    back > AGAIN * longest && back <= 1.5 * longest
}

/// How far apart two poses are: the sum over their points.
pub fn step(a: &[DVec3], b: &[DVec3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).sum()
}

/// Adds the time of one more key, which shows the first pose again.
pub fn close(times: &mut Vec<f32>) {
    if let [first, .., last] = times[..] {
        times.push(last + (last - first) / (times.len() - 1) as f32);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loop_is_closed_once() {
        let around = |i: usize, of: usize| (i as f64 / of as f64 * std::f64::consts::TAU).sin_cos();
        let apart = |(a, b): (f64, f64), (c, d): (f64, f64)| (a - c).hypot(b - d);
        assert!(closes(8, |a, b| apart(around(a, 8), around(b, 8))), "once around, the first not shown again");
        assert!(!closes(9, |a, b| apart(around(a, 8), around(b, 8)) + 1e-3), "nearly the first again");
        assert!(!closes(8, |a, b| a.abs_diff(b) as f64), "there, not back");
    }
}
