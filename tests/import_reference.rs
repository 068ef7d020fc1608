//! Imports against values that another program computed, and against everything at hand.
//!
//! The assets are not part of the project: where the folder beside it is missing, these tests say so and are left
//! out.
#![cfg(not(target_arch = "wasm32"))]

#[path = "import/variants.rs"]
mod variants;

use sinew::import::gltf::Model;
use sinew::import::{File, Options, Reference, Sampling, open};
use std::io::Write;
use std::path::{Path, PathBuf};

/// The folder of assets, or a sentence on standard error (past the test harness, so that it is seen).
fn data() -> Option<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared/data");
    if folder.join("gltf").is_dir() {
        return Some(folder);
    }
    let _ = writeln!(std::io::stderr(), "left out: ../shared/data is not there, so no imports were compared");
    None
}

fn read(path: &Path) -> File {
    File { name: path.to_string_lossy().into_owned(), bytes: std::fs::read(path).unwrap() }
}

/// A document and the files beside it.
fn with_neighbours(path: &Path) -> Vec<File> {
    let mut files = vec![read(path)];
    let beside = std::fs::read_dir(path.parent().unwrap()).unwrap();
    let mut bins: Vec<PathBuf> =
        beside.map(|e| e.unwrap().path()).filter(|p| p.extension().is_some_and(|e| e == "bin")).collect();
    bins.sort();
    files.extend(bins.iter().map(|p| read(p)));
    files
}

fn floats(path: &Path) -> Vec<f64> {
    let bytes = std::fs::read(path).unwrap();
    bytes.chunks_exact(4).map(|b| f64::from(f32::from_le_bytes(b.try_into().unwrap()))).collect()
}

/// The largest distance of a corner of a face from where the other program has it, over the diagonal.
fn difference(faces: &[[u32; 3]], positions: &[glam::DVec3], their_faces: &[u32], theirs: &[f64]) -> f64 {
    assert_eq!(3 * faces.len(), their_faces.len(), "numbers of corners");
    let at = |v: u32| glam::DVec3::from_slice(&theirs[3 * v as usize..]);
    let low = their_faces.iter().map(|&v| at(v)).fold(glam::DVec3::INFINITY, glam::DVec3::min);
    let high = their_faces.iter().map(|&v| at(v)).fold(glam::DVec3::NEG_INFINITY, glam::DVec3::max);
    let corners = faces.iter().flatten().zip(their_faces);
    let largest = corners.map(|(&a, &b)| positions[a as usize].distance(at(b))).fold(0.0, f64::max);
    largest / low.distance(high)
}

#[test]
fn poses_agree_with_three_js() {
    let Some(data) = data() else { return };
    let mut compared = 0;
    let mut names: Vec<PathBuf> =
        std::fs::read_dir(data.join("reference/gltf")).unwrap().map(|e| e.unwrap().path()).collect();
    names.retain(|p| p.extension().is_some_and(|e| e == "json"));
    names.sort();
    for path in names {
        let meta: serde_json::Value = serde_json::from_slice(&std::fs::read(&path).unwrap()).unwrap();
        let name = path.file_stem().unwrap().to_str().unwrap().to_owned();
        let beside = |end: &str| path.with_file_name(format!("{name}.{end}"));
        let asset = data.join(meta["file"].as_str().unwrap());
        let files = with_neighbours(&asset);
        let model = Model::read(&files[0], &files, false, &mut Vec::new()).unwrap();
        let their_faces: Vec<u32> = std::fs::read(beside("faces.i32"))
            .unwrap()
            .chunks_exact(4)
            .map(|b| u32::from_le_bytes(b.try_into().unwrap()))
            .collect();
        let rest = difference(model.faces(), &model.rest(), &their_faces, &floats(&beside("rest.f32")));
        assert!(rest < 1e-4, "{name} at rest is off by {rest}");
        let mut worst = rest;
        for (clip, entry) in meta["clips"].as_array().unwrap().iter().enumerate() {
            let poses = floats(&beside(&format!("clip{clip}.f32")));
            let times = entry["times"].as_array().unwrap();
            for (theirs, time) in poses.chunks_exact(poses.len() / times.len()).zip(times) {
                let ours = model.pose(clip, time.as_f64().unwrap());
                let off = difference(model.faces(), &ours, &their_faces, theirs);
                assert!(off < 1e-4, "{name}, clip {clip} at {time} is off by {off}");
                worst = worst.max(off);
                compared += 1;
            }
        }
        println!("{name}: {} vertices, off by at most {worst:.1e} of the diagonal", model.vertices());
    }
    assert!(compared >= 150, "only {compared} poses were compared");
}

