//! Faces that turn over against their neighbours, or shrink to nothing, in a pose.

use super::chart::Chart;
use super::degenerate::is_degenerate;
use super::words::{counted, grouped};
use super::{Code, Finding, Severity};
use crate::mesh::face;
use glam::DVec3;

/// Faces times poses that are looked at; of longer sequences poses are left out evenly.
const LOOKED_AT: usize = 2_000_000;

/// Cosine between neighbours beyond which they lie back to back.
const BACK_TO_BACK: f64 = -0.95;

/// Area in a pose, over that in the reference, below which a face is gone.
const GONE: f64 = 1e-4;

/// Faces that lie flat or nearly with a neighbour in the reference and back to back with it in a pose, which is what a
/// face does that is pushed through itself; and faces that have an area in the reference and none in a pose.
pub fn check(chart: &Chart) -> Vec<Finding> {
    let (count, all) = (chart.faces.len(), chart.poses.len());
    let step = (count * all).div_ceil(LOOKED_AT).max(1);
    let (mut over, mut gone) = (vec![false; count], vec![false; count]);
    let solid: Vec<bool> = (0..count).map(|f| !is_degenerate(chart, f)).collect();
    let flat: Vec<[u32; 2]> = chart.edges().filter_map(|edge| flat_pair(chart, &solid, edge)).collect();
    let mut units = Vec::with_capacity(count);
    for pose in chart.poses.iter().step_by(step) {
        units.clear();
        for (f, &corners) in chart.given.iter().enumerate() {
            let normal = face::double_area_normal(face::corners(pose, corners).map(|p| p * chart.scale));
            let (length, before) = (normal.length(), chart.normals[f].length());
            gone[f] |= solid[f] && length < GONE * before;
            units.push(if length.is_normal() { normal / length } else { DVec3::ZERO });
        }
        for &[a, b] in &flat {
            if units[a as usize].dot(units[b as usize]) < BACK_TO_BACK {
                over[a as usize] = true;
                over[b as usize] = true;
            }
        }
    }
    let looked = match step {
        1 => "Nothing: the poses are used as they are.".to_owned(),
        _ => format!(
            "Nothing: the poses are used as they are. {} of {} poses were looked at.",
            grouped(all.div_ceil(step)),
            grouped(all)
        ),
    };
    let finding = |code, faces: Vec<u32>, what: [&str; 2], means: &str| {
        (!faces.is_empty()).then(|| Finding {
            code,
            severity: Severity::Harmless,
            count: faces.len(),
            what: counted(faces.len(), what[0], what[1]),
            done: looked.clone(),
            means: means.into(),
            faces,
        })
    };
    let over = finding(
        Code::TurnedOver,
        chart.faces_where(|f| over[f]),
        ["face folds onto its neighbour in a pose", "faces fold onto their neighbours in a pose"],
        "The surface is pushed through itself there, as in the hollow of a knee. Parts may get a boundary there.",
    );
    let gone = finding(
        Code::Vanishing,
        chart.faces_where(|f| gone[f]),
        ["face shrinks to nothing in a pose", "faces shrink to nothing in a pose"],
        "What is squeezed flat there deforms strongly, and may become a part of its own.",
    );
    over.into_iter().chain(gone).collect()
}

/// Two faces that share an edge, are wound alike and look to the same side.
fn flat_pair(chart: &Chart, solid: &[bool], edge: &[super::chart::Side]) -> Option<[u32; 2]> {
    let &[a, b] = edge else { return None };
    let [f, g] = [a.face(), b.face()].map(|f| f as usize);
    let alike = a.forward() != b.forward() && solid[f] && solid[g] && chart.normals[f].dot(chart.normals[g]) > 0.0;
    alike.then_some([f as u32, g as u32])
}
