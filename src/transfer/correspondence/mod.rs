//! Which faces of two meshes correspond, from a few pairs of points.
//!
//! Robert W. Sumner, Jovan Popović, *Deformation transfer for triangle meshes*, ACM Transactions on Graphics 23(3), 2004,
//! §5: the source is bent into the target with the points where they belong ([`fit`]); then each triangle of either mesh
//! finds the nearest of the other ([`pairs`]).

pub mod fit;
pub mod pairs;

pub use fit::{Fit, Fitting};
pub use pairs::{Correspondence, Quality};
