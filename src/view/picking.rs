//! Which face lies under a line of sight.
//!
//! T. Möller, B. Trumbore, *Fast, minimum storage ray/triangle intersection*, Journal of Graphics Tools 2(1), 1997.

use super::camera::Ray;
use glam::Vec3;

/// A point on the surface.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// The face.
    pub face: u32,
    /// Weights of its corners; they add up to 1.
    pub weights: [f32; 3],
    /// The point.
    pub point: Vec3,
}

/// The face that `ray` meets first, from either side.
///
/// `faces` is #F triples of vertex numbers, `positions` #V points; faces that name other vertices are passed over.
pub fn pick(ray: Ray, faces: &[[u32; 3]], positions: &[Vec3]) -> Option<Hit> {
    let mut nearest = f32::INFINITY;
    let mut found = None;
    for (face, corners) in faces.iter().enumerate() {
        let [Some(&a), Some(&b), Some(&c)] = corners.map(|v| positions.get(v as usize)) else { continue };
        if let Some((t, u, v)) = meet(ray, a, b, c)
            && t < nearest
        {
            nearest = t;
            found = Some((face as u32, u, v));
        }
    }
    found.map(|(face, u, v)| Hit { face, weights: [1.0 - u - v, u, v], point: ray.origin + ray.direction * nearest })
}

/// Length along the ray and the weights of `b` and `c` where the ray meets the triangle.
fn meet(ray: Ray, a: Vec3, b: Vec3, c: Vec3) -> Option<(f32, f32, f32)> {
    let (ab, ac) = (b - a, c - a);
    let across = ray.direction.cross(ac);
    let determinant = ab.dot(across);
    if determinant == 0.0 {
        return None;
    }
    let inverse = 1.0 / determinant;
    let from = ray.origin - a;
    let u = from.dot(across) * inverse;
    if !(0.0..=1.0).contains(&u) {
        return None;
    }
    let side = from.cross(ab);
    let v = ray.direction.dot(side) * inverse;
    let t = ac.dot(side) * inverse;
    // Also false when a number is not finite, as with slivers.
    (v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < f32::INFINITY).then_some((t, u, v))
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use proptest::prelude::*;

    /// The same by planes and edge functions in double precision; also tells how near the ray comes to an edge.
    fn brute(ray: Ray, faces: &[[u32; 3]], positions: &[Vec3]) -> (Option<(u32, f64)>, f64) {
        let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        let mut best: Option<(u32, f64)> = None;
        let mut margin = f64::INFINITY;
        for (f, corners) in faces.iter().enumerate() {
            let [a, b, c] = corners.map(|v| positions[v as usize].as_dvec3());
            let normal = (b - a).cross(c - a);
            let t = (a - o).dot(normal) / d.dot(normal);
            let p = o + d * t;
            let inside = |a: DVec3, b: DVec3| (b - a).cross(p - a).dot(normal) / normal.length_squared();
            let least = inside(a, b).min(inside(b, c)).min(inside(c, a));
            if !t.is_finite() || t < 0.0 {
                continue;
            }
            margin = margin.min(least.abs());
            if least >= 0.0 && best.is_none_or(|(_, other)| t < other) {
                best = Some((f as u32, t));
            }
        }
        (best, margin)
    }

    fn point() -> impl Strategy<Value = Vec3> {
        (-1.0f32..1.0, -1.0f32..1.0, -1.0f32..1.0).prop_map(|(x, y, z)| Vec3::new(x, y, z))
    }

    proptest! {
        #[test]
        fn agrees_with_brute_force(
            positions in prop::collection::vec(point(), 12),
            corners in prop::collection::vec([0u32..12, 0u32..12, 0u32..12], 1..40),
            aim in point(),
        ) {
            let faces: Vec<_> = corners.into_iter().filter(crate::mesh::face::is_whole).collect();
            let origin = Vec3::new(0.3, 0.2, 4.0);
            let ray = Ray { origin, direction: (aim * 0.7 - origin).normalize() };
            let (expected, margin) = brute(ray, &faces, &positions);
            prop_assume!(margin > 1e-4);
            let found = pick(ray, &faces, &positions);
            prop_assert_eq!(found.is_some(), expected.is_some());
            if let (Some(hit), Some((_, t))) = (found, expected) {
                prop_assert!((f64::from(hit.point.distance(origin)) - t).abs() < 1e-3);
                let corners = faces[hit.face as usize].map(|v| positions[v as usize]);
                let point: Vec3 = corners.iter().zip(hit.weights).map(|(&p, w)| p * w).sum();
                prop_assert!(point.distance(hit.point) < 1e-3);
            }
        }
    }

    #[test]
    fn nearest_of_two_and_nothing_behind() {
        let positions: Vec<Vec3> = [-1.0, 1.0, 9.0]
            .iter()
            .flat_map(|&z| [Vec3::new(-1.0, -1.0, z), Vec3::new(2.0, -1.0, z), Vec3::new(-1.0, 2.0, z)])
            .collect();
        let faces = [[0, 1, 2], [3, 4, 5], [6, 7, 8], [0, 1, 99]];
        let ray = Ray { origin: Vec3::new(0.0, 0.0, 5.0), direction: Vec3::NEG_Z };
        let hit = pick(ray, &faces, &positions).unwrap();
        assert_eq!(hit.face, 1);
        assert!(hit.point.distance(Vec3::new(0.0, 0.0, 1.0)) < 1e-6);
        assert_eq!(pick(ray, &[], &positions), None);
        assert_eq!(pick(ray, &[[0, 0, 0]], &positions), None, "a face without area");
    }
}
