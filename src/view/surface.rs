//! The surface as the shaders take it: corners that share a normal share a drawn vertex, and edges know the faces
//! on them.
//!
//! Vertices that stand at the same place in every shape count as one here, so that a seam of the file is no seam
//! in the picture; sharp edges keep two normals.

use super::motion::Motion;
use super::normals;
use glam::Vec3;

/// Faces whose normals differ by less than this (cosine of 50°) across an edge are shaded as one smooth surface.
const SMOOTH: f32 = 0.643;

/// Connectivity for drawing.
#[derive(Clone, Debug, Default)]
pub struct Surface {
    /// #F triples of drawn vertices.
    pub corners: Vec<[u32; 3]>,
    /// The mesh vertex of each drawn vertex.
    pub vertex: Vec<u32>,
    /// The group of corners with one normal that each drawn vertex belongs to.
    group: Vec<u32>,
    groups: usize,
    /// The mesh vertex that stands for all at the same place.
    place: Vec<u32>,
    /// Half-edges 3·face + corner (from that corner to the next), those of one edge after one another.
    half_edges: Vec<u32>,
    /// Where each edge begins in `half_edges`, and the end.
    edges: Vec<u32>,
}

impl Surface {
    /// The surface of a motion with all its poses.
    pub fn new(motion: &Motion) -> Self {
        let faces = motion.faces();
        let place = places(motion);
        let placed: Vec<[u32; 3]> = faces.iter().map(|f| f.map(|v| place[v as usize])).collect();
        let (corner_group, groups) = smooth_groups(&placed, motion.shape(0));
        // A drawn vertex for each pair of vertex and group, in the order of the pairs.
        let mut pairs: Vec<(u32, u32, u32)> = faces
            .iter()
            .flatten()
            .zip(&corner_group)
            .enumerate()
            .map(|(corner, (&vertex, &group))| (vertex, group, corner as u32))
            .collect();
        pairs.sort_unstable();
        let mut surface = Self {
            corners: vec![[0; 3]; faces.len()],
            groups,
            place,
            half_edges: Vec::new(),
            edges: Vec::new(),
            ..Self::default()
        };
        for (vertex, group, corner) in pairs {
            if surface.vertex.last() != Some(&vertex) || surface.group.last() != Some(&group) {
                surface.vertex.push(vertex);
                surface.group.push(group);
            }
            surface.corners[corner as usize / 3][corner as usize % 3] = surface.vertex.len() as u32 - 1;
        }
        (surface.half_edges, surface.edges) = edges(&placed);
        surface
    }

    /// Packed normals of the drawn vertices in a shape with `positions`.
    pub fn normals(&self, faces: &[[u32; 3]], positions: &[Vec3]) -> Vec<u32> {
        let group_of = |f: usize, c: usize| self.group[self.corners[f][c] as usize] as usize;
        let packed = normals::smooth(faces, positions, self.groups, group_of);
        self.group.iter().map(|&g| packed[g as usize]).collect()
    }

    /// The faces on each edge, as half-edges 3·face + corner.
    pub fn edges(&self) -> impl Iterator<Item = &[u32]> {
        self.edges.windows(2).map(|w| &self.half_edges[w[0] as usize..w[1] as usize])
    }

    /// For each face six bits: bit i where the edge from corner i to the next is on a boundary between `labels`
    /// (#F), bit 3 + i where corner i is an end of such an edge.
    pub fn boundary_bits(&self, faces: &[[u32; 3]], labels: &[u32]) -> Vec<u8> {
        let mut bits = vec![0_u8; faces.len()];
        let mut ends = vec![false; self.place.len()];
        let label = |half: u32| labels.get(half as usize / 3);
        for edge in self.edges() {
            if edge.windows(2).all(|w| label(w[0]) == label(w[1])) {
                continue;
            }
            for &half in edge {
                let (face, corner) = (half as usize / 3, half as usize % 3);
                bits[face] |= 1 << corner;
                for v in [faces[face][corner], faces[face][(corner + 1) % 3]] {
                    ends[self.place[v as usize] as usize] = true;
                }
            }
        }
        for (bits, face) in bits.iter_mut().zip(faces) {
            for (i, &v) in face.iter().enumerate() {
                *bits |= u8::from(ends[self.place[v as usize] as usize]) << (3 + i);
            }
        }
        bits
    }

    /// For each of `count` labels the other labels that it has an edge with, ascending.
    pub fn label_neighbours(&self, labels: &[u32], count: usize) -> Vec<Vec<usize>> {
        let mut neighbours = vec![Vec::new(); count];
        let label = |half: u32| labels.get(half as usize / 3).map(|&l| l as usize).filter(|&l| l < count);
        for edge in self.edges() {
            for w in edge.windows(2) {
                if let (Some(a), Some(b)) = (label(w[0]), label(w[1]))
                    && a != b
                {
                    neighbours[a].push(b);
                    neighbours[b].push(a);
                }
            }
        }
        for n in &mut neighbours {
            n.sort_unstable();
            n.dedup();
        }
        neighbours
    }
}

/// For each vertex the first one that stands at the same place in every shape.
fn places(motion: &Motion) -> Vec<u32> {
    let reference = motion.shape(0);
    let key = |v: u32| reference[v as usize].to_array().map(f32::to_bits);
    let mut order: Vec<u32> = (0..reference.len() as u32).collect();
    order.sort_unstable_by_key(|&v| (key(v), v));
    let mut place: Vec<u32> = (0..reference.len() as u32).collect();
    let mut first = 0;
    for i in 1..order.len() {
        if key(order[i]) != key(order[first]) {
            first = i;
            continue;
        }
        let (a, b) = (order[first] as usize, order[i] as usize);
        if (1..=motion.poses()).all(|s| motion.shape(s)[a] == motion.shape(s)[b]) {
            place[b] = a as u32;
        }
    }
    place
}

