//! From results to files: GLB, OBJ, reports.
