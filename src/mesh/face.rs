//! Areas, normals and centroids of triangles.

use glam::DVec3;

/// The three corners of a face.
pub fn corners(positions: &[DVec3], face: [u32; 3]) -> [DVec3; 3] {
    face.map(|v| positions[v as usize])
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

/// #F centroids.
pub fn centroids(faces: &[[u32; 3]], positions: &[DVec3]) -> Vec<DVec3> {
    faces.iter().map(|&f| centroid(corners(positions, f))).collect()
}
