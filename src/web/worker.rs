//! The worker's wasm entry: one [`Engine`], called by `www/worker.js` for each message of the page.
//!
//! Everything that goes in or out is a plain object; big fields are typed arrays, so that the page can take them
//! over without a copy. Coordinates cross as `f32`, and the engine computes on exactly what it hands out: a
//! sequence that the page gives back after a restart ([`Engine::restore`]) yields the same bytes again.
//! An error is one sentence for a person, thrown as a string.

use crate::export::glb;
use crate::import::{self, Clip, File, Options};
use crate::segmentation::{Parameters, Segmentation, Segmenter, Steps};
use crate::sequence::{Pose, Sequence, Sizes};
use crate::view::colour::srgb_to_linear;
use crate::warning::Warning;
use crate::zoo::{self, Recipe};
use glam::DVec3;
use js_sys::{Array, Float32Array, Float64Array, Function, Object, Reflect, Uint8Array, Uint32Array};
use serde::de::DeserializeOwned;
use serde::{Deserialize, Serialize};
use std::fmt::Display;
use wasm_bindgen::prelude::*;

/// What a message returns: an object, or a sentence.
type Reply = Result<JsValue, JsValue>;

/// The open sequence and what is done with it.
#[wasm_bindgen]
#[derive(Default)]
pub struct Engine {
    sequence: Option<Sequence>,
    /// The merge tree of the last segmentation, with the parameters that it was made with.
    tree: Option<(Parameters, Segmenter)>,
}

/// What [`Engine::about`] says.
#[derive(Serialize)]
struct About {
    parameters: Parameters,
    options: Options,
    recipe: Recipe,
    creatures: &'static [&'static str],
}

/// The small fields of a sequence; the big ones go beside them as typed arrays.
#[derive(Serialize)]
struct Opened<'a> {
    name: &'a str,
    pose_names: Vec<&'a str>,
    sizes: Sizes,
    diagonal: f64,
    clips: &'a [Clip],
    clip: Option<usize>,
    warnings: &'a [Warning],
}

/// The small fields of a sequence that comes back from the page.
#[derive(Deserialize)]
struct Kept {
    name: String,
    pose_names: Vec<String>,
}

#[wasm_bindgen]
impl Engine {
    /// An engine with nothing open.
    #[wasm_bindgen(constructor)]
    pub fn new() -> Self {
        Self::default()
    }

    /// What the page must know before it asks for anything: the default parameters, options and recipe in their
    /// serde forms, and the names of the creatures.
    pub fn about() -> Reply {
        plain(&About {
            parameters: Parameters::default(),
            options: Options::default(),
            recipe: Recipe::default(),
            creatures: zoo::NAMES,
        })
    }

    /// Opens files, `[{name, bytes: Uint8Array}]`, with [`Options`] in their serde form. What was open stays open
    /// if they cannot be read.
    pub fn open(&mut self, files: &Array, options: JsValue) -> Reply {
        let files = files.iter().map(|file| read_file(&file)).collect::<Result<Vec<_>, _>>()?;
        let options: Options = parsed(options)?;
        let imported = import::open(&files, &options).map_err(sentence)?;
        let sequence = rounded(&imported.sequence)?;
        let reply = describe(&sequence, &imported.clips, imported.clip, &imported.warnings)?;
        self.replace(sequence);
        Ok(reply)
    }

    /// Makes a creature from a [`Recipe`] in its serde form; replies as [`Engine::open`] does.
    pub fn zoo(&mut self, recipe: JsValue) -> Reply {
        let recipe: Recipe = parsed(recipe)?;
        let creature =
            zoo::make(&recipe).ok_or_else(|| sentence(format!("There is no creature called “{}”.", recipe.name)))?;
        let sequence = rounded(&creature.sequence)?;
        let reply = describe(&sequence, &[], None, &[])?;
        self.replace(sequence);
        Ok(reply)
    }

    /// Takes back a sequence that another worker opened and the page kept.
    pub fn restore(&mut self, kept: JsValue) -> Result<(), JsValue> {
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
        self.replace(sequence);
        Ok(())
    }

