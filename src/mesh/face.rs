//! Areas, normals, centroids and nearest points of triangles.

use glam::DVec3;

/// The three corners of a face.
pub fn corners(positions: &[DVec3], face: [u32; 3]) -> [DVec3; 3] {
    face.map(|v| positions[v as usize])
}

/// Whether a face names three different vertices.
pub fn is_whole(&[a, b, c]: &[u32; 3]) -> bool {
    a != b && b != c && c != a
}

/// Normal whose length is twice the area, counter-clockwise side.
pub fn double_area_normal([a, b, c]: [DVec3; 3]) -> DVec3 {
    (b - a).cross(c - a)
}

/// Area of a triangle.
pub fn area(triangle: [DVec3; 3]) -> f64 {
    0.5 * double_area_normal(triangle).length()
}

/// Centroid of a triangle.
pub fn centroid([a, b, c]: [DVec3; 3]) -> DVec3 {
    (a + b + c) / 3.0
}

/// #F areas.
pub fn areas(faces: &[[u32; 3]], positions: &[DVec3]) -> Vec<f64> {
    faces.iter().map(|&f| area(corners(positions, f))).collect()
}

/// #V unit normals, means over the faces around by their areas; zero where there is none.
pub fn vertex_normals(faces: &[[u32; 3]], positions: &[DVec3]) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; positions.len()];
    for &face in faces {
        let normal = double_area_normal(corners(positions, face));
        face.iter().for_each(|&v| normals[v as usize] += normal);
    }
    normals.into_iter().map(DVec3::normalize_or_zero).collect()
}

/// #F centroids.
pub fn centroids(faces: &[[u32; 3]], positions: &[DVec3]) -> Vec<DVec3> {
    faces.iter().map(|&f| centroid(corners(positions, f))).collect()
}

/// The shares of the corners at the point of a triangle nearest to `p`. (Christer Ericson, Real-Time Collision
/// Detection, 2005, §5.1.5.)
pub fn nearest_in_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 && d1 - d3 > 0.0 {
        let t = d1 / (d1 - d3);
        return [1.0 - t, t, 0.0];
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 && d2 - d6 > 0.0 {
        let t = d2 / (d2 - d6);
        return [1.0 - t, 0.0, t];
    }
    let va = d3 * d6 - d5 * d4;
    let (along, back) = (d4 - d3, d5 - d6);
    if va <= 0.0 && along >= 0.0 && back >= 0.0 && along + back > 0.0 {
        let t = along / (along + back);
        return [0.0, 1.0 - t, t];
    }
    let sum = va + vb + vc;
    if sum > 0.0 && sum.is_finite() { [va / sum, vb / sum, vc / sum] } else { [1.0, 0.0, 0.0] }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_point_of_a_triangle_is_nearer_than_others() {
        let corners = [DVec3::ZERO, DVec3::new(2.0, 0.1, 0.0), DVec3::new(0.3, 1.5, 0.4)];
        let at = |s: [f64; 3]| corners[0] * s[0] + corners[1] * s[1] + corners[2] * s[2];
        for i in 0..7 {
            for j in 0..7 {
                let p = DVec3::new(f64::from(i) - 3.0, f64::from(j) - 3.0, 0.7);
                let shares = nearest_in_triangle(p, corners);
                assert!((shares.iter().sum::<f64>() - 1.0).abs() < 1e-12 && shares.iter().all(|&s| s >= 0.0));
                let found = at(shares).distance(p);
                for k in 0..=20 {
                    for l in 0..=(20 - k) {
                        let (s, t) = (f64::from(k) / 20.0, f64::from(l) / 20.0);
                        assert!(found <= at([1.0 - s - t, s, t]).distance(p) + 1e-12);
                    }
                }
            }
        }
        let flat = nearest_in_triangle(DVec3::ONE, [DVec3::ZERO; 3]);
        assert!(flat.iter().all(|s| s.is_finite()));
    }
}
