//! Normals for shading, and their packing into 32 bits.
//!
//! The packing maps the octahedron to a square: Z. Cigolle et al., *A survey of efficient representations for
//! independent unit vectors*, Journal of Computer Graphics Techniques 3(2), 2014.

use glam::{Vec2, Vec3};

/// Packs a direction into two signed 16-bit numbers, x in the low half; up (y) for a vector without direction.
pub fn pack(direction: Vec3) -> u32 {
    let sum = direction.abs().element_sum();
    let n = if sum > 0.0 && sum.is_finite() { direction / sum } else { Vec3::Y };
    let folded = if n.z >= 0.0 { n.truncate() } else { (Vec2::ONE - Vec2::new(n.y, n.x).abs()) * signs(n) };
    let byte = |x: f32| u32::from((x.clamp(-1.0, 1.0) * 32767.0).round() as i16 as u16);
    byte(folded.x) | byte(folded.y) << 16
}

/// The direction that was packed, of length 1. The shaders do the same.
pub fn unpack(packed: u32) -> Vec3 {
    let number = |bits: u32| f32::from(bits as u16 as i16) / 32767.0;
    let (x, y) = (number(packed), number(packed >> 16));
    let z = 1.0 - x.abs() - y.abs();
    let xy = Vec2::new(x, y);
    let flat = if z >= 0.0 { xy } else { (Vec2::ONE - Vec2::new(y, x).abs()) * signs(xy.extend(z)) };
    flat.extend(z).normalize_or(Vec3::Y)
}

/// −1 or 1 for x and y.
fn signs(n: Vec3) -> Vec2 {
    Vec2::new(if n.x < 0.0 { -1.0 } else { 1.0 }, if n.y < 0.0 { -1.0 } else { 1.0 })
}

/// Area-weighted normals, one for each of `groups` groups of corners, packed.
///
/// `faces` is #F triples of vertex numbers into `positions`; `group_of(face, corner)` tells the group.
pub fn smooth(
    faces: &[[u32; 3]],
    positions: &[Vec3],
    groups: usize,
    group_of: impl Fn(usize, usize) -> usize,
) -> Vec<u32> {
    let mut sums = vec![Vec3::ZERO; groups];
    for (f, corners) in faces.iter().enumerate() {
        let [Some(&a), Some(&b), Some(&c)] = corners.map(|v| positions.get(v as usize)) else { continue };
        let area = (b - a).cross(c - a);
        for corner in 0..3 {
            if let Some(sum) = sums.get_mut(group_of(f, corner)) {
                *sum += area;
            }
        }
    }
    sums.into_iter().map(pack).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn packing_loses_little() {
        for i in 0..5000 {
            // A spiral over the sphere.
            let z = 1.0 - 2.0 * (i as f32 + 0.5) / 5000.0;
            let (sin, cos) = (i as f32 * 2.399_963).sin_cos();
            let r = (1.0 - z * z).sqrt();
            let n = Vec3::new(r * cos, r * sin, z);
            assert!(unpack(pack(n)).distance(n) < 1e-4, "{n}");
            assert!(unpack(pack(n * 1e-20)).distance(n) < 1e-4, "length must not matter");
        }
        for axis in [Vec3::X, Vec3::NEG_X, Vec3::Y, Vec3::NEG_Y, Vec3::Z, Vec3::NEG_Z] {
            assert!(unpack(pack(axis)).distance(axis) < 1e-4, "{axis}");
        }
    }

    #[test]
    fn what_has_no_direction_points_up() {
        for n in [Vec3::ZERO, Vec3::NAN, Vec3::INFINITY] {
            assert!(unpack(pack(n)).distance(Vec3::Y) < 1e-4);
        }
    }

    #[test]
    fn every_bit_pattern_is_a_direction() {
        for i in 0..100_000_u32 {
            assert!(unpack(i.wrapping_mul(2_654_435_761)).is_normalized());
        }
    }

    #[test]
    fn an_octahedron_points_outwards() {
        let p = [Vec3::X, Vec3::Y, Vec3::Z, Vec3::NEG_X, Vec3::NEG_Y, Vec3::NEG_Z];
        let faces = [[0, 1, 2], [1, 3, 2], [3, 4, 2], [4, 0, 2], [1, 0, 5], [3, 1, 5], [4, 3, 5], [0, 4, 5]];
        for (v, n) in smooth(&faces, &p, 6, |f, c| faces[f][c] as usize).into_iter().enumerate() {
            assert!(unpack(n).distance(p[v]) < 1e-3);
        }
    }
}
