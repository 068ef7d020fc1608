//! glTF 2.0 and GLB: skins, morph targets and node animation, in world space.
//!
//! The Khronos Group, *glTF 2.0 Specification* (2021). The `gltf` crate gives the types of the document; reading
//! what they point to, with every size and index checked, is `accessor`'s.

mod accessor;
mod buffers;
mod clip;
mod container;
mod document;
mod draco;
mod extensions;
mod instancing;
mod look;
pub mod meshopt;
mod model;
mod nodes;
mod sample;
mod shape;
mod skin;

pub use buffers::percent_decoded;
pub use container::is_glb;
pub use model::Model;
pub use sample::open;
