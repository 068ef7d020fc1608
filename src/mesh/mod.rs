//! What the algorithms need to know of a triangle mesh: adjacency, pieces, areas, welding.

pub mod pieces;
pub mod weld;
