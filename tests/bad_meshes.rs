//! Every algorithm on every odd mesh: results are finite and fit together, or one sentence says why there are none.
#![cfg(not(target_arch = "wasm32"))]

#[path = "common/odd_meshes.rs"]
mod odd_meshes;

use glam::DVec3;
use odd_meshes::{all, healthy};
use sinew::export::animation::{exact, light_transfer};
use sinew::export::glb;
use sinew::import::{File, Options, open};
use sinew::keypoints;
use sinew::mesh::doctor::{Code, Diagnosis};
use sinew::observer::Silent;
use sinew::segmentation::{self, Method};
use sinew::sequence::{Pose, Sequence, SequenceError};
use sinew::transfer::propose::Proposer;
use sinew::transfer::{self, Pair, Prepared};
use sinew::weights::{self, Biharmonic};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What a try answers: nothing to complain about, or what is wrong.
type Outcome = Result<(), String>;

/// Runs a try on every mesh and reports all that went wrong at once.
fn on_all(what: &str, act: impl Fn(&Sequence) -> Outcome) {
    on(what, all(), act);
}

fn on(what: &str, meshes: Vec<Sequence>, act: impl Fn(&Sequence) -> Outcome) {
    let mut wrong = Vec::new();
    for mesh in meshes {
        let started = sinew::clock::seconds();
        match catch_unwind(AssertUnwindSafe(|| act(&mesh))) {
            Ok(Ok(())) => {}
            Ok(Err(why)) => wrong.push(format!("{}: {why}", mesh.name())),
            Err(_) => wrong.push(format!("{}: panicked", mesh.name())),
        }
        let seconds = sinew::clock::seconds() - started;
        if seconds > 0.3 {
            println!("{what}, {}: {seconds:.2} s", mesh.name());
        }
    }
    assert!(wrong.is_empty(), "{what}:\n{}", wrong.join("\n"));
}

fn ensure(holds: bool, why: impl FnOnce() -> String) -> Outcome {
    if holds { Ok(()) } else { Err(why()) }
}

fn finite(what: &str, values: impl IntoIterator<Item = f64>) -> Outcome {
    match values.into_iter().position(|v| !v.is_finite()) {
        Some(at) => Err(format!("{what} has a number that is not finite at {at}")),
        None => Ok(()),
    }
}

/// An error must be a sentence, and is only fine for a mesh of which nothing can be made.
fn sentence<T, E: std::fmt::Display>(result: Result<T, E>, excused: bool) -> Result<Option<T>, String> {
    match result {
        Ok(value) => Ok(Some(value)),
        Err(why) => {
            let text = why.to_string();
            ensure(excused && text.len() > 10 && !text.contains("NaN"), || format!("refused: {text}"))?;
            Ok(None)
        }
    }
}

/// Vertices that faces use, far apart, at most `count`.
fn far_apart(mesh: &Sequence, count: usize) -> Vec<u32> {
    let points = mesh.reference();
    let mut used: Vec<u32> = mesh.faces().iter().flatten().copied().collect();
    used.sort_unstable();
    used.dedup();
    let Some(&first) = used.first() else { return Vec::new() };
    let scale = unit(mesh);
    let far = |a: u32, b: u32| ((points[a as usize] - points[b as usize]) * scale).length();
    let mut chosen = vec![first];
    while chosen.len() < count {
        let nearest = |v: u32| chosen.iter().map(|&c| far(c, v)).fold(f64::INFINITY, f64::min);
        let next = used.iter().copied().max_by(|&a, &b| nearest(a).total_cmp(&nearest(b)));
        match next {
            Some(v) if nearest(v) > 1e-9 => chosen.push(v),
            _ => break,
        }
    }
    chosen
}

/// 1 over the diagonal, 1 where that is no number.
fn unit(mesh: &Sequence) -> f64 {
    let scale = 1.0 / mesh.diagonal();
    if scale.is_finite() { scale } else { 1.0 }
}

fn without_faces(mesh: &Sequence) -> bool {
    mesh.faces().is_empty()
}

