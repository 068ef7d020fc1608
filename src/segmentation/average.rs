//! The average deformation gradient of a region (§3.2 step 3): mean rotation times mean stretch.
//!
//! Ken Shoemake, Tom Duff. Matrix animation and polar decomposition. Graphics Interface 1992.

use super::gradients::Gradients;
use crate::linalg::polar::{frobenius_squared, rotation};
use crate::sequence::Pose;
use glam::{DMat3, DVec3};

/// Average gradients of one region, one a pose.
#[derive(Clone, Debug)]
pub struct AverageGradient {
    poses: Vec<DMat3>,
}

impl AverageGradient {
    /// `max_t ‖N − N′‖²_F`.
    pub fn difference(&self, other: &Self) -> f64 {
        self.poses.iter().zip(&other.poses).map(|(a, b)| frobenius_squared(*a - *b)).fold(0.0, f64::max)
    }
}

/// Averages over `region` by area, pose by pose: the rotation nearest to the mean of the faces' rotations, times the
/// mean of their stretches.
pub fn average_gradient(gradients: &Gradients<'_>, areas: &[f64], poses: &[Pose], region: &[u32]) -> AverageGradient {
    let average = |positions: &[DVec3]| {
        let (mut rotations, mut stretches, mut total) = (DMat3::ZERO, DMat3::ZERO, 0.0);
        for &f in region {
            let m = gradients.of(positions, f);
            let r = rotation(m);
            let area = areas[f as usize];
            rotations += r * area;
            stretches += r.transpose() * m * area;
            total += area;
        }
        if total > 0.0 { rotation(rotations) * (stretches * (1.0 / total)) } else { DMat3::IDENTITY }
    };
    AverageGradient { poses: poses.iter().map(|pose| average(&pose.positions)).collect() }
}
