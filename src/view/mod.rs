//! Drawing: camera, palettes, picking (plain), and the GPU stage (in the page bundle only).

pub mod board;
pub mod camera;
pub mod closer;
pub mod colormap;
pub mod colour;
pub mod flow;
pub mod frame;
#[cfg(all(target_arch = "wasm32", feature = "page"))]
pub mod gpu;
pub mod motion;
pub mod normals;
pub mod paint;
pub mod palette;
pub mod picking;
pub mod pins;
pub mod sight;
pub mod skin;
pub mod stage;
pub mod surface;
pub mod vertex_paint;
