//! What the algorithms need to know of a triangle mesh: adjacency, pieces, areas, welding.

pub mod dual;
pub mod face;
mod groups;
pub mod near;
pub mod pieces;
pub mod weld;

pub use dual::{DualEdge, DualGraph};
