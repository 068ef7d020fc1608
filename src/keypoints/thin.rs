//! A sequence on fewer vertices.

use super::decimate::decimate;
use super::surface::Surface;
use crate::sequence::{Pose, Sequence};
use glam::DVec3;

/// Some vertices of a mesh, and the mesh on them.
pub struct Thin {
    /// The sequence on these vertices.
    pub sequence: Sequence,
    /// Its welded form, in which every vertex counts for as many as it stands for.
    pub surface: Surface,
    /// Vertices of the whole sequence, ascending.
    origin: Vec<u32>,
}

impl Thin {
    /// About `vertices` vertices of a sequence, whose welded form is `surface`, `keep` (welded vertices) among them.
    pub fn new(sequence: &Sequence, surface: &Surface, keep: &[u32], vertices: usize) -> Self {
        let mut kept = vec![false; surface.reference.len()];
        keep.iter().for_each(|&v| kept[v as usize] = true);
        let thin = decimate(&surface.faces, &surface.reference, &kept, vertices);
        let mut places: Vec<u32> = thin.faces.iter().flatten().copied().collect();
        places.sort_unstable();
        places.dedup();
        let faces = thin.faces.iter().map(|face| face.map(|v| number(&places, v))).collect();
        let origin: Vec<u32> = places.iter().map(|&v| surface.origin[v as usize]).collect();
        let of = |points: &[DVec3]| origin.iter().map(|&v| points[v as usize]).collect();
        let poses = sequence.poses().iter().map(|pose| Pose { positions: of(&pose.positions), ..pose.clone() }).collect();
        // Part of a sequence is one, too.
        let part = Sequence::new(sequence.name(), faces, of(sequence.reference()), poses);
        let part = part.unwrap_or_else(|_| sequence.clone());
        let mut own = Surface::new(&part);
        own.counts.iter_mut().for_each(|count| *count = 0.0);
        for (v, &onto) in thin.onto.iter().enumerate() {
            if let Ok(place) = places.binary_search(&onto) {
                own.counts[own.number[place] as usize] += surface.counts[v];
            }
        }
        Self { sequence: part, surface: own, origin }
    }

    /// The number here of a vertex of the whole sequence that was kept.
    pub fn number(&self, vertex: u32) -> u32 {
        number(&self.origin, vertex)
    }
}

fn number(sorted: &[u32], vertex: u32) -> u32 {
    sorted.binary_search(&vertex).map_or(0, |n| n as u32)
}

/// The sequence on about `vertices` of its vertices, welded; vertices without a face are left out.
pub fn thinned(sequence: &Sequence, vertices: usize) -> Sequence {
    Thin::new(sequence, &Surface::new(sequence), &[], vertices).sequence
}
