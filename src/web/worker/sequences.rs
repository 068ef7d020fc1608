//! Sequences on their way to the page and back.

use super::values::{Reply, coordinates, field, parsed, plain, points, put, read_files, sentence, triples};
use crate::import::{self, Clip, Imported, Options, Up};
use crate::look::Look;
use crate::mesh::doctor::{Diagnosis, Finding};
use crate::sequence::{Pose, Sequence, Sizes};
use crate::warning::Warning;
use glam::DVec3;
use js_sys::{Array, Float32Array, Float64Array, Object, Uint8Array, Uint32Array};
use serde::{Deserialize, Serialize};
use wasm_bindgen::prelude::*;

/// The small fields of a sequence; the big ones go beside them as typed arrays.
#[derive(Serialize)]
struct Opened<'a> {
    name: &'a str,
    pose_names: Vec<&'a str>,
    sizes: Sizes,
    diagonal: f64,
    up: Option<Up>,
    clips: &'a [Clip],
    clip: Option<usize>,
    warnings: &'a [Warning],
}

/// The small fields of a sequence that comes back from the page, or goes to another worker.
#[derive(Serialize, Deserialize)]
struct Kept {
    name: String,
    pose_names: Vec<String>,
}

/// The same sequence with every coordinate rounded to the `f32` that the page receives.
pub fn rounded(sequence: &Sequence) -> Result<Sequence, JsValue> {
    let round = |positions: &[DVec3]| positions.iter().map(|p| p.as_vec3().as_dvec3()).collect::<Vec<_>>();
    let poses = sequence
        .poses()
        .iter()
        .map(|pose| Pose { name: pose.name.clone(), time: pose.time, positions: round(&pose.positions) })
        .collect();
    sequence.reposed(round(sequence.reference()), poses).map_err(sentence)
}

/// A sequence for the page, and what its files say of it, if it comes from files.
pub fn describe(sequence: &Sequence, imported: Option<&Imported>) -> Reply {
    let warnings = imported.map_or(&[][..], |imported| &imported.warnings);
    let reply = plain(&Opened {
        name: sequence.name(),
        pose_names: sequence.poses().iter().map(|pose| pose.name.as_str()).collect(),
        sizes: sequence.sizes(),
        diagonal: sequence.diagonal(),
        up: imported.map(|imported| imported.up),
        clips: imported.map_or(&[], |imported| &imported.clips),
        clip: imported.and_then(|imported| imported.clip),
        warnings,
    })?;
    put_arrays(&reply, sequence)?;
    put(&reply, "diagnosis", &diagnosis(&Diagnosis::of(sequence, warnings))?)?;
    Ok(reply)
}

/// What [`kept_sequence`] makes the same sequence from.
pub fn parcel(sequence: &Sequence) -> Reply {
    let pose_names = sequence.poses().iter().map(|pose| pose.name.clone()).collect();
    let reply = plain(&Kept { name: sequence.name().to_owned(), pose_names })?;
    put_arrays(&reply, sequence)?;
    Ok(reply)
}

/// The big fields of a sequence.
fn put_arrays(reply: &JsValue, sequence: &Sequence) -> Result<(), JsValue> {
    let times: Vec<f64> = sequence.poses().iter().map(|pose| pose.time).collect();
    put(reply, "times", &Float64Array::from(times.as_slice()))?;
    put(reply, "faces", &Uint32Array::from(sequence.faces().as_flattened()))?;
    put(reply, "reference", &Float32Array::from(coordinates(sequence.reference()).as_slice()))?;
    let vertices = sequence.reference().len() as u32;
    let poses = Float32Array::new_with_length(3 * vertices * sequence.poses().len() as u32);
    for (number, pose) in (0u32..).zip(sequence.poses()) {
        let place = 3 * vertices * number;
        poses.subarray(place, place + 3 * vertices).copy_from(&coordinates(&pose.positions));
    }
    put(reply, "poses", &poses)?;
    match sequence.polygons() {
        Some(polygons) => put(reply, "polygons", &Uint32Array::from(polygons)),
        None => Ok(()),
    }
}

/// A diagnosis, the faces of its findings as typed arrays.
fn diagnosis(diagnosis: &Diagnosis) -> Reply {
    let reply: JsValue = Object::new().into();
    put(&reply, "summary", &diagnosis.summary.as_str().into())?;
    let findings = Array::new();
    for finding in &diagnosis.findings {
        let item = plain(&Finding { faces: Vec::new(), ..finding.clone() })?;
        put(&item, "faces", &Uint32Array::from(finding.faces.as_slice()))?;
        findings.push(&item);
    }
    put(&reply, "findings", &findings)?;
    Ok(reply)
}

/// A sequence that the page kept.
pub fn kept_sequence(kept: JsValue) -> Result<Sequence, JsValue> {
    let faces: Vec<[u32; 3]> = triples(&Uint32Array::from(field(&kept, "faces")?).to_vec());
    let reference = points(&Float32Array::from(field(&kept, "reference")?).to_vec());
    let positions = points(&Float32Array::from(field(&kept, "poses")?).to_vec());
    let times = Float64Array::from(field(&kept, "times")?).to_vec();
    let polygons = field(&kept, "polygons")?;
    let Kept { name, pose_names } = parsed(kept)?;
    let poses = positions
        .chunks(reference.len().max(1))
        .zip(pose_names.into_iter().zip(times))
        .map(|(positions, (name, time))| Pose { name, time, positions: positions.to_vec() })
        .collect();
    let mut sequence = Sequence::new(name, faces, reference, poses).map_err(sentence)?;
    if !polygons.is_undefined() {
        sequence = sequence.with_polygons(Uint32Array::from(polygons).to_vec()).map_err(sentence)?;
    }
    Ok(sequence)
}

/// What the mesh in `files` looks like, if they say it and can be read; `options` as they were when it was opened.
pub fn look(files: &Array, options: JsValue) -> Result<Option<Look>, JsValue> {
    if files.length() == 0 {
        return Ok(None);
    }
    let options = Options { look: true, ..parsed(options)? };
    // What cannot be read has no look; the mesh itself was read before.
    Ok(import::open(&read_files(files)?, &options).ok().and_then(|imported| imported.look))
}

/// A file for the page: what it adds in error (largest and mean square, over the diagonal), and how many images it has;
/// -1 for a mesh of clay.
pub fn written(bytes: &[u8], [error, rms]: [f64; 2], look: Option<&Look>) -> Reply {
    let reply: JsValue = Object::new().into();
    put(&reply, "bytes", &Uint8Array::from(bytes))?;
    put(&reply, "error", &error.into())?;
    put(&reply, "rms", &rms.into())?;
    put(&reply, "images", &look.map_or(-1.0, |look| look.images.len() as f64).into())?;
    Ok(reply)
}
