//! From a field to a closed triangle mesh: marching tetrahedra on a sparse grid.
//!
//! Cubes are cut into six tetrahedra by Todd's triangulation J₁ (*The Computation of Fixed Points and
//! Applications*, Springer 1976, §III.2): every tetrahedron is a path from the cube's all-even corner to its
//! all-odd corner. Neighbouring cubes are mirror images, so their tetrahedra fit, the surface is a closed
//! manifold whatever the field, and a symmetric field gives a symmetric mesh.
//!
//! A box is looked into only if the field may vanish in it; every box hands the cones that matter to its
//! children, so a cell costs the same however complicated the body is.

use super::field::{Field, STEEPNESS, Value};
use glam::{DVec3, I64Vec3};

/// Cells along the side of a smallest box.
const BLOCK: i64 = 2;
/// Grid points along the side of a smallest box.
const POINTS: usize = BLOCK as usize + 1;
/// Bits of a coordinate in a packed key.
const BITS: u32 = 21;
/// What is added to a coordinate before packing, so that it is not negative.
const OFFSET: i64 = 1 << (BITS - 2);
/// The axes in every order: the six tetrahedra of a cube.
const PATHS: [[usize; 3]; 6] = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];

/// A triangle mesh as it comes from a field, and the boxes that know which cones matter where.
pub struct Extracted {
    /// Positions.
    pub positions: Vec<DVec3>,
    /// Triples of position numbers, counter-clockwise from outside.
    pub faces: Vec<[u32; 3]>,
    /// Quick access to the field near the surface.
    pub atlas: Atlas,
}

/// Which cones matter where: quick values of the field near its surface.
pub struct Atlas {
    cell: f64,
    /// Sorted by key: the box's packed position, and its cones as a range of `cones`.
    boxes: Vec<(u64, u32, u32)>,
    cones: Vec<u32>,
    all: Vec<u32>,
}

impl Atlas {
    /// The field at a point.
    pub fn value(&self, field: &Field, p: DVec3) -> Value {
        let at = (p / (self.cell * BLOCK as f64)).floor().as_i64vec3();
        match self.boxes.binary_search_by_key(&pack(at), |b| b.0) {
            Ok(found) => {
                let (_, start, end) = self.boxes[found];
                field.value(&self.cones[start as usize..end as usize], p)
            }
            Err(_) => field.value(&self.all, p),
        }
    }
}

/// The zero surface of a field on a grid of the given cell size.
///
/// Only surfaces more than a cell thick are sure to be found whole.
pub fn extract(field: &Field, cell: f64) -> Extracted {
    let mut work = Work { field, cell, boxes: Vec::new(), cones: Vec::new(), crossings: Vec::new() };
    let (low, high) = field.bounds();
    let reach = low.abs().max(high.abs()).max_element() / cell + 2.0;
    let mut half = BLOCK;
    while (half as f64) < reach {
        half *= 2;
    }
    let all = field.all();
    for octant in 0..8 {
        work.visit(corner(octant) * half - I64Vec3::splat(half), half, &all);
    }
    let Work { mut boxes, cones, crossings, .. } = work;
    boxes.sort_unstable();
    let (positions, faces) = weld(crossings);
    Extracted { positions, faces, atlas: Atlas { cell, boxes, cones, all } }
}

struct Work<'a> {
    field: &'a Field,
    cell: f64,
    boxes: Vec<(u64, u32, u32)>,
    cones: Vec<u32>,
    /// Three in a row make a triangle: the crossed edge's key and where it is crossed.
    crossings: Vec<(u64, DVec3)>,
}