/// Bind poses have the size and the orientation of the animation: Fox and CesiumMan are bound in frames of other
/// orientation than the scene's.
#[test]
fn bind_poses_stand_like_the_animation() {
    let Some(data) = data() else { return };
    for asset in [
        "bevy/animated/Fox.glb",
        "khronos/CesiumMan/glTF-Binary/CesiumMan.glb",
        "khronos/RiggedFigure/glTF-Binary/RiggedFigure.glb",
    ] {
        let files = [read(&data.join("gltf").join(asset))];
        let imported = open(&files, &Options { reference: Reference::Bind, ..Options::default() }).unwrap();
        let extent = |positions: &[glam::DVec3]| {
            let low = positions.iter().copied().fold(glam::DVec3::INFINITY, glam::DVec3::min);
            positions.iter().copied().fold(glam::DVec3::NEG_INFINITY, glam::DVec3::max) - low
        };
        let bind = extent(imported.sequence.reference());
        let posed = extent(&imported.sequence.poses()[0].positions);
        println!("{asset}: bind {bind:.3}, posed {posed:.3}");
        // Upright: the height is about the same in both, which a pose lying on its side would not give.
        assert!((bind.y / posed.y - 1.0).abs() < 0.2, "{asset}: bind pose {bind}, animation {posed}");
    }
}

/// What another project keeps to try its reader with: refused with the reason, or mended and told. Where only the look
/// is damaged (materials, textures), the shape is read.
#[test]
fn malformed_files_are_refused_or_mended_in_words() {
    let Some(data) = data() else { return };
    let open = |name: &str| {
        let path = data.join("gltf/assimp").join(name);
        open(&with_neighbours(&path), &Options::default())
    };
    for (name, part) in [
        ("IndexOutOfRange/IndexOutOfRange.gltf", "names vertex 255, but there are only 24 vertices"),
        ("IndexOutOfRange/AllIndicesOutOfRange.gltf", "names vertex 65535"),
        ("BoxWithInfinites-glTF-Binary/BoxWithInfinites.glb", "not a finite number"),
        ("MissingBin/BoxTextured.gltf", "keeps its data in BoxTextured0.bin, which was not given"),
        ("SchemaFailures/sceneWrongType.gltf", "the default scene is \"hello\""),
        ("TestNoRootNode/NoScene.gltf", "shows no triangle mesh"),
        ("TestNoRootNode/SceneWithoutNodes.gltf", "shows no triangle mesh"),
        ("RecursiveNodes/RecursiveNodes.gltf", "is its own ancestor"),
        ("wrongTypes/badArray.gltf", "mesh 0 of"),
    ] {
        let why = open(name).unwrap_err().0;
        assert!(why.contains(part), "{name}: {why}");
    }
    for name in ["badExtension", "badNumber", "badObject", "badString", "badUint"] {
        assert_eq!(open(&format!("wrongTypes/{name}.gltf")).unwrap().sequence.faces().len(), 12, "{name}");
    }
    let mended = open("IncorrectVertexArrays/Cube.gltf").unwrap();
    for code in ["primitive-left-out", "incomplete-triangle"] {
        assert!(mended.warnings.iter().any(|w| w.code == code), "{code}: {:?}", mended.warnings);
    }
}

#[test]
fn every_asset_opens_or_is_refused_in_words() {
    let Some(data) = data() else { return };
    let mut documents = Vec::new();
    collect(&data.join("gltf"), &mut documents);
    documents.sort();
    assert!(documents.len() > 80);
    let (mut opened, mut refused) = (0, 0);
    for path in documents {
        let short = path.strip_prefix(&data).unwrap().display().to_string();
        let files = with_neighbours(&path);
        for options in [
            Options::default(),
            Options { sampling: Sampling::Keys, reference: Reference::FirstFrame, weld: false, ..Options::default() },
        ] {
            match open(&files, &options) {
                Ok(imported) => {
                    opened += 1;
                    let warnings: Vec<_> = imported.warnings.iter().map(|w| w.message.as_str()).collect();
                    println!("{short}: {:?} {}", imported.sequence.sizes(), warnings.join(" "));
                }
                Err(error) => {
                    refused += 1;
                    assert!(error.0.len() > 20 && !error.0.contains('\n'), "{error}");
                    println!("{short}: REFUSED {error}");
                }
            }
        }
    }
    println!("{opened} opened, {refused} refused");
    assert!(opened > 3 * refused);
}

fn collect(folder: &Path, into: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            collect(&path, into);
        } else if path.extension().is_some_and(|e| e == "gltf" || e == "glb") {
            into.push(path);
        }
    }
}
