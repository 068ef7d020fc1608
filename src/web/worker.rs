//! The worker's wasm entry: one [`Engine`], called by `www/worker.js` for each message of the page.
//!
//! Everything that goes in or out is a plain object; big fields are typed arrays, so that the page can take them
//! over without a copy. Coordinates cross as `f32`, and the engine computes on exactly what it hands out: a
//! sequence that the page gives back after a restart ([`Engine::restore`]) yields the same bytes again.
//! An error is one sentence for a person, thrown as a string. What takes long is shared out to a crew ([`crew::Workers`]).

mod crew;
mod faces;
mod moving;
mod pair;
mod points;
mod sequences;
mod values;

use crate::export::{glb, rigid};
use crate::import::{self, Imported, Options};
use crate::keypoints;
use crate::memory::{self, Step};
use crate::segmentation::{Parameters, Segmentation, Segmenter, Steps};
use crate::sequence::Sequence;
use crate::transfer::gradients::Mover;
use crate::transfer::propose::Proposer;
use crate::transfer::{self, Prepared, Transfer};
use crate::view::colour::srgb_to_linear;
use crate::weights::{Biharmonic, Weights};
use crate::zoo::{self, Recipe};
use glam::DVec3;
use js_sys::{Array, Function, Object, Uint8Array, Uint32Array};
use sequences::{describe, kept_sequence, look, parcel, rounded, written};
use serde::Serialize;
use std::sync::Arc;
use values::{Reply, parsed, plain, put, read_file, read_files, sentence, single, triples};
use wasm_bindgen::prelude::*;

/// The open sequences and what is done with them.
#[wasm_bindgen]
#[derive(Default)]
pub struct Engine {
    sequence: Option<Sequence>,
    /// The merge tree of the last segmentation, with the parameters that it was made with.
    tree: Option<(Parameters, Segmenter)>,
    target: Option<Sequence>,
    /// What was prepared for the target, for the two together, and the last motion.
    target_field: Option<(Biharmonic, Weights)>,
    proposer: Option<Arc<Proposer>>,
    prepared: Option<(transfer::Parameters, Prepared)>,
    moved: Option<Transfer>,
    /// The same for methods that move vertices.
    mover: Option<(transfer::Parameters, Mover)>,
    faces_moved: Option<Vec<Vec<DVec3>>>,
}

