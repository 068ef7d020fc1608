//! Small glTF documents for tests.

use serde_json::{Value, json};

/// A document and its one buffer.
#[derive(Clone)]
pub struct Maker {
    pub json: Value,
    pub bytes: Vec<u8>,
}

/// One triangle at one node: (0, 0, 0), (1, 0, 0), (0, 1, 0), without indices.
pub fn triangle() -> Maker {
    let json = json!({
        "asset": {"version": "2.0"},
        "scene": 0,
        "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "buffers": [{"byteLength": 0}],
        "bufferViews": [],
        "accessors": [],
        "animations": [],
    });
    let mut maker = Maker { json, bytes: Vec::new() };
    maker.accessor(&f32s(&[0., 0., 0., 1., 0., 0., 0., 1., 0.]), 5126, "VEC3", 3);
    maker
}

/// The bytes of numbers.
pub fn f32s(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|x| x.to_le_bytes()).collect()
}

impl Maker {
    /// Appends bytes as a buffer view; returns its number.
    pub fn view(&mut self, bytes: &[u8]) -> usize {
        let views = self.json["bufferViews"].as_array_mut().unwrap();
        views.push(json!({"buffer": 0, "byteOffset": self.bytes.len(), "byteLength": bytes.len()}));
        self.bytes.extend(bytes);
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        views.len() - 1
    }

    /// Appends bytes as an accessor of its own; returns its number.
    pub fn accessor(&mut self, bytes: &[u8], component: u32, shape: &str, count: usize) -> usize {
        let view = self.view(bytes);
        let accessors = self.json["accessors"].as_array_mut().unwrap();
        accessors.push(json!({"bufferView": view, "componentType": component, "type": shape, "count": count}));
        accessors.len() - 1
    }

    /// Appends an animation of one channel of node 0.
    pub fn animate(&mut self, path: &str, interpolation: &str, times: &[f32], values: &[f32], shape: &str) {
        let width = if shape == "VEC4" {
            4
        } else if shape == "VEC3" {
            3
        } else {
            1
        };
        let input = self.accessor(&f32s(times), 5126, "SCALAR", times.len());
        let output = self.accessor(&f32s(values), 5126, shape, values.len() / width);
        self.json["animations"].as_array_mut().unwrap().push(json!({
            "channels": [{"sampler": 0, "target": {"node": 0, "path": path}}],
            "samplers": [{"input": input, "output": output, "interpolation": interpolation}],
        }));
    }

    /// The document as GLB.
    pub fn glb(&self) -> Vec<u8> {
        let mut json = self.json.clone();
        json["buffers"][0]["byteLength"] = json!(self.bytes.len());
        let mut text = json.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let total = 12 + 8 + text.len() + 8 + self.bytes.len();
        let mut glb = b"glTF".to_vec();
        glb.extend(2_u32.to_le_bytes());
        glb.extend((total as u32).to_le_bytes());
        for (kind, chunk) in [(b"JSON", &text), (b"BIN\0", &self.bytes)] {
            glb.extend((chunk.len() as u32).to_le_bytes());
            glb.extend(kind);
            glb.extend(chunk);
        }
        glb
    }

    /// The document as glTF with its buffer at an address of its own.
    pub fn split(&self, uri: &str) -> (Vec<u8>, Vec<u8>) {
        let mut json = self.json.clone();
        json["buffers"][0] = json!({"byteLength": self.bytes.len(), "uri": uri});
        (json.to_string().into_bytes(), self.bytes.clone())
    }
}
