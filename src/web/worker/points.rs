//! Messages about key points.

use super::Engine;
use super::crew::Workers;
use super::values::{Reply, parsed, plain, put, sentence, single};
use super::watcher;
use crate::keypoints::{self, KeyPoints, Parameters, Rounds};
use crate::memory::Step;
use crate::mesh::ball::unit_ball;
use crate::sequence::Sequence;
use crate::skinning::Fit;
use crate::weights::Weights;
use glam::DAffine3;
use js_sys::{Array, Float32Array, Float64Array, Function, Object, Uint32Array};
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
impl Engine {
    /// Finds the key points of what is open, with [`Parameters`] in their serde form.
    pub async fn keypoints(&self, parameters: JsValue, progress: &Function, crew: &Workers) -> Reply {
        let parameters: Parameters = parsed(parameters)?;
        self.room_for(Step::KeyPoints(parameters.points.unwrap_or(parameters.max)), self.open_sequence()?)?;
        let sequence = self.open_sequence()?;
        let found =
            keypoints::select_by(crew, sequence, &parameters, &mut watcher(progress)).await.map_err(sentence)?;
        let reply = describe(sequence, &found.weights, &found.groups, &found.fits, &found.rounds)?;
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
    pub async fn fit(&self, points: &[u32], parameters: JsValue, crew: &Workers) -> Reply {
        let parameters: Parameters = parsed(parameters)?;
        self.room_for(Step::KeyPoints(points.len()), self.open_sequence()?)?;
        let sequence = self.open_sequence()?;
        let fitted = keypoints::fit_all_by(crew, sequence, points, &parameters).await.map_err(sentence)?;
        let reply = describe(sequence, &fitted.weights, &fitted.groups, &fitted.fits, &fitted.rounds)?;
        put(&reply, "error", &fitted.error.into())?;
        Ok(reply)
    }
}

fn describe(sequence: &Sequence, weights: &Weights, groups: &[u32], fits: &[Fit], rounds: &[Rounds]) -> Reply {
    let reply: JsValue = Object::new().into();
    // What errors are stated in.
    let radius = unit_ball(&sequence.acting_faces(), sequence.reference()).1;
    put(&reply, "radius", &radius.into())?;
    put(&reply, "weights", &single(&weights.values))?;
    put(&reply, "groups", &Uint32Array::from(groups))?;
    let energies: Array = fits.iter().map(|fit| Float64Array::from(fit.energies.as_slice())).collect();
    put(&reply, "energies", &energies)?;
    let fit_errors: Vec<f64> = fits.iter().map(|fit| fit.error).collect();
    put(&reply, "fit_errors", &Float64Array::from(fit_errors.as_slice()))?;
    let rounds: Array = rounds.iter().map(|rounds| Float32Array::from(matrices(rounds).as_slice())).collect();
    put(&reply, "rounds", &rounds)?;
    Ok(reply)
}

/// Twelve numbers for each round and map: a 3×4 matrix, row by row.
fn matrices(rounds: &Rounds) -> Vec<f32> {
    let rows = |map: &DAffine3| {
        let linear = map.matrix3.transpose().to_cols_array_2d();
        let shift = map.translation.to_array();
        [0, 1, 2].map(|r| [linear[r][0], linear[r][1], linear[r][2], shift[r]].map(|x| x as f32))
    };
    rounds.iter().flatten().flat_map(|map| rows(map).into_iter().flatten()).collect()
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
