//! Meshes so far from the origin that their coordinates have few digits left.

use super::chart::Chart;
use super::{Code, Finding, Severity};

/// The relative step of the 32-bit floats that the page, the graphics and GLB files have.
const STEP: f64 = 1.0 / 16_777_216.0;

/// Steps coarser than this, over the diagonal, are seen.
const SEEN: f64 = 2e-5;

/// …and steps coarser than this leave no shape.
const RUINED: f64 = 2e-3;

/// How coarse coordinates are at the distance from the origin at which the mesh lies.
pub fn check(chart: &Chart) -> Option<Finding> {
    let used = |v: &usize| chart.used[*v] && chart.reference[*v].is_finite();
    let far = (0..chart.reference.len())
        .filter(used)
        .map(|v| (chart.reference[v] * chart.scale).abs().max_element())
        .fold(0.0, f64::max);
    let step = far * STEP;
    (step > SEEN && far.is_finite()).then(|| Finding {
        code: Code::FarFromOrigin,
        severity: if step > RUINED { Severity::Grave } else { Severity::Care },
        count: 1,
        what: "The mesh is very far from the origin".into(),
        done: "Nothing was moved, so that what is written lies where it was.".into(),
        means: format!(
            "Seven digits of a coordinate are kept: there, steps of {:.2} ‰ of the size of the mesh. Move it to the \
             origin before it is exported.",
            1000.0 * step
        ),
        faces: Vec::new(),
    })
}
