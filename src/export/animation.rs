//! An animation as a GLB that plays the same everywhere, in two forms.
//!
//! | form | what it holds | size | error |
//! |---|---|---|---|
//! | [`exact`] | every pose as a morph target | #V × poses | none but 32-bit rounding |
//! | [`light`] | a skin whose joints are the handles | #V + handles × poses | measured, and returned |

use super::cover::Cover;
use super::glb;
pub use super::skin::{Influences, Light, LightError, Skin, SkinPose, light};
use crate::look::Look;
use crate::sequence::Sequence;
#[cfg(feature = "solvers")]
use crate::transfer;

/// Linear RGB of a mesh that has no look of its own: clay.
pub(super) const CLAY: [f32; 3] = [0.55, 0.45, 0.37];

/// The sequence as a GLB file with a morph target for every pose and a key at every pose's time; in one colour where it
/// has no look that fits it.
pub fn exact(sequence: &Sequence, look: Option<&Look>) -> Vec<u8> {
    let (vertices, faces) = (sequence.reference().len(), sequence.faces());
    glb::covered(sequence, Cover::own(look, vertices, faces, CLAY, sequence.name()))
}

/// The target of a transfer as [`light`] writes it, by the transfer's skin, in the poses of the source.
#[cfg(feature = "solvers")]
pub fn light_transfer(
    source: &Sequence,
    target: &Sequence,
    skin: &transfer::Skin,
    look: Option<&Look>,
) -> Result<Light, LightError> {
    let poses = source.poses().iter().zip(&skin.maps);
    let poses: Vec<SkinPose> = poses.map(|(pose, maps)| SkinPose { name: &pose.name, time: pose.time, maps }).collect();
    let skin = Skin {
        name: target.name(),
        faces: target.faces(),
        reference: target.reference(),
        weights: &skin.dense(),
        handles: skin.handles.len(),
        poses: &poses,
        look,
    };
    light(&skin, Influences::Four)
}
