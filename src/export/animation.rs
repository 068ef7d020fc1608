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

/// Linear RGB of a mesh that has no look of its own: clay.
pub(super) const CLAY: [f32; 3] = [0.55, 0.45, 0.37];

/// The sequence as a GLB file with a morph target for every pose and a key at every pose's time; in one colour where it
/// has no look that fits it.
pub fn exact(sequence: &Sequence, look: Option<&Look>) -> Vec<u8> {
    let (vertices, faces) = (sequence.reference().len(), sequence.faces());
    glb::covered(sequence, Cover::own(look, vertices, faces, CLAY, sequence.name()))
}