#[test]
fn segmentation() {
    let presets = [
        segmentation::Parameters::default(),
        segmentation::Parameters { parts: Some(7), ..segmentation::Parameters::default() },
        segmentation::Parameters::paper(),
        segmentation::Parameters { exact: true, method: Method::Paper, ..segmentation::Parameters::default() },
    ];
    on_all("segmentation", |mesh| {
        for parameters in &presets {
            let result = segmentation::segment(mesh, parameters, &mut Silent);
            let Some(found) = sentence(result, without_faces(mesh))? else { continue };
            let count = found.parts.len() as u32;
            ensure(found.labels.len() == mesh.faces().len(), || "a face has no label".into())?;
            ensure(found.labels.iter().all(|&l| l < count), || "a label has no part".into())?;
            ensure((0..count).all(|part| found.labels.contains(&part)), || "a part has no face".into())?;
            finite("residual", [found.rigid_residual, found.residual_before_smoothing])?;
            finite("parts", found.parts.iter().flat_map(|part| [part.area, part.residual]))?;
            finite("fields", found.steps.deformation.iter().chain(&found.steps.weight).copied())?;
            finite("thresholds", [found.steps.epsilon, found.steps.gamma])?;
            finite("merges", found.steps.merges.iter().map(|merge| merge.cost))?;
            ensure(found.steps.distance.iter().all(|d| *d >= 0.0), || "a distance is no distance".into())?;
            let colours = vec![[0.5; 3]; found.parts.len()];
            read_back(mesh, glb::parts(mesh, &found.labels, &colours))?;
        }
        Ok(())
    });
}

/// What is exported can be opened, unless there is nothing in it that 32-bit floats can tell from a point.
fn read_back(mesh: &Sequence, bytes: Vec<u8>) -> Outcome {
    let file = File { name: "made.glb".into(), bytes };
    let rounded = |p: &DVec3| p.as_vec3().as_dvec3();
    let points: Vec<DVec3> = mesh.reference().iter().map(rounded).collect();
    let nothing =
        mesh.faces().iter().all(|face| face.windows(2).any(|w| points[w[0] as usize] == points[w[1] as usize]));
    sentence(open(&[file], &Options::default()), nothing).map(|_| ())
}

#[test]
fn key_points() {
    let presets = [
        keypoints::Parameters { max: 8, ..keypoints::Parameters::default() },
        keypoints::Parameters { literal: true, candidates: 6, max: 3, ..keypoints::Parameters::default() },
        keypoints::Parameters { points: Some(9), stop: keypoints::Stop::Flat, ..keypoints::Parameters::default() },
    ];
    on_all("key points", |mesh| {
        for parameters in &presets {
            let result = keypoints::select(mesh, parameters, &mut Silent);
            let Some(found) = sentence(result, flat(mesh))? else { continue };
            let points = &found.key_points;
            ensure(!points.is_empty(), || "there is no key point".into())?;
            ensure(points.iter().all(|&v| (v as usize) < mesh.reference().len()), || "a point is no vertex".into())?;
            ensure(found.errors.len() == points.len(), || "a point has no error".into())?;
            finite("errors", found.errors.iter().copied())?;
            finite("steps", found.steps.iter().flat_map(|s| s.tried.iter().map(|t| t.error).chain([s.error])))?;
            shares(&found.weights)?;
            ensure(found.groups.len() == mesh.reference().len(), || "a vertex has no group".into())?;
            ensure(found.groups.iter().all(|&g| (g as usize) < points.len()), || "a group has no point".into())?;
            ensure(found.fits.len() == mesh.poses().len(), || "a pose has no fit".into())?;
            finite("energies", found.fits.iter().flat_map(|fit| fit.energies.iter().copied()))?;
        }
        let by_hand = far_apart(mesh, 5);
        let result = keypoints::fit_all(mesh, &by_hand, &keypoints::Parameters::default());
        if let Some(fitted) = sentence(result, without_faces(mesh))? {
            finite("error", [fitted.error])?;
            shares(&fitted.weights)?;
        }
        Ok(())
    });
}

