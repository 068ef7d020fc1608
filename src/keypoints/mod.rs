//! The few points that govern a motion: §3.5 of
//!
//! Jie Yang, Lin Gao, Yu-Kun Lai, Paul L. Rosin, Shihong Xia. *Biharmonic deformation transfer with automatic key point
//! selection*. Graphical Models 98, 2018.
//!
//! | paper | file |
//! |---|---|
//! | §3.1, candidates | `candidates`, with `geodesic` distances |
//! | Algorithm 1 by the letter | `literal` |
//! | Algorithm 1 on coarse meshes, with short cuts that keep its answer | `stages`, with `search`, `leftover`, `decimate`, `coarse`, `field` |
//! | Eq. 2–21 for a set of points on the mesh itself | `full` |
//!
//! Eq. 22 divides a Frobenius norm by m·n and so is smaller than the mean vertex distance by √n; ε = 0.03 belongs to the
//! mean vertex distance in the unit sphere, which is what is meant by *error* here, everywhere.

mod candidates;
mod coarse;
mod decimate;
mod field;
mod full;
mod geodesic;
mod leftover;
mod literal;
mod parameters;
mod result;
mod search;
mod select;
mod stages;
mod thin;
mod welded;

pub use parameters::{Parameters, Stop};
pub use result::{Fitted, KeyPointError, KeyPoints, Replacement, Rounds, Step, Tried};
pub use select::{fit_all, fit_all_by, select, select_by};
pub use thin::thinned;
