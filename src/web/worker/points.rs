//! Messages about key points.

use super::Engine;
use super::values::{Reply, parsed, plain, put, sentence, single};
use super::watcher;
use crate::keypoints::{self, KeyPoints, Parameters};
use crate::memory::Step;
use crate::skinning::Fit;
use crate::weights::Weights;
use js_sys::{Array, Float64Array, Function, Object, Uint32Array};
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
impl Engine {
    /// Finds the key points of what is open, with [`Parameters`] in their serde form.
    pub fn keypoints(&self, parameters: JsValue, progress: &Function) -> Reply {
        let parameters: Parameters = parsed(parameters)?;
        self.room_for(Step::KeyPoints(parameters.points.unwrap_or(parameters.max)), self.open_sequence()?)?;
        let found = keypoints::select(self.open_sequence()?, &parameters, &mut watcher(progress)).map_err(sentence)?;
        let reply = describe(&found.weights, &found.groups, &found.fits)?;
        put(&reply, "key_points", &Uint32Array::from(found.key_points.as_slice()))?;
        put(&reply, "errors", &Float64Array::from(found.errors.as_slice()))?;
        put(&reply, "candidates", &Uint32Array::from(found.candidates.as_slice()))?;
        put(&reply, "steps", &steps(&found)?)?;
        put(&reply, "replacements", &plain(&found.replacements)?)?;
        put(&reply, "warnings", &plain(&found.warnings)?)?;
        put(&reply, "seconds", &plain(&found.seconds)?)?;
        Ok(reply)
    }

    /// What follows from points given by hand: weights, groups, the error.
    pub fn fit(&self, points: &[u32], parameters: JsValue) -> Reply {
        let parameters: Parameters = parsed(parameters)?;
        self.room_for(Step::KeyPoints(points.len()), self.open_sequence()?)?;
        let fitted = keypoints::fit_all(self.open_sequence()?, points, &parameters).map_err(sentence)?;
        let reply = describe(&fitted.weights, &fitted.groups, &fitted.fits)?;
        put(&reply, "error", &fitted.error.into())?;
        Ok(reply)
    }
}

fn describe(weights: &Weights, groups: &[u32], fits: &[Fit]) -> Reply {
    let reply: JsValue = Object::new().into();
    put(&reply, "weights", &single(&weights.values))?;
    put(&reply, "groups", &Uint32Array::from(groups))?;
    let energies: Array = fits.iter().map(|fit| Float64Array::from(fit.energies.as_slice())).collect();
    put(&reply, "energies", &energies)?;
    Ok(reply)
}

fn steps(found: &KeyPoints) -> Reply {
    let steps = Array::new();
    for step in &found.steps {
        let item: JsValue = Object::new().into();
        let vertices: Vec<u32> = step.tried.iter().map(|tried| tried.vertex).collect();
        let errors: Vec<f64> = step.tried.iter().map(|tried| tried.error).collect();
        put(&item, "candidates", &Uint32Array::from(vertices.as_slice()))?;
        put(&item, "errors", &Float64Array::from(errors.as_slice()))?;
        put(&item, "chosen", &step.chosen.into())?;
        put(&item, "error", &step.error.into())?;
        steps.push(&item);
    }
    Ok(steps.into())
}