/// Rows of shares between 0 and 1 that sum to 1.
fn shares(weights: &weights::Weights) -> Outcome {
    finite("weights", weights.values.iter().chain(&weights.sums).chain(&weights.energies).copied())?;
    finite("residual", [weights.kkt_residual])?;
    let row_holds = |row: &[f64]| {
        row.iter().all(|&w| (-1e-9..=1.0 + 1e-9).contains(&w)) && (row.iter().sum::<f64>() - 1.0).abs() < 1e-6
    };
    match weights.values.chunks(weights.count().max(1)).position(|row| !row_holds(row)) {
        Some(v) => Err(format!("the weights of vertex {v} are {:?}", weights.row(v))),
        None => Ok(()),
    }
}

#[test]
fn weights() {
    on_all("weights", |mesh| {
        let result = Biharmonic::new(mesh.faces(), mesh.reference());
        let Some(field) = sentence(result, without_faces(mesh))? else { return Ok(()) };
        let handles = far_apart(mesh, 5);
        for joint in [false, true] {
            let parameters = weights::Parameters { joint };
            let Some(first) = sentence(field.weights(&handles, &parameters), without_faces(mesh))? else { continue };
            shares(&first)?;
            let fewer = &handles[..handles.len().div_ceil(2)];
            if let Some(second) = sentence(field.update(&first, fewer, &parameters), false)? {
                shares(&second)?;
            }
        }
        Ok(())
    });
}

#[test]
fn transfer_from_an_odd_source() {
    let target = healthy();
    on_all("an odd source", |mesh| transfers(mesh, &target, without_faces(mesh), flat(mesh)));
}

#[test]
fn transfer_to_an_odd_target() {
    let source = healthy();
    on_all("an odd target", |mesh| transfers(&source, mesh, without_faces(mesh), flat(mesh)));
}

/// By all methods, with some pairs and with one; and what comes of it as files.
fn transfers(source: &Sequence, target: &Sequence, nothing: bool, flat: bool) -> Outcome {
    let pairs = far_apart(source, 5).into_iter().zip(far_apart(target, 5));
    let pairs: Vec<Pair> = pairs.map(|(source, target)| Pair { source, target }).collect();
    for method in [transfer::Method::Bones, transfer::Method::Direct, transfer::Method::Relative] {
        let parameters = transfer::Parameters { method, ..transfer::Parameters::default() };
        let prepared = Prepared::new(source, target, &parameters, &mut Silent);
        let Some(mut prepared) = sentence(prepared, nothing || flat)? else { continue };
        for pairs in [&pairs[..], &pairs[..pairs.len().min(1)]] {
            let result = prepared.transfer(pairs, &mut Silent);
            let Some(moved) = sentence(result, nothing || flat)? else { continue };
            carried(source, target, &moved).map_err(|why| format!("{method:?}: {why}"))?;
        }
    }
    Ok(())
}

/// Whether no face of the mesh has an area.
fn flat(mesh: &Sequence) -> bool {
    let scale = unit(mesh);
    mesh.faces().iter().all(|face| {
        let [a, b, c] = face.map(|v| mesh.reference()[v as usize] * scale);
        let area = (b - a).cross(c - a).length();
        area.is_nan() || area < 1e-12
    })
}

fn carried(source: &Sequence, target: &Sequence, moved: &transfer::Transfer) -> Outcome {
    let poses = moved.poses(target.reference());
    ensure(poses.len() == source.poses().len(), || "a pose is missing".into())?;
    for pose in &poses {
        ensure(pose.len() == target.reference().len(), || "a vertex is missing".into())?;
        finite("pose", pose.iter().flat_map(|p| p.to_array()))?;
    }
    finite("error", [moved.source_error])?;
    let moving = target.moving_like(source, poses).map_err(|why| why.to_string())?;
    read_back(target, exact(&moving, None))?;
    if let Some(file) = sentence(light_transfer(source, target, &moved.skin, None), true)? {
        finite("light form", [file.largest, file.rms])?;
        read_back(target, file.bytes)?;
    }
    Ok(())
}

