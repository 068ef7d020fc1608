//! A creature of the zoo as a skin: handles far from each other, weights that reach everywhere, and for each pose the
//! affine maps that fit it best around the handles.

use glam::{DAffine3, DMat3, DVec3};
use sinew::export::animation::{Skin, SkinPose};
use sinew::sequence::Sequence;
use sinew::zoo::{Recipe, make};

/// What a [`Skin`] borrows.
pub struct Made {
    pub sequence: Sequence,
    pub handles: usize,
    pub weights: Vec<f64>,
    /// Pose × handle.
    pub maps: Vec<Vec<DAffine3>>,
}

impl Made {
    /// The creature with so many handles.
    pub fn new(name: &str, faces: usize, poses: usize, handles: usize) -> Self {
        let recipe = Recipe { name: name.into(), faces, poses, exact: false, ..Recipe::default() };
        let sequence = make(&recipe).expect("a creature of the zoo").sequence;
        let points = sequence.reference();
        let mut chosen = vec![points[0]];
        while chosen.len() < handles {
            let nearest = |p: &DVec3| chosen.iter().map(|c| c.distance(*p)).fold(f64::INFINITY, f64::min);
            let far = points.iter().max_by(|a, b| nearest(a).total_cmp(&nearest(b))).expect("a vertex");
            chosen.push(*far);
        }
        let mut weights = Vec::with_capacity(points.len() * handles);
        for p in points {
            let near: Vec<f64> = chosen.iter().map(|c| (c.distance_squared(*p) + 1e-4).powi(-3)).collect();
            let sum: f64 = near.iter().sum();
            weights.extend(near.iter().map(|n| n / sum));
        }
        let fit = |h: usize, pose: &[DVec3]| affine(points, pose, |v| weights[v * handles + h].powi(2));
        let maps = sequence.poses().iter().map(|pose| (0..handles).map(|h| fit(h, &pose.positions)).collect());
        let maps = maps.collect();
        Self { sequence, handles, weights, maps }
    }

    pub fn poses(&self) -> Vec<SkinPose<'_>> {
        let poses = self.sequence.poses().iter().zip(&self.maps);
        poses.map(|(pose, maps)| SkinPose { name: &pose.name, time: pose.time, maps }).collect()
    }

    pub fn skin<'a>(&'a self, poses: &'a [SkinPose<'a>]) -> Skin<'a> {
        Skin {
            name: self.sequence.name(),
            faces: self.sequence.faces(),
            reference: self.sequence.reference(),
            weights: &self.weights,
            handles: self.handles,
            poses,
            look: None,
        }
    }

    /// Where the whole weights put the vertices.
    pub fn blend(&self, pose: usize) -> Vec<DVec3> {
        let rows = self.weights.chunks_exact(self.handles).zip(self.sequence.reference());
        let place = |(row, &x): (&[f64], &DVec3)| {
            row.iter().zip(&self.maps[pose]).map(|(&w, map)| w * map.transform_point3(x)).sum()
        };
        rows.map(place).collect()
    }
}

/// The affine map that takes `from` nearest to `to`, by least squares.
fn affine(from: &[DVec3], to: &[DVec3], weight: impl Fn(usize) -> f64) -> DAffine3 {
    let sum: f64 = (0..from.len()).map(&weight).sum();
    let mean = |points: &[DVec3]| (0..points.len()).map(|v| points[v] * weight(v)).sum::<DVec3>() / sum;
    let (p0, q0) = (mean(from), mean(to));
    let (mut pp, mut qp) = (DMat3::from_diagonal(DVec3::splat(1e-6)), DMat3::from_diagonal(DVec3::splat(1e-6)));
    for v in 0..from.len() {
        let (p, q) = ((from[v] - p0) * (weight(v) / sum), to[v] - q0);
        let r = from[v] - p0;
        pp += DMat3::from_cols(r * p.x, r * p.y, r * p.z);
        qp += DMat3::from_cols(q * p.x, q * p.y, q * p.z);
    }
    let linear = qp * pp.inverse();
    DAffine3::from_mat3_translation(linear, q0 - linear * p0)
}
