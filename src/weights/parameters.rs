//! The parameters of the weights.

use serde::{Deserialize, Serialize};

/// What can be turned. The defaults need no turning.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[serde(default, rename_all = "kebab-case")]
pub struct Parameters {
    /// Partition of unity as a constraint, all handles in one problem (Eq. 1 as printed; slow), instead of a problem per
    /// handle and rows divided by their sums (the usual reading).
    pub joint: bool,
}
