//! Vertices whose faces look in all directions at once, so that there is no outside.

use super::chart::Chart;
use super::words::counted;
use super::{Code, Finding, Severity};
use glam::DVec3;

/// The length of the sum of the normals, over the sum of their lengths, below which they contradict each other.
const CANCELLED: f64 = 0.05;

/// Points around which the normals cancel out. Faces that are wound against the rest are turned round first: they are
/// another finding. A face that is there with both windings counts with both.
pub fn check(chart: &Chart) -> Option<Finding> {
    let mut sums = vec![(DVec3::ZERO, 0.0_f64, 0_u32); chart.reference.len()];
    for (f, face) in chart.faces.iter().enumerate().filter(|&(f, _)| chart.is_whole(f)) {
        let normal = chart.normals[f];
        let length = normal.length();
        if !length.is_finite() {
            continue;
        }
        for &point in face {
            let sum = &mut sums[point as usize];
            sum.0 += if chart.orientation.turned[f] { -normal } else { normal };
            sum.1 += length;
            sum.2 += 1;
        }
    }
    let contradicts = |&(sum, total, faces): &(DVec3, f64, u32)| {
        faces > 1 && total > f64::MIN_POSITIVE && sum.length() < CANCELLED * total
    };
    let count = sums.iter().filter(|sum| contradicts(sum)).count();
    (count > 0).then(|| Finding {
        code: Code::ContradictingNormals,
        severity: Severity::Care,
        count,
        what: counted(count, "vertex has no direction", "vertices have no direction"),
        done: "Nothing: the faces around them are used as they are.".into(),
        means: "The faces around them look in opposite directions, as on two sheets back to back. Parts do not mind; \
                proposals and the transfer cannot tell the two sides apart there."
            .into(),
        faces: chart.faces_where(|f| {
            chart.is_whole(f) && chart.faces[f].iter().any(|&point| contradicts(&sums[point as usize]))
        }),
    })
}
