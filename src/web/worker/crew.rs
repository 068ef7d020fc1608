//! The crew of workers, of which this is one: `www/crew.js`.

use super::Engine;
use crate::crew::{Crew, Shared};
use crate::memory::{self, Step};
use crate::sequence::Sequence;
use js_sys::{Array, Uint8Array};
use wasm_bindgen::prelude::*;

#[wasm_bindgen]
extern "C" {
    /// What `www/crew.js` says about the others.
    pub type Workers;

    /// How many there are, this one included.
    #[wasm_bindgen(method, getter)]
    fn size(this: &Workers) -> usize;

    /// Says that so many items of `count` are done, where there is nobody else.
    #[wasm_bindgen(method)]
    fn tell(this: &Workers, done: usize, count: usize);

    /// Comes to the next meeting, about so many items.
    #[wasm_bindgen(method)]
    fn meet(this: &Workers, count: usize);

    /// The next item to be done here; undefined when the results of all are there.
    #[wasm_bindgen(method)]
    async fn next(this: &Workers) -> JsValue;

    /// Hands in the result of an item, and whether it is enough.
    #[wasm_bindgen(method)]
    fn put(this: &Workers, item: usize, result: Uint8Array, enough: bool);

    /// The results of all.
    #[wasm_bindgen(method)]
    fn results(this: &Workers) -> Array;
}

impl Crew for Workers {
    async fn until<T: Shared>(
        &self,
        count: usize,
        work: &(dyn Fn(usize) -> T + Sync),
        enough: &(dyn Fn(&T) -> bool + Sync),
    ) -> Vec<T> {
        if self.size() <= 1 {
            return self.alone(count, work, enough);
        }
        self.meet(count);
        while let Some(item) = self.next().await.as_f64() {
            let result = work(item as usize);
            let bytes = postcard::to_allocvec(&result).unwrap_or_default();
            self.put(item as usize, Uint8Array::from(bytes.as_slice()), enough(&result));
        }
        // One's own results, too, as the others have them: all go on from the same.
        let received = |(item, bytes): (usize, JsValue)| {
            postcard::from_bytes(&Uint8Array::from(bytes).to_vec()).unwrap_or_else(|_| work(item))
        };
        self.results().iter().enumerate().map(received).collect()
    }
}

impl Workers {
    fn alone<T>(&self, count: usize, work: &dyn Fn(usize) -> T, enough: &dyn Fn(&T) -> bool) -> Vec<T> {
        let mut results = Vec::new();
        while results.len() < count && !results.last().is_some_and(enough) {
            results.push(work(results.len()));
            self.tell(results.len(), count);
        }
        results
    }
}

/// Fewer weights than this are there before another worker is.
const WORTH_SHARING: usize = 40_000;

/// Bytes that all members may take together, where there are more than one.
const LIMIT: u64 = 1 << 30;

/// Meshes of fewer vertices are searched before another worker is there.
const WORTH_SEARCHING: usize = 300;

#[wasm_bindgen]
impl Engine {
    /// How many workers, this one included and `most` at most, are worth a search for so many key points.
    pub fn members_for_search(&self, points: usize, most: usize) -> usize {
        let worth = |sequence: &&Sequence| sequence.sizes().vertices >= WORTH_SEARCHING;
        self.sequence.as_ref().filter(worth).map_or(1, |of| members(Step::KeyPoints(points), of, most))
    }

    /// The same for the weights of handles of the target, or for those of the source and the fits to its poses. Weights that
    /// are known leave little to do.
    pub fn members_for_weights(&self, handles: &[u32], target: bool, most: usize) -> usize {
        let count = handles.len();
        let (sequence, step) =
            if target { (&self.target, Step::Weights(count)) } else { (&self.sequence, Step::KeyPoints(count)) };
        let known = self.target_field.as_ref().filter(|_| target).map_or(&[][..], |(_, weights)| &weights.handles);
        let new = handles.iter().filter(|handle| !known.contains(handle)).count();
        let worth = |sequence: &&Sequence| sequence.sizes().vertices.saturating_mul(new) >= WORTH_SHARING;
        let most = most.min(new);
        sequence.as_ref().filter(worth).map_or(1, |of| members(step, of, most))
    }
}

/// As many as there is memory for, one at least and `most` at most.
fn members(step: Step, of: &Sequence, most: usize) -> usize {
    memory::side_by_side(step, of, LIMIT).clamp(1, most.max(1))
}
