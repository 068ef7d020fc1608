//! The public sequences, as far as they are at hand, through segmentation and key points: one line each.
//!
//! Everything must come through with finite results; how long it takes and what is left is told.

#[path = "../tests/common/npz.rs"]
mod npz;

use sinew::clock;
use sinew::import::{File, Imported, Options, open};
use sinew::keypoints::{self, select};
use sinew::observer::Silent;
use sinew::segmentation::{self, segment};
use sinew::sequence::Sequence;
use std::path::{Path, PathBuf};

/// Files of a folder, in the order of their names; those of the weights are no sequences.
fn inside(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.path()).collect();
    paths.retain(|path| !path.to_string_lossy().ends_with("_weights.npz"));
    paths.sort();
    paths
}

/// A folder of meshes as a sequence.
fn opened(folder: &Path) -> Option<Imported> {
    let name = |path: &Path| path.strip_prefix(folder.parent()?).ok().map(|name| name.display().to_string());
    let read = |path: PathBuf| Some(File { name: name(&path)?, bytes: std::fs::read(path).ok()? });
    let files: Vec<File> = inside(folder).into_iter().filter_map(read).collect();
    open(&files, &Options::default()).map_err(|error| println!("{}: {error}", folder.display())).ok()
}

fn run(sequence: &Sequence) {
    let begun = clock::seconds();
    let parts = segment(sequence, &segmentation::Parameters::default(), &mut Silent);
    let between = clock::seconds();
    let points = select(sequence, &keypoints::Parameters::default(), &mut Silent);
    let end = clock::seconds();
    let sizes = sequence.sizes();
    print!("{:<18} {:>6} faces {:>3} poses", sequence.name(), sizes.faces, sizes.poses);
    match parts {
        Ok(parts) => {
            assert!(parts.rigid_residual.is_finite() && parts.labels.len() == sizes.faces);
            print!("  {:>3} parts, residual {:.4}, {:.2} s", parts.parts.len(), parts.rigid_residual, between - begun);
        }
        Err(error) => print!("  no parts: {error}"),
    }
    match points {
        Ok(points) => {
            assert!(points.errors.iter().all(|e| e.is_finite()));
            let last = points.errors.last().copied().unwrap_or(0.0);
            println!("  {:>3} key points, error {last:.4}, {:.1} s", points.key_points.len(), end - between);
        }
        Err(error) => println!("  no key points: {error}"),
    }
}

fn main() {
    let Some(data) = npz::data("the public sequences") else { return };
    for folder in ["sumner", "seq", "tosca"] {
        for path in inside(&data.join(folder)) {
            if path.extension().is_some_and(|end| end == "npz") {
                run(&npz::sequence(&path));
            } else if path.is_dir()
                && let Some(imported) = opened(&path)
            {
                run(&imported.sequence);
            }
        }
    }
}
