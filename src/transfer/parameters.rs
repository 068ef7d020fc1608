//! The parameters of the transfer.

use serde::{Deserialize, Serialize};

/// What can be turned. The defaults need no turning.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, rename_all = "kebab-case")]
pub struct Parameters {
    /// How motions are carried over.
    pub method: Method,
    /// At most so many bones are sought in the source by [`Method::Bones`].
    pub bones: usize,
}

impl Default for Parameters {
    fn default() -> Self {
        Self { method: Method::default(), bones: 32 }
    }
}

/// How motions are carried over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// The source is taken apart into near-rigid bones; the target, bent onto the source with the pairs where they belong,
    /// tells where on it they are, and its joints are put where its own proportions have them. Nearest to the truth where
    /// that is known.
    #[default]
    Bones,
    /// The paper: the affine motion of each key point is that of its twin, in the target's frame and scale.
    Direct,
    /// The affine motion of each key point about itself, and its displacement scaled.
    Relative,
}
