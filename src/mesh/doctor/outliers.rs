//! Vertices so far from all others that the size of the mesh means nothing.

use super::chart::Chart;
use super::words::counted;
use super::{Code, Finding, Severity};
use glam::DVec3;

/// The nearest so many of the vertices say how large the mesh is…
const MOST: f64 = 0.98;

/// …and those so many times farther from its middle lie outside.
const FAR: f64 = 10.0;

/// Fewer vertices have no middle.
const FEWEST: usize = 12;

/// Vertices of faces that lie far outside.
pub fn check(chart: &Chart) -> Option<Finding> {
    let used = |v: &usize| chart.used[*v] && chart.stands[*v] as usize == *v && chart.reference[*v].is_finite();
    let points: Vec<DVec3> =
        (0..chart.reference.len()).filter(used).map(|v| chart.reference[v] * chart.scale).collect();
    if points.len() < FEWEST {
        return None;
    }
    let middle = DVec3::new(median(&points, 0), median(&points, 1), median(&points, 2));
    let mut distances: Vec<f64> = points.iter().map(|p| p.distance(middle)).collect();
    let place = (MOST * (distances.len() - 1) as f64) as usize;
    let (_, &mut size, beyond) = distances.select_nth_unstable_by(place, f64::total_cmp);
    let count = beyond.iter().filter(|&&d| d > FAR * size).count();
    let outside = |v: u32| {
        let p = chart.reference[v as usize] * chart.scale;
        p.is_finite() && p.distance(middle) > FAR * size
    };
    (count > 0).then(|| Finding {
        code: Code::FarVertices,
        severity: Severity::Grave,
        count,
        what: counted(count, "vertex is very far from all others", "vertices are very far from all others"),
        done: "Nothing: the size of the whole is measured with them.".into(),
        means:
            "Everything is measured in the size of the whole, so all else looks small and still beside them: too few \
                parts, too few points. Delete them, and read the file again."
                .into(),
        faces: chart.faces_with(outside),
    })
}

fn median(points: &[DVec3], axis: usize) -> f64 {
    let mut values: Vec<f64> = points.iter().map(|p| p[axis]).collect();
    let middle = values.len() / 2;
    *values.select_nth_unstable_by(middle, f64::total_cmp).1
}
