//! Influence regions (§3.2 step 4): the faces around a feature where a harmonic field that is 1 at the feature and 0 on
//! the deformable set A stays above a level.
//!
//! Rhaleb Zayer, Christian Rössl, Zachi Karni, Hans-Peter Seidel. Harmonic guidance for surface deformation. Computer
//! Graphics Forum 24(3), 2005.

use super::statistics::mean;
use crate::linalg::conjugate_gradient;
use crate::mesh::DualGraph;

/// Far below the level of 0.01 at which the field is cut.
const TOLERANCE: f64 = 1e-4;

/// Scratch space that is kept between calls, so that a call costs what its component costs.
pub struct Regions<'a> {
    graph: &'a DualGraph,
    weights: &'a [f64],
    floor: f64,
    slot: Vec<u32>,
}

const OUTSIDE: u32 = u32::MAX;

impl<'a> Regions<'a> {
    /// Regions over the dual graph with #E weights of Eq. 5; the field conducts as 1 / weight.
    pub fn new(graph: &'a DualGraph, weights: &'a [f64]) -> Self {
        // A weight of 0 (two coincident centroids) would conduct infinitely well.
        let mean = mean(weights.iter().copied());
        let floor = if mean > 0.0 { 1e-6 * mean } else { 1.0 };
        Self { graph, weights, floor, slot: vec![OUTSIDE; graph.face_count()] }
    }

    /// The influence region of `feature` (which comes first in it) among the faces that are not `deformable`: the faces
    /// of the feature's component of B with a value of at least `level`. No A in reach: the whole component.
    pub fn around(&mut self, feature: u32, deformable: &[u8], level: f64) -> Vec<u32> {
        let (component, bounded) = self.component(feature, deformable);
        let region = if bounded && component.len() > 1 {
            let values = self.harmonic(&component);
            component.iter().zip(values).filter(|&(_, value)| value >= level).map(|(&f, _)| f).collect()
        } else {
            component.clone()
        };
        for &f in &component {
            self.slot[f as usize] = OUTSIDE;
        }
        region
    }

    /// The component of B that holds the feature, in the order of a breadth-first walk, and whether it borders on A.
    fn component(&mut self, feature: u32, deformable: &[u8]) -> (Vec<u32>, bool) {
        let mut component = vec![feature];
        self.slot[feature as usize] = 0;
        let mut bounded = false;
        let mut next = 0;
        while let Some(&f) = component.get(next) {
            next += 1;
            for link in self.graph.neighbours(f) {
                if deformable[link.face as usize] != 0 {
                    bounded = true;
                } else if self.slot[link.face as usize] == OUTSIDE {
                    self.slot[link.face as usize] = component.len() as u32;
                    component.push(link.face);
                }
            }
        }
        (component, bounded)
    }

    /// The harmonic values over the component, 1 at its first face.
    fn harmonic(&self, component: &[u32]) -> Vec<f64> {
        // Unknowns are the faces but the first; faces of A count as 0 and only add to the diagonal.
        let n = component.len() - 1;
        let mut diagonal = vec![0.0; n];
        let mut right = vec![0.0; n];
        let mut rows: Vec<(u32, u32, f64)> = Vec::with_capacity(3 * n);
        for (i, &f) in component.iter().enumerate().skip(1) {
            for link in self.graph.neighbours(f) {
                let conductance = 1.0 / self.weights[link.edge as usize].max(self.floor);
                diagonal[i - 1] += conductance;
                match self.slot[link.face as usize] {
                    OUTSIDE => {}
                    0 => right[i - 1] += conductance,
                    j => rows.push((i as u32 - 1, j - 1, conductance)),
                }
            }
        }
        let apply = |x: &[f64], y: &mut [f64]| {
            for i in 0..n {
                y[i] = diagonal[i] * x[i];
            }
            for &(i, j, c) in &rows {
                y[i as usize] -= c * x[j as usize];
            }
        };
        let mut values = vec![0.5; n];
        conjugate_gradient::solve(apply, &diagonal, &right, &mut values, TOLERANCE, 2000);
        values.insert(0, 1.0);
        values
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::DualEdge;

    #[test]
    fn along_a_chain_the_field_falls_linearly() {
        // Faces 0..=10 in a row, 0 and 10 deformable, the feature at 5.
        let edges = (0..10).map(|i| DualEdge { faces: [i, i + 1], vertices: [0, 1] }).collect();
        let graph = DualGraph::from_edges(11, edges);
        let weights = vec![1.0; 10];
        let mut deformable = vec![0; 11];
        deformable[0] = 1;
        deformable[10] = 1;
        let mut regions = Regions::new(&graph, &weights);
        let mut region = regions.around(5, &deformable, 0.5);
        region.sort_unstable();
        assert_eq!(region, [3, 4, 5, 6, 7]);
        assert_eq!(regions.around(5, &[0; 11], 0.5).len(), 11, "no A in reach: everything");
    }
}
