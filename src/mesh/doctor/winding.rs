//! Faces wound against their neighbours.

use super::chart::Chart;
use super::words::counted;
use super::{Code, Finding, Severity};

/// Faces that are wound against most of their sheet; and sheets, such as a Möbius band, of which no winding is right.
pub fn check(chart: &Chart) -> Vec<Finding> {
    let orientation = &chart.orientation;
    let mut findings = Vec::new();
    let flipped = chart.faces_where(|f| orientation.turned[f]);
    if !flipped.is_empty() {
        findings.push(Finding {
            code: Code::FlippedFaces,
            severity: Severity::Care,
            count: flipped.len(),
            what: counted(flipped.len(), "face shows its back", "faces show their backs"),
            done: "Nothing was turned round, so that faces are written as they were read.".into(),
            means: "Nothing for parts, weights, proposals and transfers: those that compare directions turn such faces for \
                    themselves. The light falls wrong."
                .into(),
            faces: flipped,
        });
    }
    let count = orientation.one_sided.iter().filter(|one| **one).count();
    if count > 0 {
        findings.push(Finding {
            code: Code::OneSided,
            severity: Severity::Care,
            count,
            what: counted(count, "sheet has one side only", "sheets have one side only"),
            done: "Nothing can be done: inside and outside go over into each other.".into(),
            means: "Parts and weights do not ask which side is outside. Proposals and the transfer compare directions, and \
                    may miss what is there."
                .into(),
            faces: chart.faces_where(|f| orientation.one_sided[orientation.sheet[f] as usize]),
        });
    }
    findings
}
