//! Coordinates that are no numbers.

use super::chart::Chart;
use super::words::counted;
use super::{Code, Finding, Severity};

/// Vertices with a coordinate that is NaN or infinite, in the reference or in a pose.
pub fn check(chart: &Chart) -> Option<Finding> {
    let broken = |v: usize| !chart.reference[v].is_finite() || chart.poses.iter().any(|pose| !pose[v].is_finite());
    let broken: Vec<bool> = (0..chart.reference.len()).map(broken).collect();
    let count = broken.iter().filter(|b| **b).count();
    (count > 0).then(|| Finding {
        code: Code::NotFinite,
        severity: Severity::Grave,
        count,
        what: counted(count, "vertex is nowhere", "vertices are nowhere"),
        done: "A file with such coordinates is refused.".into(),
        means: "A coordinate is no finite number, so nothing can be computed. Export the mesh again.".into(),
        faces: chart.faces_with(|v| broken[v as usize]),
    })
}
