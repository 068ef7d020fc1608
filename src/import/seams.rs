//! Vertices that are one point of the surface, stored more than once: joined, and what collapses with it removed.

use super::counted;
use crate::mesh::face::is_whole;
use crate::mesh::weld::{compact, weld};
use crate::sequence::Pose;
use crate::warning::Warning;
use glam::DVec3;

/// Vertices that differ by less than this share of the diagonal are welded: well above the rounding of 32-bit
/// floats, well below anything modelled.
const WELD_TOLERANCE: f64 = 1e-6;

/// Joins vertices that agree in the reference and in every pose, and says so where there are `warnings`. Returns for each
/// old vertex its new number, if any were joined.
pub fn weld_seams(
    faces: &mut [[u32; 3]],
    reference: &mut Vec<DVec3>,
    poses: &mut [Pose],
    warnings: Option<&mut Vec<Warning>>,
) -> Option<Vec<u32>> {
    let stands = {
        let mut all: Vec<&[DVec3]> = vec![reference];
        all.extend(poses.iter().map(|pose| pose.positions.as_slice()));
        weld(&all, WELD_TOLERANCE * extent(reference))
    };
    let (kept, numbers) = compact(&stands);
    let gone = reference.len() - kept.len();
    if gone == 0 {
        return None;
    }
    let keep = |positions: &[DVec3]| -> Vec<DVec3> { kept.iter().map(|&v| positions[v as usize]).collect() };
    *reference = keep(reference);
    poses.iter_mut().for_each(|pose| pose.positions = keep(&pose.positions));
    faces.iter_mut().flatten().for_each(|v| *v = numbers[*v as usize]);
    if let Some(warnings) = warnings {
        warnings.push(Warning::new(
            "welded",
            format!(
                "{} joined to another that is in the same place in every pose (seams of texture and normals).",
                counted(gone, "vertex was", "vertices were")
            ),
        ));
    }
    Some(numbers)
}

/// Removes faces of which two corners are one vertex. Returns the old numbers of those that stay, if any had to go.
pub fn drop_collapsed(faces: &mut Vec<[u32; 3]>, warnings: &mut Vec<Warning>) -> Option<Vec<u32>> {
    let stay: Vec<u32> = (0..faces.len() as u32).filter(|&f| is_whole(&faces[f as usize])).collect();
    let gone = faces.len() - stay.len();
    if gone == 0 {
        return None;
    }
    faces.retain(is_whole);
    let message = format!("{} left out because two corners are one point.", counted(gone, "face was", "faces were"));
    warnings.push(Warning::new("collapsed-faces", message));
    Some(stay)
}

/// The diagonal of the bounding box.
pub fn extent(positions: &[DVec3]) -> f64 {
    let low = positions.iter().copied().fold(DVec3::INFINITY, DVec3::min);
    let high = positions.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max);
    if low.x > high.x { 0.0 } else { low.distance(high) }
}