    /// Segments what is open, with [`Parameters`] in their serde form; `progress` is called with the stage and the
    /// share that is done.
    pub fn segment(&mut self, parameters: JsValue, progress: &Function) -> Reply {
        let parameters: Parameters = parsed(parameters)?;
        self.tree = None;
        let result = self.segmented(&parameters, progress)?;
        let reply = describe_parts(&result)?;
        describe_steps(&reply, &result.steps)?;
        put(&reply, "warnings", &plain(&result.warnings)?)?;
        put(&reply, "seconds", &plain(&result.seconds)?)?;
        Ok(reply)
    }

    /// Labels and parts for another number of parts: at once, if the last segmentation had the same parameters.
    pub fn parts(&mut self, parameters: JsValue, count: usize, progress: &Function) -> Reply {
        let parameters = Parameters { parts: Some(count), ..parsed(parameters)? };
        describe_parts(&self.segmented(&parameters, progress)?)
    }

    /// What is open as a GLB file: `labels` is #F part numbers, `colours` three sRGB bytes a part.
    pub fn export(&self, labels: &[u32], colours: &[u8]) -> Reply {
        let colours: Vec<[f32; 3]> =
            triples(colours).into_iter().map(|colour| srgb_to_linear(colour).to_array()).collect();
        Ok(Uint8Array::from(glb::parts(self.open_sequence()?, labels, &colours).as_slice()).into())
    }

    /// Cuts the merge tree, which is made first if there is none for these parameters.
    fn segmented(&mut self, parameters: &Parameters, progress: &Function) -> Result<Segmentation, JsValue> {
        let basis = Parameters { parts: None, ..parameters.clone() };
        let tree = match self.tree.take() {
            Some((made_with, tree)) if made_with == basis => tree,
            _ => self.grow(&basis, progress)?,
        };
        let result = tree.segmentation(parameters.parts);
        self.tree = Some((basis, tree));
        Ok(result)
    }

    fn grow(&self, parameters: &Parameters, progress: &Function) -> Result<Segmenter, JsValue> {
        let mut observer = |stage: &'static str, done: f64| {
            // A page that no longer listens is no reason to fail: it ends the worker when it wants no answer.
            let _ = progress.call2(&JsValue::NULL, &stage.into(), &done.into());
            true
        };
        Segmenter::new(self.open_sequence()?, parameters, &mut observer).map_err(sentence)
    }

    fn open_sequence(&self) -> Result<&Sequence, JsValue> {
        self.sequence.as_ref().ok_or_else(|| sentence("Nothing is open yet."))
    }

    fn replace(&mut self, sequence: Sequence) {
        self.sequence = Some(sequence);
        self.tree = None;
    }
}

/// The same sequence with every coordinate rounded to the `f32` that the page receives.
fn rounded(sequence: &Sequence) -> Result<Sequence, JsValue> {
    let round = |positions: &[DVec3]| positions.iter().map(|p| p.as_vec3().as_dvec3()).collect::<Vec<_>>();
    let poses = sequence
        .poses()
        .iter()
        .map(|pose| Pose { name: pose.name.clone(), time: pose.time, positions: round(&pose.positions) })
        .collect();
    let result = Sequence::new(sequence.name(), sequence.faces().to_vec(), round(sequence.reference()), poses)
        .map_err(sentence)?;
    match sequence.polygons() {
        Some(polygons) => result.with_polygons(polygons.to_vec()).map_err(sentence),
        None => Ok(result),
    }
}

