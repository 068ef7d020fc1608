//! The coarse mesh on which sets of key points are tried.

use super::decimate::decimate;
use super::field::{Energy, banded_order};
use super::welded::WeldedSequence;
use crate::skinning::{Placed, Ring, features};
use glam::DVec3;

/// Gradients of vertices, over all poses, that are kept.
const MOST_GRADIENTS: usize = 500_000;

/// A coarse mesh, its candidates, and what trying a set needs again and again.
pub struct CoarseMesh {
    /// Its vertices are in a banded order; `origin` are vertices of the *fine* surface.
    pub surface: WeldedSequence,
    /// The energy of its fields.
    pub energy: Energy,
    /// The candidates, in the order they were found.
    pub candidates: Vec<u32>,
    /// The poses next to the reference.
    pub placed: Vec<Placed>,
    /// #V rows of rotations and stretches.
    pub features: Vec<f64>,
    /// #V × pieces: the nearest vertex of each piece.
    nearest: Vec<u32>,
}

impl CoarseMesh {
    /// Thins a surface out to about `target` vertices, all candidates among them. `poses` are the poses that count,
    /// `gammas` those of Eq. 15.
    pub fn new(fine: &WeldedSequence, candidates: &[u32], poses: &[usize], target: usize, gammas: [f64; 2]) -> Self {
        let mut keep = vec![false; fine.reference.len()];
        candidates.iter().for_each(|&c| keep[c as usize] = true);
        // Pieces without a candidate have no say.
        let mut wanted = vec![false; fine.reference.len()];
        for piece in fine.pieces.iter().filter(|piece| piece.iter().any(|&v| keep[v as usize])) {
            piece.iter().for_each(|&v| wanted[v as usize] = true);
        }
        let faces: Vec<[u32; 3]> = fine.faces.iter().copied().filter(|face| wanted[face[0] as usize]).collect();
        let thin = decimate(&faces, &fine.reference, &keep, target);
        let kept = in_banded_order(&thin.faces);
        let mut number = vec![u32::MAX; fine.reference.len()];
        kept.iter().enumerate().for_each(|(n, &v)| number[v as usize] = n as u32);
        let mut counts = vec![0.0; kept.len()];
        for (v, &onto) in thin.onto.iter().enumerate() {
            if let Some(count) = counts.get_mut(number[onto as usize] as usize) {
                *count += fine.counts[v];
            }
        }
        let faces = thin.faces.iter().map(|face| face.map(|v| number[v as usize])).collect();
        let of = |points: &[DVec3]| -> Vec<DVec3> { kept.iter().map(|&v| points[v as usize]).collect() };
        let reference = of(&fine.reference);
        let posed: Vec<Vec<DVec3>> = poses.iter().map(|&t| of(&fine.poses[t])).collect();
        let candidates = candidates.iter().map(|&c| number[c as usize]).collect();
        let surface = WeldedSequence::assemble(faces, reference, posed, counts, kept, number, fine.ball);
        let mut piece = vec![u32::MAX; surface.reference.len()];
        for (p, vertices) in surface.pieces.iter().enumerate() {
            vertices.iter().for_each(|&v| piece[v as usize] = p as u32);
        }
        let energy = Energy::new(&surface.laplacian, piece);
        let place = |pose: &Vec<DVec3>| Placed::new(&surface.reference, &surface.counts, 1.0, pose);
        let placed = surface.poses.iter().map(place).collect();
        let all: Vec<usize> = (0..surface.poses.len()).collect();
        let features = surface.features(&all, gammas);
        let nearest = nearest_of_each_piece(&surface);
        Self { surface, energy, candidates, placed, features, nearest }
    }

    /// Vertices at most `rings` edges from `v`, without it.
    pub fn around(&self, v: u32, rings: usize) -> Vec<u32> {
        let mut found = vec![v];
        for _ in 0..rings {
            let beside = |&[a, b]: &[u32; 2]| {
                let [has_a, has_b] = [a, b].map(|v| found.binary_search(&v).is_ok());
                (has_a != has_b).then_some(if has_a { b } else { a })
            };
            let next: Vec<u32> = self.surface.laplacian.edges.iter().filter_map(beside).collect();
            found.extend(next);
            found.sort_unstable();
            found.dedup();
        }
        found.retain(|&u| u != v);
        found
    }

    /// The vertex whose weights `v` takes where its own piece has no handle: the nearest one of a piece that has.
    pub fn followed(&self, v: usize, has_handle: &[bool]) -> Option<u32> {
        let pieces = self.surface.pieces.len();
        let at = self.surface.reference[v];
        let near = (0..pieces).filter(|&p| has_handle[p]).map(|p| self.nearest[v * pieces + p]);
        near.min_by(|&a, &b| {
            let d = |v: u32| self.surface.reference[v as usize].distance_squared(at);
            d(a).total_cmp(&d(b)).then(a.cmp(&b))
        })
    }
}

impl WeldedSequence {
    /// Rotations and stretches of the vertices over some poses (Eq. 15); over fewer of them where that would be many
    /// numbers.
    pub fn features(&self, poses: &[usize], [gamma_rotation, gamma_shear]: [f64; 2]) -> Vec<f64> {
        let (edges, stiffness) = (&self.laplacian.edges, &self.laplacian.cotangents);
        let ring = Ring { faces: &self.faces, edges, stiffness, reference: &self.reference };
        let step = (poses.len() * self.reference.len()).div_ceil(MOST_GRADIENTS).clamp(1, poses.len().max(1));
        let poses: Vec<&[DVec3]> = poses.iter().step_by(step).map(|&t| self.poses[t].as_slice()).collect();
        features(&ring, &poses, gamma_rotation, gamma_shear)
    }
}

fn in_banded_order(faces: &[[u32; 3]]) -> Vec<u32> {
    let mut kept: Vec<u32> = faces.iter().flatten().copied().collect();
    kept.sort_unstable();
    kept.dedup();
    let place = |v: u32| kept.binary_search(&v).unwrap_or(0);
    let mut links = vec![Vec::new(); kept.len()];
    for face in faces {
        let [a, b, c] = face.map(place);
        for (i, j) in [(a, b), (b, c), (c, a)] {
            links[i].push(j as u32);
            links[j].push(i as u32);
        }
    }
    banded_order(&links).into_iter().map(|i| kept[i as usize]).collect()
}

fn nearest_of_each_piece(surface: &WeldedSequence) -> Vec<u32> {
    let mut nearest = Vec::with_capacity(surface.reference.len() * surface.pieces.len());
    for &p in &surface.reference {
        for piece in &surface.pieces {
            let nearer = |best: (f64, u32), &v: &u32| {
                let d = surface.reference[v as usize].distance_squared(p);
                if d < best.0 { (d, v) } else { best }
            };
            nearest.push(piece.iter().fold((f64::INFINITY, 0), nearer).1);
        }
    }
    nearest
}
