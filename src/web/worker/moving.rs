//! Messages about the target in motion.

use super::Engine;
use super::sequences::{look, written};
use super::values::{Reply, parsed, plain, put, read_pairs, sentence};
use super::watcher;
use crate::export::animation;
use crate::memory::Step;
use crate::transfer::{Parameters, Prepared};
use js_sys::{Array, Float32Array, Function, Object, Uint16Array};
use wasm_bindgen::prelude::*;

/// The most handles that a vertex follows in the picture.
const INFLUENCES: usize = 16;

#[wasm_bindgen]
impl Engine {
    /// Makes the target move like the source: `pairs` are alternately vertices of the source and of the target,
    /// [`Parameters`] are in their serde form. Starting from the last motion if `quick`, while a point is dragged.
    pub fn transfer(&mut self, pairs: &[u32], parameters: JsValue, quick: bool, progress: &Function) -> Reply {
        let parameters: Parameters = parsed(parameters)?;
        let pairs = read_pairs(pairs);
        let mut observer = watcher(progress);
        self.moved = None;
        self.faces_moved = None;
        let mut preparing = Vec::new();
        // What is of no use any more goes before its successor comes.
        let kept = self.prepared.take().filter(|(made_with, _)| *made_with == parameters);
        let mut prepared = match kept {
            Some((_, prepared)) => prepared,
            None => {
                self.mover = None;
                self.room_for(Step::Transfer(self.open_target()?.sizes()), self.open_sequence()?)?;
                let proposer = if parameters.method.by_bones() { Some(self.proposer()?) } else { None };
                let (source, target) = (self.open_sequence()?, self.open_target()?);
                let made = Prepared::with_proposer(source, target, &parameters, proposer, &mut observer);
                let made = made.map_err(sentence)?;
                preparing.extend_from_slice(made.seconds());
                made
            }
        };
        let result =
            if quick { prepared.follow(&pairs, &mut observer) } else { prepared.transfer(&pairs, &mut observer) };
        self.prepared = Some((parameters, prepared));
        let result = result.map_err(sentence)?;
        preparing.extend_from_slice(&result.seconds);
        let reply: JsValue = Object::new().into();
        let most = result.skin.most_influences().clamp(1, INFLUENCES);
        let (indices, weights) = result.skin.influences(most);
        put(&reply, "handles", &result.skin.handles.len().into())?;
        put(&reply, "K", &most.into())?;
        put(&reply, "indices", &Uint16Array::from(indices.as_slice()))?;
        put(&reply, "weights", &Float32Array::from(weights.as_slice()))?;
        put(&reply, "matrices", &Float32Array::from(result.skin.matrices().as_slice()))?;
        put(&reply, "bones", &result.bones.into())?;
        put(&reply, "source_error", &result.source_error.into())?;
        put(&reply, "warnings", &plain(&result.warnings)?)?;
        put(&reply, "seconds", &plain(&preparing)?)?;
        self.moved = Some(result);
        Ok(reply)
    }

    /// The target in motion as a GLB: `{bytes, error, rms, images}`, with the largest and the mean square error that the
    /// form adds, over the diagonal. `form` is `exact` or `light`. `files` and `options` are what the target was opened
    /// from, for it to look as it does there; without files it is of clay.
    pub fn export_transfer(&self, form: &str, files: &Array, options: JsValue) -> Reply {
        let (source, target) = (self.open_sequence()?, self.open_target()?);
        let look = look(files, options)?;
        let look = look.as_ref();
        if let ("exact", Some(poses)) = (form, &self.faces_moved) {
            let moving = target.moving_like(source, poses.clone()).map_err(sentence)?;
            return written(&animation::exact(&moving, look), [0.0; 2], look);
        }
        let moved = self.moved.as_ref().ok_or_else(|| sentence("The target does not move yet."))?;
        match form {
            "exact" => {
                let moving = target.moving_like(source, moved.poses(target.reference())).map_err(sentence)?;
                written(&animation::exact(&moving, look), [0.0; 2], look)
            }
            "light" => {
                let light = animation::light_transfer(source, target, &moved.skin, look).map_err(sentence)?;
                written(&light.bytes, [light.largest, light.rms], look)
            }
            _ => Err(sentence("The form must be exact or light.")),
        }
    }
}
