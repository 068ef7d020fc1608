//! Conjugate gradients with a diagonal preconditioner, for symmetric positive definite operators given as a function.

/// Solves `A x = b` from the start value in `x` until the preconditioned residual has fallen below `tolerance` times
/// that of `b`, or for at most `rounds` iterations. `apply(x, y)` writes `A x` into `y`; `diagonal` is A's (positive).
///
/// Returns the number of iterations.
pub fn solve(
    mut apply: impl FnMut(&[f64], &mut [f64]),
    diagonal: &[f64],
    b: &[f64],
    x: &mut [f64],
    tolerance: f64,
    rounds: usize,
) -> usize {
    let n = b.len();
    let mut product = vec![0.0; n];
    apply(x, &mut product);
    let mut r: Vec<f64> = (0..n).map(|i| b[i] - product[i]).collect();
    let goal = tolerance * tolerance * (0..n).map(|i| b[i] * b[i] / diagonal[i]).sum::<f64>();
    let mut z: Vec<f64> = (0..n).map(|i| r[i] / diagonal[i]).collect();
    let mut p = z.clone();
    let mut rz = dot(&r, &z);
    for round in 0..rounds {
        if rz <= goal {
            return round;
        }
        apply(&p, &mut product);
        let step = rz / dot(&p, &product);
        if !step.is_finite() {
            return round;
        }
        for i in 0..n {
            x[i] += step * p[i];
            r[i] -= step * product[i];
            z[i] = r[i] / diagonal[i];
        }
        let next = dot(&r, &z);
        let turn = next / rz;
        rz = next;
        for i in 0..n {
            p[i] = z[i] + turn * p[i];
        }
    }
    rounds
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| x * y).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_chain_of_springs_hangs_straight() {
        // −x[i−1] + 2 x[i] − x[i+1] = 0 with ends held at 0 and 1.
        let n = 50;
        let apply = |x: &[f64], y: &mut [f64]| {
            for i in 0..n {
                let left = if i > 0 { x[i - 1] } else { 0.0 };
                let right = if i + 1 < n { x[i + 1] } else { 0.0 };
                y[i] = 2.0 * x[i] - left - right;
            }
        };
        let mut b = vec![0.0; n];
        b[n - 1] = 1.0;
        let mut x = vec![0.0; n];
        let rounds = solve(apply, &vec![2.0; n], &b, &mut x, 1e-12, 500);
        assert!(rounds <= n + 1);
        for (i, value) in x.iter().enumerate() {
            assert!((value - (i + 1) as f64 / (n + 1) as f64).abs() < 1e-9);
        }
    }
}
