//! An animation as a GLB that plays the same everywhere, in two forms.
//!
//! | form | what it holds | size | error |
//! |---|---|---|---|
//! | [`exact`] | every pose as a morph target | #V × poses | none but 32-bit rounding |
//! | [`light`] | a skin whose joints are the handles | #V + handles × poses | measured, and returned |

use super::glb;
pub use super::skin::{Influences, Light, LightError, Skin, SkinPose, light};
use crate::sequence::Sequence;

/// Linear RGB of a mesh that has no parts: clay.
pub(super) const CLAY: [f32; 3] = [0.55, 0.45, 0.37];

/// The sequence as a GLB file in one colour: a morph target for every pose, a key at every pose's time.
pub fn exact(sequence: &Sequence) -> Vec<u8> {
    glb::named_parts(sequence, &[], &[CLAY], &[sequence.name().to_owned()])
}