/// What [`Engine::about`] says.
#[derive(Serialize)]
struct About {
    parameters: Parameters,
    keypoints: keypoints::Parameters,
    transfer: transfer::Parameters,
    options: Options,
    recipe: Recipe,
    creatures: &'static [&'static str],
    /// Of each creature.
    motions: Vec<Vec<&'static str>>,
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
            keypoints: keypoints::Parameters::default(),
            transfer: transfer::Parameters::default(),
            options: Options::default(),
            recipe: Recipe::default(),
            creatures: zoo::NAMES,
            motions: zoo::NAMES.iter().map(|name| zoo::motions(name)).collect(),
        })
    }

    /// Opens files, `[{name, bytes: Uint8Array}]`, with [`Options`] in their serde form. What was open stays open
    /// if they cannot be read.
    pub fn open(&mut self, files: &Array, options: JsValue) -> Reply {
        let options: Options = parsed(options)?;
        let imported = import::open(&read_files(files)?, &options).map_err(sentence)?;
        self.opened(&imported)
    }

    /// Opens files after a mesh that stands still and was opened from `still`: as its poses, where they are. Then the
    /// reply has `joined`, otherwise it is that of [`Engine::open`].
    pub fn open_more(&mut self, still: &Array, files: &Array, options: JsValue) -> Reply {
        let options: Options = parsed(options)?;
        let (still, files) = (read_files(still)?, read_files(files)?);
        let (imported, joined) = import::open_more(&still, &files, &options).map_err(sentence)?;
        let reply = self.opened(&imported)?;
        put(&reply, "joined", &joined.into())?;
        Ok(reply)
    }

    /// What an OBJ or its list of materials, `{name, bytes: Uint8Array}`, names that belongs to its look, as it is written
    /// there.
    pub fn needed(file: &JsValue) -> Reply {
        plain(&import::needed_for_look(&read_file(file)?))
    }

    /// Makes a creature from a [`Recipe`] in its serde form; replies as [`Engine::open`] does.
    pub fn zoo(&mut self, recipe: JsValue) -> Reply {
        let sequence = rounded(&pair::creature(recipe)?.sequence)?;
        let reply = describe(&sequence, None)?;
        self.replace(sequence);
        Ok(reply)
    }

    /// Takes back a sequence that another worker opened and the page kept.
    pub fn restore(&mut self, kept: JsValue) -> Result<(), JsValue> {
        self.replace(kept_sequence(kept)?);
        Ok(())
    }

    /// The source, or the target, as another engine takes it ([`Engine::restore`], [`Engine::restore_target`]).
    pub fn kept(&self, target: bool) -> Reply {
        parcel(if target { self.open_target()? } else { self.open_sequence()? })
    }

    /// Segments what is open, with [`Parameters`] in their serde form; `progress` is called with the stage and the
    /// share that is done.
    pub fn segment(&mut self, parameters: JsValue, progress: &Function) -> Reply {
        let parameters: Parameters = parsed(parameters)?;
        self.tree = None;
        let result = self.segmented(&parameters, progress)?;
        let reply = describe_parts(&result)?;
        describe_steps(&reply, &result.steps)?;
        if let Some((_, tree)) = &self.tree {
            let (faces, weights): (Vec<_>, Vec<_>) = tree.dual_edges().unzip();
            put(&reply, "dual", &Uint32Array::from(faces.as_flattened()))?;
            put(&reply, "dual_weights", &single(&weights))?;
        }
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

    /// What is open as a skin with a joint for each of the parts `labels` (#F); `files`, `options` and the reply are those
    /// of [`Engine::export_transfer`].
    pub fn export_rigid(&self, labels: &[u32], files: &Array, options: JsValue) -> Reply {
        let look = look(files, options)?;
        let made = rigid::rigid(self.open_sequence()?, labels, look.as_ref()).map_err(sentence)?;
        written(&made.bytes, [made.largest, made.rms], look.as_ref())
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
        self.room_for(Step::Segmentation, self.open_sequence()?)?;
        Segmenter::new(self.open_sequence()?, parameters, &mut watcher(progress)).map_err(sentence)
    }

    fn open_sequence(&self) -> Result<&Sequence, JsValue> {
        self.sequence.as_ref().ok_or_else(|| sentence("Nothing is open yet."))
    }

    fn opened(&mut self, imported: &Imported) -> Reply {
        let sequence = rounded(&imported.sequence)?;
        let reply = describe(&sequence, Some(imported))?;
        self.replace(sequence);
        Ok(reply)
    }

    /// Refuses a step for which there is not memory enough, beside what is open.
    fn room_for(&self, step: Step, of: &Sequence) -> Result<(), JsValue> {
        memory::check(step, of, self.sequence.iter().chain(&self.target), memory::LIMIT).map_err(sentence)
    }

    fn replace(&mut self, sequence: Sequence) {
        self.sequence = Some(sequence);
        self.tree = None;
        self.forget_pair();
    }
}

/// Hands progress on to the page.
fn watcher(progress: &Function) -> impl FnMut(&'static str, f64) -> bool {
    move |stage, done| {
        // A page that no longer listens is no reason to fail: it ends the worker when it wants no answer.
        let _ = progress.call2(&JsValue::NULL, &stage.into(), &done.into());
        true
    }
}

fn describe_parts(result: &Segmentation) -> Reply {
    let reply: JsValue = Object::new().into();
    put(&reply, "labels", &Uint32Array::from(result.labels.as_slice()))?;
    put(&reply, "unsmoothed", &Uint32Array::from(result.steps.unsmoothed.as_slice()))?;
    put(&reply, "band", &Uint8Array::from(result.steps.band.as_slice()))?;
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
