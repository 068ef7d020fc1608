//! Polygon meshes as OBJ, OFF, PLY and STL files have them, and their triangles.

use super::ImportError;
use super::limits::Budget;
use glam::{DVec2, DVec3};

/// Vertices and polygons of one file, in the file's own order.
#[derive(Clone, Debug, PartialEq)]
pub struct PolygonMesh {
    /// #V positions.
    pub positions: Vec<DVec3>,
    /// #P + 1 starts of the polygons' corners.
    pub starts: Vec<u32>,
    /// Vertex numbers of all polygons' corners.
    corners: Vec<u32>,
    /// What the mesh may still take.
    budget: Budget,
}

/// Bytes that a position, a polygon and a corner take while a mesh is read, cut into triangles, and kept; twice what
/// they take in the end, as lists that grow are copied.
const POSITION: u64 = 48;
const POLYGON: u64 = 8;
const CORNER: u64 = 40;

/// Polygons of more corners are cut as a fan: cutting ears takes cubic time at the worst.
const EARS: usize = 64;

impl PolygonMesh {
    /// An empty mesh, for the file called `name`.
    pub fn new(name: &str) -> Self {
        Self { positions: Vec::new(), starts: vec![0], corners: Vec::new(), budget: Budget::new(name) }
    }

    /// Appends a vertex, if there is room.
    pub fn vertex(&mut self, position: DVec3) -> Result<(), ImportError> {
        self.budget.grow(POSITION)?;
        self.positions.push(position);
        Ok(())
    }

    /// Appends a polygon, if there is room.
    pub fn push(&mut self, polygon: impl IntoIterator<Item = u32>) -> Result<(), ImportError> {
        self.budget.grow(POLYGON)?;
        for corner in polygon {
            self.budget.grow(CORNER)?;
            self.corners.push(corner);
        }
        self.starts.push(self.corners.len() as u32);
        Ok(())
    }

    /// Number of polygons.
    pub fn len(&self) -> usize {
        self.starts.len() - 1
    }

    /// The vertices of a polygon.
    pub fn polygon(&self, polygon: usize) -> &[u32] {
        &self.corners[self.starts[polygon] as usize..self.starts[polygon + 1] as usize]
    }

    /// True if both meshes have the same polygons.
    pub fn same_polygons(&self, other: &Self) -> bool {
        self.starts == other.starts && self.corners == other.corners
    }

    /// Refuses polygons that name vertices which do not exist and positions that are not finite.
    pub fn check(&self, name: &str) -> Result<(), ImportError> {
        let count = self.positions.len();
        if let Some(at) = self.corners.iter().position(|&v| v as usize >= count) {
            let polygon = self.starts.partition_point(|&start| start as usize <= at).saturating_sub(1);
            return Err(ImportError(format!(
                "face {} of {name} names vertex {}, but there are only {count} vertices (both counted from 1); the \
                 file is cut short or damaged",
                polygon + 1,
                u64::from(self.corners[at]) + 1
            )));
        }
        match self.positions.iter().position(|p| !p.is_finite()) {
            Some(vertex) => Err(ImportError(format!(
                "vertex {} of {name} (counted from 1) has a coordinate that is not a finite number",
                vertex + 1
            ))),
            None => Ok(()),
        }
    }

    /// Cuts every polygon into triangles: quads along the diagonal that keeps them flattest or, failing that, the
    /// shorter one; others by cutting ears. Returns #F triangles and for each its polygon; polygons of fewer than
    /// three corners give none. The mesh must have been checked.
    pub fn triangulate(&self) -> (Vec<[u32; 3]>, Vec<u32>) {
        let (mut faces, mut polygons) = (Vec::with_capacity(self.len()), Vec::with_capacity(self.len()));
        for number in 0..self.len() {
            let polygon = self.polygon(number);
            match *polygon {
                [] | [_] | [_, _] => {}
                [a, b, c] => faces.push([a, b, c]),
                [a, b, c, d] => faces.extend(self.cut_quad([a, b, c, d])),
                _ if polygon.len() > EARS => {
                    faces.extend(polygon[1..].windows(2).map(|w| [polygon[0], w[0], w[1]]));
                }
                _ => self.cut_ears(polygon, &mut faces),
            }
            polygons.resize(faces.len(), number as u32);
        }
        (faces, polygons)
    }

    fn at(&self, v: u32) -> DVec3 {
        self.positions[v as usize]
    }

    /// Twice the area vector of a triangle.
    fn normal(&self, [a, b, c]: [u32; 3]) -> DVec3 {
        (self.at(b) - self.at(a)).cross(self.at(c) - self.at(a))
    }

