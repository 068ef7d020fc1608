//! What all checks need to know of a mesh, found once.

use super::Mesh;
use super::orientation::Orientation;
use crate::mesh::face::is_whole;
use crate::mesh::{face, weld};
use glam::DVec3;

/// Vertices that stay closer than this (over the diagonal) in every pose are one point of the surface.
const SEAM: f64 = 1e-7;

/// A face at one of its edges.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Side {
    /// The edge: the lower of its two points in the upper half, the higher in the lower half.
    pub edge: u64,
    /// Twice the face; one more where the face runs along the edge from the lower point to the higher.
    tag: u32,
}

impl Side {
    /// The face.
    pub fn face(self) -> u32 {
        self.tag >> 1
    }

    /// Whether the face runs along the edge from the lower point to the higher.
    pub fn forward(self) -> bool {
        self.tag & 1 == 1
    }

    /// The two points, the lower first.
    pub fn points(self) -> [u32; 2] {
        [(self.edge >> 32) as u32, self.edge as u32]
    }
}

/// A mesh with what follows from it.
pub struct Chart<'a> {
    /// #F faces as given; one that names a vertex which does not exist is `[0, 0, 0]`.
    pub given: Vec<[u32; 3]>,
    /// #V positions.
    pub reference: &'a [DVec3],
    /// #V positions each.
    pub poses: Vec<&'a [DVec3]>,
    /// #V: the vertex that stands for each, vertices that agree in every pose taken as one *point*.
    pub stands: Vec<u32>,
    /// #F faces of points.
    pub faces: Vec<[u32; 3]>,
    /// #V: whether a face uses the vertex.
    pub used: Vec<bool>,
    /// #F normals of twice the face's area, at unit diagonal; zero or no number where there is none.
    pub normals: Vec<DVec3>,
    /// What lengths are multiplied by: 1 over the diagonal, 1 where that is no number.
    pub scale: f64,
    /// #F: the first face with the same points.
    pub first: Vec<u32>,
    /// The sides of all faces of three points, repeated ones left out, edge by edge.
    pub sides: Vec<Side>,
    /// Which faces look the same way.
    pub orientation: Orientation,
}

impl<'a> Chart<'a> {
    /// Looks at a mesh.
    pub fn new(mesh: &Mesh<'a>) -> Self {
        let reference = mesh.reference;
        let exists = |face: &[u32; 3]| face.iter().all(|&v| (v as usize) < reference.len());
        let kept = |face: &[u32; 3]| if exists(face) { *face } else { [0; 3] };
        let given: Vec<[u32; 3]> =
            if reference.is_empty() { Vec::new() } else { mesh.faces.iter().map(kept).collect() };
        let mut used = vec![false; reference.len()];
        given.iter().flatten().for_each(|&v| used[v as usize] = true);
        let scale = scale(reference, &used);
        let poses: Vec<&[DVec3]> = mesh.poses.iter().copied().filter(|pose| pose.len() == reference.len()).collect();
        let all: Vec<&[DVec3]> = std::iter::once(reference).chain(poses.iter().copied()).collect();
        let stands = weld::weld(&all, SEAM / scale);
        let faces: Vec<[u32; 3]> = given.iter().map(|face| face.map(|v| stands[v as usize])).collect();
        let corners = |&face: &[u32; 3]| face::corners(reference, face).map(|p| p * scale);
        let normals = given.iter().map(|face| face::double_area_normal(corners(face))).collect();
        let first = firsts(&faces, reference.len());
        let sides = sides(&faces, &first, reference.len());
        let orientation = Orientation::new(faces.len(), &sides);
        Self { given, reference, poses, stands, faces, used, normals, scale, first, sides, orientation }
    }

    /// The edges, each as the sides of its faces.
    pub fn edges(&self) -> impl Iterator<Item = &[Side]> {
        self.sides.chunk_by(|a, b| a.edge == b.edge)
    }

