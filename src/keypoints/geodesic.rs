//! Distances along the surface.
//!
//! Shortest paths run along edges and, across pairs of faces that share an edge, along the diagonal of the two unfolded
//! into one plane: on regular meshes that takes the error from up to 15 % to about 4 %.

use crate::mesh::paths::Graph;
use glam::DVec3;

/// The graph of a mesh of #V `points`, its nodes; `faces` are triples of vertices.
pub fn graph(faces: &[[u32; 3]], points: &[DVec3]) -> Graph {
    let at = |v: u32| points[v as usize];
    let mut sides = Vec::with_capacity(3 * faces.len());
    for &[a, b, c] in faces {
        for (u, v, opposite) in [(a, b, c), (b, c, a), (c, a, b)] {
            sides.push((u.min(v), u.max(v), opposite));
        }
    }
    sides.sort_unstable();
    let mut links = Vec::with_capacity(2 * sides.len());
    for same in sides.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
        let (u, v, c) = same[0];
        links.push((u, v, at(u).distance(at(v))));
        if let &[_, (_, _, d)] = same
            && let Some(length) = unfolded(at(u), at(v), at(c), at(d))
        {
            links.push((c, d, length));
        }
    }
    Graph::new(points.len(), &links)
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
    use crate::mesh::paths::Paths;

    #[test]
    fn diagonals_across_two_faces_are_straight() {
        let points: Vec<DVec3> =
            [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
        // Folded by 90° about the edge 0 2, where the way through space is shorter.
        let mut folded = points.clone();
        folded[3] = DVec3::new(0.5, 0.5, 0.5_f64.sqrt());
        for points in [points, folded] {
            let distance = Paths::from(&graph(&[[0, 1, 2], [0, 2, 3]], &points), 1).distance;
            assert!((distance[3] - 2_f64.sqrt()).abs() < 1e-12, "{distance:?}");
        }
    }

    #[test]
    fn sources_lower_what_is_nearer_to_them() {
        let points: Vec<DVec3> = (0..6).map(|i| DVec3::new(f64::from(i / 2), f64::from(i % 2), 0.0)).collect();
        let faces = [[0, 2, 1], [1, 2, 3], [2, 4, 3], [3, 4, 5]];
        let graph = graph(&faces, &points);
        let mut paths = Paths::from(&graph, 0);
        assert!((paths.distance[4] - 2.0).abs() < 1e-12);
        paths.add(&graph, 5, 1);
        assert_eq!([0, 4, 5].map(|v| (paths.distance[v], paths.label[v])), [(0.0, 0), (1.0, 1), (0.0, 1)]);
    }
}
