//! The source as a skin over near-rigid bones that nobody drew.
//!
//! Binh Huy Le and Zhigang Deng. *Smooth skinning decomposition with rigid bones*. ACM Transactions on Graphics 31(6),
//! 2012. Here: bones by clustering of motions, split where the motion is explained worst ([`bones`]); weights by a small
//! problem per vertex ([`weights`]); the bones' motions again for every pose ([`motions`]).

pub mod blends;
pub mod bones;
pub mod motions;
pub mod weights;

use super::surface::WeldedSurface;
use glam::{DAffine3, DVec3};
use weights::Row;

/// A skin of a [`WeldedSurface`], in its unit ball.
#[derive(Clone, Debug, Default)]
pub struct Rig {
    /// The number of bones.
    pub bones: usize,
    /// #N rows: bones and their shares, which sum to 1.
    pub rows: Vec<Row>,
    /// Where bones meet.
    pub blends: blends::Blends,
    /// For each pose, the motion of each bone.
    pub maps: Vec<Vec<DAffine3>>,
    /// Mean distance of the skinned vertices from the true ones, over vertices (by area) and poses, in radii.
    pub error: f64,
    /// The poses that tell most, in ascending order.
    pub telling: Vec<usize>,
    motions: motions::Motions,
}

impl Rig {
    /// Finds bones that explain the poses (positions in the unit ball, as the surface's), `most` at most but for those that
    /// part where their vertices lie apart, and binds the surface to them.
    pub fn new(surface: &WeldedSurface, poses: &[Vec<DVec3>], most: usize) -> Self {
        let chosen = bones::telling_poses(surface, poses);
        let seen: Vec<&[DVec3]> = chosen.iter().map(|&p| poses[p].as_slice()).collect();
        let found = bones::find(surface, &seen, most);
        let rows = weights::bind(surface, &seen, &found);
        let blends = blends::blends(surface, &rows, found.count);
        let motions = motions::Motions::new(surface, &rows, found.count);
        let maps: Vec<Vec<DAffine3>> = poses.iter().map(|pose| motions.fit(surface, pose)).collect();
        let error = poses.iter().zip(&maps).map(|(pose, maps)| deviation(surface, &rows, pose, maps)).sum::<f64>()
            / poses.len().max(1) as f64;
        Self { bones: found.count, rows, blends, maps, error, telling: chosen, motions }
    }

    /// The motion of each bone in another pose, #N positions in the unit ball of the surface that the rig was made of.
    pub fn follow(&self, surface: &WeldedSurface, pose: &[DVec3]) -> Vec<DAffine3> {
        self.motions.fit(surface, pose)
    }
}

/// Where a row of weights puts a point.
pub fn blend(row: &[(u32, f64)], maps: &[DAffine3], point: DVec3) -> DVec3 {
    row.iter().filter_map(|&(bone, w)| Some(w * maps.get(bone as usize)?.transform_point3(point))).sum()
}

fn deviation(surface: &WeldedSurface, rows: &[Row], pose: &[DVec3], maps: &[DAffine3]) -> f64 {
    let at = surface.positions.iter().zip(rows).map(|(&p, row)| blend(row, maps, p));
    at.zip(pose).zip(&surface.mass).map(|((a, b), m)| m * a.distance(*b)).sum()
}
