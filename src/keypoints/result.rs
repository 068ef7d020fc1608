//! What the selection answers.

use crate::skinning::Fit;
use crate::stopwatch::Cancelled;
use crate::warning::Warning;
use crate::weights::{Weights, WeightsError};
use glam::DAffine3;
use serde::Serialize;

/// The maps of the points after each round of a fit, in mesh units: one list for each of its energies.
pub type Rounds = Vec<Vec<DAffine3>>;

/// Key points, what moves by them, and everything that the search saw on the way.
#[derive(Clone, Debug)]
pub struct KeyPoints {
    /// Vertices of the sequence, the most telling first.
    pub key_points: Vec<u32>,
    /// The error when only the first 1, 2, … of them are used: mean vertex distance between the poses and the skinned
    /// reference, over all poses and all vertices that faces use, in radii of the unit sphere. The last one is measured
    /// on the mesh itself; on large meshes those before it are measured on a coarse one.
    pub errors: Vec<f64>,
    /// The candidates in the order they were found; at the end key points that lie between them.
    pub candidates: Vec<u32>,
    /// What was tried when points were added, step by step.
    pub steps: Vec<Step>,
    /// What was replaced afterwards.
    pub replacements: Vec<Replacement>,
    /// The weights of all key points.
    pub weights: Weights,
    /// #V group numbers (Eq. 15), below the number of key points.
    pub groups: Vec<u32>,
    /// One fit a pose, with all key points.
    pub fits: Vec<Fit>,
    /// What each fit came by.
    pub rounds: Vec<Rounds>,
    /// What was noticed.
    pub warnings: Vec<Warning>,
    /// Seconds by step, in the order in which the steps ran. The only part of a result that differs from run to run.
    pub seconds: Vec<(&'static str, f64)>,
}

/// A set of points given by hand, and what moves by it.
#[derive(Clone, Debug)]
pub struct Fitted {
    /// The weights of the points.
    pub weights: Weights,
    /// #V group numbers (Eq. 15), below the number of points.
    pub groups: Vec<u32>,
    /// One fit a pose.
    pub fits: Vec<Fit>,
    /// What each fit came by.
    pub rounds: Vec<Rounds>,
    /// Mean of the fits' errors, in radii of the unit sphere; 0 where there is no pose.
    pub error: f64,
}

/// One point more.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Step {
    /// The candidates that were tried, with the error that each would leave.
    pub tried: Vec<Tried>,
    /// The one that was chosen.
    pub chosen: u32,
    /// The error that it leaves, as the search measures it (on a coarse mesh by default).
    pub error: f64,
}

/// A candidate and the error of the set with it.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Tried {
    /// The candidate, a vertex of the sequence.
    pub vertex: u32,
    /// As the search measures it.
    pub error: f64,
}

/// A point that gave way to a better one.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Replacement {
    /// The vertex that was a key point.
    pub from: u32,
    /// The vertex that is one.
    pub to: u32,
    /// The error afterwards, as the search measures it.
    pub error: f64,
}

/// Why there are no key points.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum KeyPointError {
    /// The observer asked to stop.
    #[error("cancelled")]
    Cancelled,
    /// There is nothing to choose from.
    #[error("the mesh has no faces")]
    NoFaces,
    /// A parameter is out of its range.
    #[error("{name} must be {range}, not {value}")]
    Parameter {
        /// Its name.
        name: &'static str,
        /// Its value.
        value: f64,
        /// What it may be.
        range: &'static str,
    },
    /// There are no weights for the points.
    #[error(transparent)]
    Weights(#[from] WeightsError),
}

impl From<Cancelled> for KeyPointError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}