    /// The faces with a corner that is `wanted`.
    pub fn faces_with(&self, wanted: impl Fn(u32) -> bool) -> Vec<u32> {
        self.faces_where(|f| self.given[f].iter().any(|&v| wanted(v)))
    }

    /// The faces that are `wanted`.
    pub fn faces_where(&self, wanted: impl Fn(usize) -> bool) -> Vec<u32> {
        (0..self.given.len()).filter(|&f| wanted(f)).map(|f| f as u32).collect()
    }

    /// Whether an earlier face has the same points.
    pub fn is_repeated(&self, f: usize) -> bool {
        self.first[f] as usize != f
    }

    /// Whether a face names three different points.
    pub fn is_whole(&self, f: usize) -> bool {
        is_whole(&self.faces[f])
    }

    /// The square of a face's longest side, at unit diagonal.
    pub fn longest_squared(&self, f: usize) -> f64 {
        let [a, b, c] = face::corners(self.reference, self.given[f]).map(|p| p * self.scale);
        a.distance_squared(b).max(b.distance_squared(c)).max(c.distance_squared(a))
    }
}

/// 1 over the diagonal of the box around the vertices that faces use.
fn scale(reference: &[DVec3], used: &[bool]) -> f64 {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    for (p, _) in reference.iter().zip(used).filter(|(p, used)| **used && p.is_finite()) {
        low = low.min(*p);
        high = high.max(*p);
    }
    // Halves, lest huge coordinates overflow; the largest side first, lest its square does.
    let half = 0.5 * high - 0.5 * low;
    let largest = half.max_element();
    let scale = 0.5 / (largest * (half / largest).length());
    if scale.is_finite() && scale > 0.0 { scale } else { 1.0 }
}

/// #F: the first face with the same three points.
fn firsts(faces: &[[u32; 3]], points: usize) -> Vec<u32> {
    let sorted = |(f, face): (usize, &[u32; 3])| {
        let mut points = *face;
        points.sort_unstable();
        (points, f as u32)
    };
    let mut order: Vec<([u32; 3], u32)> =
        faces.iter().enumerate().filter(|(_, face)| is_whole(face)).map(sorted).collect();
    sort_by_point(&mut order, points, |entry| entry.0[0]);
    let mut first: Vec<u32> = (0..faces.len() as u32).collect();
    for same in order.chunk_by(|a, b| a.0 == b.0) {
        same.iter().for_each(|&(_, f)| first[f as usize] = same[0].1);
    }
    first
}

fn sides(faces: &[[u32; 3]], first: &[u32], points: usize) -> Vec<Side> {
    let mut sides = Vec::with_capacity(3 * faces.len());
    for (f, &[a, b, c]) in faces.iter().enumerate().filter(|&(f, face)| is_whole(face) && first[f] as usize == f) {
        for (v, w) in [(a, b), (b, c), (c, a)] {
            let edge = u64::from(v.min(w)) << 32 | u64::from(v.max(w));
            sides.push(Side { edge, tag: (f as u32) << 1 | u32::from(v < w) });
        }
    }
    sort_by_point(&mut sides, points, |side| side.points()[0]);
    sides
}

/// Sorts what begins with a point below `points`: by the point with counting, then the few that have it.
fn sort_by_point<T: Copy + Ord>(items: &mut Vec<T>, points: usize, point: impl Fn(&T) -> u32) {
    let Some(&any) = items.first() else { return };
    let mut start = vec![0_u32; points + 1];
    items.iter().for_each(|item| start[point(item) as usize + 1] += 1);
    for p in 0..points {
        start[p + 1] += start[p];
    }
    let mut next = start.clone();
    let mut sorted = vec![any; items.len()];
    for item in items.iter() {
        let slot = &mut next[point(item) as usize];
        sorted[*slot as usize] = *item;
        *slot += 1;
    }
    start.windows(2).for_each(|range| sorted[range[0] as usize..range[1] as usize].sort_unstable());
    *items = sorted;
}
