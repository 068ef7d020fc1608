//! Messages about the target moved by its faces, and about any method beside another.

use super::values::{Reply, coordinates, parsed, plain, put, read_pairs, sentence};
use super::{Engine, watcher};
use crate::memory::Step;
use crate::transfer::gradients::Mover;
use crate::transfer::{Parameters, Prepared};
use glam::DVec3;
use js_sys::{Float32Array, Function, Object};
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
impl Engine {
    /// As [`Engine::transfer`], by what each face does: the reply has `positions`, T·#V·3 numbers, in place of a skin;
    /// `shapes`, R·#V·3 numbers, of the source as it was bent into the target; and how well it covers that.
    pub fn transfer_faces(&mut self, pairs: &[u32], parameters: JsValue, progress: &Function) -> Reply {
        let parameters: Parameters = parsed(parameters)?;
        let mut observer = watcher(progress);
        (self.moved, self.faces_moved) = (None, None);
        let kept = self.mover.take().filter(|(made_with, _)| *made_with == parameters);
        let mover = match kept {
            Some((_, mover)) => mover,
            None => {
                self.prepared = None;
                self.room_for(Step::Faces(self.open_target()?.sizes()), self.open_sequence()?)?;
                let proposer = Some(self.proposer()?);
                let (source, target) = (self.open_sequence()?, self.open_target()?);
                Mover::with_proposer(source, target, &parameters, proposer, &mut observer).map_err(sentence)?
            }
        };
        let result = mover.transfer(&read_pairs(pairs), &mut observer);
        let mut seconds = mover.seconds().to_vec();
        self.mover = Some((parameters, mover));
        let result = result.map_err(sentence)?;
        seconds.extend_from_slice(&result.seconds);
        let reply: JsValue = Object::new().into();
        put(&reply, "positions", &table(&result.poses))?;
        put(&reply, "shapes", &table(&result.bent.shapes))?;
        put(&reply, "rounds", &result.bent.shapes.len().into())?;
        put(&reply, "quality", &plain(&result.bent.quality)?)?;
        put(&reply, "parts", &result.parts.into())?;
        put(&reply, "warnings", &plain(&result.warnings)?)?;
        put(&reply, "seconds", &plain(&seconds)?)?;
        self.faces_moved = Some(result.poses);
        Ok(reply)
    }

    /// Where the target's vertices are by any method: `{positions}`, T·#V·3 numbers. What was moved before stays.
    pub fn positions_by(&mut self, pairs: &[u32], parameters: JsValue, progress: &Function) -> Reply {
        let parameters: Parameters = parsed(parameters)?;
        let proposer = if parameters.method.by_bones() { Some(self.proposer()?) } else { None };
        let (source, target) = (self.open_sequence()?, self.open_target()?);
        let (pairs, mut observer) = (read_pairs(pairs), watcher(progress));
        let poses = if parameters.method.moves_vertices() {
            self.room_for(Step::Faces(target.sizes()), source)?;
            let mover = Mover::with_proposer(source, target, &parameters, proposer, &mut observer);
            mover.and_then(|mover| mover.transfer(&pairs, &mut observer)).map_err(sentence)?.poses
        } else {
            self.room_for(Step::Transfer(target.sizes()), source)?;
            let prepared = Prepared::with_proposer(source, target, &parameters, proposer, &mut observer);
            let moved = prepared.and_then(|mut prepared| prepared.transfer(&pairs, &mut observer));
            moved.map_err(sentence)?.poses(target.reference())
        };
        let reply: JsValue = Object::new().into();
        put(&reply, "positions", &table(&poses))?;
        Ok(reply)
    }
}

fn table(shapes: &[Vec<DVec3>]) -> Float32Array {
    let each: u32 = shapes.first().map_or(0, |shape| 3 * shape.len() as u32);
    let table = Float32Array::new_with_length(each * shapes.len() as u32);
    for (number, shape) in (0_u32..).zip(shapes) {
        table.subarray(each * number, each * (number + 1)).copy_from(&coordinates(shape));
    }
    table
}
