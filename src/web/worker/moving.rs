//! Messages about the target in motion.

use super::Engine;
use super::sequences::moving;
use super::values::{Reply, parsed, plain, put, sentence};
use super::watcher;
use crate::export::animation;
use crate::export::skin::{self, Influences, SkinPose};
use crate::memory::Step;
use crate::transfer::{Pair, Parameters, Prepared};
use js_sys::{Float32Array, Function, Object, Uint8Array, Uint16Array};
use wasm_bindgen::prelude::*;

/// The most handles that a vertex follows in the picture.
const INFLUENCES: usize = 16;

#[wasm_bindgen]
impl Engine {
    /// Makes the target move like the source: `pairs` are alternately vertices of the source and of the target,
    /// [`Parameters`] are in their serde form. Starting from the last motion if `quick`, while a point is dragged.
    pub fn transfer(&mut self, pairs: &[u32], parameters: JsValue, quick: bool, progress: &Function) -> Reply {
        let parameters: Parameters = parsed(parameters)?;
        let pairs: Vec<Pair> = pairs.as_chunks().0.iter().map(|&[source, target]| Pair { source, target }).collect();
        let mut observer = watcher(progress);
        self.moved = None;
        self.faces_moved = None;
        let mut preparing = Vec::new();
        let mut prepared = match self.prepared.take() {
            Some((made_with, prepared)) if made_with == parameters => prepared,
            _ => {
                self.room_for(Step::Transfer(self.open_target()?.sizes()), self.open_sequence()?)?;
                let made = Prepared::new(self.open_sequence()?, self.open_target()?, &parameters, &mut observer)
                    .map_err(sentence)?;
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

    /// The target in motion as a GLB: `{bytes, error, rms}`, with the largest and the mean square error that the form
    /// adds, over the diagonal. `form` is `exact` or `light`.
    pub fn export_transfer(&self, form: &str) -> Reply {
        let (source, target) = (self.open_sequence()?, self.open_target()?);
        if let ("exact", Some(poses)) = (form, &self.faces_moved) {
            let reply: JsValue = Object::new().into();
            let bytes = animation::exact(&moving(source, target, poses.clone())?);
            put(&reply, "bytes", &Uint8Array::from(bytes.as_slice()))?;
            put(&reply, "error", &0.0_f64.into())?;
            put(&reply, "rms", &0.0_f64.into())?;
            return Ok(reply);
        }
        let moved = self.moved.as_ref().ok_or_else(|| sentence("The target does not move yet."))?;
        let (bytes, error, rms) = match form {
            "exact" => (animation::exact(&moving(source, target, moved.poses(target.reference()))?), 0.0, 0.0),
            "light" => {
                let poses = source.poses().iter().zip(&moved.skin.maps);
                let poses: Vec<SkinPose> =
                    poses.map(|(pose, maps)| SkinPose { name: &pose.name, time: pose.time, maps }).collect();
                let weights = moved.skin.dense();
                let skin = skin::Skin {
                    name: target.name(),
                    faces: target.faces(),
                    reference: target.reference(),
                    weights: &weights,
                    handles: moved.skin.handles.len(),
                    poses: &poses,
                };
                let light = skin::light(&skin, Influences::Four).map_err(sentence)?;
                (light.bytes, light.largest, light.rms)
            }
            _ => return Err(sentence("The form must be exact or light.")),
        };
        let reply: JsValue = Object::new().into();
        put(&reply, "bytes", &Uint8Array::from(bytes.as_slice()))?;
        put(&reply, "error", &error.into())?;
        put(&reply, "rms", &rms.into())?;
        Ok(reply)
    }
}
