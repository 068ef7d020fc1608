//! A sequence on fewer vertices.

use super::decimate::decimate;
use super::welded::WeldedSequence;
use crate::sequence::{Pose, Sequence};
use glam::DVec3;

/// The sequence on about `vertices` of its vertices, welded; vertices without a face are left out.
pub fn thinned(sequence: &Sequence, vertices: usize) -> Sequence {
    let surface = WeldedSequence::new(sequence);
    let keep = vec![false; surface.reference.len()];
    let thin = decimate(&surface.faces, &surface.reference, &keep, vertices);
    let mut kept: Vec<u32> = thin.faces.iter().flatten().copied().collect();
    kept.sort_unstable();
    kept.dedup();
    let number = |v: u32| kept.binary_search(&v).map_or(0, |n| n as u32);
    let faces = thin.faces.iter().map(|face| face.map(number)).collect();
    let of = |points: &[DVec3]| kept.iter().map(|&v| points[surface.origin[v as usize] as usize]).collect();
    let poses = sequence.poses().iter().map(|pose| Pose { positions: of(&pose.positions), ..pose.clone() }).collect();
    // Part of a sequence is one, too.
    Sequence::new(sequence.name(), faces, of(sequence.reference()), poses).unwrap_or_else(|_| sequence.clone())
}
