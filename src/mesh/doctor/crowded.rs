//! Edges with three faces or more.

use super::chart::Chart;
use super::words::counted;
use super::{Code, Finding, Severity};

/// Edges of more than two faces; copies of a face do not count.
pub fn check(chart: &Chart) -> Option<Finding> {
    let mut faces: Vec<u32> = Vec::new();
    let mut count = 0;
    for edge in chart.edges().filter(|edge| edge.len() > 2) {
        count += 1;
        faces.extend(edge.iter().map(|side| side.face()));
    }
    faces.sort_unstable();
    faces.dedup();
    (count > 0).then(|| Finding {
        code: Code::CrowdedEdges,
        severity: Severity::Care,
        count,
        what: counted(count, "edge has three faces or more", "edges have three faces or more"),
        done: "Their faces are taken as neighbours, one after the other.".into(),
        means:
            "Motion and weights pass between all the sheets that meet there, also where they only touch. Separate the \
                sheets if they are to move on their own."
                .into(),
        faces,
    })
}
