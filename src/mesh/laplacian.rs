//! The cotangent Laplacian and the Voronoi areas of a triangle mesh.
//!
//! Ulrich Pinkall, Konrad Polthier. *Computing discrete minimal surfaces and their conjugates*. Experimental
//! Mathematics 2(1), 1993. Areas: Mark Meyer, Mathieu Desbrun, Peter Schröder, Alan Barr. *Discrete
//! differential-geometry operators for triangulated 2-manifolds*, 2003, §3.3.
//!
//! Triangles that are degenerate, or nearly, are mollified: their three lengths grow by as much as the triangle
//! inequality lacks. Nicholas Sharp, Keenan Crane. *A Laplacian for nonmanifold triangle meshes*. Computer Graphics
//! Forum 39(5), 2020, §4.5 lengthens all edges of the mesh alike; here it is each bad triangle's own, so that the others
//! keep their cotangents to the bit. Every triangle still adds a positive semidefinite share.

use super::face;
use glam::DVec3;

/// By how much of the mean edge length two sides of a triangle together must exceed the third; and of the third, so that
/// a long triangle cannot have cotangents beyond what sums hold beside those of the others.
const SLACK: f64 = 1e-5;

/// The matrices of a mesh: L, with `cotangents` off the diagonal and rows that sum to zero, and the diagonal M.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Laplacian {
    /// Pairs of vertices that share a face, the lower number first, in ascending order.
    pub edges: Vec<[u32; 2]>,
    /// For each edge, ½ (cot α + cot β) over the angles that lie opposite it: one, two or more.
    pub cotangents: Vec<f64>,
    /// #V areas around the vertices, in squares of the unit of length: Voronoi areas, safe in obtuse triangles. Zero
    /// for a vertex without a face.
    pub mass: Vec<f64>,
    /// How many triangles were mollified.
    pub mollified: usize,
}

impl Laplacian {
    /// Builds both matrices. `faces` is #F triples of vertex numbers below #V; a face that names a vertex twice is left
    /// out. `positions` is #V finite points whose differences have squares in the range of numbers.
    pub fn new(faces: &[[u32; 3]], positions: &[DVec3]) -> Self {
        let whole: Vec<[u32; 3]> = faces.iter().copied().filter(face::is_whole).collect();
        let lengths: Vec<[f64; 3]> = whole.iter().map(|face| lengths(face.map(|v| positions[v as usize]))).collect();
        let mean = lengths.iter().flatten().sum::<f64>() / (3 * lengths.len()).max(1) as f64;
        let mut result = Self { mass: vec![0.0; positions.len()], ..Self::default() };
        let mut shares = Vec::with_capacity(3 * whole.len());
        for (face, &given) in whole.iter().zip(&lengths) {
            let sides = mollified(given, mean);
            result.mollified += usize::from(sides != given);
            let Some((cotangents, areas)) = triangle(sides) else { continue };
            for corner in 0..3 {
                let (u, v) = (face[(corner + 1) % 3], face[(corner + 2) % 3]);
                shares.push(([u.min(v), u.max(v)], 0.5 * cotangents[corner]));
                result.mass[face[corner] as usize] += areas[corner];
            }
        }
        // Stable, so that sums do not depend on anything but the order of the faces.
        shares.sort_by_key(|&(edge, _)| edge);
        for same in shares.chunk_by(|a, b| a.0 == b.0) {
            result.edges.push(same[0].0);
            result.cotangents.push(same.iter().map(|share| share.1).sum());
        }
        result
    }
}

/// The lengths of the sides opposite to the corners.
fn lengths([a, b, c]: [DVec3; 3]) -> [f64; 3] {
    [b.distance(c), c.distance(a), a.distance(b)]
}

/// The sides, longer by what they lack for the two shorter ones to exceed the longest; `mean` is that of the mesh.
fn mollified(sides: [f64; 3], mean: f64) -> [f64; 3] {
    let longest = sides.iter().copied().fold(0.0, f64::max);
    let slack = SLACK * mean.max(longest);
    let excess = sides.iter().sum::<f64>() - 2.0 * longest;
    if excess >= slack { sides } else { sides.map(|side| side + (slack - excess)) }
}

