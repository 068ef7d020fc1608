//! Sinew: see how a mesh bends, make another one bend the same way.
//!
//! The crate implements, for animated triangle meshes,
//!
//! * *Segmenting a deforming mesh into near-rigid components* (Lee, Wang, Chen 2006): [`segmentation`];
//! * *Biharmonic deformation transfer with automatic key point selection* (Yang, Gao, Lai, Rosin, Xia 2018):
//!   [`weights`], [`skinning`], [`keypoints`] and [`transfer`];
//! * *Deformation transfer for triangle meshes* (Sumner, Popović 2004): [`transfer::gradients`], with references in different
//!   postures as in the first paper: [`transfer::posed`].
//!
//! Data flows one way: [`import`] (or [`zoo`]) → [`sequence::Sequence`] → [`segmentation`] or [`keypoints`] →
//! [`transfer`] → [`export`] or [`view`]. Algorithms are plain functions from inputs and a parameter struct to a result
//! struct; they know nothing of files, of the browser or of drawing.

pub mod clock;
#[cfg(feature = "solvers")]
pub mod crew;
pub mod export;
pub mod import;
#[cfg(feature = "solvers")]
pub mod keypoints;
pub mod linalg;
pub mod look;
pub mod memory;
pub mod mesh;
pub mod observer;
#[cfg(feature = "solvers")]
pub mod poses;
pub mod segmentation;
pub mod sequence;
#[cfg(feature = "solvers")]
pub mod skinning;
pub mod stopwatch;
#[cfg(feature = "solvers")]
pub mod transfer;
pub mod view;
pub mod warning;
pub mod web;
#[cfg(feature = "solvers")]
pub mod weights;
pub mod zoo;
