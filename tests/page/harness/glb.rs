//! A GLB made by code: the bending bar, skinned to two joints.

#[path = "../../common/hinge.rs"]
mod hinge;

use serde_json::{Value, json};

/// One clip of two seconds, in which the right half of a bar of `rings` rings goes up by 70° and back.
pub fn hinge(rings: u32) -> Vec<u8> {
    let (positions, faces) = hinge::bar(rings);
    let angles = [0.0_f64, 70.0, 0.0].map(|degrees| degrees.to_radians() / 2.0);
    let mut buffer = Buffer::default();
    let place = buffer.add("VEC3", positions.iter().flatten().map(|&x| x as f32));
    let (low, high) = ([-1.0, -0.125, -0.125], [1.0, 0.125, 0.125]);
    buffer.accessors[place]["min"] = json!(low);
    buffer.accessors[place]["max"] = json!(high);
    let joints = buffer.add_bytes(positions.iter().flat_map(|p| [u8::from(p[0] > 0.0), 0, 0, 0]));
    let weights = buffer.add("VEC4", positions.iter().flat_map(|_| [1.0, 0.0, 0.0, 0.0]));
    let indices = buffer.add_indices(faces.iter().flatten().copied());
    let identity = |i: usize| if (i % 16).is_multiple_of(5) { 1.0 } else { 0.0 };
    let inverse = buffer.add("MAT4", (0..32).map(identity));
    let times = buffer.add("SCALAR", [0.0, 1.0, 2.0]);
    buffer.accessors[times]["min"] = json!([0.0]);
    buffer.accessors[times]["max"] = json!([2.0]);
    let turns = buffer.add("VEC4", angles.iter().flat_map(|half| [0.0, 0.0, half.sin() as f32, half.cos() as f32]));
    let document = json!({
        "asset": { "version": "2.0" },
        "scene": 0,
        "scenes": [{ "nodes": [0, 1] }],
        "nodes": [{ "mesh": 0, "skin": 0 }, { "name": "left", "children": [2] }, { "name": "right" }],
        "meshes": [{ "primitives": [{
            "attributes": { "POSITION": place, "JOINTS_0": joints, "WEIGHTS_0": weights },
            "indices": indices,
        }] }],
        "skins": [{ "joints": [1, 2], "inverseBindMatrices": inverse }],
        "animations": [{
            "name": "bend",
            "channels": [{ "sampler": 0, "target": { "node": 2, "path": "rotation" } }],
            "samplers": [{ "input": times, "output": turns }],
        }],
        "buffers": [{ "byteLength": buffer.bytes.len() }],
        "bufferViews": buffer.views,
        "accessors": buffer.accessors,
    });
    assemble(&document, &buffer.bytes)
}

/// The binary chunk and what describes it, growing together.
#[derive(Default)]
struct Buffer {
    bytes: Vec<u8>,
    views: Vec<Value>,
    accessors: Vec<Value>,
}

impl Buffer {
    /// Adds floats and returns the number of their accessor.
    fn add(&mut self, shape: &str, values: impl IntoIterator<Item = f32>) -> usize {
        self.push(5126, shape, &values.into_iter().flat_map(f32::to_le_bytes).collect::<Vec<_>>())
    }

    /// Adds quadruples of bytes.
    fn add_bytes(&mut self, values: impl IntoIterator<Item = u8>) -> usize {
        self.push(5121, "VEC4", &values.into_iter().collect::<Vec<_>>())
    }

    /// Adds 32-bit indices.
    fn add_indices(&mut self, values: impl IntoIterator<Item = u32>) -> usize {
        self.push(5125, "SCALAR", &values.into_iter().flat_map(u32::to_le_bytes).collect::<Vec<_>>())
    }

    fn push(&mut self, component: u32, shape: &str, bytes: &[u8]) -> usize {
        let numbers = match shape {
            "SCALAR" => 1,
            "VEC3" => 3,
            "VEC4" => 4,
            _ => 16,
        };
        let size = numbers * if component == 5121 { 1 } else { 4 };
        self.views.push(json!({ "buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len() }));
        self.bytes.extend_from_slice(bytes);
        let (view, count) = (self.views.len() - 1, bytes.len() / size);
        self.accessors.push(json!({ "bufferView": view, "componentType": component, "count": count, "type": shape }));
        self.accessors.len() - 1
    }
}

/// Header, JSON chunk padded with spaces, binary chunk padded with zeros.
fn assemble(document: &Value, binary: &[u8]) -> Vec<u8> {
    let mut text = document.to_string().into_bytes();
    text.resize(text.len().next_multiple_of(4), b' ');
    let mut binary = binary.to_vec();
    binary.resize(binary.len().next_multiple_of(4), 0);
    let length = |bytes: usize| u32::try_from(bytes).expect("a small file").to_le_bytes();
    let total = length(12 + 8 + text.len() + 8 + binary.len());
    let parts: [&[u8]; 9] = [
        b"glTF",
        &2_u32.to_le_bytes(),
        &total,
        &length(text.len()),
        b"JSON",
        &text,
        &length(binary.len()),
        b"BIN\0",
        &binary,
    ];
    parts.concat()
}
