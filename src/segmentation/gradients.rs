//! Deformation gradients (Eq. 1–3): the linear map that carries a face of the reference pose onto the same face of
//! another pose, a fourth vertex above the face making it unique.
//!
//! Robert W. Sumner, Jovan Popović. Deformation transfer for triangle meshes. ACM Transactions on Graphics 23(3), 2004.

use crate::mesh::{DualGraph, face};
use glam::{DMat3, DVec3};

/// Area over squared longest side below which a face has no usable frame.
const FLAT: f64 = 1e-10;

/// What every pose needs: the inverse frames of the reference pose.
pub struct Gradients<'a> {
    faces: &'a [[u32; 3]],
    scale: f64,
    inverse: Vec<DMat3>,
    donor: Vec<u32>,
    degenerate: Vec<u32>,
}

impl<'a> Gradients<'a> {
    /// Prepares #F faces over #V reference positions. Lengths are multiplied by `scale`, which keeps their squares in the
    /// range of numbers (1 over the diagonal) and changes no gradient.
    ///
    /// A face without area has no gradient of its own: it takes that of the nearest face (in steps
    /// across edges) that has one, or none (the identity) where there is none on its piece.
    pub fn new(faces: &'a [[u32; 3]], reference: &[DVec3], scale: f64, graph: &DualGraph) -> Self {
        const NONE: u32 = u32::MAX;
        let mut inverse = vec![DMat3::IDENTITY; faces.len()];
        let mut donor = vec![NONE; faces.len()];
        let mut queue = Vec::with_capacity(faces.len());
        let mut degenerate = Vec::new();
        for (f, &corners) in faces.iter().enumerate() {
            let triangle = scaled(face::corners(reference, corners), scale);
            if is_flat(triangle) {
                degenerate.push(f as u32);
            } else {
                inverse[f] = frame(triangle).inverse();
                donor[f] = f as u32;
                queue.push(f as u32);
            }
        }
        if !degenerate.is_empty() {
            let mut next = 0;
            while let Some(&f) = queue.get(next) {
                next += 1;
                for link in graph.neighbours(f) {
                    if donor[link.face as usize] == NONE {
                        donor[link.face as usize] = donor[f as usize];
                        queue.push(link.face);
                    }
                }
            }
        }
        Self { faces, scale, inverse, donor, degenerate }
    }

    /// The faces without area in the reference pose.
    pub fn degenerate(&self) -> &[u32] {
        &self.degenerate
    }

    /// The gradient of one face in the pose with the given #V positions.
    pub fn of(&self, positions: &[DVec3], face: u32) -> DMat3 {
        let donor = self.donor[face as usize];
        match self.faces.get(donor as usize) {
            Some(&corners) => {
                let triangle = scaled(face::corners(positions, corners), self.scale);
                frame(triangle) * self.inverse[donor as usize]
            }
            None => DMat3::IDENTITY,
        }
    }

    /// #F gradients of the pose with the given #V positions.
    pub fn all(&self, positions: &[DVec3]) -> Vec<DMat3> {
        (0..self.faces.len() as u32).map(|f| self.of(positions, f)).collect()
    }
}

fn scaled(triangle: [DVec3; 3], scale: f64) -> [DVec3; 3] {
    triangle.map(|p| p * scale)
}

fn is_flat([a, b, c]: [DVec3; 3]) -> bool {
    let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
    // Written so that NaN counts as flat.
    !(face::double_area_normal([a, b, c]).length() > FLAT * longest && longest > f64::MIN_POSITIVE)
}

/// `[v2 − v1, v3 − v1, v4 − v1]` with v4 of Eq. 1.
fn frame([a, b, c]: [DVec3; 3]) -> DMat3 {
    let n = face::double_area_normal([a, b, c]);
    let up = n / n.length().sqrt();
    DMat3::from_cols(b - a, c - a, if up.is_finite() { up } else { DVec3::ZERO })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::linalg::polar::frobenius;

    fn tent() -> (Vec<[u32; 3]>, Vec<DVec3>) {
        let positions = vec![
            DVec3::new(0.0, 0.0, 0.0),
            DVec3::new(1.0, 0.1, 0.0),
            DVec3::new(0.3, 0.9, 0.2),
            DVec3::new(1.2, 1.1, -0.4),
            DVec3::new(1.0, 0.1, 0.0),
        ];
        (vec![[0, 1, 2], [1, 3, 2], [1, 4, 2]], positions)
    }

    #[test]
    fn a_rotation_is_its_own_gradient_and_a_flat_face_borrows_it() {
        let (faces, reference) = tent();
        let graph = DualGraph::new(&faces);
        let gradients = Gradients::new(&faces, &reference, 1.0, &graph);
        assert_eq!(gradients.degenerate(), [2]);
        let turn = DMat3::from_euler(glam::EulerRot::XYZ, 0.4, -1.0, 2.0);
        let moved: Vec<_> = reference.iter().map(|&p| turn * p + DVec3::ONE).collect();
        for m in gradients.all(&moved) {
            assert!(frobenius(m - turn) < 1e-12);
        }
    }

    #[test]
    fn a_uniform_scale_scales_all_three_directions() {
        let (faces, reference) = tent();
        let gradients = Gradients::new(&faces, &reference, 0.1, &DualGraph::new(&faces));
        let moved: Vec<_> = reference.iter().map(|&p| 3.0 * p).collect();
        assert!(frobenius(gradients.of(&moved, 0) - DMat3::from_diagonal(DVec3::splat(3.0))) < 1e-12);
    }
}
