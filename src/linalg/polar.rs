//! Polar decomposition of 3×3 matrices.
//!
//! Nicholas J. Higham. Computing the polar decomposition — with applications. SIAM Journal on Scientific and
//! Statistical Computing 7(4), 1986.

use glam::DMat3;

/// The rotation nearest to `m` (det +1); where several are nearest, one of them. The identity for what is not finite.
///
/// Higham's Newton iteration for well-conditioned matrices of positive determinant; every other input (mirrored,
/// flat, zero) goes through a symmetric eigenproblem ([`super::rigid_fit::best_rotation`]), which always answers.
pub fn rotation(m: DMat3) -> DMat3 {
    newton(m).unwrap_or_else(|| super::rigid_fit::best_rotation(m))
}

fn newton(m: DMat3) -> Option<DMat3> {
    let size = frobenius(m);
    // A flat or mirrored matrix has no unique nearest rotation along this path.
    if !size.is_finite() || m.determinant() <= 1e-9 * size * size * size {
        return None;
    }
    let mut x = m;
    for _ in 0..20 {
        let inverse = x.inverse().transpose();
        // Scaling makes the first steps quadratic, too.
        let scale = (frobenius(inverse) / frobenius(x)).sqrt();
        let next = (x * scale + inverse * (1.0 / scale)) * 0.5;
        let change = frobenius(next - x);
        x = next;
        if change < 1e-13 {
            return Some(x);
        }
    }
    None
}

/// The cosine of the angle by which a rotation turns.
pub fn cosine(rotation: DMat3) -> f64 {
    0.5 * (rotation.x_axis.x + rotation.y_axis.y + rotation.z_axis.z - 1.0)
}

/// The angle by which a rotation turns, in radians.
pub fn angle(rotation: DMat3) -> f64 {
    cosine(rotation).clamp(-1.0, 1.0).acos()
}

/// Square root of the sum of squared entries.
pub fn frobenius(m: DMat3) -> f64 {
    frobenius_squared(m).sqrt()
}

/// Sum of squared entries.
pub fn frobenius_squared(m: DMat3) -> f64 {
    m.x_axis.length_squared() + m.y_axis.length_squared() + m.z_axis.length_squared()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DQuat, DVec3};
    use proptest::prelude::*;

    fn is_rotation(r: DMat3) -> bool {
        frobenius(r * r.transpose() - DMat3::IDENTITY) < 1e-10 && (r.determinant() - 1.0).abs() < 1e-10
    }

    #[test]
    fn flat_mirrored_and_zero_matrices_still_have_a_rotation() {
        let flat = DMat3::from_diagonal(DVec3::new(2.0, 1.0, 0.0));
        let line = DMat3::from_diagonal(DVec3::new(2.0, 0.0, 0.0));
        let mirrored = DMat3::from_diagonal(DVec3::new(1.0, 1.0, -1.0));
        for m in [flat, line, mirrored, DMat3::ZERO] {
            assert!(is_rotation(rotation(m)), "{m}");
        }
        assert!(frobenius(rotation(flat) - DMat3::IDENTITY) < 1e-10);
    }

    proptest! {
        #[test]
        fn recovers_the_rotation_of_a_stretched_rotation(
            axis in prop::array::uniform3(-1.0..1.0f64), angle in -3.0..3.0f64,
            stretch in prop::array::uniform3(0.05..5.0f64), frame in prop::array::uniform3(-3.0..3.0f64),
        ) {
            let axis = DVec3::from_array(axis);
            prop_assume!(axis.length() > 0.1);
            let r = DMat3::from_quat(DQuat::from_axis_angle(axis.normalize(), angle));
            let basis = DMat3::from_euler(glam::EulerRot::XYZ, frame[0], frame[1], frame[2]);
            let s = basis * DMat3::from_diagonal(DVec3::from_array(stretch)) * basis.transpose();
            let found = rotation(r * s);
            prop_assert!(frobenius(found - r) < 1e-9);
        }
    }
}
