//! The parameters of the segmentation.

use super::SegmentationError;
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

impl Parameters {
    /// The paper by the letter, its thresholds in the middle of their ranges.
    pub fn paper() -> Self {
        Self { method: Method::Paper, smoothing: Smoothing::Printed, ..Self::default() }
    }

    /// Refuses values outside their ranges (NaN included).
    pub fn check(&self) -> Result<(), SegmentationError> {
        let share = |name, value: f64| match value {
            v if (0.0..=1.0).contains(&v) => Ok(()),
            value => Err(SegmentationError::Parameter { name, value, range: "between 0 and 1" }),
        };
        let positive = |name, value: Option<f64>| match value {
            Some(value) if !(value >= 0.0 && value.is_finite()) => {
                Err(SegmentationError::Parameter { name, value, range: "0 or more" })
            }
            _ => Ok(()),
        };
        share("delta", self.delta)?;
        share("alpha", self.alpha)?;
        share("min-area", self.min_area)?;
        share("harmonic-level", self.harmonic_level)?;
        positive("epsilon", self.epsilon)?;
        positive("gamma", self.gamma)?;
        match self.parts {
            Some(0) => Err(SegmentationError::Parameter { name: "parts", value: 0.0, range: "at least 1" }),
            _ => Ok(()),
        }
    }
}
