//! The dual graph of a mesh: its nodes are the faces, its edges join faces that share a mesh edge.

use glam::DVec3;

/// Two faces that share a mesh edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DualEdge {
    /// The faces.
    pub faces: [u32; 2],
    /// The vertices of the shared mesh edge.
    pub vertices: [u32; 2],
}

/// The dual graph of a triangle mesh, as compressed rows.
///
/// An edge with more than two faces joins them one after the other, in the order of their numbers, so that its
/// faces stay connected and the number of dual edges grows with the number of faces whatever the mesh.
#[derive(Clone, Debug)]
pub struct DualGraph {
    edges: Vec<DualEdge>,
    offsets: Vec<u32>,
    links: Vec<Link>,
}

/// A way out of a face.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// The face on the other side.
    pub face: u32,
    /// The dual edge that leads there.
    pub edge: u32,
}

impl DualGraph {
    /// The dual graph of #F faces. Corners that name the same vertex twice make no edge.
    pub fn new(faces: &[[u32; 3]]) -> Self {
        Self::from_edges(faces.len(), shared_edges(faces))
    }

    /// A graph over `faces` nodes with the given edges.
    pub fn from_edges(faces: usize, edges: Vec<DualEdge>) -> Self {
        let mut offsets = vec![0u32; faces + 1];
        for edge in &edges {
            for f in edge.faces {
                offsets[f as usize + 1] += 1;
            }
        }
        for i in 0..faces {
            offsets[i + 1] += offsets[i];
        }
        let mut next = offsets.clone();
        let mut links = vec![Link { face: 0, edge: 0 }; 2 * edges.len()];
        for (e, edge) in edges.iter().enumerate() {
            let [a, b] = edge.faces;
            for (from, to) in [(a, b), (b, a)] {
                let slot = &mut next[from as usize];
                links[*slot as usize] = Link { face: to, edge: e as u32 };
                *slot += 1;
            }
        }
        Self { edges, offsets, links }
    }

    /// Number of faces.
    pub fn face_count(&self) -> usize {
        self.offsets.len() - 1
    }

    /// The edges, ordered by the vertices of their mesh edge.
    pub fn edges(&self) -> &[DualEdge] {
        &self.edges
    }

    /// The faces next to `face`.
    pub fn neighbours(&self, face: u32) -> &[Link] {
        let f = face as usize;
        &self.links[self.offsets[f] as usize..self.offsets[f + 1] as usize]
    }

    /// Connected pieces: #F piece numbers, counted from 0 in the order of their first faces, and their count.
    pub fn pieces(&self) -> (Vec<u32>, usize) {
        self.pieces_where(|_, _| true)
    }

    /// Connected pieces when only dual edges between faces with `joined(a, b)` connect.
    pub fn pieces_where(&self, joined: impl Fn(u32, u32) -> bool) -> (Vec<u32>, usize) {
        const NONE: u32 = u32::MAX;
        let mut piece = vec![NONE; self.face_count()];
        let mut stack = Vec::new();
        let mut count = 0;
        for start in 0..self.face_count() as u32 {
            if piece[start as usize] != NONE {
                continue;
            }
            piece[start as usize] = count;
            stack.push(start);
            while let Some(f) = stack.pop() {
                for link in self.neighbours(f) {
                    if piece[link.face as usize] == NONE && joined(f, link.face) {
                        piece[link.face as usize] = count;
                        stack.push(link.face);
                    }
                }
            }
            count += 1;
        }
        (piece, count as usize)
    }

    /// The pairs of different labels, the lower first, that share an edge under #F labels; in rising order.
    pub fn touching(&self, labels: &[u32]) -> Vec<(u32, u32)> {
        let mut pairs: Vec<(u32, u32)> = self
            .edges
            .iter()
            .map(|edge| edge.faces.map(|f| labels[f as usize]))
            .filter(|[a, b]| a != b)
            .map(|[a, b]| (a.min(b), a.max(b)))
            .collect();
        pairs.sort_unstable();
        pairs.dedup();
        pairs
    }

