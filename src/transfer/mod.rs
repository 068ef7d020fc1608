//! Deformation transfer: a second mesh moves like the first.
//!
//! A few pairs of corresponding vertices are all that is given. Jie Yang, Lin Gao, Yu-Kun Lai, Paul L. Rosin, Shihong Xia,
//! *Biharmonic deformation transfer with automatic key point selection*, Graphical Models 98, 2018, §3.6, blends the
//! motions of these points by their biharmonic weights on the target (`by_key_points`, [`biharmonic`]). The default
//! (`by_bones`) finds the whole surface of the target on the source, starting from the pairs and from places that the
//! surfaces seem to have in common (`bending`, with [`propose`], [`spline`] and [`registration`]), takes the source's
//! motion apart into near-rigid bones ([`rig`]), and sets these into the target, joint on joint ([`joints`]). Both give a
//! [`Skin`].
//! What each face of the source does can also be asked of the target's faces directly ([`gradients`]), and so with
//! references in different postures ([`posed`]); that gives the positions of vertices, by a [`gradients::Mover`].

pub mod alignment;
mod bending;
pub mod biharmonic;
mod by_bones;
mod by_key_points;
mod checked;
pub mod correspondence;
mod error;
mod fill;
pub mod gradients;
pub mod growth;
pub mod joints;
pub mod layers;
pub mod mend;
mod parameters;
pub mod posed;
pub mod posture;
mod prepared;
pub mod propose;
pub mod registration;
pub mod rig;
mod skin;
pub mod spline;
pub mod surface;
mod ties;

pub use error::TransferError;
pub use parameters::{Method, Parameters};
pub use prepared::Prepared;
pub use skin::Skin;

use crate::observer::Observer;
use crate::sequence::Sequence;
use crate::warning::Warning;
use alignment::Alignment;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// A vertex of the source and its twin on the target.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Pair {
    /// Its number in the source.
    pub source: u32,
    /// The number of its twin in the target.
    pub target: u32,
}

/// A transferred motion.
#[derive(Clone, Debug)]
pub struct Transfer {
    /// The moving target.
    pub skin: Skin,
    /// How the target as a whole lies to the source, both in their unit balls.
    pub alignment: Alignment,
    /// The number of bones found in the source (0 for the other methods).
    pub bones: usize,
    /// Mean distance of the source's own skin from the source, in its radii (0 for the other methods).
    pub source_error: f64,
    /// What a person should know.
    pub warnings: Vec<Warning>,
    /// Seconds by step.
    pub seconds: Vec<(&'static str, f64)>,
}

impl Transfer {
    /// For each pose of the source, #V positions of the target's vertices in its own frame and scale; `reference` are
    /// those of its reference pose.
    pub fn poses(&self, reference: &[DVec3]) -> Vec<Vec<DVec3>> {
        (0..self.skin.maps.len()).map(|pose| self.skin.pose(reference, pose)).collect()
    }
}

/// Makes the target's reference pose move like the source.
///
/// Pairs name vertices of the sequences as they are given. To try several sets of pairs, keep a [`Prepared`].
pub fn transfer(
    source: &Sequence,
    target: &Sequence,
    pairs: &[Pair],
    parameters: &Parameters,
    observer: &mut dyn Observer,
) -> Result<Transfer, TransferError> {
    let mut prepared = Prepared::new(source, target, parameters, observer)?;
    let mut result = prepared.transfer(pairs, observer)?;
    result.seconds.splice(0..0, prepared.seconds().iter().copied());
    Ok(result)
}
