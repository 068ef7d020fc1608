//! The same animal in other files: re-encoded, compressed, quantised, split into several files. Every pose is compared
//! with what another program computed, and the parts with those of the original.

#[path = "../common/agreement.rs"]
mod agreement;

use super::{collect, data, floats, read, with_neighbours};
use glam::DVec3;
use sinew::import::gltf::Model;
use sinew::import::{Clip, Options, open};
use sinew::observer::Silent;
use sinew::segmentation::{Parameters, segment};
use sinew::sequence::Sequence;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// A face's centroid in every pose, one after the other.
type Path3 = Vec<DVec3>;

fn paths(faces: &[[u32; 3]], poses: &[Vec<DVec3>]) -> Vec<Path3> {
    let centroid = |face: &[u32; 3], pose: &Vec<DVec3>| face.iter().map(|&v| pose[v as usize]).sum::<DVec3>() / 3.0;
    faces.iter().map(|face| poses.iter().map(|pose| centroid(face, pose)).collect()).collect()
}

/// For each face of `a` the face of `b` that is nearest to it in the pose in which they are farthest apart, and that
/// distance. Faces of one file may come in another order in another.
fn nearest(a: &[Path3], b: &[Path3]) -> Vec<(usize, f64)> {
    let mut order: Vec<usize> = (0..b.len()).collect();
    order.sort_by(|&i, &j| b[i][0].x.total_cmp(&b[j][0].x));
    let apart = |p: &Path3, q: &Path3, enough: f64| {
        let mut far: f64 = 0.0;
        for (p, q) in p.iter().zip(q) {
            far = far.max(p.distance(*q));
            if far >= enough {
                break;
            }
        }
        far
    };
    let one = |path: &Path3| {
        let start = order.partition_point(|&i| b[i][0].x < path[0].x);
        let (mut up, mut down) = (start, start);
        let mut best = (usize::MAX, f64::INFINITY);
        // Outwards from where it would stand, until even the first coordinate is farther away than the best.
        loop {
            let right = order.get(up).filter(|&&i| b[i][0].x - path[0].x < best.1);
            let left = down.checked_sub(1).map(|k| order[k]).filter(|&i| path[0].x - b[i][0].x < best.1);
            if right.is_none() && left.is_none() {
                return best;
            }
            for &i in right.into_iter().chain(left.iter()) {
                let far = apart(path, &b[i], best.1);
                if far < best.1 {
                    best = (i, far);
                }
            }
            up += usize::from(right.is_some());
            down -= usize::from(left.is_some());
        }
    };
    a.iter().map(one).collect()
}

fn diagonal(positions: &[DVec3], faces: &[[u32; 3]]) -> f64 {
    let used = || faces.iter().flatten().map(|&v| positions[v as usize]);
    used().fold(DVec3::NEG_INFINITY, DVec3::max).distance(used().fold(DVec3::INFINITY, DVec3::min))
}

/// The name of the animal in a file's name: `Fox` of `Fox-draco.glb`.
fn animal(path: &Path) -> String {
    let stem = path.file_stem().unwrap().to_str().unwrap();
    stem.split('-').next().unwrap_or(stem).to_owned()
}

/// How far a file may be off, as a share of the diagonal: more where coordinates were rounded on purpose.
fn allowed(path: &Path) -> f64 {
    let name = path.display().to_string();
    if ["-quantized", "-draco", "-meshopt"].iter().any(|end| name.contains(end)) { 1e-3 } else { 1e-4 }
}

/// What comparing a file came to.
enum Outcome {
    Agrees,
    DoesNotMove,
    /// Why there is nothing to compare it with.
    Without(String),
}

