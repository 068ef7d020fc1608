//! The parameters of the selection.

use super::KeyPointError;
use crate::skinning::FitParameters;
use serde::{Deserialize, Serialize};

/// More candidates would have to be tried on a mesh that is not coarse any more.
const MOST_CANDIDATES: usize = 1000;

/// What can be turned. The defaults need no turning. Where no range is told it is 0 … 1,000,000, for counts 1 and more.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, rename_all = "kebab-case")]
pub struct Parameters {
    /// How many vertices may become key points, 1 … 1000 (paper: 100).
    pub candidates: usize,
    /// ε, the mean vertex distance in the unit sphere at which there are points enough (paper: 0.03).
    pub error: f64,
    /// Exactly so many points; `None`: until `stop` says so.
    pub points: Option<usize>,
    /// The most points, unless their number is given.
    pub max: usize,
    /// When to stop.
    pub stop: Stop,
    /// Algorithm 1 by the letter (slow: the test oracle).
    pub literal: bool,
    /// λ of Eq. 5, the share of rigidity (paper: 0.5).
    pub lambda: f64,
    /// γ_logr of Eq. 15, the share of rotations in the groups (paper: 1).
    pub gamma_rotation: f64,
    /// γ_s of Eq. 15, the share of stretches in the groups (paper: 0.1).
    pub gamma_shear: f64,
    /// How firmly maps are held near rotations where no pose says otherwise ([`FitParameters::hold`]).
    pub hold: f64,
    /// Another number, another vertex from which the first candidate is sought; hardly any matters.
    pub seed: u64,
}

/// When there are points enough.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Stop {
    /// When the error is down to [`Parameters::error`].
    #[default]
    Error,
    /// When one more point takes little off the error.
    Flat,
}

impl Default for Parameters {
    fn default() -> Self {
        let fit = FitParameters::default();
        Self {
            candidates: 100,
            error: 0.03,
            points: None,
            max: 30,
            stop: Stop::default(),
            literal: false,
            lambda: fit.lambda,
            gamma_rotation: 1.0,
            gamma_shear: 0.1,
            hold: fit.hold,
            seed: 0,
        }
    }
}

impl Parameters {
    /// Refuses values outside their ranges (NaN included).
    pub fn check(&self) -> Result<(), KeyPointError> {
        let refuse = |name, value, range| Err(KeyPointError::Parameter { name, value, range });
        let counts = [("candidates", Some(self.candidates)), ("points", self.points), ("max", Some(self.max))];
        for (name, count) in counts {
            if count == Some(0) {
                return refuse(name, 0.0, "at least 1");
            }
        }
        if self.candidates > MOST_CANDIDATES {
            return refuse("candidates", self.candidates as f64, "at most 1000");
        }
        let shares = [
            ("error", self.error),
            ("lambda", self.lambda),
            ("gamma-rotation", self.gamma_rotation),
            ("gamma-shear", self.gamma_shear),
            ("hold", self.hold),
        ];
        for (name, value) in shares {
            if !(0.0..=1e6).contains(&value) {
                return refuse(name, value, "between 0 and 1000000");
            }
        }
        Ok(())
    }

    /// What the fits weigh.
    pub fn fit(&self) -> FitParameters {
        FitParameters { lambda: self.lambda, hold: self.hold, ..FitParameters::default() }
    }
}
