//! Faces without area.

use super::chart::Chart;
use super::words::{counted, grouped, noted};
use super::{Code, Finding, Severity};
use crate::warning::Warning;

/// Twice the area over the squared longest side, below which there is no area.
const FLAT: f64 = 2e-10;

/// Whether a face names a point twice, or its corners lie on a line.
pub fn is_degenerate(chart: &Chart, f: usize) -> bool {
    let area = chart.normals[f].length();
    !chart.is_whole(f) || area <= FLAT * chart.longest_squared(f)
}

/// Faces that name a point twice or whose corners lie on a line; also those that the importer left out.
pub fn check(chart: &Chart, notes: &[Warning]) -> Option<Finding> {
    let faces = chart.faces_where(|f| is_degenerate(chart, f));
    let twice = faces.iter().filter(|&&f| !chart.is_whole(f as usize)).count();
    let note = noted(notes, "collapsed-faces").filter(|_| twice == 0);
    let count = faces.len() + note.map_or(0, |(left_out, _)| left_out);
    let kept = match (faces.len(), twice) {
        (0, _) => String::new(),
        (_, 0) => "They were kept; each moves with its nearest neighbour.".to_owned(),
        (all, _) if all == twice => {
            "They name a point twice. They were kept, so that faces keep their numbers; each moves with its nearest \
             neighbour."
                .to_owned()
        }
        _ => format!(
            "{} of them name a point twice. They were kept, so that faces keep their numbers; each moves with its \
             nearest neighbour.",
            grouped(twice)
        ),
    };
    let done = [kept.as_str(), note.map_or("", |(_, message)| message)];
    (count > 0).then(|| Finding {
        code: Code::DegenerateFaces,
        severity: if 2 * faces.len() > chart.faces.len() { Severity::Grave } else { Severity::Harmless },
        count,
        what: counted(count, "face has no area", "faces have no area"),
        done: done.iter().filter(|part| !part.is_empty()).copied().collect::<Vec<_>>().join(" "),
        means: if 2 * faces.len() > chart.faces.len() {
            "Most of the mesh is no surface: there is little to measure.".into()
        } else {
            "They cover nothing, so nothing is lost.".into()
        },
        faces,
    })
}