/// For each corner (3·#F) the group of corners with which it shares a normal, and the number of groups. Corners at
/// one place share a normal if a chain of faces around it connects them over edges that are not sharp.
fn smooth_groups(placed: &[[u32; 3]], positions: &[Vec3]) -> (Vec<u32>, usize) {
    let normal: Vec<Vec3> = placed
        .iter()
        .map(|f| {
            let [a, b, c] = f.map(|v| positions[v as usize]);
            (b - a).cross(c - a).normalize_or_zero()
        })
        .collect();
    let mut around: Vec<(u32, u32)> =
        placed.iter().flatten().enumerate().map(|(corner, &v)| (v, corner as u32)).collect();
    around.sort_unstable();
    let mut group = vec![0; 3 * placed.len()];
    let mut groups = 0;
    for fan in around.chunk_by(|a, b| a.0 == b.0) {
        let mut root: Vec<usize> = (0..fan.len()).collect();
        for i in 0..fan.len() {
            for j in 0..i {
                let (f, g) = (fan[i].1 as usize / 3, fan[j].1 as usize / 3);
                let share = placed[f].iter().any(|&v| v != fan[0].0 && placed[g].contains(&v));
                let flat = normal[f] == Vec3::ZERO || normal[g] == Vec3::ZERO;
                if share && (flat || normal[f].dot(normal[g]) > SMOOTH) {
                    let (from, to) = (root[i], root[j]);
                    root.iter_mut().filter(|r| **r == from).for_each(|r| *r = to);
                }
            }
        }
        for (i, &(_, corner)) in fan.iter().enumerate() {
            if root[i] == i {
                group[corner as usize] = groups;
                groups += 1;
            }
        }
        for (i, &(_, corner)) in fan.iter().enumerate() {
            group[corner as usize] = group[fan[root[i]].1 as usize];
        }
    }
    (group, groups as usize)
}

/// Half-edges sorted by edge, and where each edge begins.
fn edges(placed: &[[u32; 3]]) -> (Vec<u32>, Vec<u32>) {
    let key = |half: u32| {
        let f = placed[half as usize / 3];
        let (a, b) = (f[half as usize % 3], f[(half as usize + 1) % 3]);
        (a.min(b), a.max(b))
    };
    let mut half: Vec<u32> = (0..3 * placed.len() as u32).collect();
    half.sort_unstable_by_key(|&h| (key(h), h));
    let mut starts: Vec<u32> =
        (0..half.len()).filter(|&i| i == 0 || key(half[i - 1]) != key(half[i])).map(|i| i as u32).collect();
    starts.push(half.len() as u32);
    (half, starts)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::normals::unpack;

    /// Two triangles that share an edge by place, not by number; `z` bends the second.
    fn seam(z: f32) -> Motion {
        let reference =
            [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, z], [0.0, 1.0, 0.0]];
        Motion::new(&[0, 1, 2, 3, 4, 5], reference.as_flattened()).unwrap()
    }

    #[test]
    fn a_seam_is_invisible() {
        let motion = seam(0.2);
        let surface = Surface::new(&motion);
        let n = surface.normals(motion.faces(), motion.shape(0));
        assert_eq!(n[surface.corners[0][1] as usize], n[surface.corners[1][0] as usize]);
        assert_eq!(surface.boundary_bits(motion.faces(), &[0, 1]), [0b110_010, 0b101_100]);
        assert_eq!(surface.boundary_bits(motion.faces(), &[4, 4]), [0, 0]);
        assert_eq!(surface.label_neighbours(&[0, 2], 3), [vec![2], vec![], vec![0]]);
    }

    #[test]
    fn a_seam_that_opens_in_a_pose_is_a_gap() {
        let mut motion = seam(0.0);
        let mut pose: Vec<f32> = motion.shape(0).iter().flat_map(|p| p.to_array()).collect();
        pose[9] += 1.0;
        motion.set_poses(&pose).unwrap();
        let bits = Surface::new(&motion).boundary_bits(motion.faces(), &[0, 1]);
        assert_eq!(bits, [0, 0]);
    }

    #[test]
    fn a_cube_keeps_its_edges() {
        let corner = |i: u32| [(i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32];
        let reference: Vec<f32> = (0..8).flat_map(corner).collect();
        let faces = [
            0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5,
        ];
        let motion = Motion::new(&faces, &reference).unwrap();
        let surface = Surface::new(&motion);
        assert_eq!(surface.vertex.len(), 24);
        for n in surface.normals(motion.faces(), motion.shape(0)) {
            assert!((unpack(n).abs().max_element() - 1.0).abs() < 1e-3, "{}", unpack(n));
        }
        assert_eq!(surface.edges().count(), 18);
        assert!(surface.edges().all(|e| e.len() == 2));
    }

    #[test]
    fn three_faces_on_one_edge() {
        let reference = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.0, 0.0, 1.0]];
        let motion = Motion::new(&[0, 1, 2, 1, 0, 3, 0, 1, 4], reference.as_flattened()).unwrap();
        let bits = Surface::new(&motion).boundary_bits(motion.faces(), &[0, 0, 1]);
        assert_eq!(bits.iter().map(|b| b & 7).collect::<Vec<_>>(), [1, 1, 1]);
    }

    #[test]
    fn an_empty_mesh() {
        let motion = Motion::default();
        let surface = Surface::new(&motion);
        assert_eq!(surface.edges().count(), 0);
        assert!(surface.boundary_bits(&[], &[]).is_empty());
    }
}
