//! Why there is no transfer.

use crate::stopwatch::Cancelled;
use crate::weights::WeightsError;

/// Why there is no transfer.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum TransferError {
    /// No pair is given.
    #[error("there are no pairs; name at least one vertex of the source and the vertex of the target that is its twin")]
    NoPairs,
    /// A pair names a vertex that does not exist.
    #[error("pair {pair} names vertex {vertex} of the {side}, whose vertices are numbered from 0 to {}", vertices.saturating_sub(1))]
    OutOfRange {
        /// The pair, counted from 0.
        pair: usize,
        /// Source or target.
        side: &'static str,
        /// The vertex that it names.
        vertex: u32,
        /// The number of vertices there.
        vertices: usize,
    },
    /// Two pairs name one point of one surface and different points of the other.
    #[error(
        "pairs {first} and {second} have one point of the {side} but different ones of the other mesh; leave one out"
    )]
    SamePlace {
        /// The one, counted from 0.
        first: usize,
        /// The other.
        second: usize,
        /// Source or target.
        side: &'static str,
    },
    /// A mesh has no face.
    #[error("the {side} has no faces; a mesh is needed, not points")]
    NoFaces {
        /// Source or target.
        side: &'static str,
    },
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
    /// The weights of the key points could not be found.
    #[error(transparent)]
    Weights(#[from] WeightsError),
    /// The target's system of equations has no solution within rounding.
    #[error("the {side} is too degenerate: its faces have no area")]
    Degenerate {
        /// Source or target.
        side: &'static str,
    },
    /// The observer asked to stop.
    #[error("cancelled")]
    Cancelled,
}

impl From<Cancelled> for TransferError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}
