//! Creatures made by code, each with its true parts.

use crate::sequence::Sequence;

/// A creature: a moving mesh whose parts are known.
#[derive(Clone, Debug)]
pub struct Creature {
    /// The mesh and one loop of its motion.
    pub sequence: Sequence,
    /// #F true part numbers: the bone that each face follows most.
    pub labels: Vec<u32>,
    /// The name of each part.
    pub parts: Vec<String>,
}

/// What to make.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, rename_all = "kebab-case")]
pub struct Recipe {
    /// One of [`NAMES`].
    pub name: String,
    /// About how many faces (1,000 to 1,000,000).
    pub faces: usize,
    /// Number of poses in one loop of the motion.
    pub poses: usize,
    /// Every vertex follows exactly one bone, instead of a smooth blend.
    pub exact: bool,
}

impl Default for Recipe {
    fn default() -> Self {
        Self { name: "horse".into(), faces: 12_000, poses: 24, exact: false }
    }
}

/// The creatures there are.
pub const NAMES: &[&str] = &[];

/// Makes a creature; `None` if there is none of that name.
pub fn make(recipe: &Recipe) -> Option<Creature> {
    let _ = recipe;
    None
}
