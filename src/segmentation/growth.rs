//! How large each connected piece of the mesh is in each pose: a figure that grows, a ball that pulses.

use super::motion::{FAR, PartMoments};
use crate::mesh::face;
use crate::sequence::Sequence;

/// A piece within this share of its own size has that size: limbs that bend stretch a little skin.
const STEADY: f64 = 0.02;

/// Sizes of pieces over those in the reference pose.
pub struct Growth {
    /// #F numbers of pieces.
    piece: Vec<u32>,
    poses: usize,
    /// Piece by piece, #T sizes.
    size: Vec<f64>,
}

impl Growth {
    /// Every one of `pieces` pieces keeps its size; `piece` are #F numbers of pieces.
    pub fn none(piece: Vec<u32>, pieces: usize, poses: usize) -> Self {
        Self { piece, poses, size: vec![1.0; pieces * poses] }
    }

    /// #F numbers of pieces.
    pub fn pieces(&self) -> &[u32] {
        &self.piece
    }

    /// #T sizes of a face's piece.
    pub fn of(&self, face: u32) -> &[f64] {
        &self.size[self.piece[face as usize] as usize * self.poses..][..self.poses]
    }

    /// Measures the pieces of a sequence, one over whose diagonal is `scale`; `moments` are those of the pieces.
    ///
    /// The size of a piece is the median over its faces of the root of their areas' growth. Noise makes every face larger,
    /// and that is no growth: the size counts only if the piece is then closer to a rigid motion.
    pub fn measure(&mut self, sequence: &Sequence, scale: f64, moments: &[PartMoments]) {
        let faces = sequence.faces();
        let area = |positions, f: u32| face::area(face::corners(positions, faces[f as usize]).map(|p| p * scale));
        let rest: Vec<f64> = (0..faces.len() as u32).map(|f| area(sequence.reference(), f)).collect();
        let mut order: Vec<u32> = (0..faces.len() as u32).collect();
        order.sort_by_key(|&f| self.piece[f as usize]);
        for members in order.chunk_by(|&a, &b| self.piece[a as usize] == self.piece[b as usize]) {
            let piece = self.piece[members[0] as usize] as usize;
            for (t, pose) in sequence.poses().iter().enumerate() {
                let ratio = |&f: &u32| (area(&pose.positions, f) / rest[f as usize]).sqrt();
                let mut ratios: Vec<f64> = members.iter().map(ratio).filter(|r| *r > 0.0 && *r < FAR).collect();
                if ratios.is_empty() {
                    continue;
                }
                let middle = ratios.len() / 2;
                let size = *ratios.select_nth_unstable_by(middle, f64::total_cmp).1;
                let moments = &moments[piece][t];
                if (size - 1.0).abs() > STEADY && moments.residual_at(size) < moments.residual_at(1.0) {
                    self.size[piece * self.poses + t] = size;
                }
            }
        }
    }
}
