//! Messages about the target: opening it, and where the key points lie on it.

use super::Engine;
use super::crew::Workers;
use super::sequences::{describe, kept_sequence, rounded};
use super::values::{Reply, parsed, put, read_files, sentence, single};
use crate::import::{self, Options};
use crate::memory::Step;
use crate::sequence::Sequence;
use crate::transfer::propose::Proposer;
use crate::weights::Biharmonic;
use crate::zoo::{self, Recipe};
use js_sys::{Array, Object, Uint32Array};
use std::sync::Arc;
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
impl Engine {
    /// Opens files as the target; as [`Engine::open`].
    pub fn target(&mut self, files: &Array, options: JsValue) -> Reply {
        let options: Options = parsed(options)?;
        let imported = import::open(&read_files(files)?, &options).map_err(sentence)?;
        let sequence = rounded(&imported.sequence)?;
        let reply = describe(&sequence, Some(&imported))?;
        self.replace_target(Some(sequence));
        Ok(reply)
    }

    /// Makes a creature as the target; as [`Engine::zoo`].
    pub fn target_zoo(&mut self, recipe: JsValue) -> Reply {
        let sequence = rounded(&creature(recipe)?.sequence)?;
        let reply = describe(&sequence, None)?;
        self.replace_target(Some(sequence));
        Ok(reply)
    }

    /// Takes back a target that another worker opened and the page kept.
    pub fn restore_target(&mut self, kept: JsValue) -> Result<(), JsValue> {
        let target = kept_sequence(kept)?;
        self.replace_target(Some(target));
        Ok(())
    }

    /// Forgets the target.
    pub fn drop_target(&mut self) {
        self.replace_target(None);
    }

    /// Proposes where `points` of the source lie on the target; `known` has a vertex or −1 for each of them.
    pub fn propose(&mut self, points: &[u32], known: &[i32]) -> Reply {
        let proposer = self.proposer()?;
        let known: Vec<Option<u32>> = known.iter().map(|&vertex| u32::try_from(vertex).ok()).collect();
        let proposals = proposer.propose(points, &known).map_err(sentence)?;
        let reply: JsValue = Object::new().into();
        let targets: Vec<u32> = proposals.points.iter().map(|point| point.target).collect();
        let confidences: Vec<f64> = proposals.points.iter().map(|point| point.confidence).collect();
        put(&reply, "targets", &Uint32Array::from(targets.as_slice()))?;
        put(&reply, "confidences", &single(&confidences))?;
        Ok(reply)
    }

    /// The weights of some vertices of the target, #V rows × the number of them; from those that were asked for before.
    pub async fn target_weights(&mut self, handles: &[u32], crew: &Workers) -> Reply {
        let retained = self.target_field.take();
        let target = self.open_target()?;
        let (field, weights) = match retained {
            Some((field, before)) => {
                let weights = field.update_by(crew, &before, handles).await;
                (field, weights)
            }
            None => {
                self.room_for(Step::Weights(handles.len()), target)?;
                let field = Biharmonic::new(target.faces(), target.reference()).map_err(sentence)?;
                let weights = field.weights_by(crew, handles).await;
                (field, weights)
            }
        };
        let weights = weights.map_err(sentence)?;
        let reply = single(&weights.values).into();
        self.target_field = Some((field, weights));
        Ok(reply)
    }

    /// The places that two creatures have in common: `{source, target}`, vertices of either.
    pub fn landmarks(source: JsValue, target: JsValue) -> Reply {
        let pairs = zoo::landmark_pairs(&creature(source)?, &creature(target)?);
        let reply: JsValue = Object::new().into();
        let side = |vertices: Vec<u32>| Uint32Array::from(vertices.as_slice());
        put(&reply, "source", &side(pairs.iter().map(|pair| pair.1).collect()))?;
        put(&reply, "target", &side(pairs.iter().map(|pair| pair.2).collect()))?;
        Ok(reply)
    }
}

impl Engine {
    pub(super) fn open_target(&self) -> Result<&Sequence, JsValue> {
        self.target.as_ref().ok_or_else(|| sentence("No target is open yet."))
    }

    /// Who finds places of the source on the target.
    pub(super) fn proposer(&mut self) -> Result<Arc<Proposer>, JsValue> {
        if let Some(proposer) = &self.proposer {
            return Ok(proposer.clone());
        }
        let (source, target) = (self.open_sequence()?, self.open_target()?);
        let proposer = Arc::new(Proposer::of(source, target).map_err(sentence)?);
        self.proposer = Some(proposer.clone());
        Ok(proposer)
    }

    fn replace_target(&mut self, target: Option<Sequence>) {
        self.target = target;
        self.target_field = None;
        self.forget_pair();
    }

    /// Forgets what was prepared for the source and the target together.
    pub(super) fn forget_pair(&mut self) {
        self.proposer = None;
        self.prepared = None;
        self.moved = None;
        self.mover = None;
        self.faces_moved = None;
    }
}

pub(super) fn creature(recipe: JsValue) -> Result<zoo::Creature, JsValue> {
    let recipe: Recipe = parsed(recipe)?;
    let none = || {
        sentence(format!("There is no “{}” of {} faces: try fewer, or another creature.", recipe.name, recipe.faces))
    };
    zoo::make(&recipe).ok_or_else(none)
}
