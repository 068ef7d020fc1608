//! What the segmentation answers.

use crate::stopwatch::Cancelled;
use crate::warning::Warning;
use serde::Serialize;

/// Parts, their quality, and everything that the steps computed on the way.
#[derive(Clone, Debug, PartialEq)]
pub struct Segmentation {
    /// #F part numbers, `0..parts.len()`.
    pub labels: Vec<u32>,
    /// The parts.
    pub parts: Vec<Part>,
    /// Rms over faces and poses of the distance of a face's centroid from where its part's best rigid motion puts
    /// it, over the diagonal of the reference pose. Where a piece of the mesh grows as a whole, the motion is rigid at the
    /// size that the part has in the pose.
    pub rigid_residual: f64,
    /// The same before boundaries were smoothed.
    pub residual_before_smoothing: f64,
    /// What the steps computed.
    pub steps: Steps,
    /// What was noticed.
    pub warnings: Vec<Warning>,
    /// Seconds by step, in the order in which the steps ran. The only part of a result that differs from run to run.
    pub seconds: Vec<(&'static str, f64)>,
}

/// A near-rigid part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Part {
    /// Number of faces.
    pub faces: usize,
    /// Share of the total area in the reference pose (0 to 1).
    pub area: f64,
    /// Rms distance of its faces' centroids from its best rigid motion, over the diagonal of the reference pose.
    pub residual: f64,
}

/// The intermediate fields, for the stage view.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Steps {
    /// #F: the largest deformation distance (Eq. 4) of a face to a neighbour, at unit diagonal.
    pub deformation: Vec<f64>,
    /// #F: the largest weight (Eq. 5) of a face's dual edges, which ε is compared with.
    pub weight: Vec<f64>,
    /// #F: 1 where a face is in the deformable set A (§3.2 step 1).
    pub deformable: Vec<u8>,
    /// The ε that was used.
    pub epsilon: f64,
    /// The γ that was used; 0 where none was, every feature founding a partition ([`super::Method::Tree`] by default).
    pub gamma: f64,
    /// #F: distance (Eq. 5) from the set A at the start; infinite where no A is in reach.
    pub distance: Vec<f64>,
    /// The features in the order in which they were found.
    pub features: Vec<Feature>,
    /// #F partition numbers after each round of clustering (§3.3) and, by [`super::Method::Tree`], the finest parts at
    /// the end.
    pub rounds: Vec<Vec<u32>>,
    /// Merges from the finest parts to one part, pieces that do not touch included, cheapest first
    /// ([`super::Method::Tree`] only).
    pub merges: Vec<Merge>,
    /// #F part numbers before boundaries were smoothed.
    pub unsmoothed: Vec<u32>,
    /// #F: 1 where a face lay in the band around a boundary in which smoothing could move it (§3.4).
    pub band: Vec<u8>,
}

/// A feature face and its influence region (§3.2 steps 2 to 4).
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Feature {
    /// The face.
    pub face: u32,
    /// The partition that it founded or joined.
    pub partition: u32,
    /// The faces of its influence region.
    pub region: Vec<u32>,
}

/// One step of the merge tree: part `from` joins part `into`.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Merge {
    /// The part that disappears (a number of the finest parts, which are the last of [`Steps::rounds`]).
    pub from: u32,
    /// The part that stays.
    pub into: u32,
    /// What the merge costs: the growth of the summed squared residual, over the total area and squared diagonal.
    pub cost: f64,
}

/// Why there is no segmentation.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SegmentationError {
    /// The observer asked to stop.
    #[error("cancelled")]
    Cancelled,
    /// There is nothing to segment.
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
}

impl From<Cancelled> for SegmentationError {
    fn from(_: Cancelled) -> Self {
        Self::Cancelled
    }
}
