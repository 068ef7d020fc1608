//! From files to a [`Sequence`], with warnings.
//!
//! [`open`] takes the files as a person gives them (one glTF or GLB with whatever lies beside it, or numbered
//! OBJ, OFF or PLY files) and returns a checked sequence, or one sentence that says what is wrong.

pub mod gltf;
mod limits;
mod natural;
mod numbered;
mod obj;
mod off;
mod ply;
mod polygons;
mod text;

pub use natural::natural_order;

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
    /// The number of faces that the input has, a polygon counted as one face. `sequence.polygons()` says which of
    /// them each triangle of the sequence comes from, where the two differ.
    pub input_faces: usize,
    /// What was noticed on the way.
    pub warnings: Vec<Warning>,
}

/// Why files cannot be opened: one sentence for a person.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct ImportError(pub String);

/// Reads the given files, which may be in any order, as when they are dropped on a page.
///
/// One glTF or GLB (with its buffers beside it), or several OBJ, OFF or PLY files: the first in [`natural_order`]
/// is the reference pose, the others are its poses. Files that are neither are passed over.
pub fn open(files: &[File], options: &Options) -> Result<Imported, ImportError> {
    let mut order: Vec<&File> = files.iter().collect();
    natural::sort(&mut order);
    open_listed(&order, files, options)
}

/// Reads the given files in the given order, as on a command line: of OBJ, OFF and PLY files the first is the
/// reference pose, the others are its poses. Otherwise as [`open`].
pub fn open_in_order(files: &[File], options: &Options) -> Result<Imported, ImportError> {
    open_listed(&files.iter().collect::<Vec<_>>(), files, options)
}

fn open_listed(order: &[&File], files: &[File], options: &Options) -> Result<Imported, ImportError> {
    let mut documents: Vec<&File> = Vec::new();
    let mut meshes = Vec::new();
    for &file in order.iter().filter(|file| !is_hidden(&file.name)) {
        match kind(file) {
            Some(Kind::Gltf) => documents.push(file),
            Some(Kind::Mesh(format)) => meshes.push((file, format)),
            None => {}
        }
    }
    match (documents.as_slice(), meshes.as_slice()) {
        ([document], _) => gltf::open(document, files, options),
        ([first, second, ..], _) => Err(ImportError(format!(
            "several glTF files were given ({}, {}, …); give one at a time",
            first.name, second.name
        ))),
        ([], []) => Err(ImportError(nothing_to_read(files))),
        ([], _) => numbered::open(&meshes),
    }
}

fn nothing_to_read(files: &[File]) -> String {
    match files {
        [] => "no file was given; give one glTF or GLB, or OBJ, OFF or PLY files".into(),
        [file] => format!("{} is no glTF, GLB, OBJ, OFF or PLY file, which is what can be read", file.name),
        _ => {
            format!("none of the {} files is a glTF, GLB, OBJ, OFF or PLY file, which is what can be read", files.len())
        }
    }
}

enum Kind {
    Gltf,
    Mesh(numbered::Format),
}

/// What a file is, by the end of its name or, where that says nothing, by how it begins.
fn kind(file: &File) -> Option<Kind> {
    use numbered::Format;
    let extension = file.name.rsplit_once('.').map(|(_, end)| end.to_ascii_lowercase());
    match extension.as_deref() {
        _ if gltf::is_glb(&file.bytes) => Some(Kind::Gltf),
        Some("gltf" | "glb") => Some(Kind::Gltf),
        Some("obj") => Some(Kind::Mesh(Format::Obj)),
        Some("off") => Some(Kind::Mesh(Format::Off)),
        Some("ply") => Some(Kind::Mesh(Format::Ply)),
        _ if file.bytes.starts_with(b"ply\n") || file.bytes.starts_with(b"ply\r") => Some(Kind::Mesh(Format::Ply)),
        _ if file.bytes.starts_with(b"OFF") => Some(Kind::Mesh(Format::Off)),
        _ => None,
    }
}

/// True for what file managers leave in folders.
fn is_hidden(name: &str) -> bool {
    name.split(['/', '\\']).any(|part| (part.starts_with('.') && part != "." && part != "..") || part == "__MACOSX")
}

/// `1 face was`, `2 faces were`.
fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}
