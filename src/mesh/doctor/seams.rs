//! Vertices that are one point of the surface: those that the importer joined, and those that are still stored apart.

use super::chart::Chart;
use super::words::{counted, noted};
use super::{Code, Finding, Severity};
use crate::warning::Warning;

/// Vertices that the importer joined; and vertices of faces that agree with another in every pose.
pub fn check(chart: &Chart, notes: &[Warning]) -> Vec<Finding> {
    let mut findings = Vec::new();
    if let Some((count, message)) = noted(notes, "welded") {
        findings.push(Finding {
            code: Code::Welded,
            severity: Severity::Harmless,
            count,
            what: counted(count, "vertex was stored twice", "vertices were stored twice"),
            done: message.to_owned(),
            means: "The surface hangs together across its seams.".into(),
            faces: Vec::new(),
        });
    }
    let mut crowd = vec![0_u32; chart.stands.len()];
    let users = || (0..chart.stands.len()).filter(|&v| chart.used[v]);
    users().for_each(|v| crowd[chart.stands[v] as usize] += 1);
    let count = users().count() - crowd.iter().filter(|&&n| n > 0).count();
    if count > 0 {
        findings.push(Finding {
            code: Code::Seams,
            severity: Severity::Harmless,
            count,
            what: counted(count, "vertex is stored twice", "vertices are stored twice"),
            done: "They are in the same place in every pose and are taken as one everywhere; in what is written they stay \
                   apart."
                .into(),
            means: "The surface hangs together across its seams.".into(),
            faces: chart.faces_with(|v| crowd[chart.stands[v as usize] as usize] > 1),
        });
    }
    findings
}
