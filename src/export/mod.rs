//! From results to files: GLB, OBJ, reports.

pub mod glb;
pub mod labels;
