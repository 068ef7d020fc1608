//! Pieces that hang together by nothing, and those that stand still.

use super::chart::Chart;
use super::words::{counted, grouped};
use super::{Code, Finding, Severity};
use crate::mesh::pieces::pieces;

/// More pieces than this are many.
const MANY: usize = 200;

/// A vertex moves if it goes farther than this, over the diagonal.
const MOVES: f64 = 1e-6;

/// Pieces, of which all but the one with most faces are shown; and pieces that never move while others do.
pub fn check(chart: &Chart) -> Vec<Finding> {
    let found = pieces(&chart.faces, chart.reference.len());
    if found.count < 2 {
        return Vec::new();
    }
    let mut sizes = vec![0_usize; found.count];
    found.face.iter().for_each(|&p| sizes[p as usize] += 1);
    let largest = (0..found.count).fold(0, |best, p| if sizes[p] > sizes[best] { p } else { best });
    let many = found.count > MANY;
    let share = 100.0 * sizes[largest] as f64 / chart.faces.len().max(1) as f64;
    let mut findings = vec![Finding {
        code: Code::Pieces,
        severity: if many { Severity::Care } else { Severity::Harmless },
        count: found.count,
        what: counted(found.count, "piece", "pieces"),
        done: format!(
            "The largest has {share:.0} % of the faces. Each other one may join the part that it lies next to; where a \
             piece has no key point, it follows the nearest one that has."
        ),
        means: if many {
            "So many pieces are sorted by their motion and by what lies near, which may put together what only stands \
             close together."
                .into()
        } else {
            "They hang together by nothing but their motion and by lying close together.".into()
        },
        faces: chart.faces_where(|f| found.face[f] as usize != largest),
    }];
    findings.extend(still(chart, &found.face, found.count));
    findings
}

fn still(chart: &Chart, piece: &[u32], count: usize) -> Option<Finding> {
    let moved = |v: u32| {
        let from = chart.reference[v as usize];
        chart.poses.iter().any(|pose| ((pose[v as usize] - from) * chart.scale).length() > MOVES)
    };
    let mut moves = vec![false; count];
    for (face, &p) in chart.given.iter().zip(piece) {
        moves[p as usize] = moves[p as usize] || face.iter().any(|&v| moved(v));
    }
    let still = moves.iter().filter(|moves| !**moves).count();
    (still > 0 && still < count).then(|| Finding {
        code: Code::StillPieces,
        severity: Severity::Harmless,
        count: still,
        what: format!("{} of {} pieces stand still", grouped(still), grouped(count)),
        done: "Nothing: they are used as they are.".into(),
        means: "What does not move while the rest does becomes a part of its own, or several.".into(),
        faces: chart.faces_where(|f| !moves[piece[f] as usize]),
    })
}
