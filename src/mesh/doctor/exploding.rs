//! Poses that are much larger than the reference.

use super::chart::Chart;
use super::words::counted;
use super::{Code, Finding, Severity};

/// A vertex is lost if it is so many diagonals from where it was, beyond what the pose does with all of them.
const FAR: f64 = 10.0;

/// Poses that put some vertices far away, which a broken animation does.
pub fn check(chart: &Chart) -> Option<Finding> {
    let mut lost = vec![false; chart.reference.len()];
    let mut count = 0;
    let used: Vec<usize> = (0..chart.reference.len()).filter(|&v| chart.used[v]).collect();
    for pose in &chart.poses {
        let mut moves: Vec<f64> =
            used.iter().map(|&v| ((pose[v] - chart.reference[v]) * chart.scale).length()).collect();
        let far = |d: f64, common: f64| d - common > FAR || d.is_infinite();
        let largest = moves.iter().copied().fold(0.0, f64::max);
        if largest <= FAR {
            continue;
        }
        let middle = moves.len() / 2;
        let common = *moves.select_nth_unstable_by(middle, f64::total_cmp).1;
        if !far(largest, common) {
            continue;
        }
        count += 1;
        for &v in &used {
            lost[v] |= far(((pose[v] - chart.reference[v]) * chart.scale).length(), common);
        }
    }
    (count > 0).then(|| Finding {
        code: Code::ExplodingPoses,
        severity: Severity::Grave,
        count,
        what: counted(count, "pose flies apart", "poses fly apart"),
        done: "Nothing: the poses are used as they are.".into(),
        means:
            "Some vertices move by more than ten times the size of the mesh. Parts and points follow that motion and \
                little else. Mend these poses, or leave them out."
                .into(),
        faces: chart.faces_with(|v| lost[v as usize]),
    })
}