#[test]
fn proposals() {
    let partner = healthy();
    on_all("proposals", |mesh| {
        for (source, target) in [(mesh, &partner), (&partner, mesh)] {
            let result = Proposer::new(source.faces(), source.reference(), target.faces(), target.reference());
            let Some(proposer) = sentence(result, without_faces(mesh))? else { continue };
            let points = far_apart(source, 5);
            let mut known = vec![None; points.len()];
            if let (Some(first), Some(&place)) = (known.first_mut(), far_apart(target, 1).first()) {
                *first = Some(place);
            }
            for known in [vec![None; points.len()], known] {
                let Some(found) = sentence(proposer.propose(&points, &known), without_faces(mesh))? else { continue };
                ensure(found.points.len() == points.len(), || "a point has no proposal".into())?;
                let exists = |p: &transfer::propose::Proposal| (p.target as usize) < target.reference().len();
                ensure(found.points.iter().all(exists), || "a proposal is no vertex".into())?;
                let confident = |p: &transfer::propose::Proposal| (0.0..=1.0).contains(&p.confidence);
                ensure(found.points.iter().all(confident), || "a confidence is no share".into())?;
            }
        }
        Ok(())
    });
}

#[test]
fn the_doctor() {
    on_all("the doctor", |mesh| {
        let diagnosis = Diagnosis::of(mesh, &[]);
        ensure(diagnosis.summary.ends_with('.'), || "there is no summary".into())?;
        for finding in &diagnosis.findings {
            let faces = &finding.faces;
            ensure(finding.count > 0, || format!("{:?} of nothing", finding.code))?;
            ensure(faces.is_sorted_by(|a, b| a < b), || format!("{:?}: faces out of order", finding.code))?;
            ensure(faces.last().is_none_or(|&f| (f as usize) < mesh.faces().len()), || "no such face".into())?;
        }
        let expected = expected(mesh.name());
        let missing = expected.iter().find(|&&code| diagnosis.finding(code).is_none());
        ensure(missing.is_none(), || format!("{missing:?} was not found"))
    });
    assert_eq!(Diagnosis::of(&healthy(), &[]).findings, []);
}

/// What the doctor has to find in a mesh.
fn expected(name: &str) -> &'static [Code] {
    match name {
        "hundreds of pieces" => &[Code::Pieces, Code::StillPieces],
        "a piece that does not move" => &[Code::Pieces, Code::StillPieces],
        "a soup of triangles" => &[Code::Seams],
        "a soup that flies apart" => &[Code::Pieces],
        "holes" => &[Code::Holes],
        "edges with five faces" => &[Code::CrowdedEdges],
        "faces twice" => &[Code::DuplicateFaces],
        "flipped faces" => &[Code::FlippedFaces],
        "a band with half a turn" => &[Code::OneSided],
        "faces without area" | "all on a line" | "all in one point" | "from a point" => &[Code::DegenerateFaces],
        "into a point" => &[Code::Vanishing],
        "a flat pose" => &[Code::TurnedOver],
        "slivers" => &[Code::Slivers],
        "one vertex far away" => &[Code::FarVertices],
        "far from the origin" => &[Code::FarFromOrigin],
        "vertices without a face" => &[Code::UnusedVertices],
        "a pose that explodes" => &[Code::ExplodingPoses],
        _ => &[],
    }
}

#[test]
fn a_large_mesh_is_examined_at_once() {
    let (faces, points) = odd_meshes::grid(318);
    let mesh = odd_meshes::sequence("large", &faces, &points, &odd_meshes::bent(&points, 12));
    let started = sinew::clock::seconds();
    let found = Diagnosis::of(&mesh, &[]);
    let seconds = sinew::clock::seconds() - started;
    println!("{} faces in {} poses: {seconds:.3} s", faces.len(), mesh.poses().len());
    assert_eq!(found.finding(Code::Holes).map(|holes| holes.count), Some(1));
    assert!(seconds < 5.0, "{seconds} s, on whatever machine");
}

#[test]
fn poses_that_are_not_numbers_are_refused_by_name() {
    let (faces, points) = odd_meshes::closed_tube(4);
    let mut broken = points.clone();
    broken[3].y = f64::NAN;
    let pose = Pose { name: "frame 7".into(), time: 0.0, positions: broken };
    let refused = Sequence::new("tube", faces, points, vec![pose]).expect_err("a coordinate is not a number");
    assert_eq!(refused, SequenceError::NotFinite { pose: "frame 7".into(), vertex: 3 });
    assert!(refused.to_string().contains("vertex 3 of frame 7"));
}
