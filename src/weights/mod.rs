//! Bounded biharmonic weights: how much each handle has to say at each vertex.
//!
//! Alec Jacobson, Ilya Baran, Jovan Popović, Olga Sorkine. *Bounded biharmonic weights for real-time deformation*. ACM
//! Transactions on Graphics 30(4), 2011; Eq. 1 of Yang, Gao, Lai, Rosin, Xia. *Biharmonic deformation transfer with
//! automatic key point selection*, 2018.
//!
//! | paper | code |
//! |---|---|
//! | wⱼ, the weights of handle j | a column of [`Weights::values`] |
//! | ½ wᵀ Q w, Q = L M⁻¹ L | `quadratic` |
//! | 0 ≤ w ≤ 1, w = 1 at its handle, 0 at the others | `box_problem`, a bounded quadratic problem per handle |
//! | Q restricted to the weights that are free, solved again and again | `factor`, on [`crate::linalg::principal`] |
//! | Σⱼ wⱼ = 1 | rows divided by their sums; with [`Parameters::joint`] a constraint, `joint` |
//!
//! The domain is the surface. Vertices that lie at one place are one; pieces without a handle follow the nearest piece
//! that has one (`follow`).

mod biharmonic;
mod box_problem;
mod descent;
mod dissection;
mod error;
mod factor;
mod follow;
mod fronts;
mod joint;
mod levels;
mod parameters;
mod quadratic;
mod result;
mod rings;
mod surface;

pub use biharmonic::Biharmonic;
pub use error::WeightsError;
pub use parameters::Parameters;
pub use result::Weights;
