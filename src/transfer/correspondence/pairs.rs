//! Pairs of triangles, from the source bent into the target.
//!
//! Sumner & Popović 2004, §5: each triangle of either mesh is paired with the nearest of the other whose normal is less than
//! 90° off, so that a triangle may have several partners, and every triangle of the target has one.

use super::fit::{face_normals, normals_at};
use crate::mesh::bvh::Bvh;
use crate::mesh::face;
use crate::transfer::surface::Surface;
use glam::DVec3;
use serde::Serialize;

/// In radii of the target: a triangle of the bent source that is farther away is paired with none, and the target's
/// triangles count as covered up to this distance.
const NEAR: f64 = 0.05;

/// Which faces correspond.
#[derive(Clone, Debug, Default)]
pub struct Correspondence {
    /// Faces of the target's surface and of the source's, ascending; every face of the target at least once.
    pub pairs: Vec<[u32; 2]>,
    /// How well the bent source covers the target.
    pub quality: Quality,
}

/// How well the bent source covers the target.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize)]
pub struct Quality {
    /// The share of the target's area with the bent source near it and facing the same way.
    pub coverage: f64,
    /// The mean distance over the target's area from the middle of a face to the bent source, in radii of the target.
    pub distance: f64,
    /// The share of the target's area where the nearest sheet of the bent source faces the other way.
    pub flipped: f64,
}

impl Correspondence {
    /// Pairs of the faces of `source`, bent to `bent` (#N positions), and `target`, whose faces are in `tree`. Of the
    /// source only faces that are `sound` (#F) are paired.
    pub fn new(source: &Surface, bent: &[DVec3], sound: &[bool], target: &Surface, tree: &Bvh) -> Self {
        let mut pairs = Vec::with_capacity(source.faces.len() + target.faces.len());
        let (own, other) = (normals_at(source, bent), face_normals(target));
        for (f, middle) in face::centroids(&source.faces, bent).into_iter().enumerate() {
            let hit = tree.nearest(middle, |g| other[g as usize].dot(own[f]) > 0.0);
            if let Some(hit) = hit.filter(|hit| sound[f] && hit.squared <= NEAR * NEAR) {
                pairs.push([hit.face, f as u32]);
            }
        }
        let tree = Bvh::new(&source.faces, bent);
        let areas = face::areas(&target.faces, &target.positions);
        let mut quality = Quality::default();
        for (g, middle) in face::centroids(&target.faces, &target.positions).into_iter().enumerate() {
            let faces_alike = |f: u32| own[f as usize].dot(other[g]) > 0.0;
            let usable = |f: u32| sound[f as usize];
            let Some(nearest) = tree.nearest(middle, usable) else { continue };
            let flipped = !faces_alike(nearest.face) && other[g] != DVec3::ZERO;
            let hit = if flipped {
                tree.nearest(middle, |f| usable(f) && faces_alike(f)).unwrap_or(nearest)
            } else {
                nearest
            };
            pairs.push([g as u32, hit.face]);
            quality.distance += areas[g] * hit.squared.sqrt();
            quality.coverage += if hit.squared <= NEAR * NEAR && faces_alike(hit.face) { areas[g] } else { 0.0 };
            quality.flipped += if flipped { areas[g] } else { 0.0 };
        }
        let total = areas.iter().sum::<f64>().max(f64::MIN_POSITIVE);
        quality.coverage /= total;
        quality.distance /= total;
        quality.flipped /= total;
        pairs.sort_unstable();
        pairs.dedup();
        Self { pairs, quality }
    }
}
