//! A reference pose and the poses that share its faces.

use crate::mesh::backdrop::without_backdrop;
use glam::DVec3;
use serde::Serialize;
use std::borrow::Cow;

/// A triangle mesh in a reference pose, and the same mesh in other poses.
///
/// Lengths are in the units of the input. What holds for every sequence is checked by [`Sequence::new`]: every
/// pose has as many vertices as the reference, every face names three vertices that exist, every coordinate is
/// finite.
#[derive(Clone, Debug, PartialEq)]
pub struct Sequence {
    name: String,
    faces: Vec<[u32; 3]>,
    reference: Vec<DVec3>,
    poses: Vec<Pose>,
    polygons: Option<Vec<u32>>,
}

/// One pose of a sequence.
#[derive(Clone, Debug, PartialEq)]
pub struct Pose {
    /// Where it comes from: a file name, or the time in the clip.
    pub name: String,
    /// Time in seconds from the start of the animation.
    pub time: f64,
    /// #V positions.
    pub positions: Vec<DVec3>,
}

/// Why arrays do not make a sequence.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum SequenceError {
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
    /// A pose has another number of vertices than the reference pose.
    #[error("pose {pose} has {found} vertices, but the reference pose has {expected}; all poses must share one mesh")]
    VertexCount {
        /// The pose's name.
        pose: String,
        /// Its number of vertices.
        found: usize,
        /// The reference pose's number of vertices.
        expected: usize,
    },
    /// A coordinate is NaN or infinite.
    #[error("vertex {vertex} of {pose} has a coordinate that is not a finite number")]
    NotFinite {
        /// The pose's name.
        pose: String,
        /// The vertex, counted from 0.
        vertex: usize,
    },
    /// The map from faces to polygons has the wrong length.
    #[error("{found} polygon numbers for {expected} faces")]
    PolygonCount {
        /// Its length.
        found: usize,
        /// The number of faces.
        expected: usize,
    },
}

/// Sizes of a sequence, for reports.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Sizes {
    /// Number of vertices.
    pub vertices: usize,
    /// Number of triangles.
    pub faces: usize,
    /// Number of poses, the reference not counted.
    pub poses: usize,
}

impl Sequence {
    /// Checks the arrays and makes a sequence of them.
    ///
    /// `faces` is #F triples of vertex numbers; `reference` and the positions of every pose are #V points.
    pub fn new(
        name: impl Into<String>,
        faces: Vec<[u32; 3]>,
        reference: Vec<DVec3>,
        poses: Vec<Pose>,
    ) -> Result<Self, SequenceError> {
        let vertices = reference.len();
        for (face, corners) in faces.iter().enumerate() {
            if let Some(&vertex) = corners.iter().find(|&&v| v as usize >= vertices) {
                return Err(SequenceError::FaceOutOfRange { face, vertex, vertices });
            }
        }
        check_finite("the reference pose", &reference)?;
        for pose in &poses {
            if pose.positions.len() != vertices {
                return Err(SequenceError::VertexCount {
                    pose: pose.name.clone(),
                    found: pose.positions.len(),
                    expected: vertices,
                });
            }
            check_finite(&pose.name, &pose.positions)?;
        }
        Ok(Self { name: name.into(), faces, reference, poses, polygons: None })
    }

    /// Records which input polygon each triangle was cut from (#F numbers, not falling), where the input had
    /// polygons.
    pub fn with_polygons(mut self, polygons: Vec<u32>) -> Result<Self, SequenceError> {
        if polygons.len() != self.faces.len() {
            return Err(SequenceError::PolygonCount { found: polygons.len(), expected: self.faces.len() });
        }
        self.polygons = Some(polygons);
        Ok(self)
    }

    /// The same mesh, with its polygons, in another reference pose and other poses.
    pub fn reposed(&self, reference: Vec<DVec3>, poses: Vec<Pose>) -> Result<Self, SequenceError> {
        let reposed = Self::new(self.name.clone(), self.faces.clone(), reference, poses)?;
        Ok(Self { polygons: self.polygons.clone(), ..reposed })
    }

    /// The same mesh in poses of its own (#V positions each) that have the names and times of `leader`'s.
    pub fn moving_like(&self, leader: &Self, positions: Vec<Vec<DVec3>>) -> Result<Self, SequenceError> {
        let poses = leader.poses.iter().zip(positions);
        let poses = poses.map(|(pose, positions)| Pose { name: pose.name.clone(), time: pose.time, positions });
        self.reposed(self.reference.clone(), poses.collect())
    }

    /// The reference pose without the others.
    pub fn reference_alone(&self) -> Self {
        Self { poses: Vec::new(), ..self.clone() }
    }

    /// What to call it: the file's or creature's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// #F triples of vertex numbers.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// #V positions in the reference pose.
    pub fn reference(&self) -> &[DVec3] {
        &self.reference
    }

    /// The other poses, in the order of time.
    pub fn poses(&self) -> &[Pose] {
        &self.poses
    }

