//! From files to a [`Sequence`], with warnings.
//!
//! [`open`] takes the files as a person gives them (one glTF or GLB with whatever lies beside it, numbered OBJ, OFF,
//! PLY or STL files, or a zip archive of any of these) and returns a checked sequence, or one sentence that says what
//! is wrong.

mod archive;
mod beside;
pub mod gltf;
mod limits;
mod natural;
mod numbered;
mod obj;
mod off;
mod off_binary;
mod ply;
mod polygons;
mod seams;
mod stl;
mod text;
mod upright;
mod zip;

pub use archive::may_be_needed;
pub use natural::natural_order;
pub use obj::needed as needed_for_look;
pub use upright::Up;

use crate::look::Look;
use crate::sequence::Sequence;
use crate::warning::Warning;
use limits::Budget;
use serde::{Deserialize, Serialize};
use std::borrow::Cow;

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
    /// Join vertices that agree in every pose (glTF only: seams of UVs and normals; STL is welded in any case).
    pub weld: bool,
    /// Read what the mesh looks like, too (glTF and OBJ only).
    pub look: bool,
    /// The axis that is up in the files; what their format says if `None`: z for STL, which is made for construction and
    /// printing, y for all else.
    pub up: Option<Up>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            clip: None,
            sampling: Sampling::default(),
            reference: Reference::default(),
            weld: true,
            look: false,
            up: None,
        }
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
    /// The mesh and its poses, y being up.
    pub sequence: Sequence,
    /// The axis that was up in the files.
    pub up: Up,
    /// The animations that the file has (empty for OBJ, OFF, PLY and STL).
    pub clips: Vec<Clip>,
    /// The clip that was sampled: an index into `clips`.
    pub clip: Option<usize>,
    /// The number of faces that the input has, a polygon counted as one face. `sequence.polygons()` says which of
    /// them each triangle of the sequence comes from, where the two differ.
    pub input_faces: usize,
    /// What the mesh looks like, if that was asked for and the file says it.
    pub look: Option<Look>,
    /// What was noticed on the way.
    pub warnings: Vec<Warning>,
}

/// Why files cannot be opened: one sentence for a person.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error("{0}")]
pub struct ImportError(pub String);

/// The longest sentence, in characters: names in a file may have any length.
const LONGEST: usize = 600;

impl ImportError {
    /// Names out of a file, and what other programs say, may hold line breaks and other control characters.
    fn on_one_line(self) -> Self {
        let plain = self.0.split(|c: char| c.is_control()).map(str::trim).filter(|part| !part.is_empty());
        let mut text = plain.collect::<Vec<_>>().join(" ");
        if let Some((end, _)) = text.char_indices().nth(LONGEST) {
            text.truncate(end);
            text.push('…');
        }
        Self(text)
    }
}

/// Reads the given files, which may be in any order, as when they are dropped on a page.
///
/// One glTF or GLB (with its buffers beside it), or several OBJ, OFF, PLY or STL files: the first in
/// [`natural_order`] is the reference pose, the others are its poses. A zip archive stands for what is in it. Files
/// that are none of these are passed over.
pub fn open(files: &[File], options: &Options) -> Result<Imported, ImportError> {
    let unpacked = unpacked(files, options.look)?;
    let files = unpacked.as_ref();
    let mut order: Vec<&File> = files.iter().collect();
    natural::sort(&mut order);
    open_listed(&order, files, options)
}

/// Reads the given files in the given order, as on a command line: of OBJ, OFF, PLY and STL files the first is the
/// reference pose, the others are its poses. Otherwise as [`open`]; what is in an archive comes in natural order.
pub fn open_in_order(files: &[File], options: &Options) -> Result<Imported, ImportError> {
    let unpacked = unpacked(files, options.look)?;
    let files = unpacked.as_ref();
    open_listed(&files.iter().collect::<Vec<_>>(), files, options)
}

/// Reads more files for a mesh that was opened before from `still` and stands still: its poses, where they are meshes
/// of the same kind, with as many vertices and faces. Otherwise as [`open`] with `more` alone. `options.up` is that of the
/// mesh and its poses; what stands alone is up as its format says.
///
/// Returns with the result whether the poses joined the mesh.
pub fn open_more(still: &[File], more: &[File], options: &Options) -> Result<(Imported, bool), ImportError> {
    let (still, more) = (unpacked(still, false)?, unpacked(more, options.look)?);
    let (still, more) = (still.as_ref(), more.as_ref());
    let mut poses: Vec<&File> = more.iter().collect();
    natural::sort(&mut poses);
    let (resting, moving) = (sorted_out(still.iter()), sorted_out(poses.iter().copied()));
    if let ([], [resting]) = (resting.documents.as_slice(), resting.meshes.as_slice())
        && moving.documents.is_empty()
        && !moving.meshes.iter().any(|(file, _)| last_part(&file.name) == last_part(&resting.0.name))
    {
        let all: Vec<_> = [resting].into_iter().chain(&moving.meshes).copied().collect();
        match numbered::open(&all, None) {
            Ok(joined) if all.len() > 1 && !joined.warnings.iter().any(|w| w.code == numbered::DIFFERENT) => {
                return Ok((upright::upright(joined, options.up), true));
            }
            _ => {}
        }
    }
    let options = Options { up: None, ..options.clone() };
    open_listed(&poses, more, &options).map(|imported| (imported, false))
}