    fn cut_quad(&self, [a, b, c, d]: [u32; 4]) -> [[u32; 3]; 2] {
        let first = [[a, b, c], [a, c, d]];
        let second = [[a, b, d], [b, c, d]];
        // On a concave quad one diagonal lies outside; its triangles then face opposite ways.
        let folds = |pair: [[u32; 3]; 2]| self.normal(pair[0]).dot(self.normal(pair[1])) < 0.0;
        match (folds(first), folds(second)) {
            (false, true) => first,
            (true, false) => second,
            _ if self.at(b).distance_squared(self.at(d)) < self.at(a).distance_squared(self.at(c)) => second,
            _ => first,
        }
    }

    /// Meisters, *Polygons have ears* (1975), in the plane of the polygon's area vector.
    fn cut_ears(&self, polygon: &[u32], faces: &mut Vec<[u32; 3]>) {
        let origin = self.at(polygon[0]);
        let turn = |w: &[u32]| (self.at(w[0]) - origin).cross(self.at(w[1]) - origin);
        let up = polygon.windows(2).map(turn).sum::<DVec3>().try_normalize().unwrap_or(DVec3::Z);
        let (x, y) = up.any_orthonormal_pair();
        let flat = |v: u32| DVec2::new((self.at(v) - origin).dot(x), (self.at(v) - origin).dot(y));
        let turn = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a);
        let mut left: Vec<(u32, DVec2)> = polygon.iter().map(|&v| (v, flat(v))).collect();
        let sign = if x.cross(y).dot(up) < 0.0 { -1.0 } else { 1.0 };
        while left.len() > 3 {
            let n = left.len();
            let is_ear = |&k: &usize| {
                let (a, b, c) = (left[(k + n - 1) % n].1, left[k].1, left[(k + 1) % n].1);
                let inside = |p: DVec2| {
                    sign * turn(a, b, p) >= 0.0 && sign * turn(b, c, p) >= 0.0 && sign * turn(c, a, p) >= 0.0
                };
                let corner = |p: DVec2| p == a || p == b || p == c;
                sign * turn(a, b, c) > 0.0 && !left.iter().any(|&(_, p)| !corner(p) && inside(p))
            };
            // A polygon that crosses itself may have no ear; any corner will do then.
            let ear = (0..n).find(is_ear).unwrap_or(1);
            faces.push([left[(ear + n - 1) % n].0, left[ear].0, left[(ear + 1) % n].0]);
            left.remove(ear);
        }
        faces.push([left[0].0, left[1].0, left[2].0]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area(mesh: &PolygonMesh, faces: &[[u32; 3]]) -> f64 {
        faces.iter().map(|&f| mesh.normal(f).z / 2.0).sum()
    }

    fn flat(points: &[(f64, f64)]) -> PolygonMesh {
        let positions = points.iter().map(|&(x, y)| DVec3::new(x, y, 0.0)).collect();
        let mut mesh = PolygonMesh { positions, ..PolygonMesh::new("flat") };
        mesh.push(0..points.len() as u32).expect("room");
        mesh
    }

    #[test]
    fn concave_polygons_are_covered_once() {
        // A comb whose teeth make most fans fold over.
        let comb = flat(&[(0., 0.), (6., 0.), (6., 3.), (5., 1.), (4., 3.), (3., 1.), (2., 3.), (1., 1.), (0., 3.)]);
        let (faces, polygons) = comb.triangulate();
        assert_eq!((faces.len(), polygons), (7, vec![0; 7]));
        assert!(faces.iter().all(|&f| comb.normal(f).z > 0.0), "{faces:?}");
        assert!((area(&comb, &faces) - 12.0).abs() < 1e-12);
    }

    #[test]
    fn concave_quads_are_cut_inside() {
        let dart = flat(&[(0., 0.), (2., -1.), (0.5, 0.), (2., 1.)]);
        let (faces, _) = dart.triangulate();
        assert!(faces.iter().all(|&f| dart.normal(f).z > 0.0), "{faces:?}");
    }

    #[test]
    fn degenerate_polygons_end() {
        for points in [vec![(0., 0.); 9], (0..9).map(|i| (f64::from(i), 0.)).collect()] {
            assert_eq!(flat(&points).triangulate().0.len(), 7);
        }
        let mut mesh = flat(&[(0., 0.), (1., 0.), (0., 1.)]);
        for polygon in [&[0, 1][..], &[], &[2, 1, 0]] {
            mesh.push(polygon.iter().copied()).expect("room");
        }
        assert_eq!(mesh.triangulate(), (vec![[0, 1, 2], [2, 1, 0]], vec![0, 3]));
    }

    #[test]
    fn checks_indices() {
        let mut mesh = flat(&[(0., 0.), (1., 0.), (0., 1.)]);
        mesh.push([0, 1, 3]).expect("room");
        let why = mesh.check("a.obj").unwrap_err().0;
        assert!(why.contains("face 2") && why.contains("vertex 4") && why.contains("3 vertices"), "{why}");
        mesh.positions.push(DVec3::NAN);
        assert!(mesh.check("a.obj").unwrap_err().0.contains("vertex 4"));
    }
}
