//! How faces move, as far as rigid parts care: their centroids in the reference pose and in every pose, and the rigid
//! motions that explain sets of them.
//!
//! What grows as a whole is as rigid as before: all its deformation gradients are equal, so that the paper's measure (Eq.
//! 4) finds nothing to cut there. The motion of a part is therefore rigid at the size that the part has in each pose
//! ([`super::growth`]), which is 1 for all that only moves.

use super::growth::Growth;
use crate::linalg::rigid_fit::{Moments, RigidMotion};
use crate::mesh::{DualGraph, face};
use crate::sequence::Sequence;
use glam::{DVec3, Vec3};

/// Coordinates (at unit diagonal) beyond this count as this, so that their squares stay in the range of 32-bit numbers.
pub const FAR: f64 = 1e15;

/// Face centroids at unit diagonal, about the middle of the mesh, and the weight of each face.
pub struct FaceMotion {
    poses: usize,
    weight: Vec<f64>,
    reference: Vec<Vec3>,
    /// Face by face, #T centroids.
    moved: Vec<Vec3>,
    growth: Growth,
}

/// The moments of one part, one set a pose.
pub type PartMoments = Vec<PoseMoments>;

/// What the motion of a part in one pose follows from: additive, as [`Moments`] are.
#[derive(Clone, Copy, Debug, Default)]
pub struct PoseMoments {
    pairs: Moments,
    /// Σ w |p|²
    squares: f64,
    /// Σ w · size of the face's piece in this pose
    size: f64,
}

impl PoseMoments {
    /// Adds a point of weight `w` that the pose carries from `p` to `q`, on a piece that is `size` times as large there.
    pub fn add(&mut self, w: f64, size: f64, p: DVec3, q: DVec3) {
        self.pairs.add(w, p, q);
        self.squares += w * p.length_squared();
        self.size += w * size;
    }

    fn merge(&mut self, other: &Self) {
        self.pairs.merge(&other.pairs);
        self.squares += other.squares;
        self.size += other.size;
    }

    /// The mean size of the part; exactly 1 where nothing grows, the two sums being the same then.
    fn size(&self) -> f64 {
        if self.pairs.weight > 0.0 { self.size / self.pairs.weight } else { 1.0 }
    }

    /// Squared residual of the best rigid motion.
    pub fn residual(&self) -> f64 {
        self.residual_at(self.size())
    }

    /// The same with the part `size` times as large as in the reference pose.
    pub fn residual_at(&self, size: f64) -> f64 {
        self.pairs_at(size).residual()
    }

    /// Moments of the pairs `size·p → q`.
    fn pairs_at(&self, size: f64) -> Moments {
        let Moments { weight, p, q, qp, squares } = self.pairs;
        Moments { weight, p: size * p, q, qp: size * qp, squares: squares + (size * size - 1.0) * self.squares }
    }
}

impl FaceMotion {
    /// Takes the centroids of #F faces of a sequence, `graph` being their dual graph; `scale` is one over its diagonal.
    /// Every face weighs 1.
    pub fn new(sequence: &Sequence, graph: &DualGraph, scale: f64) -> Self {
        let (faces, poses) = (sequence.faces(), sequence.poses().len());
        let centroids = |positions: &[DVec3]| -> Vec<Vec3> {
            let near = |p: DVec3| (p * scale).clamp(DVec3::splat(-FAR), DVec3::splat(FAR));
            let scaled = |f: &[u32; 3]| face::centroid(face::corners(positions, *f).map(near));
            let all: Vec<DVec3> = faces.iter().map(scaled).collect();
            let middle = all.iter().copied().sum::<DVec3>() / all.len().max(1) as f64;
            all.iter().map(|&c| (c - middle).as_vec3()).collect()
        };
        let mut moved = vec![Vec3::ZERO; faces.len() * poses];
        for (t, pose) in sequence.poses().iter().enumerate() {
            for (f, c) in centroids(&pose.positions).into_iter().enumerate() {
                moved[f * poses + t] = c;
            }
        }
        let (piece, pieces) = graph.pieces();
        let growth = Growth::none(piece, pieces, poses);
        let weight = vec![1.0; faces.len()];
        let mut faces = Self { poses, weight, reference: centroids(sequence.reference()), moved, growth };
        let moments = faces.moments(faces.growth.pieces(), pieces);
        faces.growth.measure(sequence, scale, &moments);
        faces
    }

