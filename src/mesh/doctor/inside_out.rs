//! Closed pieces that show their inside.

use super::chart::Chart;
use super::words::counted;
use super::{Code, Finding, Severity};
use crate::mesh::face;

/// Closed sheets whose volume is negative, faces that are wound against the rest turned round.
pub fn check(chart: &Chart) -> Option<Finding> {
    let orientation = &chart.orientation;
    let mut closed = vec![true; chart.faces.len()];
    for edge in chart.edges().filter(|edge| edge.len() != 2) {
        edge.iter().for_each(|side| closed[orientation.sheet[side.face() as usize] as usize] = false);
    }
    let mut volume = vec![0.0; chart.faces.len()];
    for (f, &sheet) in orientation.sheet.iter().enumerate().filter(|&(f, _)| chart.is_whole(f) && !chart.repeated[f]) {
        let origin = chart.reference[chart.given[sheet as usize][0] as usize];
        let [a, b, c] = face::corners(chart.reference, chart.given[f]).map(|p| (p - origin) * chart.scale);
        volume[sheet as usize] += if orientation.turned[f] { -1.0 } else { 1.0 } * a.dot(b.cross(c));
    }
    let inside_out = |sheet: usize| closed[sheet] && !orientation.one_sided[sheet] && volume[sheet] < -NOTHING;
    let count = (0..chart.faces.len()).filter(|&f| orientation.sheet[f] as usize == f && inside_out(f)).count();
    (count > 0).then(|| Finding {
        code: Code::InsideOut,
        severity: Severity::Care,
        count,
        what: counted(count, "closed piece is inside out", "closed pieces are inside out"),
        done: "Nothing was turned round, so that faces are written as they were read.".into(),
        means: "Parts and weights do not ask which side is outside. Proposals and the transfer look for surfaces that look \
                the same way, and find the wrong ones. Turn the faces round where it is not meant."
            .into(),
        faces: chart.faces_where(|f| inside_out(orientation.sheet[f] as usize)),
    })
}

/// Volumes (six times, at unit diagonal) below this are flat.
const NOTHING: f64 = 1e-9;
