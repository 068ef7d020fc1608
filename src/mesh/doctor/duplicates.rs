//! Faces that are there more than once.

use super::chart::Chart;
use super::words::counted;
use super::{Code, Finding, Severity};

/// Faces with the same three points as an earlier one, in any order.
pub fn check(chart: &Chart) -> Option<Finding> {
    let faces = chart.faces_where(|f| chart.is_repeated(f));
    (!faces.is_empty()).then(|| Finding {
        code: Code::DuplicateFaces,
        severity: Severity::Care,
        count: faces.len(),
        what: counted(faces.len(), "face is there twice", "faces are there twice"),
        done: "They were kept, so that faces keep their numbers.".into(),
        means: "Their area counts twice, and weights cross them more easily. Their edges have three faces and more."
            .into(),
        faces,
    })
}
