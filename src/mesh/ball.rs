//! The ball around a mesh that is its unit of length: results are stated in its radius.

use glam::DVec3;

/// A ball around the vertices that faces use: the centre of their bounding box, and the largest distance from it.
///
/// `faces` is #F triples of vertex numbers, `positions` #V points. Where no face uses a vertex, all vertices count. A
/// radius that would be zero or no finite number is 1, so that one can divide by it.
pub fn unit_ball(faces: &[[u32; 3]], positions: &[DVec3]) -> (DVec3, f64) {
    let used = || faces.iter().flatten().filter_map(|&v| positions.get(v as usize));
    if used().next().is_some() { around(used) } else { around(|| positions.iter()) }
}

fn around<'a, I: Iterator<Item = &'a DVec3>>(points: impl Fn() -> I) -> (DVec3, f64) {
    let low = points().fold(DVec3::INFINITY, |low, p| low.min(*p));
    let high = points().fold(DVec3::NEG_INFINITY, |high, p| high.max(*p));
    let centre = 0.5 * low + 0.5 * high;
    if !centre.is_finite() {
        return (DVec3::ZERO, 1.0);
    }
    // Squares of huge and tiny coordinates are out of the range of numbers: measured in halves of the box.
    let half = (high - centre).max_element();
    let radius = half * points().map(|p| ((*p - centre) / half).length()).fold(0.0, f64::max);
    (centre, if radius > 0.0 && radius.is_finite() { radius } else { 1.0 })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn holds_what_faces_use() {
        let points = [DVec3::ZERO, DVec3::new(2.0, 0.0, 0.0), DVec3::new(0.0, 2.0, 0.0), DVec3::splat(9.0)];
        let (centre, radius) = unit_ball(&[[0, 1, 2]], &points);
        assert_eq!(centre, DVec3::new(1.0, 1.0, 0.0));
        assert!((radius - 2_f64.sqrt()).abs() < 1e-15);
        assert_eq!(unit_ball(&[], &points[..2]).1, 1.0);
    }

    #[test]
    fn a_radius_is_always_a_length() {
        assert_eq!(unit_ball(&[], &[]), (DVec3::ZERO, 1.0));
        assert_eq!(unit_ball(&[], &[DVec3::splat(3.0)]), (DVec3::splat(3.0), 1.0));
        for size in [1e-200, 1e200] {
            let (_, radius) = unit_ball(&[], &[DVec3::ZERO, DVec3::new(size, 0.0, 0.0)]);
            assert!((radius / size - 0.5).abs() < 1e-12, "{size}");
        }
    }
}