fn describe(sequence: &Sequence, clips: &[Clip], clip: Option<usize>, warnings: &[Warning]) -> Reply {
    let reply = plain(&Opened {
        name: sequence.name(),
        pose_names: sequence.poses().iter().map(|pose| pose.name.as_str()).collect(),
        sizes: sequence.sizes(),
        diagonal: sequence.diagonal(),
        clips,
        clip,
        warnings,
    })?;
    let times: Vec<f64> = sequence.poses().iter().map(|pose| pose.time).collect();
    put(&reply, "times", &Float64Array::from(times.as_slice()))?;
    put(&reply, "faces", &Uint32Array::from(sequence.faces().as_flattened()))?;
    put(&reply, "reference", &Float32Array::from(coordinates(sequence.reference()).as_slice()))?;
    let vertices = sequence.reference().len() as u32;
    let poses = Float32Array::new_with_length(3 * vertices * sequence.poses().len() as u32);
    for (number, pose) in (0u32..).zip(sequence.poses()) {
        let place = 3 * vertices * number;
        poses.subarray(place, place + 3 * vertices).copy_from(&coordinates(&pose.positions));
    }
    put(&reply, "poses", &poses)?;
    if let Some(polygons) = sequence.polygons() {
        put(&reply, "polygons", &Uint32Array::from(polygons))?;
    }
    Ok(reply)
}

fn describe_parts(result: &Segmentation) -> Reply {
    let reply: JsValue = Object::new().into();
    put(&reply, "labels", &Uint32Array::from(result.labels.as_slice()))?;
    put(&reply, "unsmoothed", &Uint32Array::from(result.steps.unsmoothed.as_slice()))?;
    put(&reply, "parts", &plain(&result.parts)?)?;
    put(&reply, "rigid_residual", &result.rigid_residual.into())?;
    put(&reply, "residual_before_smoothing", &result.residual_before_smoothing.into())?;
    Ok(reply)
}

fn describe_steps(reply: &JsValue, steps: &Steps) -> Result<(), JsValue> {
    put(reply, "deformation", &single(&steps.deformation))?;
    put(reply, "weight", &single(&steps.weight))?;
    put(reply, "deformable", &Uint8Array::from(steps.deformable.as_slice()))?;
    put(reply, "distance", &single(&steps.distance))?;
    put(reply, "epsilon", &steps.epsilon.into())?;
    put(reply, "gamma", &steps.gamma.into())?;
    let features = Array::new();
    for feature in &steps.features {
        let item: JsValue = Object::new().into();
        put(&item, "face", &feature.face.into())?;
        put(&item, "partition", &feature.partition.into())?;
        put(&item, "region", &Uint32Array::from(feature.region.as_slice()))?;
        features.push(&item);
    }
    put(reply, "features", &features)?;
    let rounds: Array = steps.rounds.iter().map(|round| Uint32Array::from(round.as_slice())).collect();
    put(reply, "rounds", &rounds)?;
    put(reply, "merges", &plain(&steps.merges)?)
}

fn read_file(file: &JsValue) -> Result<File, JsValue> {
    let name = field(file, "name")?.as_string().ok_or_else(|| sentence("A file has no name."))?;
    Ok(File { name, bytes: Uint8Array::from(field(file, "bytes")?).to_vec() })
}

fn coordinates(points: &[DVec3]) -> Vec<f32> {
    points.iter().flat_map(|p| p.as_vec3().to_array()).collect()
}

fn points(coordinates: &[f32]) -> Vec<DVec3> {
    triples(coordinates).into_iter().map(|[x, y, z]: [f32; 3]| DVec3::new(x.into(), y.into(), z.into())).collect()
}

fn triples<T: Copy>(flat: &[T]) -> Vec<[T; 3]> {
    flat.as_chunks().0.to_vec()
}

fn single(values: &[f64]) -> Float32Array {
    Float32Array::from(values.iter().map(|&value| value as f32).collect::<Vec<_>>().as_slice())
}

fn field(object: &JsValue, name: &str) -> Reply {
    Reflect::get(object, &name.into())
}

fn put(object: &JsValue, name: &str, value: &JsValue) -> Result<(), JsValue> {
    Reflect::set(object, &name.into(), value).map(|_| ())
}

fn plain<T: Serialize + ?Sized>(value: &T) -> Reply {
    serde_wasm_bindgen::to_value(value).map_err(sentence)
}

fn parsed<T: DeserializeOwned>(value: JsValue) -> Result<T, JsValue> {
    serde_wasm_bindgen::from_value(value).map_err(sentence)
}

/// An error as the page expects it.
fn sentence(error: impl Display) -> JsValue {
    JsValue::from_str(&error.to_string())
}
