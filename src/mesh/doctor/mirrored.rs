//! Poses that are mirror images of the reference: no rotation leads there.

use super::chart::Chart;
use super::words::counted;
use super::{Code, Finding, Severity};
use crate::linalg::rigid_fit::Moments;
use glam::DVec3;

/// Vertices that are looked at.
const LOOKED_AT: usize = 2000;

/// A pose is a mirror image if that leaves less than this share of the squared distance that a rotation leaves…
const SHARE: f64 = 0.25;

/// …which is more than this rms distance, over the diagonal.
const LEAST: f64 = 0.01;

/// Poses that a mirror explains much better than a rotation.
pub fn check(chart: &Chart) -> Option<Finding> {
    let used: Vec<usize> = (0..chart.reference.len()).filter(|&v| chart.used[v]).collect();
    let step = used.len().div_ceil(LOOKED_AT).max(1);
    let sample: Vec<usize> = used.into_iter().step_by(step).collect();
    let count = chart.poses.iter().filter(|pose| is_mirror(chart, pose, &sample)).count();
    (count > 0).then(|| Finding {
        code: Code::MirroredPoses,
        severity: Severity::Care,
        count,
        what: counted(count, "pose is a mirror image", "poses are mirror images"),
        done: "Nothing: the poses are used as they are.".into(),
        means:
            "No rotation leads from the reference to its mirror image, so parts do not move rigidly there. An axis was \
                probably turned round in the export of these poses."
                .into(),
        faces: Vec::new(),
    })
}

fn is_mirror(chart: &Chart, pose: &[DVec3], sample: &[usize]) -> bool {
    let Some(&first) = sample.first() else { return false };
    let (mut straight, mut mirrored) = (Moments::default(), Moments::default());
    for &v in sample {
        // About vertices of their own, lest figures far from the origin lose their digits.
        let p = (chart.reference[v] - chart.reference[first]) * chart.scale;
        let q = (pose[v] - pose[first]) * chart.scale;
        straight.add(1.0, p, q);
        mirrored.add(1.0, DVec3::new(-p.x, p.y, p.z), q);
    }
    let turned = straight.residual();
    turned > LEAST * LEAST * straight.weight && mirrored.residual() < SHARE * turned
}
