//! Distances along the surface, lowered source by source.
//!
//! Shortest paths run along edges and, across pairs of faces that share an edge, along the diagonal of the two unfolded
//! into one plane: on regular meshes that takes the error from up to 15 % to about 4 %.
//!
//! Edsger W. Dijkstra. A note on two problems in connexion with graphs. Numerische Mathematik 1, 1959.

use glam::DVec3;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A mesh as a graph of its vertices.
pub struct Graph {
    start: Vec<u32>,
    links: Vec<(u32, f64)>,
}

impl Graph {
    /// The graph of a mesh of #V `points`; `faces` are triples of vertices.
    pub fn new(faces: &[[u32; 3]], points: &[DVec3]) -> Self {
        let mut arcs = Vec::with_capacity(12 * faces.len());
        let mut link = |a: u32, b: u32, length: f64| {
            if a != b && length.is_finite() {
                arcs.extend([(a, b, length), (b, a, length)]);
            }
        };
        let at = |v: u32| points[v as usize];
        let mut sides = Vec::with_capacity(3 * faces.len());
        for &[a, b, c] in faces {
            for (u, v, opposite) in [(a, b, c), (b, c, a), (c, a, b)] {
                sides.push((u.min(v), u.max(v), opposite));
            }
        }
        sides.sort_unstable();
        for same in sides.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
            let (u, v, c) = same[0];
            link(u, v, at(u).distance(at(v)));
            if let &[_, (_, _, d)] = same
                && let Some(length) = unfolded(at(u), at(v), at(c), at(d))
            {
                link(c, d, length);
            }
        }
        arcs.sort_by(|x, y| (x.0, x.1).cmp(&(y.0, y.1)).then(x.2.total_cmp(&y.2)));
        arcs.dedup_by_key(|arc| (arc.0, arc.1));
        let mut start = vec![0; points.len() + 1];
        arcs.iter().for_each(|arc| start[arc.0 as usize + 1] += 1);
        (1..start.len()).for_each(|i| start[i] += start[i - 1]);
        Self { start, links: arcs.into_iter().map(|(_, to, length)| (to, length)).collect() }
    }

    /// Neighbours of a vertex and how far they are.
    pub fn links(&self, v: u32) -> &[(u32, f64)] {
        &self.links[self.start[v as usize] as usize..self.start[v as usize + 1] as usize]
    }

    /// Adds a source to `distance` (#V, infinite where no source is in reach); visits only what becomes nearer.
    pub fn lower(&self, distance: &mut [f64], source: u32) {
        let mut heap = BinaryHeap::new();
        distance[source as usize] = 0.0;
        // Distances are not negative, so their bits are ordered like their values.
        heap.push((Reverse(0_u64), Reverse(source)));
        while let Some((Reverse(bits), Reverse(v))) = heap.pop() {
            let d = f64::from_bits(bits);
            if d > distance[v as usize] {
                continue;
            }
            for &(to, length) in self.links(v) {
                let further = d + length;
                if further < distance[to as usize] {
                    distance[to as usize] = further;
                    heap.push((Reverse(further.to_bits()), Reverse(to)));
                }
            }
        }
    }
}

/// The distance of `c` and `d` when the faces `u v c` and `v u d` are unfolded into one plane; `None` where the straight
/// line between them leaves the two faces.
fn unfolded(u: DVec3, v: DVec3, c: DVec3, d: DVec3) -> Option<f64> {
    let axis = (v - u).normalize_or_zero();
    let flat = |p: DVec3| {
        let along = (p - u).dot(axis);
        (along, (p - u - along * axis).length())
    };
    let ((cx, cy), (dx, dy)) = (flat(c), flat(d));
    let crossing = (cx * dy + dx * cy) / (cy + dy);
    (crossing >= 0.0 && crossing <= u.distance(v)).then(|| (cx - dx).hypot(cy + dy))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn diagonals_across_two_faces_are_straight() {
        let points: Vec<DVec3> =
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
        // Folded by 90° about the edge 0 2, where the way through space is shorter.
        let mut folded = points.clone();
        folded[3] = DVec3::new(0.5, 0.5, 0.5_f64.sqrt());
        for points in [points, folded] {
            let graph = Graph::new(&[[0, 1, 2], [0, 2, 3]], &points);
            let mut distance = vec![f64::INFINITY; 4];
            graph.lower(&mut distance, 1);
            assert!((distance[3] - 2_f64.sqrt()).abs() < 1e-12, "{distance:?}");
        }
    }

    #[test]
    fn sources_lower_what_is_nearer_to_them() {
        let points: Vec<DVec3> = (0..6).map(|i| DVec3::new(f64::from(i / 2), f64::from(i % 2), 0.0)).collect();
        let faces = [[0, 2, 1], [1, 2, 3], [2, 4, 3], [3, 4, 5]];
        let graph = Graph::new(&faces, &points);
        let mut distance = vec![f64::INFINITY; 6];
        graph.lower(&mut distance, 0);
        assert!((distance[4] - 2.0).abs() < 1e-12);
        graph.lower(&mut distance, 5);
        assert_eq!((distance[0], distance[4], distance[5]), (0.0, 1.0, 0.0));
    }
}
