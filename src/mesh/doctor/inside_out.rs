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
    let volume = volumes(chart);
    let inside_out = |sheet: usize| closed[sheet] && !orientation.one_sided[sheet] && volume[sheet] < -NOTHING;
    let count = (0..chart.faces.len()).filter(|&f| orientation.sheet[f] as usize == f && inside_out(f)).count();
    (count > 0).then(|| Finding {
        code: Code::InsideOut,
        severity: Severity::Care,
        count,
        what: counted(count, "closed piece is inside out", "closed pieces are inside out"),
        done: "Nothing was turned round, so that faces are written as they were read.".into(),
        means: "Little for parts, weights, proposals and transfers: those that ask which side is outside turn such pieces \
                round for themselves, unless they are as thin as a plate. Viewers that leave out the back of faces show the \
                inside: turn the faces round where that is not meant."
            .into(),
        faces: chart.faces_where(|f| inside_out(orientation.sheet[f] as usize)),
    })
}

/// Six times the volume at unit diagonal, for the face that numbers its sheet, faces that are wound against the rest turned
/// round. Of a sheet with an open border it is the volume of the cone from a point of it.
pub fn volumes(chart: &Chart) -> Vec<f64> {
    let orientation = &chart.orientation;
    let mut volume = vec![0.0; chart.faces.len()];
    for (f, &sheet) in orientation.sheet.iter().enumerate().filter(|&(f, _)| chart.is_whole(f) && !chart.is_repeated(f))
    {
        let origin = chart.reference[chart.given[sheet as usize][0] as usize];
        let [a, b, c] = face::corners(chart.reference, chart.given[f]).map(|p| (p - origin) * chart.scale);
        volume[sheet as usize] += if orientation.turned[f] { -1.0 } else { 1.0 } * a.dot(b.cross(c));
    }
    volume
}

/// Volumes (six times, at unit diagonal) below this are flat.
const NOTHING: f64 = 1e-9;