    /// The positions of the reference and of every pose, to be moved: #V finite ones they must stay.
    pub(crate) fn positions_mut(&mut self) -> impl Iterator<Item = &mut [DVec3]> {
        let poses = self.poses.iter_mut().map(|pose| pose.positions.as_mut_slice());
        std::iter::once(self.reference.as_mut_slice()).chain(poses)
    }

    /// The input polygon that each triangle was cut from; `None` where every input polygon was a triangle.
    pub fn polygons(&self) -> Option<&[u32]> {
        self.polygons.as_deref()
    }

    /// Numbers of vertices, faces and poses.
    pub fn sizes(&self) -> Sizes {
        Sizes { vertices: self.reference.len(), faces: self.faces.len(), poses: self.poses.len() }
    }

    /// Length of the diagonal of the reference pose's bounding box over the vertices that faces use; 0 for an
    /// empty mesh. The unit in which Sinew states residuals.
    pub fn diagonal(&self) -> f64 {
        self.diagonal_of(&self.faces)
    }

    /// The faces without a still backdrop that is much larger than what moves ([`without_backdrop`]).
    pub fn acting_faces(&self) -> Cow<'_, [[u32; 3]]> {
        let poses: Vec<&[DVec3]> = self.poses.iter().map(|pose| pose.positions.as_slice()).collect();
        without_backdrop(&self.faces, &self.reference, &poses)
    }

    /// The sequence with its [`Self::acting_faces`] alone and all of its vertices.
    pub fn acting(&self) -> Cow<'_, Self> {
        match self.acting_faces() {
            Cow::Borrowed(_) => Cow::Borrowed(self),
            Cow::Owned(faces) => Cow::Owned(Self { faces, polygons: None, ..self.clone() }),
        }
    }

    /// [`Self::diagonal`] of the [`Self::acting_faces`]: the length against which the steps measure what moves.
    pub fn acting_diagonal(&self) -> f64 {
        self.diagonal_of(&self.acting_faces())
    }

    fn diagonal_of(&self, faces: &[[u32; 3]]) -> f64 {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for &v in faces.iter().flatten() {
            low = low.min(self.reference[v as usize]);
            high = high.max(self.reference[v as usize]);
        }
        if low.x > high.x { 0.0 } else { length(high - low) }
    }
}

/// Length of a vector that is not negative, also where its square is out of the range of numbers; finite in any case.
fn length(v: DVec3) -> f64 {
    let largest = v.max_element().min(f64::MAX);
    if largest > 0.0 { (largest * (v.min(DVec3::MAX) / largest).length()).min(f64::MAX) } else { 0.0 }
}

fn check_finite(pose: &str, positions: &[DVec3]) -> Result<(), SequenceError> {
    match positions.iter().position(|p| !p.is_finite()) {
        Some(vertex) => Err(SequenceError::NotFinite { pose: pose.to_owned(), vertex }),
        None => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_moves_like_another_keeps_its_own_mesh() {
        let square = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| DVec3::new(x, y, 0.0)).to_vec();
        let faces = vec![[0, 1, 2], [0, 2, 3]];
        let still =
            Sequence::new("square", faces, square.clone(), Vec::new()).unwrap().with_polygons(vec![7, 7]).unwrap();
        let pose = |name: &str, time| Pose { name: name.to_owned(), time, positions: vec![DVec3::ZERO; 3] };
        let leader =
            Sequence::new("leader", vec![[0, 1, 2]], vec![DVec3::ZERO; 3], vec![pose("a", 0.5), pose("b", 2.0)]);
        let moved: Vec<DVec3> = square.iter().map(|p| *p + DVec3::Z).collect();
        let moving = still.moving_like(&leader.unwrap(), vec![square, moved.clone()]).unwrap();
        assert_eq!((moving.name(), moving.polygons()), ("square", Some(&[7, 7][..])));
        assert_eq!(moving.reference(), still.reference());
        assert_eq!(moving.poses()[1], Pose { name: "b".to_owned(), time: 2.0, positions: moved });
    }

    #[test]
    fn the_diagonal_is_right_for_huge_and_tiny_meshes() {
        for size in [1e-300, 1e-160, 1.0, 1e160, 1e300] {
            let reference = vec![DVec3::ZERO, DVec3::new(3.0 * size, 0.0, 0.0), DVec3::new(0.0, 4.0 * size, 0.0)];
            let sequence = Sequence::new("", vec![[0, 1, 2]], reference, Vec::new()).expect("a mesh");
            assert!((sequence.diagonal() / size - 5.0).abs() < 1e-12, "{size}");
        }
        let apart = vec![DVec3::splat(-f64::MAX), DVec3::splat(f64::MAX), DVec3::ZERO];
        let sequence = Sequence::new("", vec![[0, 1, 2]], apart, Vec::new()).expect("a mesh");
        assert!(sequence.diagonal().is_finite());
    }
}
