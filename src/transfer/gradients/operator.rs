//! What a deformation does to the faces of a mesh, as a linear function of where its vertices go.
//!
//! Robert W. Sumner, Jovan Popović, *Deformation transfer for triangle meshes*, SIGGRAPH 2004, §3, give each triangle a
//! fourth vertex over its first corner, so that its affine map is known: T = Ṽ V⁻¹. With the fourth vertex along the unit
//! normal n that is T = Σ x̃ᵥ gᵥᵀ + t nᵀ, where gᵥ is the gradient of the hat function of corner v and t, the image of n,
//! says the same as the fourth vertex. Where no other face asks for t, it takes the value that is wanted of it, and what
//! remains of a face is its three corners.

use crate::linalg::outer::outer;
use crate::mesh::face;
use crate::transfer::surface::WeldedSurface;
use glam::{DMat3, DVec3};

/// A face whose height is below this share of its longest edge has no gradient.
const FLAT: f64 = 1e-5;
/// Nor has one whose height is below this share of the radius.
const TINY: f64 = 1e-9;

/// The gradients of a face's three hat functions, and its unit normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Gradient {
    /// For each corner, the gradient of the function that is 1 there and 0 at the others.
    pub corners: [DVec3; 3],
    /// The unit normal.
    pub normal: DVec3,
}

impl Gradient {
    /// Of a triangle in the unit ball; `None` if it has no area to speak of.
    pub fn new([a, b, c]: [DVec3; 3]) -> Option<Self> {
        let double = face::double_area_normal([a, b, c]);
        let longest = (b - a).length().max((c - b).length()).max((a - c).length());
        let height = double.length() / longest;
        let sound = height > FLAT * longest && height > TINY;
        sound.then(|| {
            let area = double.length();
            let normal = double / area;
            Self { corners: [c - b, a - c, b - a].map(|edge| normal.cross(edge) / area), normal }
        })
    }

    /// The affine map's linear part, of where the corners and the normal go.
    pub fn map(&self, corners: [DVec3; 3], normal: DVec3) -> DMat3 {
        let mut map = outer(normal, self.normal);
        for (x, g) in corners.into_iter().zip(self.corners) {
            map += outer(x, g);
        }
        map
    }
}

/// #F gradients of a surface in its reference pose.
pub fn gradients(surface: &WeldedSurface) -> Vec<Option<Gradient>> {
    surface.faces.iter().map(|&f| Gradient::new(face::corners(&surface.positions, f))).collect()
}

/// #F linear parts of the maps from the reference to a pose (#N positions). Across the face it stretches by the root of the
/// area's growth, as the fourth vertex of §3.1 does. `None` for faces without a gradient.
pub fn deformations(surface: &WeldedSurface, gradients: &[Option<Gradient>], pose: &[DVec3]) -> Vec<Option<DMat3>> {
    let of_face = |(&face, gradient): (&[u32; 3], &Option<Gradient>)| {
        let gradient = gradient.as_ref()?;
        let before = face::double_area_normal(face::corners(&surface.positions, face)).length();
        let corners = face::corners(pose, face);
        let after = face::double_area_normal(corners);
        let normal = after.normalize_or_zero() * (after.length() / before).sqrt();
        Some(gradient.map(corners, normal)).filter(DMat3::is_finite)
    };
    surface.faces.iter().zip(gradients).map(of_face).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_affine_map_is_found_again() {
        let corners = [DVec3::new(0.1, 0.2, 0.0), DVec3::new(0.5, 0.1, 0.3), DVec3::new(0.2, 0.6, -0.1)];
        let gradient = Gradient::new(corners).expect("a face with area");
        let map = DMat3::from_cols(DVec3::new(1.0, 0.2, 0.0), DVec3::new(-0.3, 0.9, 0.4), DVec3::new(0.1, 0.0, 1.3));
        let found = gradient.map(corners.map(|c| map * c + DVec3::ONE), map * gradient.normal);
        assert!((found - map).to_cols_array().iter().all(|x| x.abs() < 1e-12));
        assert_eq!(Gradient::new([DVec3::ZERO, DVec3::X, 2.0 * DVec3::X]), None);
        assert_eq!(Gradient::new([DVec3::ONE; 3]), None);
    }
}
