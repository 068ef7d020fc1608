//! What the algorithms need to know of a triangle mesh: adjacency, pieces, areas, welding; and what is wrong with it.

pub mod backdrop;
pub mod ball;
pub mod bvh;
pub mod doctor;
pub mod dual;
pub mod face;
pub mod groups;
pub mod kd_tree;
pub mod laplacian;
pub mod near;
pub mod paths;
pub mod pieces;
pub mod weld;

pub use dual::{DualEdge, DualGraph};
