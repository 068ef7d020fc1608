//! Near-rigid segmentation of a deforming mesh.

use crate::observer::Observer;
use crate::sequence::Sequence;
use crate::warning::Warning;
use serde::{Deserialize, Serialize};

/// What can be turned. The defaults need no turning.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, rename_all = "kebab-case")]
pub struct Parameters {
    /// By the letter of the paper, or with the additions that make the result independent of its thresholds.
    pub method: Method,
    /// δ of Eq. 5, the share of geodesic distance in a dual edge's weight (paper: 0.1 to 0.2).
    pub delta: f64,
    /// ε of §3.2 step 1, the edge weight above which a face is deformable (paper: 0.3 to 0.8); `None`: from the data.
    pub epsilon: Option<f64>,
    /// γ of §3.2 step 3, the squared difference of average gradients below which regions merge (paper: 0.4 to
    /// 1.6); `None`: from the method.
    pub gamma: Option<f64>,
    /// α of Eq. 8, the share of deformation in the price of cutting an edge (paper: below 0.1).
    pub alpha: f64,
    /// Feature extraction stops at influence regions smaller than this share of the total area.
    pub min_area: f64,
    /// The harmonic value above which a face belongs to a feature's influence region (paper: 0.01).
    pub harmonic_level: f64,
    /// The number of parts; `None`: from the costs of the merge tree. Ignored by [`Method::Paper`].
    pub parts: Option<usize>,
    /// How boundaries are smoothed.
    pub smoothing: Smoothing,
    /// Average distances from all pairs of faces, streamed, instead of from landmarks (slow: the test oracle).
    pub exact: bool,
}

impl Default for Parameters {
    fn default() -> Self {
        Self {
            method: Method::default(),
            delta: 0.15,
            epsilon: None,
            gamma: None,
            alpha: 0.1,
            min_area: 0.001,
            harmonic_level: 0.01,
            parts: None,
            smoothing: Smoothing::default(),
            exact: false,
        }
    }
}

/// Which algorithm.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// The paper's steps, then merge tree, rigid refinement and min cut.
    #[default]
    Tree,
    /// The paper by the letter.
    Paper,
}

/// How boundaries are smoothed (§3.4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Smoothing {
    /// Not at all.
    None,
    /// Min cut that is cheap where the mesh deforms, as the paper's text asks.
    #[default]
    Deformable,
    /// Min cut with Eq. 8 as printed, where deformation makes a cut expensive.
    Printed,
}

/// Parts, their quality, and everything that the steps computed on the way.
#[derive(Clone, Debug, PartialEq)]
pub struct Segmentation {
    /// #F part numbers, `0..parts.len()`.
    pub labels: Vec<u32>,
    /// The parts.
    pub parts: Vec<Part>,
    /// Rms over faces and poses of the distance of a face's centroid from where its part's best rigid motion puts
    /// it, over the diagonal of the reference pose.
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
    /// #F: 1 where a face is in the deformable set A (§3.2 step 1).
    pub deformable: Vec<u8>,
    /// The ε that was used.
    pub epsilon: f64,
    /// The γ that was used.
    pub gamma: f64,
    /// #F: distance (Eq. 5) from the set A at the start; infinite where no A is in reach.
    pub distance: Vec<f64>,
    /// The features in the order in which they were found.
    pub features: Vec<Feature>,
    /// #F partition numbers after each round of clustering (§3.3).
    pub rounds: Vec<Vec<u32>>,
    /// Merges from the finest parts to one part per connected piece, cheapest first ([`Method::Tree`] only).
    pub merges: Vec<Merge>,
    /// #F part numbers before boundaries were smoothed.
    pub unsmoothed: Vec<u32>,
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
    /// The part that disappears (a number of the finest parts, the last round of clustering).
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

/// Segments a sequence into near-rigid parts.
pub fn segment(
    sequence: &Sequence,
    parameters: &Parameters,
    observer: &mut dyn Observer,
) -> Result<Segmentation, SegmentationError> {
    let _ = (parameters, observer);
    let faces = sequence.faces().len();
    if faces == 0 {
        return Err(SegmentationError::NoFaces);
    }
    Ok(Segmentation {
        labels: vec![0; faces],
        parts: vec![Part { faces, area: 1.0, residual: 0.0 }],
        rigid_residual: 0.0,
        residual_before_smoothing: 0.0,
        steps: Steps::default(),
        warnings: Vec::new(),
        seconds: Vec::new(),
    })
}
