//! What a mesh looks like, beside its shape and motion: materials, textures, and where these lie on it.

use glam::Vec3;
use serde_json::{Map, Value};

/// Normals whose cosine is above this belong to one smooth surface.
const SMOOTH: f32 = 0.999;
/// A vertex is compared with so many others in its place at most, or a place with very many would take very long.
pub(crate) const MOST_COMPARED: usize = 64;

/// The look of a mesh, as its file says it and a glTF takes it again.
///
/// A mesh has one vertex where its surface has one point. Its look has more: two where a texture has a seam, or where
/// the surface has a hard edge.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Look {
    /// #L: the vertex of the mesh that each vertex of the look lies on.
    pub vertices: Vec<u32>,
    /// #L: vertices with one number are shaded as one; empty for a mesh that is shaded flat, each face by itself.
    pub shades: Vec<u32>,
    /// The faces of the mesh (#F triples) in vertices of the look.
    pub faces: Vec<[u32; 3]>,
    /// #F: the material of each face, a number in the document's list.
    pub materials: Vec<Option<u32>>,
    /// Coordinates of textures, and colours.
    pub layers: Vec<Layer>,
    /// The lists `materials`, `textures`, `samplers` and `images` of a glTF document (images without their bytes), and
    /// the lists of extensions that they use and require.
    pub document: Map<String, Value>,
    /// The bytes of the document's images, in their order.
    pub images: Vec<Vec<u8>>,
}

/// A value for each vertex of a look.
#[derive(Clone, Debug, PartialEq)]
pub struct Layer {
    /// What glTF calls it: `TEXCOORD_0`, `COLOR_0`.
    pub name: String,
    /// Numbers a vertex: 2 or 4.
    pub width: usize,
    /// #L × `width` numbers.
    pub values: Vec<f32>,
}

impl Look {
    /// Whether it is one of a mesh with so many vertices and faces.
    pub fn fits(&self, vertices: usize, faces: usize) -> bool {
        self.faces.len() == faces
            && self.materials.len() == faces
            && (self.shades.is_empty() || self.shades.len() == self.vertices.len())
            && self.vertices.iter().all(|&v| (v as usize) < vertices)
            && self.faces.iter().flatten().all(|&v| (v as usize) < self.vertices.len())
            && self.layers.iter().all(|layer| layer.values.len() == layer.width * self.vertices.len())
    }

    /// Lays it on the vertices of the mesh that its own became, #L `numbers`, and finds what is shaded as one: vertices in
    /// one place whose normals (#L) agree. Without normals it is shaded flat.
    pub fn settle(&mut self, numbers: Vec<u32>, normals: &[Vec3]) {
        const NONE: u32 = u32::MAX;
        self.shades = (0..normals.len() as u32).collect();
        // Lists of the shades in each place: the last one, and before each the one before.
        let places = numbers.iter().max().map_or(0, |&most| most as usize + 1);
        let (mut last, mut before) = (vec![NONE; places], vec![NONE; normals.len()]);
        for v in 0..normals.len() {
            let place = numbers[v] as usize;
            let mut shade = last[place];
            let mut compared = 0;
            while shade != NONE && normals[v].dot(normals[shade as usize]) <= SMOOTH {
                compared += 1;
                shade = if compared < MOST_COMPARED { before[shade as usize] } else { NONE };
            }
            if shade == NONE {
                before[v] = std::mem::replace(&mut last[place], v as u32);
            } else {
                self.shades[v] = shade;
            }
        }
        self.vertices = numbers;
    }

    /// Keeps the faces with these numbers alone.
    pub fn keep_faces(&mut self, stay: &[u32]) {
        self.faces = stay.iter().map(|&f| self.faces[f as usize]).collect();
        self.materials = stay.iter().map(|&f| self.materials[f as usize]).collect();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_seam_is_smooth_and_a_hard_edge_is_not() {
        let mut look = Look::default();
        look.settle(vec![4, 4, 4, 1], &[Vec3::X, Vec3::Y, Vec3::X, Vec3::X]);
        assert_eq!(look.shades, [0, 1, 0, 3]);
        look.settle(vec![4, 4, 4, 1], &[]);
        assert_eq!(look.shades, [0; 0]);
    }
}
