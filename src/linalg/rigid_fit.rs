//! The rigid motion that best carries one weighted point set onto another, from moments alone.
//!
//! Berthold K. P. Horn. Closed-form solution of absolute orientation using unit quaternions. Journal of the Optical
//! Society of America A 4(4), 1987. The residual alone needs only the largest root of a quartic: Douglas L.
//! Theobald. Rapid calculation of RMSDs using a quaternion-based characteristic polynomial. Acta Crystallographica
//! A61, 2005.

use super::jacobi;
use super::outer::outer;
use super::polar::frobenius_squared;
use glam::{DMat3, DQuat, DVec3};

/// Sums over weighted pairs of points `p → q`; enough for the best rigid motion of the set, and additive: the moments
/// of a union are the sum of the moments.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moments {
    /// Σ w
    pub weight: f64,
    /// Σ w p
    pub p: DVec3,
    /// Σ w q
    pub q: DVec3,
    /// Σ w q pᵀ
    pub qp: DMat3,
    /// Σ w (|p|² + |q|²)
    pub squares: f64,
}

/// `x ↦ rotation·x + translation`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RigidMotion {
    /// A rotation matrix (det +1).
    pub rotation: DMat3,
    /// In the units of the points.
    pub translation: DVec3,
}

impl RigidMotion {
    /// Where the motion puts `p`.
    pub fn apply(&self, p: DVec3) -> DVec3 {
        self.rotation * p + self.translation
    }
}

impl Default for Moments {
    /// No points. (glam's default matrix is the identity, so this cannot be derived.)
    fn default() -> Self {
        Self { weight: 0.0, p: DVec3::ZERO, q: DVec3::ZERO, qp: DMat3::ZERO, squares: 0.0 }
    }
}

impl Moments {
    /// Adds a pair of weight `w`.
    pub fn add(&mut self, w: f64, p: DVec3, q: DVec3) {
        self.weight += w;
        self.p += w * p;
        self.q += w * q;
        self.qp += outer(q, w * p);
        self.squares += w * (p.length_squared() + q.length_squared());
    }

    /// Adds the pairs of another set.
    pub fn merge(&mut self, other: &Self) {
        self.weight += other.weight;
        self.p += other.p;
        self.q += other.q;
        self.qp += other.qp;
        self.squares += other.squares;
    }

    /// Takes away pairs that were added before.
    pub fn remove(&mut self, other: &Self) {
        self.weight -= other.weight;
        self.p -= other.p;
        self.q -= other.q;
        self.qp -= other.qp;
        self.squares -= other.squares;
    }

    /// Σ w q′ p′ᵀ and Σ w (|p′|² + |q′|²) about the two centroids.
    fn centred(&self) -> (DMat3, f64) {
        if self.weight <= 0.0 {
            return (DMat3::ZERO, 0.0);
        }
        let (p, q) = (self.p / self.weight, self.q);
        let h = self.qp - outer(q, p);
        let squares = self.squares - (self.p.length_squared() + self.q.length_squared()) / self.weight;
        (h, squares.max(0.0))
    }

    /// Σ w |R p + t − q|² of the best rigid motion; never negative.
    pub fn residual(&self) -> f64 {
        let (h, squares) = self.centred();
        (squares - 2.0 * largest_root(h, 0.5 * squares)).max(0.0)
    }

    /// Σ w q′ p′ᵀ about the two centroids: what the best rotation is read from.
    pub fn covariance(&self) -> DMat3 {
        self.centred().0
    }

    /// The best rigid motion; the identity for no points.
    pub fn motion(&self) -> RigidMotion {
        self.motion_with(DMat3::ZERO)
    }

    /// The same with `more` covariance for the rotation, of points elsewhere: a few points, or points on a line, do not
    /// tell how they turn.
    pub fn motion_with(&self, more: DMat3) -> RigidMotion {
        if self.weight <= 0.0 {
            return RigidMotion { rotation: DMat3::IDENTITY, translation: DVec3::ZERO };
        }
        let rotation = best_rotation(self.covariance() + more);
        RigidMotion { rotation, translation: (self.q - rotation * self.p) / self.weight }
    }
}

/// Slope of the quartic, over the cube of the value, below which its largest root counts as double.
const DOUBLE_ROOT: f64 = 1e-4;

