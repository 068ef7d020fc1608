//! What every command that reads a mesh shares: the files and how to read them.

use crate::Refusal;
use clap::{Args, ValueEnum};
use sinew::import::{
    File, Imported, Options, Reference, Sampling, Up, may_be_needed, natural_order, needed_for_look, open_in_order,
};
use sinew::warning::Warning;
use std::collections::BTreeSet;
use std::io::Write;
use std::path::{Path, PathBuf};

/// Files, and how to read them.
#[derive(Args)]
pub struct Input {
    /// One glTF or GLB; or OBJ, OFF, PLY or STL files, the first the reference pose, the others its poses; or a folder
    /// or zip archive of these
    #[arg(required = true)]
    input: Vec<PathBuf>,
    /// The clip of a glTF, by name or by number from 0 (default: the first that moves the mesh)
    #[arg(long)]
    clip: Option<String>,
    /// Poses a second of a glTF's clip
    #[arg(long, default_value_t = 12.0, conflicts_with = "keys")]
    fps: f64,
    /// A pose at every key of the clip, instead of so many a second
    #[arg(long)]
    keys: bool,
    /// The reference pose of a glTF
    #[arg(long, value_enum, default_value_t = ReferenceArgument::Bind)]
    reference: ReferenceArgument,
    /// Keep vertices apart that agree in every pose (seams of texture and normals)
    #[arg(long)]
    no_weld: bool,
    /// The axis that is up in the files: x, y, z, -x, -y or -z (default: z for STL, y for all else)
    #[arg(long, value_name = "AXIS", value_parser = axis, allow_hyphen_values = true)]
    up: Option<Up>,
}

/// The other mesh, and how to read it.
#[derive(Args)]
pub struct Target {
    /// The mesh that is to move, or on which points are to be found: its reference pose
    #[arg(long, value_name = "MESH")]
    target: PathBuf,
    /// The axis that is up in the target and in its true poses (named and chosen as with --up)
    #[arg(long, value_name = "AXIS", value_parser = axis, allow_hyphen_values = true)]
    target_up: Option<Up>,
}

/// An axis by its name.
fn axis(name: &str) -> Result<Up, serde_json::Error> {
    serde_json::from_value(name.to_lowercase().into())
}

#[derive(Clone, Copy, ValueEnum)]
enum ReferenceArgument {
    /// The pose in which skins were bound
    Bind,
    /// Every node where the file puts it
    Nodes,
    /// The first pose of the clip
    First,
}

impl Input {
    /// Reads the files.
    pub fn open(&self) -> Result<Imported, Refusal> {
        let mut files = Vec::new();
        for path in &self.input {
            if path.is_dir() { read_folder(path, &mut files)? } else { files.push(read(path)?) }
        }
        if self.input.first().is_some_and(|path| path.is_dir()) {
            natural_order(&mut files);
        } else if let Some((_, poses)) = files.split_first_mut() {
            natural_order(poses);
        }
        if let [document] = self.input.as_slice() {
            files.extend(beside(document)?);
        }
        let options = Options {
            clip: self.clip.clone(),
            sampling: if self.keys { Sampling::Keys } else { Sampling::Rate(self.fps) },
            reference: match self.reference {
                ReferenceArgument::Bind => Reference::Bind,
                ReferenceArgument::Nodes => Reference::Nodes,
                ReferenceArgument::First => Reference::FirstFrame,
            },
            weld: !self.no_weld,
            up: self.up,
            ..Options::default()
        };
        Ok(open_in_order(&files, &options)?)
    }

    /// Reads the target.
    pub fn open_target(&self, target: &Target) -> Result<Imported, Refusal> {
        self.open_still(&target.target, target.target_up)
    }

    /// Reads one more file as a mesh that stands still, its vertices numbered as those of the input are; with its look.
    /// `up` as of [`Options`].
    pub fn open_still(&self, path: &Path, up: Option<Up>) -> Result<Imported, Refusal> {
        let options = Options { weld: !self.no_weld, look: true, up, ..Options::default() };
        let mut files = vec![read(path)?];
        files.extend(beside(path)?);
        files.extend(materials(path, &files[0]));
        Ok(at_rest(open_in_order(&files, &options)?))
    }

