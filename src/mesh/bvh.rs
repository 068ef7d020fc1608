//! The nearest point of a triangle mesh, by a hierarchy of bounding boxes: of the faces, and of their normals, lest a
//! place that faces away from all of a sheet ask every face.

use super::face::{self, nearest_in_triangle};
use glam::DVec3;

/// Faces that a box holds without being split.
const LEAF: usize = 4;

/// A place on a mesh.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The number of the face.
    pub face: u32,
    /// Shares of its corners, which sum to 1.
    pub shares: [f64; 3],
    /// The point itself.
    pub point: DVec3,
    /// Its squared distance from what was asked for.
    pub squared: f64,
}

impl Hit {
    fn order(&self, other: &Self) -> std::cmp::Ordering {
        self.squared.total_cmp(&other.squared).then(self.face.cmp(&other.face))
    }
}

/// Triangles in a binary tree of boxes.
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    nodes: Vec<Node>,
    /// The corners of the faces in the order of the tree, their unit normals (0 where there is none), and their numbers.
    triangles: Vec<[DVec3; 3]>,
    normals: Vec<DVec3>,
    numbers: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: DVec3,
    high: DVec3,
    /// The box of the normals.
    normals: [DVec3; 2],
    /// The faces below it, as places in the order of the tree.
    from: u32,
    to: u32,
    /// Its second child; the first follows it at once. 0 for a leaf.
    second: u32,
}

impl Node {
    fn squared(&self, p: DVec3) -> f64 {
        (self.low - p).max(p - self.high).max(DVec3::ZERO).length_squared()
    }

    /// Whether a face below it may have its normal less than 90° off this one.
    fn may_face(&self, normal: DVec3) -> bool {
        let [low, high] = self.normals.map(|corner| corner * normal);
        low.max(high).element_sum() > 0.0
    }
}

impl Bvh {
    /// Builds the tree over those of #F faces that are `wanted`; vertices are at finite positions.
    pub fn new(faces: &[[u32; 3]], positions: &[DVec3], wanted: impl Fn(u32) -> bool) -> Self {
        let centroids = face::centroids(faces, positions);
        let normal = |&face: &[u32; 3]| face::double_area_normal(face::corners(positions, face)).normalize_or_zero();
        let normals: Vec<DVec3> = faces.iter().map(normal).collect();
        let mut numbers: Vec<u32> = (0..faces.len() as u32).filter(|&f| wanted(f)).collect();
        let mut nodes = Vec::with_capacity(numbers.len());
        // Places still to be boxed, and the node whose second child they are.
        let mut stack = vec![(0, numbers.len(), None)];
        while let Some((from, to, parent)) = stack.pop() {
            if from == to {
                continue;
            }
            let own: &mut [u32] = &mut numbers[from..to];
            let [low, high] = bounds(own.iter().flat_map(|&f| face::corners(positions, faces[f as usize])));
            let facing = bounds(own.iter().map(|&f| normals[f as usize]));
            let number = nodes.len() as u32;
            if let Some(parent) = parent {
                let parent: &mut Node = &mut nodes[parent as usize];
                parent.second = number;
            }
            nodes.push(Node { low, high, normals: facing, from: from as u32, to: to as u32, second: 0 });
            if own.len() > LEAF {
                let size = high - low;
                let axis = if size.x >= size.y && size.x >= size.z { 0 } else { 1 + usize::from(size.z > size.y) };
                let half = own.len() / 2;
                own.select_nth_unstable_by(half, |&a, &b| {
                    centroids[a as usize][axis].total_cmp(&centroids[b as usize][axis]).then(a.cmp(&b))
                });
                stack.push((from + half, to, Some(number)));
                stack.push((from, from + half, None));
            }
        }
        let triangles = numbers.iter().map(|&f| face::corners(positions, faces[f as usize])).collect();
        let normals = numbers.iter().map(|&f| normals[f as usize]).collect();
        Self { nodes, triangles, normals, numbers }
    }

    /// The nearest point of all faces; `None` if there is none. Of equally near faces the one with the lowest number.
    pub fn nearest(&self, to: DVec3) -> Option<Hit> {
        self.search(to, |_| true, |_| true)
    }

    /// The same among faces whose normal is less than 90° off `normal`.
    pub fn nearest_facing(&self, to: DVec3, normal: DVec3) -> Option<Hit> {
        self.search(to, |node| node.may_face(normal), |place| self.normals[place].dot(normal) > 0.0)
    }