    /// Gives #F weights to the faces.
    pub fn weigh(&mut self, weight: Vec<f64>) {
        self.weight = weight;
    }

    /// #T sizes of a face's piece over that in the reference pose.
    pub fn sizes(&self, face: u32) -> &[f64] {
        self.growth.of(face)
    }

    /// Number of poses.
    pub fn pose_count(&self) -> usize {
        self.poses
    }

    /// Number of faces.
    pub fn face_count(&self) -> usize {
        self.reference.len()
    }

    /// #T centroids of a face.
    fn moved(&self, face: u32) -> &[Vec3] {
        &self.moved[face as usize * self.poses..][..self.poses]
    }

    /// Adds a face to the moments of a part, by its weight.
    pub fn add_face(&self, moments: &mut PartMoments, face: u32) {
        self.add(moments, face, self.weight[face as usize]);
    }

    fn add(&self, moments: &mut PartMoments, face: u32, w: f64) {
        let p = self.reference[face as usize].as_dvec3();
        for ((m, q), &size) in moments.iter_mut().zip(self.moved(face)).zip(self.sizes(face)) {
            m.add(w, size, p, q.as_dvec3());
        }
    }

    /// Weighted moments of the parts `0..parts` under #F labels.
    pub fn weighted_moments(&self, labels: &[u32], parts: usize) -> Vec<PartMoments> {
        let mut moments = vec![vec![PoseMoments::default(); self.poses]; parts];
        for (f, &label) in labels.iter().enumerate() {
            self.add_face(&mut moments[label as usize], f as u32);
        }
        moments
    }

    /// Moments of the parts `0..parts` under #F labels, every face counting alike.
    pub fn moments(&self, labels: &[u32], parts: usize) -> Vec<PartMoments> {
        let mut moments = vec![vec![PoseMoments::default(); self.poses]; parts];
        for (f, &label) in labels.iter().enumerate() {
            self.add(&mut moments[label as usize], f as u32, 1.0);
        }
        moments
    }

    /// Summed squared distance of a face's centroids from where the motion puts its reference centroid (not weighted).
    pub fn error(&self, motion: &[Rigid32], face: u32) -> f32 {
        let p = self.reference[face as usize];
        motion.iter().zip(self.moved(face)).map(|(m, &q)| (m.rotation * p + m.translation - q).length_squared()).sum()
    }
}

/// A rigid motion of a part at its size, in single precision, for the many evaluations of [`FaceMotion::error`].
#[derive(Clone, Copy, Debug)]
pub struct Rigid32 {
    /// Times the size.
    rotation: glam::Mat3,
    translation: Vec3,
}

/// The best rigid motions of a part.
pub fn best_motion(moments: &PartMoments) -> Vec<Rigid32> {
    moments
        .iter()
        .map(|m| {
            let size = m.size();
            let RigidMotion { rotation, translation } = m.pairs_at(size).motion();
            Rigid32 { rotation: (size * rotation).as_mat3(), translation: translation.as_vec3() }
        })
        .collect()
}

/// Squared residual of a part, summed over all poses.
pub fn residual(moments: &PartMoments) -> f64 {
    // A sum of nothing would be −0.
    moments.iter().map(PoseMoments::residual).fold(0.0, |sum, r| sum + r)
}

/// Squared residual of the union of two parts.
pub fn union_residual(a: &PartMoments, b: &PartMoments) -> f64 {
    let union = |(x, y): (&PoseMoments, &PoseMoments)| {
        let mut sum = *x;
        sum.merge(y);
        sum.residual()
    };
    a.iter().zip(b).map(union).sum()
}

/// Adds `b`'s faces to `a`.
pub fn merge(a: &mut PartMoments, b: &PartMoments) {
    for (x, y) in a.iter_mut().zip(b) {
        x.merge(y);
    }
}
