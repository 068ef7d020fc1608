//! Plain objects of the page to values of the engine, and back.

use crate::import::File;
use crate::transfer::Pair;
use glam::DVec3;
use js_sys::{Array, Float32Array, Reflect, Uint8Array};
use serde::Serialize;
use serde::de::DeserializeOwned;
use std::fmt::Display;
use wasm_bindgen::prelude::*;

/// What a message returns: an object, or a sentence.
pub type Reply = Result<JsValue, JsValue>;

/// `[{name, bytes: Uint8Array}]`.
pub fn read_files(files: &Array) -> Result<Vec<File>, JsValue> {
    files.iter().map(|file| read_file(&file)).collect()
}

/// `{name, bytes: Uint8Array}`.
pub fn read_file(file: &JsValue) -> Result<File, JsValue> {
    let name = field(file, "name")?.as_string().ok_or_else(|| sentence("A file has no name."))?;
    Ok(File { name, bytes: Uint8Array::from(field(file, "bytes")?).to_vec() })
}

pub fn coordinates(points: &[DVec3]) -> Vec<f32> {
    points.iter().flat_map(|p| p.as_vec3().to_array()).collect()
}

pub fn points(coordinates: &[f32]) -> Vec<DVec3> {
    triples(coordinates).into_iter().map(|[x, y, z]: [f32; 3]| DVec3::new(x.into(), y.into(), z.into())).collect()
}

pub fn triples<T: Copy>(flat: &[T]) -> Vec<[T; 3]> {
    flat.as_chunks().0.to_vec()
}

/// Alternately vertices of the source and of the target.
pub fn read_pairs(flat: &[u32]) -> Vec<Pair> {
    flat.as_chunks().0.iter().map(|&[source, target]| Pair { source, target }).collect()
}

pub fn single(values: &[f64]) -> Float32Array {
    Float32Array::from(values.iter().map(|&value| value as f32).collect::<Vec<_>>().as_slice())
}

pub fn field(object: &JsValue, name: &str) -> Reply {
    Reflect::get(object, &name.into())
}

pub fn put(object: &JsValue, name: &str, value: &JsValue) -> Result<(), JsValue> {
    Reflect::set(object, &name.into(), value).map(|_| ())
}

pub fn plain<T: Serialize + ?Sized>(value: &T) -> Reply {
    serde_wasm_bindgen::to_value(value).map_err(sentence)
}

pub fn parsed<T: DeserializeOwned>(value: JsValue) -> Result<T, JsValue> {
    serde_wasm_bindgen::from_value(value).map_err(sentence)
}

/// An error as the page expects it.
pub fn sentence(error: impl Display) -> JsValue {
    JsValue::from_str(&error.to_string())
}