    /// #E geodesic distances between the centroids of adjacent faces: the straight line across the shared edge when
    /// the two triangles are unfolded into one plane. Two corners that only touch fall back to the straight distance.
    pub fn geodesic_lengths(&self, faces: &[[u32; 3]], positions: &[DVec3]) -> Vec<f64> {
        let centroids = super::face::centroids(faces, positions);
        let unfolded = |edge: &DualEdge| {
            let [a, b] = edge.vertices.map(|v| positions[v as usize]);
            let [p, q] = edge.faces.map(|f| centroids[f as usize]);
            let Some(along) = (b - a).try_normalize() else { return p.distance(q) };
            let split = |c: DVec3| {
                let s = (c - a).dot(along);
                (s, (c - a - s * along).length())
            };
            let ((s1, h1), (s2, h2)) = (split(p), split(q));
            (h1 + h2).hypot(s1 - s2)
        };
        self.edges.iter().map(unfolded).collect()
    }

    /// #E lengths of the shared mesh edges.
    pub fn shared_lengths(&self, positions: &[DVec3]) -> Vec<f64> {
        self.edges
            .iter()
            .map(|e| positions[e.vertices[0] as usize].distance(positions[e.vertices[1] as usize]))
            .collect()
    }
}

fn shared_edges(faces: &[[u32; 3]]) -> Vec<DualEdge> {
    let mut sides: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * faces.len());
    for (f, &[a, b, c]) in faces.iter().enumerate() {
        for (v, w) in [(a, b), (b, c), (c, a)] {
            if v != w {
                sides.push((v.min(w), v.max(w), f as u32));
            }
        }
    }
    sides.sort_unstable();
    sides
        .windows(2)
        .filter(|pair| pair[0].0 == pair[1].0 && pair[0].1 == pair[1].1 && pair[0].2 != pair[1].2)
        .map(|pair| DualEdge { faces: [pair[0].2, pair[1].2], vertices: [pair[0].0, pair[0].1] })
        .collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tetrahedron_has_six_dual_edges() {
        let faces = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];
        let graph = DualGraph::new(&faces);
        assert_eq!(graph.edges().len(), 6);
        assert!((0..4).all(|f| graph.neighbours(f).len() == 3));
        assert_eq!(graph.pieces(), (vec![0; 4], 1));
        assert_eq!(graph.touching(&[1, 0, 1, 2]), [(0, 1), (0, 2), (1, 2)]);
    }

    #[test]
    fn an_edge_with_four_faces_keeps_them_together() {
        let faces = [[0, 1, 2], [0, 1, 3], [0, 1, 4], [1, 0, 5], [6, 7, 8], [9, 9, 10]];
        let graph = DualGraph::new(&faces);
        assert_eq!(graph.edges().len(), 3);
        assert_eq!(graph.pieces(), (vec![0, 0, 0, 0, 1, 2], 3));
    }

    #[test]
    fn geodesic_lengths_do_not_change_when_the_hinge_folds() {
        let faces = [[0, 1, 2], [1, 0, 3]];
        let graph = DualGraph::new(&faces);
        let shape = |angle: f64| {
            let (s, c) = angle.sin_cos();
            [DVec3::ZERO, DVec3::Y, DVec3::new(-1.0, 0.3, 0.0), DVec3::new(c, 0.6, s)]
        };
        let flat = graph.geodesic_lengths(&faces, &shape(0.0))[0];
        let folded = graph.geodesic_lengths(&faces, &shape(2.5))[0];
        assert!((flat - folded).abs() < 1e-12);
        let centroids = DVec3::new(-1.0, 1.3, 0.0).distance(DVec3::new(1.0, 1.6, 0.0)) / 3.0;
        assert!((flat - centroids).abs() < 1e-12);
    }
}
