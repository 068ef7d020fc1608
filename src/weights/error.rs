//! Why there are no weights.

/// Why there are no weights.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WeightsError {
    /// A face names a vertex that does not exist.
    #[error("face {face} names vertex {vertex}, but there are only {vertices} vertices")]
    FaceOutOfRange {
        /// The face, counted from 0.
        face: usize,
        /// The vertex it names.
        vertex: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} has a coordinate that is not a finite number")]
    NotFinite {
        /// The vertex, counted from 0.
        vertex: usize,
    },
    /// A list of handles is empty.
    #[error("there are no handles; name at least one vertex")]
    NoHandles,
    /// A handle is no vertex.
    #[error("handle {handle} does not exist: vertices are numbered from 0 to {}", vertices.saturating_sub(1))]
    HandleOutOfRange {
        /// The handle.
        handle: u32,
        /// The number of vertices.
        vertices: usize,
    },
    /// A vertex is named as a handle twice.
    #[error("vertex {handle} is named as a handle twice; name it once")]
    DuplicateHandle {
        /// The vertex.
        handle: u32,
    },
    /// Two handles are one point of the surface, stored more than once along a seam.
    #[error("handles {first} and {second} lie at the same place; leave one of them out")]
    SamePlace {
        /// The one.
        first: u32,
        /// The other.
        second: u32,
    },
    /// Weights to start from belong to another mesh.
    #[error("the weights to start from are of a mesh of {found} vertices, not {expected}")]
    OtherMesh {
        /// Rows of the weights.
        found: usize,
        /// Vertices of the mesh.
        expected: usize,
    },
}
