//! What the steps need to know of the mesh in its reference pose, lengths at unit diagonal.

use crate::mesh::{DualGraph, face, near, weld};
use crate::sequence::Sequence;
use glam::DVec3;

/// Vertices that stay closer than this (at unit diagonal) in every pose are one point of the surface.
const SEAM: f64 = 1e-7;

/// The reference pose at unit diagonal, and which faces are neighbours.
pub struct Geometry {
    /// The dual graph, vertices that agree in every pose taken as one: a seam of a file is no boundary of the mesh.
    pub graph: DualGraph,
    /// #F areas.
    pub areas: Vec<f64>,
    /// #F centroids.
    pub centroids: Vec<DVec3>,
    /// #E geodesic distances between the centroids of adjacent faces.
    pub geodesic: Vec<f64>,
    /// #E lengths of the shared mesh edges.
    pub edge_length: Vec<f64>,
}

impl Geometry {
    /// Measures the reference pose of a sequence; `scale` is [`unit_scale`]'s.
    pub fn new(sequence: &Sequence, scale: f64) -> Self {
        let faces = sequence.faces();
        let reference: Vec<DVec3> = sequence.reference().iter().map(|&p| p * scale).collect();
        let graph = DualGraph::new(&joined_faces(sequence, SEAM / scale));
        Self {
            areas: face::areas(faces, &reference),
            centroids: face::centroids(faces, &reference),
            geodesic: graph.geodesic_lengths(faces, &reference),
            edge_length: graph.shared_lengths(&reference),
            graph,
        }
    }

    /// Pairs of faces that join the pieces of the mesh into one, each to its nearest.
    pub fn bridges(&self) -> Vec<[u32; 2]> {
        near::bridges(&self.graph, &self.centroids)
    }

    /// Pairs of faces of each piece of the mesh and those around it.
    pub fn beside(&self) -> Vec<[u32; 2]> {
        near::beside(&self.graph, &self.centroids, &self.areas)
    }

    /// Pairs of faces where cells of different pieces (#F cell numbers) lie against each other, within `reach`.
    pub fn contacts(&self, cell: &[u32], reach: f64) -> Vec<[u32; 2]> {
        near::contacts(&self.graph, &self.centroids, cell, reach)
    }
}

/// What lengths are multiplied by: 1 over the diagonal of what moves in the reference pose, 1 where that is no number.
pub fn unit_scale(sequence: &Sequence) -> f64 {
    let scale = 1.0 / sequence.acting_diagonal();
    if scale.is_finite() { scale } else { 1.0 }
}

/// The faces with vertices that agree within `tolerance` in every pose taken as one.
fn joined_faces(sequence: &Sequence, tolerance: f64) -> Vec<[u32; 3]> {
    let moved = sequence.poses().iter().map(|pose| pose.positions.as_slice());
    let poses: Vec<&[DVec3]> = std::iter::once(sequence.reference()).chain(moved).collect();
    let stands = weld::weld(&poses, tolerance);
    sequence.faces().iter().map(|face| face.map(|v| stands[v as usize])).collect()
}