/// The cotangents of the angles of a triangle, and the areas that its corners get; `None` where it has no extent.
fn triangle(sides: [f64; 3]) -> Option<([f64; 3], [f64; 3])> {
    let area = area(sides);
    let squares = sides.map(|side| side * side);
    let cotangents = [0, 1, 2].map(|i| (squares[(i + 1) % 3] + squares[(i + 2) % 3] - squares[i]) / (4.0 * area));
    if !(area > 0.0 && cotangents.iter().all(|c| c.is_finite())) {
        return None;
    }
    let areas = match cotangents.iter().position(|&c| c < 0.0) {
        Some(obtuse) => [0, 1, 2].map(|i| if i == obtuse { 0.5 * area } else { 0.25 * area }),
        None => [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            (squares[j] * cotangents[j] + squares[k] * cotangents[k]) / 8.0
        }),
    };
    Some((cotangents, areas))
}

/// Heron's formula in the form that stays accurate for needles (W. Kahan, *Miscalculating area and angles of a
/// needle-like triangle*).
fn area(mut sides: [f64; 3]) -> f64 {
    sides.sort_by(|x, y| y.total_cmp(x));
    let [a, b, c] = sides;
    let product = (a + (b + c)) * (c - (a - b)) * (c + (a - b)) * (a + (b - c));
    0.25 * product.max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_square_has_the_known_matrices() {
        let positions = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.0), DVec3::Y];
        let found = Laplacian::new(&[[0, 1, 2], [0, 2, 3]], &positions);
        assert_eq!(found.edges, [[0, 1], [0, 2], [0, 3], [1, 2], [2, 3]]);
        for (cotangent, expected) in found.cotangents.iter().zip([0.5, 0.0, 0.5, 0.5, 0.5]) {
            assert!((cotangent - expected).abs() < 1e-15);
        }
        assert!(found.mass.iter().all(|m| (m - 0.25).abs() < 1e-15), "{:?}", found.mass);
        assert_eq!(found.mollified, 0);
    }

    #[test]
    fn linear_functions_are_harmonic_inside() {
        // A fan around an inner vertex, with obtuse triangles.
        let rim = |i: u32| f64::from(i) * std::f64::consts::TAU / 5.0;
        let mut positions = vec![DVec3::new(0.6, 0.1, 0.0)];
        positions.extend((0..5).map(|i| DVec3::new(rim(i).cos(), rim(i).sin(), 0.0)));
        let faces: Vec<[u32; 3]> = (0..5).map(|i| [0, 1 + i, 1 + (i + 1) % 5]).collect();
        let found = Laplacian::new(&faces, &positions);
        let at_centre: DVec3 = (found.edges.iter().zip(&found.cotangents))
            .filter(|(edge, _)| edge[0] == 0)
            .map(|(edge, &c)| c * (positions[edge[1] as usize] - positions[0]))
            .sum();
        assert!(at_centre.length() < 1e-14);
        let area = 2.5 * (std::f64::consts::TAU / 5.0).sin();
        assert!((found.mass.iter().sum::<f64>() - area).abs() < 1e-14);
    }

    #[test]
    fn long_slivers_among_small_triangles_have_bounded_cotangents() {
        // Among a thousand small triangles lies one 600 times as long and a tenth as wide: cotangents of 3000.
        let corners = |i: u32| [DVec3::ZERO, DVec3::X, DVec3::Y].map(|p| p + f64::from(i) * DVec3::Z);
        let mut positions: Vec<DVec3> = (0..1000).flat_map(corners).collect();
        positions.push(DVec3::new(301.0, 0.1, 0.0));
        positions.push(DVec3::new(601.0, 0.0, 0.0));
        let mut faces: Vec<[u32; 3]> = (0..1000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        faces.push([1, 3001, 3000]);
        let found = Laplacian::new(&faces, &positions);
        assert_eq!(found.mollified, 1);
        let largest = found.cotangents.iter().fold(0.0, |most: f64, c| most.max(c.abs()));
        assert!((100.0..1000.0).contains(&largest), "{largest}");
    }

    #[test]
    fn degenerate_triangles_stay_finite_and_leave_others_alone() {
        let mut positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(0.5, 0.5, 0.0), DVec3::ZERO];
        let clean = Laplacian::new(&[[0, 1, 2]], &positions);
        let faces = [[0, 1, 2], [1, 3, 2], [0, 4, 2], [2, 2, 1]];
        let found = Laplacian::new(&faces, &positions);
        assert_eq!(found.mollified, 2);
        assert!(found.cotangents.iter().chain(&found.mass).all(|x| x.is_finite()));
        let at = |l: &Laplacian, edge| l.edges.iter().position(|e| *e == edge).map(|i| l.cotangents[i]);
        assert_eq!(at(&found, [0, 1]), at(&clean, [0, 1]));
        positions.iter_mut().for_each(|p| *p = DVec3::ZERO);
        assert!(Laplacian::new(&faces, &positions).cotangents.is_empty());
    }
}