impl Work<'_> {
    /// Looks into the box with its lowest corner at `low`, `size` cells wide.
    fn visit(&mut self, low: I64Vec3, size: i64, among: &[u32]) {
        let half = 0.5 * size as f64 * self.cell;
        let centre = low.as_dvec3() * self.cell + half;
        let reach = half * 3f64.sqrt();
        let (kept, distance) = self.field.narrow(among, centre, reach);
        if distance.abs() > STEEPNESS * reach {
            return;
        }
        if size > BLOCK {
            for octant in 0..8 {
                self.visit(low + corner(octant) * (size / 2), size / 2, &kept);
            }
        } else {
            self.march(low, &kept);
            let start = self.cones.len() as u32;
            self.cones.extend_from_slice(&kept);
            self.boxes.push((pack(low.div_euclid(I64Vec3::splat(BLOCK))), start, self.cones.len() as u32));
        }
    }

    /// Emits the triangles of a smallest box.
    fn march(&mut self, low: I64Vec3, among: &[u32]) {
        let mut values = [0.0; POINTS * POINTS * POINTS];
        for (number, value) in values.iter_mut().enumerate() {
            let (i, j, k) = (number % POINTS, number / POINTS % POINTS, number / (POINTS * POINTS));
            let at = (low + I64Vec3::new(i as i64, j as i64, k as i64)).as_dvec3() * self.cell;
            *value = self.field.value(among, at).distance;
        }
        let value = |p: I64Vec3| {
            let q = p - low;
            values[q.x as usize + POINTS * (q.y as usize + POINTS * q.z as usize)]
        };
        for cube in 0..BLOCK * BLOCK * BLOCK {
            let base = low + I64Vec3::new(cube % BLOCK, cube / BLOCK % BLOCK, cube / (BLOCK * BLOCK));
            let inside = (0..8).filter(|&c| value(base + corner(c)) < 0.0).count();
            if inside == 0 || inside == 8 {
                continue;
            }
            // From the even corner every axis leads to the odd one.
            let even = base + (base & I64Vec3::ONE);
            let step = I64Vec3::ONE - 2 * (base & I64Vec3::ONE);
            for path in PATHS {
                let mut corners = [even; 4];
                for (i, axis) in path.into_iter().enumerate() {
                    corners[i + 1] = corners[i];
                    corners[i + 1][axis] += step[axis];
                }
                let right_handed = is_right_handed(path) == (step.x * step.y * step.z > 0);
                if !right_handed {
                    corners.swap(2, 3);
                }
                self.tetrahedron(corners, corners.map(value));
            }
        }
    }

    /// Emits the triangles in a tetrahedron whose corners are in right-handed order.
    fn tetrahedron(&mut self, corners: [I64Vec3; 4], values: [f64; 4]) {
        // Even permutations that bring the inside corners to the front.
        let inside = |i: usize| values[i] < 0.0;
        let count = (0..4).filter(|&i| inside(i)).count();
        let mut cross = |i: usize, j: usize| {
            let (a, b, fa, fb) = if pack(corners[i]) < pack(corners[j]) {
                (corners[i], corners[j], values[i], values[j])
            } else {
                (corners[j], corners[i], values[j], values[i])
            };
            let t = (fa / (fa - fb)).clamp(0.02, 0.98);
            let at = (a.as_dvec3() * (1.0 - t) + b.as_dvec3() * t) * self.cell;
            self.crossings.push((pack(a + b), at));
        };
        let single = |wanted: bool| {
            let first = (0..4).find(|&i| inside(i) == wanted).unwrap_or(0);
            [[0, 1, 2, 3], [1, 0, 3, 2], [2, 0, 1, 3], [3, 0, 2, 1]][first]
        };
        match count {
            1 => {
                let [a, b, c, d] = single(true);
                [b, c, d].into_iter().for_each(|other| cross(a, other));
            }
            3 => {
                let [a, b, c, d] = single(false);
                [b, d, c].into_iter().for_each(|other| cross(a, other));
            }
            2 => {
                let pairs = [[0, 1, 2, 3], [0, 2, 3, 1], [0, 3, 1, 2], [1, 2, 0, 3], [1, 3, 2, 0], [2, 3, 0, 1]];
                let [a, b, c, d] = pairs.into_iter().find(|p| inside(p[0]) && inside(p[1])).unwrap_or([0, 1, 2, 3]);
                for (from, to) in [(a, c), (a, d), (b, d), (a, c), (b, d), (b, c)] {
                    cross(from, to);
                }
            }
            _ => {}
        }
    }
}

/// Joins crossings of the same edge.
fn weld(crossings: Vec<(u64, DVec3)>) -> (Vec<DVec3>, Vec<[u32; 3]>) {
    let mut order: Vec<(u64, u32)> = crossings.iter().zip(0..).map(|(c, i)| (c.0, i)).collect();
    order.sort_unstable();
    let mut positions: Vec<DVec3> = Vec::with_capacity(crossings.len() / 6);
    let mut numbers = vec![0u32; crossings.len()];
    let mut last = None;
    for (key, i) in order {
        if last != Some(key) {
            positions.push(crossings[i as usize].1);
            last = Some(key);
        }
        numbers[i as usize] = positions.len() as u32 - 1;
    }
    (positions, numbers.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect())
}

/// The `c`-th corner of the unit cube.
fn corner(c: i64) -> I64Vec3 {
    I64Vec3::new(c & 1, c >> 1 & 1, c >> 2 & 1)
}

/// Grid points (or sums of two) as one number.
fn pack(p: I64Vec3) -> u64 {
    let bits = |c: i64| (c + OFFSET) as u64 & ((1 << BITS) - 1);
    bits(p.z) << (2 * BITS) | bits(p.y) << BITS | bits(p.x)
}

fn is_right_handed(path: [usize; 3]) -> bool {
    matches!(path, [0, 1, 2] | [1, 2, 0] | [2, 0, 1])
}
