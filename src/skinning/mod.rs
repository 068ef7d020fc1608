//! Linear blend skinning, and the affine maps that make it follow a pose.
