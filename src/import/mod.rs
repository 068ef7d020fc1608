//! From files to a [`Sequence`], with warnings.
//!
//! [`open`] takes the files as a person gives them (one glTF or GLB with whatever lies beside it, or numbered
//! OBJ, OFF or PLY files) and returns a checked sequence, or one sentence that says what is wrong.

use crate::sequence::Sequence;
use crate::warning::Warning;
use serde::{Deserialize, Serialize};

/// A file as it was given: its name (possibly with folders, `/` between them) and its bytes.
#[derive(Clone, Debug)]
pub struct File {
    /// Name, possibly with folders.
    pub name: String,
    /// Contents.
    pub bytes: Vec<u8>,
}

/// How to read an animation.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default)]
pub struct Options {
    /// Name (or number, from 0) of the clip; the first one that moves something if `None`.
    pub clip: Option<String>,
    /// How a clip is sampled.
    pub sampling: Sampling,
    /// Which pose is the reference.
    pub reference: Reference,
    /// Join vertices that agree in every pose (glTF only: seams of UVs and normals).
    pub weld: bool,
}

impl Default for Options {
    fn default() -> Self {
        Self { clip: None, sampling: Sampling::default(), reference: Reference::default(), weld: true }
    }
}

/// Where poses are taken from a clip.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Sampling {
    /// So many poses a second, first and last moment included.
    Rate(f64),
    /// At every key of every channel.
    Keys,
}

impl Default for Sampling {
    fn default() -> Self {
        Self::Rate(12.0)
    }
}

/// Which pose of a glTF is the reference.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Reference {
    /// The pose in which skins were bound (inverse bind matrices cancel); unskinned meshes at their nodes.
    #[default]
    Bind,
    /// Every node where the file puts it, no clip applied.
    Nodes,
    /// The first sampled pose of the clip.
    FirstFrame,
}

/// An animation of a file.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Clip {
    /// Its name, or its number where it has none.
    pub name: String,
    /// Length in seconds.
    pub seconds: f64,
}

/// A file, read.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The mesh and its poses.
    pub sequence: Sequence,
    /// The animations that the file has (empty for OBJ, OFF and PLY).
    pub clips: Vec<Clip>,
    /// The clip that was sampled: an index into `clips`.
    pub clip: Option<usize>,
    /// What was noticed on the way.
    pub warnings: Vec<Warning>,
}

/// Why files cannot be opened: one sentence for a person.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct ImportError(pub String);

/// Reads the given files.
///
/// One glTF or GLB (with its buffers beside it), or several OBJ, OFF or PLY files: the first in natural order is
/// the reference pose, the others are its poses.
pub fn open(files: &[File], options: &Options) -> Result<Imported, ImportError> {
    let _ = (files, options);
    Err(ImportError("no importer is built in".into()))
}
