//! Deformation transfer by gradients.
//!
//! Robert W. Sumner, Jovan Popović, *Deformation transfer for triangle meshes*, ACM Transactions on Graphics 23(3), 2004.
//! The affine map of each face of the source, from its reference to a pose, is asked of the faces of the target that
//! [correspond](super::correspondence) to it; vertices go where they all agree best, in the sense of least squares.
//!
//! | paper | here |
//! |---|---|
//! | §3.1, S = Ṽ V⁻¹ with a fourth vertex | [`operator::deformations`] |
//! | Eq. 5–8, min ‖c − A x‖², factored once | [`solver`] |
//! | several partners of one face | [`carry`]: the mean of their maps, and a weight for each |
//! | §5, correspondence | [`super::correspondence`] |
//!
//! Faces are weighted by their area as in Mario Botsch, Robert Sumner, Mark Pauly, Markus Gross, *Deformation transfer for
//! detail-preserving surface editing*, VMV 2006, which comes nearer to the results that Sumner and Popović published than
//! equal weights do; and those that a first solution leaves far from what was asked of them, because their partner lies on
//! another limb or beyond a fold, count less.

pub mod carry;
mod mover;
pub mod normal;
pub mod operator;
pub mod solver;

pub use mover::{Bent, Moved, Mover};
