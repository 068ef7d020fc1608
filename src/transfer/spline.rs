//! A smooth displacement of space that takes given points where they belong.
//!
//! The biharmonic spline of space: a constant and one kernel |x − xₖ| a point. J. Duchon, *Splines minimizing
//! rotation-invariant semi-norms in Sobolev spaces*, 1977.

use glam::DVec3;
use nalgebra::DMatrix;

/// Added on the diagonal, in lengths.
const RIDGE: f64 = 1e-3;
/// The same where displacements are not exact.
const LOOSE: f64 = 0.1;
/// Points that take part: the system is dense.
const MOST: usize = 500;

/// Displacements known at some points, and between them.
pub struct Spline {
    points: Vec<DVec3>,
    kernels: Vec<DVec3>,
    constant: DVec3,
}

impl Spline {
    /// Interpolates displacements at points that differ; near repetitions are met in the mean. Of more than 500 points
    /// some are met, evenly.
    pub fn new(known: &[(DVec3, DVec3)]) -> Self {
        Self::with_ridge(known, RIDGE)
    }

    /// Smooths over displacements that are not exact.
    pub fn loose(known: &[(DVec3, DVec3)]) -> Self {
        Self::with_ridge(known, LOOSE)
    }

    fn with_ridge(known: &[(DVec3, DVec3)], ridge: f64) -> Self {
        let known: Vec<&(DVec3, DVec3)> = known.iter().step_by(known.len().div_ceil(MOST).max(1)).collect();
        let n = known.len();
        let points: Vec<DVec3> = known.iter().map(|k| k.0).collect();
        let constant = known.iter().map(|k| k.1).sum::<DVec3>() / n.max(1) as f64;
        let mut system = DMatrix::zeros(n + 1, n + 1);
        let mut side = DMatrix::zeros(n + 1, 3);
        for i in 0..n {
            for j in 0..n {
                system[(i, j)] = -points[i].distance(points[j]);
            }
            // −|x| is positive definite over kernels that sum to zero; more on the diagonal lets displacements of points
            // that nearly coincide differ without large kernels.
            system[(i, i)] = ridge;
            system[(i, n)] = 1.0;
            system[(n, i)] = 1.0;
            (0..3).for_each(|k| side[(i, k)] = known[i].1[k]);
        }
        let row = |m: &DMatrix<f64>, i: usize| DVec3::new(m[(i, 0)], m[(i, 1)], m[(i, 2)]);
        match system.lu().solve(&side) {
            Some(solved) if solved.iter().all(|x| x.is_finite()) => {
                Self { points, kernels: (0..n).map(|i| row(&solved, i)).collect(), constant: row(&solved, n) }
            }
            _ => Self { points: Vec::new(), kernels: Vec::new(), constant },
        }
    }

    /// The displacement at a point.
    pub fn at(&self, x: DVec3) -> DVec3 {
        self.constant - self.points.iter().zip(&self.kernels).map(|(p, k)| *k * p.distance(x)).sum::<DVec3>()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nearly_meets_what_is_known_and_keeps_what_is_common() {
        let known = [
            (DVec3::ZERO, DVec3::X),
            (DVec3::X, DVec3::Y),
            (DVec3::Y, DVec3::new(0.3, 0.2, 0.1)),
            (DVec3::Z, DVec3::ZERO),
        ];
        let spline = Spline::new(&known);
        for (p, d) in known {
            assert!(spline.at(p).distance(d) < 5e-3, "{p} {}", spline.at(p));
        }
        let common = Spline::new(&known.map(|k| (k.0, DVec3::ONE)));
        assert!(common.at(DVec3::new(0.4, -0.8, 0.2)).distance(DVec3::ONE) < 1e-9);
        assert_eq!(Spline::new(&[(DVec3::ONE, DVec3::X)]).at(DVec3::ZERO), DVec3::X);
        assert!(Spline::new(&[(DVec3::ONE, DVec3::X), (DVec3::ONE, DVec3::Y)]).at(DVec3::X).is_finite());
        assert_eq!(Spline::new(&[]).at(DVec3::ONE), DVec3::ZERO);
    }
}
