//! The binary form of glTF: a document, and one buffer that it describes.

use glam::{DVec3, Mat4, Quat, Vec3};
use serde_json::{Value, json};

const UNSIGNED_BYTE: u32 = 5121;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;
const ARRAY_BUFFER: u32 = 34962;
const ELEMENT_ARRAY_BUFFER: u32 = 34963;

/// What data are for; each kind is one view of the buffer, because a view is for one purpose only.
#[derive(Clone, Copy)]
enum Kind {
    /// Positions and normals of vertices.
    Vectors,
    Indices,
    /// Joint numbers of vertices.
    Joints,
    /// Joint weights and colours of vertices.
    Weights,
    /// Inverse bind matrices.
    Binds,
    /// Times and values of animations.
    Keys,
    /// Coordinates of textures.
    TextureCoordinates,
}

const KINDS: usize = 7;

/// Collects binary data with the views and accessors that describe it.
#[derive(Default)]
pub struct Writer {
    /// Each with its kind in place of the number of its view.
    accessors: Vec<(Kind, Value)>,
    data: [Vec<u8>; KINDS],
    /// Bytes from one vertex's joint numbers to the next one's.
    joint_stride: usize,
    /// The images of the document, in their order; each is a view of its own.
    images: Vec<Vec<u8>>,
}

/// A point as 32-bit floats, brought into their range.
pub fn single(p: DVec3) -> Vec3 {
    const LIMIT: f64 = f32::MAX as f64;
    p.clamp(DVec3::splat(-LIMIT), DVec3::splat(LIMIT)).as_vec3()
}

impl Writer {
    /// What a document says of itself.
    pub fn asset() -> Value {
        json!({ "version": "2.0", "generator": "Sinew" })
    }

    /// Adds values of one kind and returns the number of their accessor.
    fn add(&mut self, kind: Kind, bytes: impl IntoIterator<Item = u8>, accessor: Value) -> usize {
        let data = &mut self.data[kind as usize];
        let mut accessor = accessor;
        accessor["byteOffset"] = json!(data.len());
        data.extend(bytes);
        self.accessors.push((kind, accessor));
        self.accessors.len() - 1
    }

    fn floats(&mut self, kind: Kind, shape: &str, width: usize, values: impl Iterator<Item = f32>) -> usize {
        let bytes: Vec<u8> = values.flat_map(f32::to_le_bytes).collect();
        let count = bytes.len() / (4 * width);
        self.add(kind, bytes, json!({ "componentType": FLOAT, "count": count, "type": shape }))
    }