    /// The nearest point in the nodes and at the places of the tree that are wanted.
    fn search(&self, to: DVec3, node: impl Fn(&Node) -> bool, place: impl Fn(usize) -> bool) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        let mut stack = Vec::with_capacity(64);
        if let Some(root) = self.nodes.first() {
            stack.push((0_u32, root.squared(to)));
        }
        while let Some((number, gap)) = stack.pop() {
            let here = self.nodes[number as usize];
            if best.is_some_and(|best| gap > best.squared) || !node(&here) {
                continue;
            }
            if here.second == 0 {
                let wanted = (here.from as usize..here.to as usize).filter(|&at| place(at));
                best = wanted.map(|at| self.hit(at, to)).chain(best).min_by(Hit::order);
                continue;
            }
            let children = [number + 1, here.second].map(|n| (n, self.nodes[n as usize].squared(to)));
            let [near, far] = if children[1].1 < children[0].1 { [children[1], children[0]] } else { children };
            stack.push(far);
            stack.push(near);
        }
        best
    }

    /// The nearest point of the face at a place of the tree.
    fn hit(&self, place: usize, to: DVec3) -> Hit {
        let corners = self.triangles[place];
        let shares = nearest_in_triangle(to, corners);
        let point = corners[0] * shares[0] + corners[1] * shares[1] + corners[2] * shares[2];
        Hit { face: self.numbers[place], shares, point, squared: point.distance_squared(to) }
    }
}

/// The least and the greatest coordinates.
fn bounds(points: impl Iterator<Item = DVec3>) -> [DVec3; 2] {
    points.fold([DVec3::INFINITY, DVec3::NEG_INFINITY], |[low, high], p| [low.min(p), high.max(p)])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_asking_all_faces() {
        let mut state = 5_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / (1_u64 << 24) as f64
        };
        let mut point = |size: f64| size * DVec3::new(next(), next(), next());
        let mut positions = Vec::new();
        for _ in 0..150 {
            let at = point(1.0);
            positions.extend([at, at + point(0.2), at + point(0.2)]);
        }
        // A flat face and one that is a point.
        positions[4] = positions[3];
        positions[7] = positions[6];
        positions[8] = positions[6];
        let faces: Vec<[u32; 3]> = (0..150).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
        let odd = |f: u32| f % 2 == 1;
        let trees = [Bvh::new(&faces, &positions, |_| true), Bvh::new(&faces, &positions, odd)];
        for _ in 0..200 {
            let (to, normal) = (point(1.2), point(1.0) - DVec3::splat(0.5));
            for tree in &trees {
                let hit = |at: &usize| tree.hit(*at, to);
                let all = || 0..tree.numbers.len();
                let facing = |at: &usize| tree.normals[*at].dot(normal) > 0.0;
                assert_eq!(tree.nearest(to), all().map(|at| hit(&at)).min_by(Hit::order));
                assert_eq!(tree.nearest_facing(to, normal), all().filter(facing).map(|at| hit(&at)).min_by(Hit::order));
            }
            assert!(trees[1].nearest(to).is_some_and(|hit| odd(hit.face)));
            assert_eq!(trees[0].nearest_facing(to, DVec3::ZERO), None);
        }
        assert_eq!(Bvh::new(&faces, &positions, |_| false).nearest(DVec3::ZERO), None);
    }

    #[test]
    fn a_sheet_is_not_searched_for_what_faces_away() {
        let side = 40_u32;
        let at = |i: u32| DVec3::new(f64::from(i % side), 0.01 * f64::from((i * i) % 7), f64::from(i / side));
        let positions: Vec<DVec3> = (0..side * side).map(at).collect();
        let corner = |i: u32| i % side + 1 < side && i / side + 1 < side;
        let faces: Vec<[u32; 3]> = (0..side * side).filter(|&i| corner(i)).map(|i| [i, i + side, i + 1]).collect();
        let tree = Bvh::new(&faces, &positions, |_| true);
        let asked = std::cell::Cell::new(0);
        let counted = |node: &Node| {
            asked.set(asked.get() + 1);
            node.may_face(DVec3::NEG_Y)
        };
        assert_eq!(tree.search(DVec3::ONE, counted, |_| true), None);
        assert!(asked.get() <= 3, "{} nodes", asked.get());
        assert!(tree.nearest_facing(DVec3::ONE, DVec3::Y).is_some());
    }
}
