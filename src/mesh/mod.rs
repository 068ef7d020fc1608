//! What the algorithms need to know of a triangle mesh: adjacency, pieces, areas, welding.

pub mod ball;
pub mod doctor;
pub mod dual;
pub mod face;
mod groups;
pub mod laplacian;
pub mod near;
pub mod pieces;
pub mod weld;

pub use dual::{DualEdge, DualGraph};
