//! Small numerical tools: polar decomposition, rigid fits, sparse solves.

#[cfg(feature = "solvers")]
pub mod cholesky;
pub mod conjugate_gradient;
pub mod envelope;
#[cfg(feature = "solvers")]
mod front;
pub mod jacobi;
pub mod outer;
pub mod polar;
#[cfg(feature = "solvers")]
pub mod principal;
pub mod rigid_fit;
#[cfg(feature = "solvers")]
pub mod symmetric;
#[cfg(feature = "solvers")]
mod tree;
