//! Primitives that are stored compressed: `KHR_draco_mesh_compression`.
//!
//! F. Galligan et al., *Draco bitstream specification* (Google, 2017); the decoder is the crate `draco-core`.

use super::extensions::Draco;
use crate::import::limits::Budget;
use draco_core::{DataType, DecodeLimits, DecoderBuffer, Mesh, MeshDecoder, PointAttribute, PointIndex};
use gltf::json::accessor::ComponentType;
use std::collections::BTreeMap;

/// A primitive, decoded.
pub struct Unpacked {
    /// Number of vertices.
    pub vertices: usize,
    /// #F triples of vertex numbers, each below `vertices`.
    pub faces: Vec<[u32; 3]>,
    /// Attributes by their glTF names.
    pub attributes: BTreeMap<String, Attribute>,
}

/// The values of an attribute, vertex by vertex without gaps.
pub struct Attribute {
    /// #V × `width` numbers, lowest byte first.
    pub bytes: Vec<u8>,
    /// Their type.
    pub component: ComponentType,
    /// Numbers a vertex.
    pub width: usize,
}

/// Bytes a vertex, and a face, at the least while a mesh is decoded and read.
const VERTEX: u64 = 64;
const FACE: u64 = 48;

/// Decodes `data`. Fails with the end of a sentence that begins with what the data are.
pub fn unpack(data: &[u8], entry: &Draco, wanted: &[&str], budget: &Budget) -> Result<Unpacked, String> {
    let limits = DecodeLimits::default()
        .with_max_points(budget.left() / VERTEX)
        .with_max_faces(budget.left() / FACE)
        .with_max_decoded_bytes(budget.left() / 2);
    let mut mesh = Mesh::new();
    MeshDecoder::new()
        .decode(&mut DecoderBuffer::new(data).with_limits(limits), &mut mesh)
        .map_err(|error| format!("cannot be decoded ({error})"))?;
    let vertices = mesh.num_points();
    let faces: Vec<[u32; 3]> = mesh.faces().iter().map(|face| face.map(|point| point.0)).collect();
    if let Some(vertex) = faces.iter().flatten().find(|&&v| v as usize >= vertices) {
        return Err(format!("names vertex {vertex}, but has only {vertices} vertices"));
    }
    let mut attributes = BTreeMap::new();
    for (name, &id) in entry.attributes.iter().filter(|(name, _)| wanted.contains(&name.as_str())) {
        let attribute = mesh
            .attribute_by_unique_id(id)
            .ok_or_else(|| format!("has no attribute {id}, which is to be its {name}"))?;
        let values =
            read(attribute, vertices).ok_or_else(|| format!("has values of {name} that glTF does not know"))?;
        attributes.insert(name.clone(), values);
    }
    Ok(Unpacked { vertices, faces, attributes })
}

fn read(attribute: &PointAttribute, vertices: usize) -> Option<Attribute> {
    let component = match attribute.data_type() {
        DataType::Int8 => ComponentType::I8,
        DataType::Uint8 | DataType::Bool => ComponentType::U8,
        DataType::Int16 => ComponentType::I16,
        DataType::Uint16 => ComponentType::U16,
        DataType::Uint32 => ComponentType::U32,
        DataType::Float32 => ComponentType::F32,
        _ => return None,
    };
    let width = usize::from(attribute.num_components());
    let size = width * component.size();
    let stride = usize::try_from(attribute.byte_stride()).ok()?;
    let data = attribute.buffer().data();
    let mut bytes = Vec::with_capacity(vertices.checked_mul(size)?);
    for vertex in 0..u32::try_from(vertices).ok()? {
        let start = (attribute.mapped_index(PointIndex(vertex)).0 as usize).checked_mul(stride)?;
        bytes.extend_from_slice(data.get(start..start.checked_add(size)?)?);
    }
    Some(Attribute { bytes, component, width })
}
