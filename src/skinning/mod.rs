//! Linear blend skinning, and the affine maps that make it follow a pose: §3.2 to §3.4 of
//!
//! Jie Yang, Lin Gao, Yu-Kun Lai, Paul L. Rosin, Shihong Xia. *Biharmonic deformation transfer with automatic key point
//! selection*. Graphical Models 98, 2018,
//!
//! in the reduced form of Alec Jacobson, Ilya Baran, Ladislav Kavan, Jovan Popović, Olga Sorkine. *Fast automatic
//! skinning transformations*. ACM Transactions on Graphics 31(4), 2012.
//!
//! | paper | code |
//! |---|---|
//! | W, Eq. 2 | [`Rows`], [`blend`] |
//! | Eq. 6–14, rotations and stretches about each vertex | `gradients` |
//! | Eq. 15, groups | [`clusters`] |
//! | Eq. 3–5 and 16–21, the alternation | [`Fitter`] |
//!
//! The second equation of Eq. 18 is *not* stacked below the first: that would minimise another energy, one in which the
//! Laplacian is squared. Here `E = λ E_arap + E_diff` itself falls with every round.

mod assembly;
mod clusters;
pub(crate) mod factor;
mod fitter;
mod functions;
mod gradients;
mod rows;

pub use clusters::clusters;
pub use fitter::{Fit, FitParameters, Fitter, Placed, SkinnedMesh};
pub use gradients::{Ring, features};
pub use rows::Rows;

use glam::{DAffine3, DVec3};

/// Linear blend skinning (Eq. 2): each vertex goes to the mean of where the handles' maps put it.
///
/// `reference` is #V points, `weights` #V rows of #H weights, `maps` one affine map a handle, in mesh units. A vertex
/// without a row, or a row without a map, counts as weight 0.
pub fn blend(reference: &[DVec3], weights: &Rows, maps: &[DAffine3]) -> Vec<DVec3> {
    let blended = |(v, &p): (usize, &DVec3)| {
        weights.entries(v).filter_map(|(k, w)| Some(w * maps.get(k as usize)?.transform_point3(p))).sum()
    };
    reference.iter().enumerate().map(blended).collect()
}