/// The files, with what is in archives in place of these.
fn unpacked(files: &[File], look: bool) -> Result<Cow<'_, [File]>, ImportError> {
    if !files.iter().any(|file| archive::is_zip(&file.bytes)) {
        return Ok(Cow::Borrowed(files));
    }
    let mut budget = Budget::new("what was given");
    let mut all = Vec::new();
    for file in files {
        if archive::is_zip(&file.bytes) {
            let mut inside = archive::unpack(file, look, &mut budget).map_err(ImportError::on_one_line)?;
            natural_order(&mut inside);
            all.extend(inside);
        } else {
            all.push(file.clone());
        }
    }
    Ok(Cow::Owned(all))
}

/// The files that can be read, by what they are.
struct SortedOut<'a> {
    documents: Vec<&'a File>,
    meshes: Vec<(&'a File, numbered::Format)>,
}

fn sorted_out<'a>(files: impl Iterator<Item = &'a File>) -> SortedOut<'a> {
    let mut found = SortedOut { documents: Vec::new(), meshes: Vec::new() };
    for file in files.filter(|file| !is_hidden(&file.name)) {
        match kind(file) {
            Some(Kind::Gltf) => found.documents.push(file),
            Some(Kind::Mesh(format)) => found.meshes.push((file, format)),
            None => {}
        }
    }
    found
}

fn open_listed(order: &[&File], files: &[File], options: &Options) -> Result<Imported, ImportError> {
    let imported = read_listed(order, files, options).map_err(ImportError::on_one_line)?;
    Ok(upright::upright(imported, options.up))
}

fn read_listed(order: &[&File], files: &[File], options: &Options) -> Result<Imported, ImportError> {
    let found = sorted_out(order.iter().copied());
    match (found.documents.as_slice(), found.meshes.as_slice()) {
        ([document], meshes) => {
            let mut imported = gltf::open(document, files, options)?;
            if let [first, ..] = meshes {
                let which = match meshes.len() {
                    1 => first.0.name.clone(),
                    more => format!("{} and {} more", first.0.name, more - 1),
                };
                let message = format!("{} was opened, and what lay beside it left out: {which}.", document.name);
                imported.warnings.push(Warning::new("meshes-left-out", message));
            }
            Ok(imported)
        }
        ([first, second, rest @ ..], _) => Err(ImportError(format!(
            "several glTF files were given ({}, {}{}); give one at a time",
            first.name,
            second.name,
            if rest.is_empty() { "" } else { ", …" }
        ))),
        ([], []) => Err(ImportError(nothing_to_read(files))),
        ([], meshes) => numbered::open(meshes, options.look.then_some(files)),
    }
}

fn nothing_to_read(files: &[File]) -> String {
    match files {
        [] => "no file was given; give one glTF or GLB, or OBJ, OFF, PLY or STL files".into(),
        [file] => format!("{} is no glTF, GLB, OBJ, OFF, PLY, STL or zip file, which is what can be read", file.name),
        _ => {
            format!(
                "none of the {} files is a glTF, GLB, OBJ, OFF, PLY or STL file, which is what can be read",
                files.len()
            )
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
        Some("stl") => Some(Kind::Mesh(Format::Stl)),
        _ if file.bytes.starts_with(b"ply\n") || file.bytes.starts_with(b"ply\r") => Some(Kind::Mesh(Format::Ply)),
        _ if file.bytes.starts_with(b"OFF") => Some(Kind::Mesh(Format::Off)),
        _ => None,
    }
}

/// True for what file managers leave in folders.
fn is_hidden(name: &str) -> bool {
    last_part(name).starts_with('.') || name.split(['/', '\\']).any(|part| part == "__MACOSX")
}

/// The last part of a path.
fn last_part(path: &str) -> &str {
    path.rsplit(['/', '\\']).next().unwrap_or(path)
}

/// `1 face was`, `2 faces were`.
fn counted(count: usize, one: &str, many: &str) -> String {
    format!("{count} {}", if count == 1 { one } else { many })
}