/// Compares a file with what another program made of it or of the file that it is a variant of.
fn compare(path: &Path, data: &Path) -> Outcome {
    let short = path.strip_prefix(data).unwrap().display().to_string();
    let files = with_neighbours(path);
    let Ok(model) = Model::read(&files[0], &files, false, &mut Vec::new()) else { return Outcome::DoesNotMove };
    if model.clips().is_empty() {
        return Outcome::DoesNotMove;
    }
    let reference = data.join("reference/gltf").join(format!("{}.json", animal(path)));
    let Ok(text) = std::fs::read(&reference) else {
        return Outcome::Without(short);
    };
    let meta: serde_json::Value = serde_json::from_slice(&text).unwrap();
    let own = with_neighbours(&data.join(meta["file"].as_str().unwrap()));
    let clips = Model::read(&own[0], &own, false, &mut Vec::new()).unwrap().clips();
    let lengths = |clips: &[Clip]| clips.iter().map(|c| (c.seconds * 1e3).round()).collect::<Vec<_>>();
    if lengths(&model.clips()) != lengths(&clips) {
        return Outcome::Without(format!("{short} (other clips than {})", meta["file"]));
    }
    let beside = |end: &str| reference.with_extension(end);
    let their_faces: Vec<[u32; 3]> = std::fs::read(beside("faces.i32"))
        .unwrap()
        .chunks(12)
        .map(|f| [0, 4, 8].map(|k| u32::from_le_bytes(f[k..k + 4].try_into().unwrap())))
        .collect();
    let points = |flat: &[f64]| flat.chunks(3).map(DVec3::from_slice).collect::<Vec<_>>();
    let (mut ours, mut theirs) = (vec![model.rest()], vec![points(&floats(&beside("rest.f32")))]);
    for (clip, entry) in meta["clips"].as_array().unwrap().iter().enumerate() {
        let times: Vec<f64> = entry["times"].as_array().unwrap().iter().map(|t| t.as_f64().unwrap()).collect();
        let poses = floats(&beside(&format!("clip{clip}.f32")));
        theirs.extend(poses.chunks(poses.len() / times.len()).map(points));
        ours.extend(times.iter().map(|&time| model.pose(clip, time)));
    }
    // Encoders leave out triangles of no area; what is left must be the same.
    let whole = |faces: &[[u32; 3]], pose: &[DVec3]| -> Vec<[u32; 3]> {
        let at = |v: u32| pose[v as usize];
        let area = |[a, b, c]: [u32; 3]| (at(b) - at(a)).cross(at(c) - at(a)).length();
        faces.iter().copied().filter(|&f| area(f) > 1e-9 * diagonal(pose, faces).powi(2)).collect()
    };
    let size = diagonal(&theirs[0], &their_faces);
    let (a, b) = (paths(model.faces(), &ours), paths(&their_faces, &theirs));
    let sound = [paths(&whole(model.faces(), &ours[0]), &ours), paths(&whole(&their_faces, &theirs[0]), &theirs)];
    let mut worst: f64 = 0.0;
    for (from, to) in [(&sound[0], &b), (&sound[1], &a)] {
        worst = nearest(from, to).iter().map(|(_, far)| far / size).fold(worst, f64::max);
    }
    println!("{short}: {} faces, {} poses, off by at most {worst:.1e} of the diagonal", a.len(), ours.len());
    assert!(worst < allowed(path), "{short} is off by {worst} of the diagonal");
    Outcome::Agrees
}

#[test]
fn every_animated_file_agrees_with_another_program() {
    let Some(data) = data() else { return };
    let mut documents = Vec::new();
    collect(&data.join("gltf"), &mut documents);
    documents.sort();
    let (even, odd): (Vec<_>, Vec<_>) = documents.iter().enumerate().partition(|(i, _)| i % 2 == 0);
    let all = |some: Vec<(usize, &PathBuf)>| some.into_iter().map(|(_, path)| compare(path, &data)).collect::<Vec<_>>();
    let outcomes = std::thread::scope(|scope| {
        let beside = scope.spawn(|| all(odd));
        let mut outcomes = all(even);
        outcomes.extend(beside.join().unwrap());
        outcomes
    });
    let compared = outcomes.iter().filter(|outcome| matches!(outcome, Outcome::Agrees)).count();
    let without = outcomes.iter().filter_map(|outcome| match outcome {
        Outcome::Without(why) => Some(why.as_str()),
        _ => None,
    });
    println!("{compared} files compared; without a reference: {}", without.collect::<Vec<_>>().join(", "));
    assert!(compared >= 30, "only {compared} files were compared");
}

fn sequence(path: &Path) -> Sequence {
    open(&[read(path)], &Options::default()).unwrap().sequence
}

#[test]
fn re_encoded_files_have_the_same_parts() {
    let Some(data) = data() else { return };
    let originals = BTreeMap::from([
        ("Fox", "bevy/animated/Fox.glb"),
        ("CesiumMan", "khronos/CesiumMan/glTF-Binary/CesiumMan.glb"),
        ("RiggedFigure", "khronos/RiggedFigure/glTF-Binary/RiggedFigure.glb"),
    ]);
    let mut variants: Vec<PathBuf> = Vec::new();
    collect(&data.join("gltf/variants"), &mut variants);
    variants.sort();
    let mut worst: f64 = 1.0;
    for path in variants {
        let original = sequence(&data.join("gltf").join(originals[animal(&path).as_str()]));
        let variant = sequence(&path);
        let labels = |sequence: &Sequence| segment(sequence, &Parameters::default(), &mut Silent).unwrap().labels;
        let of = |s: &Sequence| paths(s.faces(), &s.poses().iter().map(|p| p.positions.clone()).collect::<Vec<_>>());
        let theirs = labels(&variant);
        let there: Vec<u32> = nearest(&of(&original), &of(&variant)).iter().map(|&(f, _)| theirs[f]).collect();
        let same = agreement::agreement(&original, &labels(&original), &there);
        let name = path.file_name().unwrap().display().to_string();
        println!("{name}: {:?}, {same:.4} of the area in the same parts", variant.sizes());
        worst = worst.min(same);
    }
    assert!(worst >= 0.98, "only {worst} of the area is in the same parts");
}
