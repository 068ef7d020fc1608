//! From results to files: GLB, OBJ, reports.

pub mod animation;
mod container;
mod cover;
pub mod glb;
pub mod labels;
pub mod rigid;
pub mod skin;
mod timing;
