//! Vertices without a face.

use super::chart::Chart;
use super::words::counted;
use super::{Code, Finding, Severity};

/// Vertices that no face names.
pub fn check(chart: &Chart) -> Option<Finding> {
    let count = chart.used.iter().filter(|used| !**used).count();
    (count > 0).then(|| Finding {
        code: Code::UnusedVertices,
        severity: Severity::Harmless,
        count,
        what: counted(count, "vertex has no face", "vertices have no face"),
        done: "They were kept, so that vertices keep their numbers, and go along with what is nearest.".into(),
        means: "They are not seen and not measured.".into(),
        faces: Vec::new(),
    })
}
