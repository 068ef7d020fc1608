//! Shortest paths on the weighted dual graph (Dijkstra), from one or many faces.

use crate::mesh::DualGraph;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// No source is in reach.
pub const NONE: u32 = u32::MAX;

/// The distance of every face from the nearest source, and which source that is. Ties go to the lower face number.
#[derive(Clone, Debug)]
pub struct ShortestPaths {
    /// #F distances; infinite where no source is in reach.
    pub distance: Vec<f64>,
    /// #F labels of the nearest source; [`NONE`] where no source is in reach.
    pub label: Vec<u32>,
    heap: BinaryHeap<(Reverse<u64>, Reverse<u32>)>,
}

impl ShortestPaths {
    /// No sources yet: every distance is infinite.
    pub fn new(faces: usize) -> Self {
        Self { distance: vec![f64::INFINITY; faces], label: vec![NONE; faces], heap: BinaryHeap::new() }
    }

    /// Distances from the given `(face, label)` sources.
    pub fn from_sources(graph: &DualGraph, weights: &[f64], sources: impl IntoIterator<Item = (u32, u32)>) -> Self {
        let mut paths = Self::new(graph.face_count());
        paths.lower(graph, weights, sources);
        paths
    }

    /// Distances from one face.
    pub fn from_face(graph: &DualGraph, weights: &[f64], face: u32) -> Self {
        Self::from_sources(graph, weights, [(face, 0)])
    }

    /// Adds sources; only what becomes nearer is visited.
    pub fn lower(&mut self, graph: &DualGraph, weights: &[f64], sources: impl IntoIterator<Item = (u32, u32)>) {
        for (face, label) in sources {
            if self.distance[face as usize] > 0.0 {
                self.distance[face as usize] = 0.0;
                self.label[face as usize] = label;
                self.heap.push((Reverse(0), Reverse(face)));
            }
        }
        // Distances are not negative, so their bits are ordered like their values.
        while let Some((Reverse(bits), Reverse(face))) = self.heap.pop() {
            let d = f64::from_bits(bits);
            if d > self.distance[face as usize] {
                continue;
            }
            for link in graph.neighbours(face) {
                let further = d + weights[link.edge as usize];
                if further < self.distance[link.face as usize] {
                    self.distance[link.face as usize] = further;
                    self.label[link.face as usize] = self.label[face as usize];
                    self.heap.push((Reverse(further.to_bits()), Reverse(link.face)));
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::DualEdge;
    use proptest::prelude::*;

    fn floyd(n: usize, edges: &[(u32, u32, f64)]) -> Vec<Vec<f64>> {
        let mut d = vec![vec![f64::INFINITY; n]; n];
        for (i, row) in d.iter_mut().enumerate() {
            row[i] = 0.0;
        }
        for &(a, b, w) in edges {
            let (a, b) = (a as usize, b as usize);
            d[a][b] = d[a][b].min(w);
            d[b][a] = d[a][b];
        }
        for k in 0..n {
            for i in 0..n {
                for j in 0..n {
                    d[i][j] = d[i][j].min(d[i][k] + d[k][j]);
                }
            }
        }
        d
    }

    proptest! {
        #[test]
        fn agrees_with_all_pairs_also_when_sources_come_later(
            edges in prop::collection::vec((0..12u32, 0..12u32, 0.0..3.0f64), 0..40), s in 0..12u32, t in 0..12u32,
        ) {
            let dual = edges.iter().map(|&(a, b, _)| DualEdge { faces: [a, b], vertices: [0, 1] }).collect();
            let graph = DualGraph::from_edges(12, dual);
            let weights: Vec<f64> = edges.iter().map(|e| e.2).collect();
            let all = floyd(12, &edges);
            let mut paths = ShortestPaths::from_sources(&graph, &weights, [(s, 0)]);
            paths.lower(&graph, &weights, [(t, 1)]);
            let expected = all[s as usize].iter().zip(&all[t as usize]).map(|(a, b)| a.min(*b));
            for ((expected, &found), &label) in expected.zip(&paths.distance).zip(&paths.label) {
                prop_assert!(found == expected || (found - expected).abs() < 1e-12);
                prop_assert_eq!(label == NONE, expected.is_infinite());
            }
        }
    }
}
