//! Whether two references stand in one posture: arms that hang on one and are spread on the other turn about other axes.

use super::rig::weights::{Row, main_bone};
use crate::linalg::polar::angle;
use crate::linalg::rigid_fit::Moments;
use crate::warning::Warning;
use glam::DVec3;

/// A bone that is turned by more than this (radians) stands differently.
const TURNED: f64 = 0.6;
/// The share of the surface that may.
const FEW: f64 = 0.16;

/// Warns if parts of a target are turned far against the source. `rest` and `bent` are #N positions of the target as it
/// stands and as it lies on the source, in one frame; `rows` and `areas` are its rows of bones and what each place counts,
/// 1 together.
pub fn differ(rest: &[DVec3], bent: &[DVec3], rows: &[Row], areas: &[f64], bones: usize) -> Option<Warning> {
    let mut moments = vec![(Moments::default(), 0.0); bones];
    for (((&from, &to), row), &area) in rest.iter().zip(bent).zip(rows).zip(areas) {
        let (bone, sum) = moments.get_mut(main_bone(row) as usize)?;
        bone.add(area, from, to);
        *sum += area;
    }
    let turned =
        moments.iter().filter(|(bone, _)| angle(bone.motion().rotation) > TURNED).map(|bone| bone.1).sum::<f64>();
    (turned > FEW).then(|| {
        let message = format!(
            "the two stand in different postures: {:.0} % of the target is turned by more than {:.0}° against the source, and \
             moves about other axes than one would expect; “Gradients, posed” (`--method posed`) turns it first",
            100.0 * turned,
            TURNED.to_degrees()
        );
        Warning::new("different-postures", message)
    })
}