/// The largest eigenvalue of Horn's 4×4 matrix, i.e. the largest tr(Rᵀh) over rotations R, by Newton's method from
/// the upper bound `start`, where the quartic is convex, so that it falls monotonically onto the root.
///
/// Few or collinear points make the root double: the slope vanishes with the value and their quotient is noise. The
/// eigenvalue is then found the long way.
fn largest_root(h: DMat3, start: f64) -> f64 {
    let gram = h.transpose() * h;
    let square = frobenius_squared(h);
    let c2 = -2.0 * square;
    let c1 = -8.0 * h.determinant();
    let c0 = 2.0 * frobenius_squared(gram) - square * square;
    let mut x = start;
    for _ in 0..60 {
        let x2 = x * x;
        let slope = (4.0 * x2 + 2.0 * c2) * x + c1;
        if slope <= DOUBLE_ROOT * x2 * x {
            return jacobi::largest_eigenpair(horn(h)).0;
        }
        let step = ((x2 + c2) * x2 + c1 * x + c0) / slope;
        if step <= 1e-15 * start {
            break;
        }
        x -= step;
    }
    x
}

/// Horn's symmetric matrix, whose quadratic form over unit quaternions is tr(Rᵀh).
fn horn(h: DMat3) -> [[f64; 4]; 4] {
    let m = h.transpose().to_cols_array_2d(); // m[i][j] = h(i, j)
    let [[xx, xy, xz], [yx, yy, yz], [zx, zy, zz]] = m;
    [
        [xx + yy + zz, zy - yz, xz - zx, yx - xy],
        [zy - yz, xx - yy - zz, xy + yx, xz + zx],
        [xz - zx, xy + yx, yy - xx - zz, yz + zy],
        [yx - xy, xz + zx, yz + zy, zz - xx - yy],
    ]
}

/// The rotation R that makes tr(Rᵀ h) largest: the best rotation for `h = Σ w q pᵀ` about the centroids. It exists for
/// every matrix; where several are best (rank below two), one of them.
pub fn best_rotation(h: DMat3) -> DMat3 {
    if !h.is_finite() {
        return DMat3::IDENTITY;
    }
    let [w, x, y, z] = jacobi::largest_eigenpair(horn(h)).1;
    let q = DQuat::from_xyzw(x, y, z, w);
    if q.is_finite() && q.length_squared() > 0.5 { DMat3::from_quat(q.normalize()) } else { DMat3::IDENTITY }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn moments(pairs: &[(DVec3, DVec3)]) -> Moments {
        let mut m = Moments::default();
        for &(p, q) in pairs {
            m.add(0.7, p, q);
        }
        m
    }

    fn literal_residual(pairs: &[(DVec3, DVec3)], motion: &RigidMotion) -> f64 {
        pairs.iter().map(|&(p, q)| 0.7 * motion.apply(p).distance_squared(q)).sum()
    }

    fn points() -> impl Strategy<Value = Vec<(DVec3, DVec3)>> {
        let coordinate = || prop::array::uniform3(-1.0..1.0f64).prop_map(DVec3::from_array);
        let pairs = prop::collection::vec((coordinate(), coordinate()), 1..12);
        // Points on a line, or nearly so, have more than one best rotation.
        (pairs, prop_oneof![Just(1.0), Just(0.0), 0.0..0.01]).prop_map(|(mut pairs, thickness)| {
            let flat = DVec3::new(1.0, thickness, thickness);
            pairs.iter_mut().for_each(|(p, q)| (*p, *q) = (*p * flat, *q * flat));
            pairs
        })
    }

    proptest! {
        #[test]
        fn the_residual_from_moments_is_that_of_the_motion(pairs in points()) {
            let m = moments(&pairs);
            prop_assert!((m.residual() - literal_residual(&pairs, &m.motion())).abs() < 1e-10);
        }

        #[test]
        fn no_other_rotation_is_better(pairs in points(), a in -3.0..3.0f64, b in -3.0..3.0f64, c in -3.0..3.0f64) {
            let m = moments(&pairs);
            let rotation = DMat3::from_euler(glam::EulerRot::ZYX, a, b, c);
            let other = RigidMotion { rotation, translation: (m.q - rotation * m.p) / m.weight };
            prop_assert!(m.residual() <= literal_residual(&pairs, &other) + 1e-9);
        }

        #[test]
        fn a_rigid_motion_leaves_nothing(pairs in points(), a in -3.0..3.0f64, b in -3.0..3.0f64) {
            let rotation = DMat3::from_euler(glam::EulerRot::XYZ, a, b, a - b);
            let moved: Vec<_> = pairs.iter().map(|&(p, _)| (p, rotation * p + DVec3::new(a, b, 1.0))).collect();
            prop_assert!(moments(&moved).residual() < 1e-10);
            let motion = moments(&moved).motion();
            for (p, q) in moved {
                prop_assert!(motion.apply(p).distance(q) < 1e-6);
            }
        }

        #[test]
        fn moments_of_a_union_are_sums(first in points(), second in points()) {
            let mut sum = moments(&first);
            sum.merge(&moments(&second));
            let all: Vec<_> = first.iter().chain(&second).copied().collect();
            prop_assert!((sum.residual() - moments(&all).residual()).abs() < 1e-9);
        }
    }
}
