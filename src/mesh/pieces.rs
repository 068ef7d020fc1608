//! Connected pieces of a mesh, and a census of its defects.

use super::groups::Groups;
use serde::Serialize;

/// The connected pieces of a mesh: faces that share a vertex are in one piece. (Those of [`super::DualGraph::pieces`]
/// share edges: two cones that touch at their tips are one piece here, two there.)
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Pieces {
    /// How many pieces there are.
    pub count: usize,
    /// #F piece numbers, in the order in which the pieces' first faces come.
    pub face: Vec<u32>,
}

/// Finds the connected pieces of a mesh of `vertices` vertices; vertices without a face belong to none.
///
/// `faces` is #F triples of vertex numbers below `vertices`.
pub fn pieces(faces: &[[u32; 3]], vertices: usize) -> Pieces {
    let mut groups = Groups::new(vertices);
    for &[a, b, c] in faces {
        groups.join(a, b);
        groups.join(a, c);
    }
    let mut number = vec![u32::MAX; vertices];
    let mut count = 0;
    let mut face = Vec::with_capacity(faces.len());
    for corners in faces {
        let root = groups.root(corners[0]) as usize;
        if number[root] == u32::MAX {
            number[root] = count;
            count += 1;
        }
        face.push(number[root]);
    }
    Pieces { count: count as usize, face }
}

/// How far a mesh is from a closed manifold.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Census {
    /// Edges with one face.
    pub boundary_edges: usize,
    /// Edges with more than two faces.
    pub nonmanifold_edges: usize,
    /// Faces that name a vertex twice.
    pub collapsed_faces: usize,
    /// Vertices without a face.
    pub unused_vertices: usize,
}

/// Counts boundary and non-manifold edges, collapsed faces (left out of the edges) and unused vertices.
///
/// `faces` is #F triples of vertex numbers below `vertices`.
pub fn census(faces: &[[u32; 3]], vertices: usize) -> Census {
    let mut edges = Vec::with_capacity(3 * faces.len());
    let mut used = vec![false; vertices];
    let mut census = Census::default();
    for &[a, b, c] in faces {
        [a, b, c].iter().for_each(|&v| used[v as usize] = true);
        if a == b || b == c || c == a {
            census.collapsed_faces += 1;
        } else {
            edges.extend([[a, b], [b, c], [c, a]].map(|[u, v]| (u.min(v), u.max(v))));
        }
    }
    edges.sort_unstable();
    for same in edges.chunk_by(|a, b| a == b) {
        match same.len() {
            1 => census.boundary_edges += 1,
            2 => {}
            _ => census.nonmanifold_edges += 1,
        }
    }
    census.unused_vertices = used.iter().filter(|&&u| !u).count();
    census
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_tetrahedra_are_two_closed_pieces() {
        let one = [[0, 1, 2], [0, 3, 1], [1, 3, 2], [2, 3, 0]];
        let mut faces = one.to_vec();
        faces.extend(one.map(|f| f.map(|v| v + 4)));
        let found = pieces(&faces, 8);
        assert_eq!(found, Pieces { count: 2, face: vec![0, 0, 0, 0, 1, 1, 1, 1] });
        assert_eq!(census(&faces, 9), Census { unused_vertices: 1, ..Census::default() });
    }

    #[test]
    fn counts_defects() {
        let faces = [[0, 1, 2], [1, 0, 3], [0, 1, 4], [2, 2, 0]];
        let expected = Census { boundary_edges: 6, nonmanifold_edges: 1, collapsed_faces: 1, unused_vertices: 0 };
        assert_eq!(census(&faces, 5), expected);
        assert_eq!(pieces(&faces, 5).count, 1);
    }
}
