//! The mesh as the weights see it: vertices at one place made one, in pieces, at unit size.

use super::rings::Rings;
use super::{WeightsError, dissection};
use crate::mesh::ball::unit_ball;
use crate::mesh::{face, weld};
use glam::DVec3;

/// How far apart, in radii of the mesh, vertices along a seam may lie.
const WELD_TOLERANCE: f64 = 1e-9;

/// A mesh of welded vertices; those without a face are in it as pieces of their own.
#[derive(Debug)]
pub struct Surface {
    /// For each given vertex, its place among the welded ones.
    pub welded: Vec<u32>,
    /// Positions of the welded vertices, about the centre of the mesh, in (powers of two close to) its radius.
    pub positions: Vec<DVec3>,
    /// Faces of the welded vertices, none of which names a vertex twice.
    pub faces: Vec<[u32; 3]>,
    /// The neighbours of the welded vertices.
    pub rings: Rings,
    /// The piece of each welded vertex.
    pub piece: Vec<u32>,
    /// The number of pieces.
    pub pieces: usize,
    /// The radius of the mesh in units of `positions`: between 1 and 2 (or 0 for a point).
    pub radius: f64,
}

impl Surface {
    /// Checks and welds a mesh; `more` are poses that vertices must agree in as well.
    pub fn new(faces: &[[u32; 3]], positions: &[DVec3], more: &[&[DVec3]]) -> Result<Self, WeightsError> {
        let vertices = positions.len();
        for (face, corners) in faces.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= vertices) {
                return Err(WeightsError::FaceOutOfRange { face, vertex, vertices });
            }
        }
        if let Some(vertex) = positions.iter().position(|p| !p.is_finite()) {
            return Err(WeightsError::NotFinite { vertex });
        }
        let (centre, radius) = unit_ball(faces, positions);
        let scale = power_of_two_below(radius);
        let scaled: Vec<DVec3> = positions.iter().map(|p| ((*p / scale) - (centre / scale)).clamp(-FAR, FAR)).collect();
        let mut poses: Vec<&[DVec3]> = vec![positions];
        poses.extend(more.iter().copied().filter(|pose| pose.len() == vertices));
        let stands = weld::weld(&poses, WELD_TOLERANCE * radius);
        let (kept, welded) = weld::compact(&stands);
        let positions: Vec<DVec3> = kept.iter().map(|&v| scaled[v as usize]).collect();
        let renumbered = faces.iter().map(|face| face.map(|v| welded[v as usize]));
        let faces: Vec<[u32; 3]> = renumbered.filter(face::is_whole).collect();
        Ok(Self::dissected(welded, positions, faces, radius / scale))
    }
}

impl Surface {
    /// The surface with its vertices renumbered for elimination.
    pub fn dissected(welded: Vec<u32>, positions: Vec<DVec3>, faces: Vec<[u32; 3]>, radius: f64) -> Self {
        let order = dissection::order(&Rings::new(&faces, positions.len()), &positions);
        let mut number = vec![0; order.len()];
        order.iter().enumerate().for_each(|(new, &old)| number[old as usize] = new as u32);
        let faces: Vec<[u32; 3]> = faces.iter().map(|face| face.map(|v| number[v as usize])).collect();
        let (piece, pieces) = pieces(&faces, positions.len());
        Self {
            welded: welded.iter().map(|&v| number[v as usize]).collect(),
            positions: order.iter().map(|&v| positions[v as usize]).collect(),
            rings: Rings::new(&faces, order.len()),
            faces,
            piece,
            pieces,
            radius,
        }
    }
}

/// Beyond this many radii a vertex without a face is as good as there.
const FAR: DVec3 = DVec3::splat(1e6);

/// Dividing by a power of two changes no digit, so that cotangents are those of the given mesh.
fn power_of_two_below(radius: f64) -> f64 {
    radius.log2().floor().clamp(-1000.0, 1000.0).exp2()
}

/// The piece of every vertex, counted in the order of their first vertices, and the number of pieces.
fn pieces(faces: &[[u32; 3]], vertices: usize) -> (Vec<u32>, usize) {
    let found = crate::mesh::pieces::pieces(faces, vertices);
    let mut piece = vec![u32::MAX; vertices];
    for (corners, &p) in faces.iter().zip(&found.face) {
        corners.iter().for_each(|&v| piece[v as usize] = p);
    }
    let mut count = found.count;
    for p in piece.iter_mut().filter(|p| **p == u32::MAX) {
        *p = count as u32;
        count += 1;
    }
    (piece, count)
}
