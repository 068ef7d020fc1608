//! The nearest point of a triangle mesh, by a hierarchy of bounding boxes.

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

/// Triangles in a binary tree of boxes.
#[derive(Clone, Debug, Default)]
pub struct Bvh {
    nodes: Vec<Node>,
    /// The corners of the faces in the order of the tree, and their numbers.
    triangles: Vec<[DVec3; 3]>,
    numbers: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Node {
    low: DVec3,
    high: DVec3,
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
}

impl Bvh {
    /// Builds the tree over #F faces of vertices at finite positions.
    pub fn new(faces: &[[u32; 3]], positions: &[DVec3]) -> Self {
        let centroids = face::centroids(faces, positions);
        let mut numbers: Vec<u32> = (0..faces.len() as u32).collect();
        let mut nodes = Vec::with_capacity(faces.len());
        // Places still to be boxed, and the node whose second child they are.
        let mut stack = vec![(0, faces.len(), None)];
        while let Some((from, to, parent)) = stack.pop() {
            if from == to {
                continue;
            }
            let own: &mut [u32] = &mut numbers[from..to];
            let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
            for p in own.iter().flat_map(|&f| face::corners(positions, faces[f as usize])) {
                (low, high) = (low.min(p), high.max(p));
            }
            let number = nodes.len() as u32;
            if let Some(parent) = parent {
                let parent: &mut Node = &mut nodes[parent as usize];
                parent.second = number;
            }
            nodes.push(Node { low, high, from: from as u32, to: to as u32, second: 0 });
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
        Self { nodes, triangles, numbers }
    }

    /// The nearest point of the faces that are `wanted`; `None` if there is none. Of equally near faces the one with
    /// the lowest number.
    pub fn nearest(&self, to: DVec3, wanted: impl Fn(u32) -> bool) -> Option<Hit> {
        let mut best: Option<Hit> = None;
        let mut stack = Vec::with_capacity(64);
        if let Some(root) = self.nodes.first() {
            stack.push((0_u32, root.squared(to)));
        }
        while let Some((number, gap)) = stack.pop() {
            if best.is_some_and(|best| gap > best.squared) {
                continue;
            }
            let node = self.nodes[number as usize];
            if node.second == 0 {
                self.try_faces(node.from as usize..node.to as usize, to, &wanted, &mut best);
                continue;
            }
            let children = [number + 1, node.second].map(|n| (n, self.nodes[n as usize].squared(to)));
            let [near, far] = if children[1].1 < children[0].1 { [children[1], children[0]] } else { children };
            stack.push(far);
            stack.push(near);
        }
        best
    }

    fn try_faces(
        &self,
        places: std::ops::Range<usize>,
        to: DVec3,
        wanted: &impl Fn(u32) -> bool,
        best: &mut Option<Hit>,
    ) {
        for (corners, &face) in self.triangles[places.clone()].iter().zip(&self.numbers[places]) {
            let shares = nearest_in_triangle(to, *corners);
            let point = corners[0] * shares[0] + corners[1] * shares[1] + corners[2] * shares[2];
            let squared = point.distance_squared(to);
            let better = best.is_none_or(|best| (squared, face) < (best.squared, best.face));
            if better && wanted(face) {
                *best = Some(Hit { face, shares, point, squared });
            }
        }
    }
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
        let tree = Bvh::new(&faces, &positions);
        for _ in 0..200 {
            let to = point(1.2);
            let odd = |f: u32| f % 2 == 1;
            let all = Bvh { nodes: Vec::new(), ..tree.clone() };
            let mut expected = None;
            all.try_faces(0..150, to, &odd, &mut expected);
            assert_eq!(tree.nearest(to, odd), expected);
            let hit = tree.nearest(to, |_| true).expect("a face");
            assert!((hit.point.distance_squared(to) - hit.squared).abs() < 1e-15);
        }
        assert_eq!(tree.nearest(DVec3::ZERO, |_| false), None);
        assert_eq!(Bvh::new(&[], &[]).nearest(DVec3::ZERO, |_| true), None);
    }
}
