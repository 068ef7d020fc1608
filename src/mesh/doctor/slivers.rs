//! Needles: faces much longer than high.

use super::chart::Chart;
use super::degenerate::is_degenerate;
use super::words::counted;
use super::{Code, Finding, Severity};

/// Height over longest side of a sliver.
const THIN: f64 = 0.02;

/// Slivers matter if they are more than this share of the faces.
const MANY: f64 = 0.05;

/// Faces with an area that are fifty times as long as high, or more.
pub fn check(chart: &Chart) -> Option<Finding> {
    let thin = |f: usize| chart.normals[f].length() < THIN * chart.longest_squared(f);
    let faces = chart.faces_where(|f| thin(f) && !is_degenerate(chart, f));
    let many = faces.len() as f64 > MANY * chart.faces.len() as f64;
    (!faces.is_empty()).then(|| Finding {
        code: Code::Slivers,
        severity: if many { Severity::Care } else { Severity::Harmless },
        count: faces.len(),
        what: counted(faces.len(), "face is a sliver", "faces are slivers"),
        done: "Nothing: they are used as they are.".into(),
        means:
            "They are fifty times as long as high, or more. Rounding alone turns them, so boundaries of parts may be \
                ragged there."
                .into(),
        faces,
    })
}