    /// Vectors of vertices, with their range.
    pub fn vectors(&mut self, values: &[Vec3]) -> usize {
        let (low, high) = values
            .iter()
            .fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), value| (low.min(*value), high.max(*value)));
        let accessor = self.floats(Kind::Vectors, "VEC3", 3, values.iter().flat_map(|v| v.to_array()));
        self.accessors[accessor].1["min"] = json!(low.as_dvec3().to_array());
        self.accessors[accessor].1["max"] = json!(high.as_dvec3().to_array());
        accessor
    }

    /// Corners of faces.
    pub fn indices(&mut self, faces: &[[u32; 3]]) -> usize {
        let bytes = faces.iter().flatten().flat_map(|corner| corner.to_le_bytes());
        let count = 3 * faces.len();
        self.add(Kind::Indices, bytes, json!({ "componentType": UNSIGNED_INT, "count": count, "type": "SCALAR" }))
    }

    /// Four joints a vertex, in bytes if `joints`, the number of joints there are, allows it. Every call must give
    /// the same number.
    pub fn joints(&mut self, values: &[[u16; 4]], joints: usize) -> usize {
        let short = joints > 256;
        self.joint_stride = if short { 8 } else { 4 };
        let bytes = values.iter().flatten().flat_map(|j| j.to_le_bytes().into_iter().take(if short { 2 } else { 1 }));
        let component = if short { UNSIGNED_SHORT } else { UNSIGNED_BYTE };
        self.add(Kind::Joints, bytes, json!({ "componentType": component, "count": values.len(), "type": "VEC4" }))
    }

    /// Four joint weights a vertex.
    pub fn weights(&mut self, values: &[[f32; 4]]) -> usize {
        self.floats(Kind::Weights, "VEC4", 4, values.iter().flatten().copied())
    }

    /// Two or four numbers a vertex: coordinates of a texture, or a colour.
    pub fn layer(&mut self, width: usize, values: &[f32]) -> usize {
        let (kind, shape) = if width == 2 { (Kind::TextureCoordinates, "VEC2") } else { (Kind::Weights, "VEC4") };
        self.floats(kind, shape, width, values.iter().copied())
    }

    /// The bytes of the document's next image.
    pub fn image(&mut self, bytes: &[u8]) {
        self.images.push(bytes.to_vec());
    }

    /// Inverse bind matrices.
    pub fn binds(&mut self, values: &[Mat4]) -> usize {
        self.floats(Kind::Binds, "MAT4", 16, values.iter().flat_map(|m| m.to_cols_array()))
    }

    /// Times of keys (at least one), which rise.
    pub fn times(&mut self, values: &[f32]) -> usize {
        let accessor = self.scalars(values);
        if let (Some(first), Some(last)) = (values.first(), values.last()) {
            self.accessors[accessor].1["min"] = json!([f64::from(*first)]);
            self.accessors[accessor].1["max"] = json!([f64::from(*last)]);
        }
        accessor
    }

    /// Numbers of keys.
    pub fn scalars(&mut self, values: &[f32]) -> usize {
        self.floats(Kind::Keys, "SCALAR", 1, values.iter().copied())
    }

    /// Shifts or scales of keys.
    pub fn shifts(&mut self, values: impl Iterator<Item = Vec3>) -> usize {
        self.floats(Kind::Keys, "VEC3", 3, values.flat_map(|v| v.to_array()))
    }

    /// Turns of keys.
    pub fn turns(&mut self, values: impl Iterator<Item = Quat>) -> usize {
        self.floats(Kind::Keys, "VEC4", 4, values.flat_map(|q| q.to_array()))
    }

    /// The views of what there is, the bytes they view, and the number of each kind's view.
    fn views(data: [Vec<u8>; KINDS], joint_stride: usize) -> (Vec<Value>, Vec<u8>, [usize; KINDS]) {
        let mut binary = Vec::with_capacity(data.iter().map(Vec::len).sum());
        let (mut views, mut numbers) = (Vec::new(), [0; KINDS]);
        // All data are in groups of four bytes, so every view starts at a multiple of four.
        for (kind, data) in data.into_iter().enumerate() {
            numbers[kind] = views.len();
            if data.is_empty() {
                continue;
            }
            let mut view = json!({ "buffer": 0, "byteOffset": binary.len(), "byteLength": data.len() });
            let stride = [12, 0, joint_stride, 16, 0, 0, 8][kind];
            if stride > 0 {
                view["byteStride"] = json!(stride);
                view["target"] = json!(ARRAY_BUFFER);
            } else if kind == Kind::Indices as usize {
                view["target"] = json!(ELEMENT_ARRAY_BUFFER);
            }
            views.push(view);
            binary.extend_from_slice(&data);
        }
        (views, binary, numbers)
    }

    /// Puts document and data together: a header and two chunks, each padded to four bytes.
    pub fn finish(self, mut document: Value) -> Vec<u8> {
        let Self { accessors, data, joint_stride, images } = self;
        let (mut views, mut binary, numbers) = Self::views(data, joint_stride);
        for (number, image) in images.iter().enumerate() {
            document["images"][number]["bufferView"] = json!(views.len());
            views.push(json!({ "buffer": 0, "byteOffset": binary.len(), "byteLength": image.len() }));
            binary.extend_from_slice(image);
            binary.resize(binary.len().next_multiple_of(4), 0);
        }
        if !binary.is_empty() {
            let accessors = accessors.into_iter().map(|(kind, mut accessor)| {
                accessor["bufferView"] = json!(numbers[kind as usize]);
                accessor
            });
            document["accessors"] = accessors.collect();
            document["bufferViews"] = json!(views);
            document["buffers"] = json!([{ "byteLength": binary.len() }]);
        }
        let mut text = document.to_string().into_bytes();
        text.resize(text.len().next_multiple_of(4), b' ');
        let data = if binary.is_empty() { 0 } else { 8 + binary.len() };
        let mut file = Vec::with_capacity(20 + text.len() + data);
        let length = |n: usize| u32::try_from(n).unwrap_or(u32::MAX).to_le_bytes();
        file.extend_from_slice(b"glTF");
        file.extend_from_slice(&2u32.to_le_bytes());
        file.extend_from_slice(&length(20 + text.len() + data));
        file.extend_from_slice(&length(text.len()));
        file.extend_from_slice(b"JSON");
        file.extend_from_slice(&text);
        if !binary.is_empty() {
            file.extend_from_slice(&length(binary.len()));
            file.extend_from_slice(b"BIN\0");
            file.extend_from_slice(&binary);
        }
        file
    }
}
