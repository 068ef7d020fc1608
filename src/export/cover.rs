//! What covers a mesh in a glTF file: primitives with materials, painted in flat colours or as its own file has them.

use super::container::Writer;
use crate::look::Look;
use crate::mesh::face::vertex_normals;
use glam::{DVec3, Vec3};
use serde_json::{Map, Value, json};

/// Colour of parts that were given none.
const GREY: [f32; 3] = [0.5; 3];
/// In place of the number of a material.
const NONE: u32 = u32::MAX;

/// The primitives of a mesh and what they look like.
pub struct Cover<'a> {
    /// The faces of each primitive, in vertices of the file.
    groups: Vec<(Option<u32>, Vec<[u32; 3]>)>,
    /// The faces of the mesh, in vertices of the file or, where these are split, in [`Look::shades`].
    shaded: Vec<[u32; 3]>,
    look: Option<&'a Look>,
    document: Map<String, Value>,
}

impl<'a> Cover<'a> {
    /// One primitive and one matte material a part: `labels` is #F part numbers (0 for a face without), `colours` linear
    /// RGB by part, `names` those of the parts.
    pub fn painted(faces: &[[u32; 3]], labels: &[u32], colours: &[[f32; 3]], names: &[String]) -> Self {
        let groups = grouped(faces, &|f| labels.get(f).copied().unwrap_or(0));
        let materials: Value = groups.iter().map(|(part, _)| material(*part, colours, names)).collect();
        let document = Map::from_iter([("materials".to_owned(), materials)]);
        let groups = (0..).zip(groups).map(|(number, (_, faces))| (Some(number), faces)).collect();
        Self { groups, shaded: faces.to_vec(), look: None, document }
    }

    /// As its own file has it.
    pub fn dressed(look: &'a Look) -> Self {
        let groups = grouped(&look.faces, &|f| look.materials[f].unwrap_or(NONE));
        let groups = groups.into_iter().map(|(part, faces)| (Some(part).filter(|&part| part != NONE), faces)).collect();
        let shade = |v: u32| look.shades.get(v as usize).copied().unwrap_or(v);
        let shaded = look.faces.iter().map(|face| face.map(shade)).collect();
        Self { groups, shaded, look: Some(look), document: look.document.clone() }
    }

    /// As its own file has it, if that fits a mesh with so many vertices and these faces; otherwise in one colour.
    pub fn own(look: Option<&'a Look>, vertices: usize, faces: &[[u32; 3]], colour: [f32; 3], name: &str) -> Self {
        match look.filter(|look| look.fits(vertices, faces.len())) {
            Some(look) => Self::dressed(look),
            None => Self::painted(faces, &[], &[colour], &[name.to_owned()]),
        }
    }

    /// Values of the mesh's vertices as values of the file's.
    pub fn spread<T: Copy>(&self, values: &[T]) -> Vec<T> {
        match self.look {
            Some(look) => look.vertices.iter().map(|&v| values[v as usize]).collect(),
            None => values.to_vec(),
        }
    }

    /// Area-weighted unit normals at positions of the file's vertices, +y where there is none; `None` where each face is
    /// shaded by itself, which is what players do without normals.
    pub fn normals(&self, positions: &[DVec3]) -> Option<Vec<Vec3>> {
        if self.look.is_some_and(|look| look.shades.is_empty()) {
            return None;
        }
        let normals = vertex_normals(&self.shaded, positions);
        let unit = |normal: DVec3| normal.as_vec3().normalize_or(Vec3::Y);
        Some(match self.look {
            Some(look) => look.shades.iter().map(|&v| unit(normals[v as usize])).collect(),
            None => normals.into_iter().map(unit).collect(),
        })
    }

    /// The primitives, with these attributes and morph targets and those of the look; its lists go into the document.
    pub fn write(self, file: &mut Writer, document: &mut Value, mut attributes: Value, targets: &[Value]) -> Value {
        for layer in self.look.iter().flat_map(|look| &look.layers) {
            attributes[&layer.name] = json!(file.layer(layer.width, &layer.values));
        }
        let mut primitives = Vec::with_capacity(self.groups.len());
        for (material, faces) in &self.groups {
            let mut primitive = json!({ "attributes": attributes, "indices": file.indices(faces), "mode": 4 });
            if let Some(material) = material {
                primitive["material"] = json!(material);
            }
            if !targets.is_empty() {
                primitive["targets"] = json!(targets);
            }
            primitives.push(primitive);
        }
        for (key, list) in self.document {
            document[key] = list;
        }
        for image in self.look.iter().flat_map(|look| &look.images) {
            file.image(image);
        }
        primitives.into()
    }
}

/// Faces of each part that has any, by rising part number.
fn grouped(faces: &[[u32; 3]], part: &dyn Fn(usize) -> u32) -> Vec<(u32, Vec<[u32; 3]>)> {
    let mut order: Vec<(u32, usize)> = (0..faces.len()).map(|f| (part(f), f)).collect();
    order.sort_unstable();
    let chunks = order.chunk_by(|a, b| a.0 == b.0);
    chunks.map(|chunk| (chunk[0].0, chunk.iter().map(|&(_, f)| faces[f]).collect())).collect()
}

fn material(part: u32, colours: &[[f32; 3]], names: &[String]) -> Value {
    let [r, g, b] = colours
        .get(part as usize)
        .filter(|colour| colour.iter().all(|c| c.is_finite()))
        .unwrap_or(&GREY)
        .map(|c| f64::from(c.clamp(0.0, 1.0)));
    let name = names.get(part as usize).cloned().unwrap_or_else(|| format!("part {}", u64::from(part) + 1));
    json!({
        "name": name,
        "pbrMetallicRoughness": { "baseColorFactor": [r, g, b, 1.0], "metallicFactor": 0.0, "roughnessFactor": 0.9 },
    })
}
