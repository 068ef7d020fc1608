//! The average distance from a face to the faces of a partition, `avg(Dis(f, Fᵢ))` of Eq. 7.
//!
//! The paper reads it from a table of all pairs of faces. Here are two ways without one: [`Landmarks`] estimates it from
//! the distances to some far-apart faces, each standing for the faces around it; [`Exact`] sums it up literally, one
//! shortest-path search a face, keeping only the sums.

use super::SegmentationError;
use super::shortest_paths::{NONE, ShortestPaths};
use crate::mesh::DualGraph;

/// What the distance to a face on another piece counts in a sum that must stay finite.
const OUT_OF_REACH: f64 = 1e12;

/// A way to average distances from faces to partitions.
pub trait Averages {
    /// Takes notice of #F partition numbers ([`NONE`]: in no partition). `keep_going` hears how far along it is (0 to 1)
    /// and may stop it.
    fn update(
        &mut self,
        labels: &[u32],
        partitions: usize,
        keep_going: &mut dyn FnMut(f64) -> bool,
    ) -> Result<(), SegmentationError>;

    /// Writes the average distance from `face` to the faces of every partition into `row`; infinite for partitions
    /// without faces in reach.
    fn of(&self, face: u32, row: &mut [f32]);
}

/// Estimates from landmark faces: the distance to a face is about that to its nearest landmark.
pub struct Landmarks {
    /// Landmark by landmark, #F distances.
    distances: Vec<Vec<f32>>,
    /// #F nearest landmarks.
    nearest: Vec<u32>,
    /// Partition by partition, the landmarks that stand for its faces and for which share of them.
    shares: Vec<Vec<(u32, f32)>>,
}

impl Landmarks {
    /// Chooses `count` landmarks among the `asked` of #F faces, each farthest from those before; if `count` is less than
    /// the number of connected pieces with such faces, one on each.
    pub fn new(graph: &DualGraph, weights: &[f64], asked: &[bool], count: usize) -> Self {
        let mut paths = ShortestPaths::new(graph.face_count());
        let mut distances = Vec::new();
        let asked: Vec<usize> = (0..asked.len()).filter(|&f| asked[f]).collect();
        for landmark in 0..asked.len() as u32 {
            let farther = |best: usize, f: usize| if paths.distance[f] > paths.distance[best] { f } else { best };
            let Some(farthest) = asked.iter().copied().reduce(farther) else { break };
            if landmark as usize >= count && paths.distance[farthest].is_finite() {
                break;
            }
            let own = ShortestPaths::from_face(graph, weights, farthest as u32);
            distances.push(own.distance.iter().map(|&d| d as f32).collect());
            paths.lower(graph, weights, [(farthest as u32, landmark)]);
        }
        Self { distances, nearest: paths.label, shares: Vec::new() }
    }
}

impl Averages for Landmarks {
    fn update(
        &mut self,
        labels: &[u32],
        partitions: usize,
        keep_going: &mut dyn FnMut(f64) -> bool,
    ) -> Result<(), SegmentationError> {
        if !keep_going(0.0) {
            return Err(SegmentationError::Cancelled);
        }
        let mut counts = vec![vec![0u32; self.distances.len()]; partitions];
        for (&label, &landmark) in labels.iter().zip(&self.nearest) {
            if label != NONE && landmark != NONE {
                counts[label as usize][landmark as usize] += 1;
            }
        }
        self.shares = counts
            .iter()
            .map(|row| {
                let total: u32 = row.iter().sum();
                let own = row.iter().enumerate().filter(|&(_, &n)| n > 0);
                own.map(|(l, &n)| (l as u32, n as f32 / total as f32)).collect()
            })
            .collect();
        Ok(())
    }

    fn of(&self, face: u32, row: &mut [f32]) {
        for (average, shares) in row.iter_mut().zip(&self.shares) {
            *average = match shares.as_slice() {
                [] => f32::INFINITY,
                _ => shares.iter().map(|&(l, share)| share * self.distances[l as usize][face as usize]).sum(),
            };
        }
    }
}

/// The literal average over all faces of a partition: the oracle.
///
/// `Σ Dis(f, g)` over the faces g of a partition is kept for every f and partition; a face that changes its partition
/// moves its row of distances from one sum to the other. Memory: faces × partitions.
pub struct Exact<'a> {
    graph: &'a DualGraph,
    weights: &'a [f64],
    labels: Vec<u32>,
    partitions: usize,
    sums: Vec<f64>,
    sizes: Vec<usize>,
}

impl<'a> Exact<'a> {
    /// Sums over the given weighted dual graph.
    pub fn new(graph: &'a DualGraph, weights: &'a [f64]) -> Self {
        Self { graph, weights, labels: Vec::new(), partitions: 0, sums: Vec::new(), sizes: Vec::new() }
    }
}

impl Averages for Exact<'_> {
    fn update(
        &mut self,
        labels: &[u32],
        partitions: usize,
        keep_going: &mut dyn FnMut(f64) -> bool,
    ) -> Result<(), SegmentationError> {
        let faces = self.graph.face_count();
        let moved = (0..faces).filter(|&f| self.labels.get(f) != labels.get(f)).count();
        if self.partitions != partitions || 2 * moved > faces {
            self.partitions = partitions;
            self.labels = vec![NONE; faces];
            self.sums = vec![0.0; faces * partitions];
            self.sizes = vec![0; partitions];
        }
        for (g, (own, &to)) in self.labels.iter_mut().zip(labels).enumerate() {
            let from = std::mem::replace(own, to);
            if from == to {
                continue;
            }
            if g % 64 == 0 && !keep_going(g as f64 / faces as f64) {
                return Err(SegmentationError::Cancelled);
            }
            let distance = ShortestPaths::from_face(self.graph, self.weights, g as u32).distance;
            for (label, sign) in [(from, -1.0), (to, 1.0)] {
                if label != NONE {
                    for (f, &d) in distance.iter().enumerate() {
                        self.sums[f * partitions + label as usize] += sign * d.min(OUT_OF_REACH);
                    }
                }
            }
            if from != NONE {
                self.sizes[from as usize] -= 1;
            }
            if to != NONE {
                self.sizes[to as usize] += 1;
            }
        }
        Ok(())
    }

    fn of(&self, face: u32, row: &mut [f32]) {
        for (i, average) in row.iter_mut().enumerate() {
            let sum = self.sums[face as usize * self.partitions + i];
            *average = match self.sizes[i] {
                0 => f32::INFINITY,
                n => (sum / n as f64) as f32,
            };
        }
    }
}
