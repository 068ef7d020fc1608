//! Small glTF documents for tests.

mod draco;
pub mod meshopt;

pub use draco::{draco_mesh, draco_triangle};
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

/// A skin of two joints in a frame that lies on its side and is a hundred times too large, as exporters make them.
pub fn skinned() -> Maker {
    let mut maker = triangle();
    let joints = maker.accessor(&[0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0], 5121, "VEC4", 3);
    // The second vertex's weights do not add up to 1, the third follows both joints alike.
    let weights = maker.accessor(&[255, 0, 0, 0, 51, 0, 0, 0, 128, 128, 0, 0], 5121, "VEC4", 3);
    maker.json["accessors"][weights]["normalized"] = json!(true);
    let attributes = &mut maker.json["meshes"][0]["primitives"][0]["attributes"];
    attributes["JOINTS_0"] = json!(joints);
    attributes["WEIGHTS_0"] = json!(weights);
    // Inverse binds: the first joint at the origin, the second at x = 1 of the mesh's frame.
    let identity = [1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1., 0., 0., 0., 0., 1.];
    let mut second = identity;
    second[12] = -1.0;
    let binds = maker.accessor(&f32s(&[identity, second].concat()), 5126, "MAT4", 2);
    maker.json["skins"] = json!([{"joints": [2, 3], "inverseBindMatrices": binds}]);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    maker.json["nodes"] = json!([
        {"mesh": 0, "skin": 0, "translation": [9, 9, 9]},
        {"children": [2], "rotation": [-half, 0, 0, half], "scale": [0.01, 0.01, 0.01]},
        {"children": [3]},
        {"translation": [1, 0, 0]},
    ]);
    maker.json["scenes"] = json!([{"nodes": [0, 1]}]);
    maker
}

/// A skin, a morph target and a clip of each interpolation.
pub fn rich() -> Maker {
    let mut maker = skinned();
    let offsets = maker.accessor(&f32s(&[0., 0., 1., 0., 0., 0., 0., 0., 0.]), 5126, "VEC3", 3);
    maker.json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": offsets}]);
    maker.animate("weights", "CUBICSPLINE", &[0.0, 1.0], &[0., 0., 1., 1., 4., 0.], "SCALAR");
    maker.animate("translation", "STEP", &[0.0, 1.0], &[0., 0., 0., 1., 0., 0.], "VEC3");
    maker.animate("rotation", "LINEAR", &[0.0, 1.0], &[0., 0., 0., 1., 0., 1., 0., 0.], "VEC4");
    maker
}

/// A picture of one pixel.
pub const PNG: &[u8] = &[
    0x89, b'P', b'N', b'G', 13, 10, 26, 10, 0, 0, 0, 13, b'I', b'H', b'D', b'R', 0, 0, 0, 1, 0, 0, 0, 1, 8, 0, 0, 0, 0,
    0x3a, 0x7e, 0x9b, 0x55, 0, 0, 0, 10, b'I', b'D', b'A', b'T', 0x78, 0x9c, 0x63, 0x68, 0, 0, 0, 0x82, 0, 0x81, 0x77,
    0xcd, 0x72, 0xb6, 0, 0, 0, 0, b'I', b'E', b'N', b'D', 0xae, 0x42, 0x60, 0x82,
];

/// A square of two triangles that have materials of their own, with a seam between them: one has a texture, the other
/// that texture moved, and colours.
pub fn dressed() -> Maker {
    let mut maker = triangle();
    let normals = f32s(&[0., 0., 1., 0., 0., 1., 0., 0., 1.]);
    let first =
        (maker.accessor(&normals, 5126, "VEC3", 3), maker.accessor(&f32s(&[0., 0., 1., 0., 0., 1.]), 5126, "VEC2", 3));
    let positions = maker.accessor(&f32s(&[1., 0., 0., 1., 1., 0., 0., 1., 0.]), 5126, "VEC3", 3);
    let second = (
        maker.accessor(&normals, 5126, "VEC3", 3),
        maker.accessor(&f32s(&[0.5, 0.5, 1., 1., 0., 0.5]), 5126, "VEC2", 3),
    );
    let colours = maker.accessor(&f32s(&[0.5, 0.25, 0., 1., 0., 0., 0., 0., 1.]), 5126, "VEC3", 3);
    let picture = maker.view(PNG);
    maker.json["meshes"][0]["primitives"] = json!([
        { "material": 0, "attributes": { "POSITION": 0, "NORMAL": first.0, "TEXCOORD_0": first.1 } },
        { "material": 1, "attributes": {
            "POSITION": positions, "NORMAL": second.0, "TEXCOORD_0": second.1, "COLOR_0": colours } },
    ]);
    maker.json["materials"] = json!([
        { "name": "skin", "pbrMetallicRoughness": { "baseColorTexture": { "index": 0 } } },
        { "name": "cloth", "doubleSided": true, "emissiveTexture": {
            "index": 0, "extensions": { "KHR_texture_transform": { "offset": [0.5, 0.0] } } } },
    ]);
    maker.json["textures"] = json!([{ "source": 0, "sampler": 0 }]);
    maker.json["samplers"] = json!([{ "wrapS": 33071 }]);
    maker.json["images"] = json!([{ "name": "picture", "mimeType": "image/png", "bufferView": picture }]);
    maker.json["extensionsUsed"] = json!(["KHR_texture_transform"]);
    maker
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
