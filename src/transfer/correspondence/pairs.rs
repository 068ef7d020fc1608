//! Pairs of triangles, from the source bent into the target.
//!
//! Sumner & Popović 2004, §5: each triangle of either mesh is paired with the nearest of the other whose normal is less than
//! 90° off, so that a triangle may have several partners, and every triangle of the target has one.
//!
//! Beyond the paper, where nothing of the source is near, a triangle takes the partner of the nearest along the surface that
//! has one near it: a tail that the source has not moves with what it grows from, not with the legs beside it.

use super::fit::{face_normals, normals_at};
use crate::mesh::bvh::Bvh;
use crate::mesh::{DualGraph, face};
use crate::segmentation::shortest_paths::{NONE, ShortestPaths};
use crate::transfer::surface::WeldedSurface;
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
    pub fn new(source: &WeldedSurface, bent: &[DVec3], sound: &[bool], target: &WeldedSurface, tree: &Bvh) -> Self {
        let mut pairs = Vec::with_capacity(source.faces.len() + target.faces.len());
        let (own, other) = (normals_at(source, bent), face_normals(target));
        for (f, middle) in face::centroids(&source.faces, bent).into_iter().enumerate() {
            let hit = tree.nearest_facing(middle, own[f]);
            if let Some(hit) = hit.filter(|hit| sound[f] && hit.squared <= NEAR * NEAR) {
                pairs.push([hit.face, f as u32]);
            }
        }
        let tree = Bvh::new(&source.faces, bent, |f| sound[f as usize]);
        let areas = face::areas(&target.faces, &target.positions);
        let mut quality = Quality::default();
        let middles = face::centroids(&target.faces, &target.positions);
        let mut partners = vec![None; target.faces.len()];
        let mut covered = Vec::new();
        for (g, &middle) in middles.iter().enumerate() {
            let faces_alike = |f: u32| own[f as usize].dot(other[g]) > 0.0;
            let Some(nearest) = tree.nearest(middle) else { continue };
            let flipped = !faces_alike(nearest.face) && other[g] != DVec3::ZERO;
            let facing = if flipped { tree.nearest_facing(middle, other[g]) } else { None };
            let hit = facing.unwrap_or(nearest);
            partners[g] = Some(hit.face);
            quality.distance += areas[g] * hit.squared.sqrt();
            quality.flipped += if flipped { areas[g] } else { 0.0 };
            if hit.squared <= NEAR * NEAR && faces_alike(hit.face) {
                quality.coverage += areas[g];
                covered.push(g as u32);
            }
        }
        for (g, holder) in (0..).zip(holders(target, &middles, &covered)) {
            pairs.extend(partners[holder as usize].map(|f| [g, f]));
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

/// For each face the nearest along the surface that is `covered`, itself if there is none in reach.
fn holders(target: &WeldedSurface, middles: &[DVec3], covered: &[u32]) -> Vec<u32> {
    let graph = DualGraph::new(&target.faces);
    let length = |[a, b]: [u32; 2]| middles[a as usize].distance(middles[b as usize]);
    let lengths: Vec<f64> = graph.edges().iter().map(|edge| length(edge.faces)).collect();
    let nearest = ShortestPaths::from_sources(&graph, &lengths, covered.iter().map(|&g| (g, g))).label;
    (0..).zip(nearest).map(|(g, holder)| if holder == NONE { g } else { holder }).collect()
}