    /// As [`Input::open`], for what needs no motion.
    pub fn open_at_rest(&self) -> Result<Imported, Refusal> {
        self.open().map(at_rest)
    }
}

/// Without a note that it stands still, which it may.
fn at_rest(mut mesh: Imported) -> Imported {
    mesh.warnings.retain(|warning| warning.code != "no-animation");
    mesh
}

/// Prints warnings to standard error.
pub fn print_warnings(warnings: &[Warning]) {
    for warning in warnings {
        // Nobody may be reading, which is no error.
        let _ = writeln!(std::io::stderr(), "note: {}", warning.message);
    }
}

fn read(path: &Path) -> Result<File, Refusal> {
    let name = path.display().to_string();
    match std::fs::read(path) {
        Ok(bytes) => Ok(File { name, bytes }),
        Err(error) => Err(Refusal(format!("{name} cannot be read: {error}"))),
    }
}

/// Everything in a folder that a mesh may need, folders in it included.
fn read_folder(folder: &Path, files: &mut Vec<File>) -> Result<(), Refusal> {
    let wrong = |error: std::io::Error| Refusal(format!("{} cannot be read: {error}", folder.display()));
    for entry in std::fs::read_dir(folder).map_err(wrong)? {
        let entry = entry.map_err(wrong)?;
        // A link to a folder is not followed: it may lead back here.
        if entry.file_type().map_err(wrong)?.is_dir() {
            read_folder(&entry.path(), files)?;
        } else if may_be_needed(&entry.path().display().to_string(), false) {
            files.push(read(&entry.path())?);
        }
    }
    Ok(())
}

/// The buffers and images that a glTF names, as far as they are there: a missing one is the importer's to explain.
fn beside(document: &Path) -> Result<Vec<File>, Refusal> {
    if !document.extension().is_some_and(|end| end.eq_ignore_ascii_case("gltf")) {
        return Ok(Vec::new());
    }
    let folder = document.parent().unwrap_or(Path::new(""));
    let bytes = read(document)?.bytes;
    let Ok(json) = serde_json::from_slice::<serde_json::Value>(&bytes) else { return Ok(Vec::new()) };
    let lists = ["buffers", "images"].into_iter().filter_map(|key| json.get(key)?.as_array());
    let addresses = lists.flatten().filter_map(|b| b.get("uri")?.as_str()).filter(|uri| !uri.starts_with("data:"));
    let decoded = addresses.map(sinew::import::gltf::percent_decoded);
    Ok(decoded.filter_map(|name| read(&folder.join(name)).ok()).collect())
}

/// The lists of materials that an OBJ names and the pictures that these name, as far as they are there. Only what lies
/// beside it, or in folders beside it, is read, whatever the names say.
fn materials(path: &Path, mesh: &File) -> Vec<File> {
    if !path.extension().is_some_and(|end| end.eq_ignore_ascii_case("obj")) {
        return Vec::new();
    }
    let folder = path.parent().unwrap_or(Path::new(""));
    let whole =
        |folder: &Path| if folder == Path::new("") { Path::new(".").canonicalize() } else { folder.canonicalize() };
    let Ok(root) = whole(folder) else { return Vec::new() };
    let mut known = BTreeSet::new();
    let mut named = |folder: &Path, file: &File| -> Vec<File> {
        let paths = needed_for_look(file).into_iter().map(|name| folder.join(name.replace('\\', "/")));
        let inside =
            |path: &PathBuf| path.canonicalize().is_ok_and(|whole| whole.starts_with(&root) && whole.is_file());
        paths.filter(inside).filter(|path| known.insert(path.clone())).filter_map(|path| read(&path).ok()).collect()
    };
    let lists = named(folder, mesh);
    let folder_of = |list: &File| Path::new(&list.name).parent().unwrap_or(Path::new("")).to_owned();
    let pictures: Vec<File> = lists.iter().flat_map(|list| named(&folder_of(list), list)).collect();
    lists.into_iter().chain(pictures).collect()
}
