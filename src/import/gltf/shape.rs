//! One primitive: positions, triangles, morph targets, the joints that its vertices follow, and where textures lie.
//!
//! Only the vertices that triangles use are read; many primitives may share one large array of vertices.

use super::accessor::Accessor;
use super::buffers::Buffers;
use super::document::Document;
use super::draco::{self, Unpacked};
use crate::import::limits::Budget;
use crate::import::{ImportError, counted};
use crate::look::Layer;
use crate::mesh::face::is_whole;
use crate::warning::Warning;
use glam::{DVec3, Vec3};
use gltf::json::accessor::Type;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;

/// The geometry of a primitive, in the frame of its mesh.
#[derive(Clone, Debug, Default)]
pub struct Shape {
    /// #V positions.
    pub positions: Vec<DVec3>,
    /// #F triples of vertex numbers.
    pub faces: Vec<[u32; 3]>,
    /// The morph targets, in order.
    pub targets: Vec<Target>,
    /// Which joints the vertices follow; `None` without a skin.
    pub influences: Option<Influences>,
    /// Coordinates of textures and colours, where the look is asked for.
    pub layers: Vec<Layer>,
    /// #V normals, where the look is asked for and the file has them.
    pub normals: Vec<Vec3>,
}

/// A morph target: the vertices that it moves, and how far at weight 1.
#[derive(Clone, Debug, Default)]
pub struct Target {
    /// The vertices that it moves and by how much.
    pub offsets: Vec<(u32, Vec3)>,
}

/// Joints and weights, any number a vertex.
#[derive(Clone, Debug, Default)]
pub struct Influences {
    /// #V + 1 starts of the vertices' entries.
    pub starts: Vec<u32>,
    /// Entries: a joint (a number in the skin's list) and its weight; the weights of a vertex add up to 1.
    pub entries: Vec<(u32, f32)>,
}

/// Reads primitive `number` of mesh `mesh`; `None`, with a warning, for one that has no triangles.
///
/// `joints` is the number of joints of the skin that it is bound to, if any; `look` asks for what textures need.
pub fn read(
    document: &Document,
    buffers: &Buffers,
    (mesh, number): (usize, usize),
    (joints, look): (Option<usize>, bool),
    budget: &mut Budget,
    warnings: &mut Vec<Warning>,
) -> Result<Option<Shape>, ImportError> {
    let whose = document.mesh_name(mesh);
    let Some(primitive) = document.meshes.get(mesh).and_then(|m| m.primitives.get(number)) else { return Ok(None) };
    let unpacked = unpack(document, buffers, (mesh, number), (joints.is_some(), look), budget)?;
    let unpacked = unpacked.as_ref();
    let mut reader = Reader { document, buffers, primitive, unpacked, whose: &whose, budget, look, left_over: 0 };
    let why = match primitive.mode {
        Checked::Invalid => "is of an unknown kind",
        Checked::Valid(Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) => "is made of points or lines",
        Checked::Valid(mode) => match reader.attribute(Semantic::Positions)? {
            None => "has no positions",
            Some(positions) => match reader.shape(mode, &positions, joints)? {
                None => "has no triangle",
                shape => {
                    if reader.left_over > 0 {
                        let rest = counted(reader.left_over, "corner was", "corners were");
                        let what = format!("Primitive {number} of {whose} ends within a triangle; {rest} left out.");
                        warnings.push(Warning::new("incomplete-triangle", what));
                    }
                    return Ok(shape);
                }
            },
        },
    };
    let message = format!("Primitive {number} of {whose} {why}; it was left out.");
    warnings.push(Warning::new("primitive-left-out", message));
    Ok(None)
}

/// Decodes a primitive that is stored compressed: its faces and what places its vertices.
fn unpack(
    document: &Document,
    buffers: &Buffers,
    (mesh, number): (usize, usize),
    (skinned, look): (bool, bool),
    budget: &Budget,
) -> Result<Option<Unpacked>, ImportError> {
    let Some(entry) = document.extensions.draco.get(&(mesh, number)) else { return Ok(None) };
    let starts = |name: &str, heads: &[&str]| heads.iter().any(|head| name.starts_with(head));
    let wanted = |name: &&str| {
        *name == "POSITION"
            || skinned && starts(name, &["JOINTS_", "WEIGHTS_"])
            || look && starts(name, &["NORMAL", "TEXCOORD_", "COLOR_"])
    };
    let wanted: Vec<&str> = entry.attributes.keys().map(String::as_str).filter(wanted).collect();
    let data = buffers.view(document, entry.buffer_view)?;
    draco::unpack(data, entry, &wanted, budget).map(Some).map_err(|what| {
        let whose = document.mesh_name(mesh);
        ImportError(format!("the Draco data of {whose} of {} {what}; export the file again", document.name))
    })
}

/// A primitive and where its data are.
struct Reader<'a> {
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    primitive: &'a Primitive,
    /// What was decoded of it, if it is stored compressed.
    unpacked: Option<&'a Unpacked>,
    /// Its mesh, for sentences.
    whose: &'a str,
    budget: &'a mut Budget,
    /// Whether what textures need is read.
    look: bool,
    /// Corners after the last whole triangle.
    left_over: usize,
}

impl<'a> Reader<'a> {
    fn shape(&mut self, mode: Mode, positions: &Accessor, joints: Option<usize>) -> Result<Option<Shape>, ImportError> {
        positions.expect_shape(Type::Vec3)?;
        let listed = match self.unpacked {
            Some(unpacked) => {
                positions.expect_len(unpacked.vertices, "its compressed mesh")?;
                self.budget.take(unpacked.faces.len() as u64, 12, self.whose)?;
                unpacked.faces.clone()
            }
            None => {
                let corners = self.corners(positions.len())?;
                self.left_over = if mode == Mode::Triangles { corners.len() % 3 } else { 0 };
                triangles(mode, &corners)
            }
        };
        let (used, faces) = compact(listed, positions.len());
        if faces.is_empty() {
            return Ok(None);
        }
        self.budget.take(used.len() as u64, 24, self.whose)?;
        let read_position = |&v: &u32| positions.numbers(v as usize).map(DVec3::from_array);
        Ok(Some(Shape {
            positions: used.iter().map(read_position).collect::<Result<_, _>>()?,
            faces,
            targets: self.targets(positions, &used)?,
            influences: match joints {
                Some(joints) => self.influences(joints, positions, &used)?,
                None => None,
            },
            layers: self.layers(positions.len(), &used),
            normals: self.normals(positions.len(), &used),
        }))
    }

    /// Coordinates of textures, and colours. What is broken is left out, as if it were not there.
    fn layers(&mut self, vertices: usize, used: &[u32]) -> Vec<Layer> {
        let mut layers = Vec::new();
        for set in 0.. {
            let name = format!("TEXCOORD_{set}");
            let Some(values) = self.look(Semantic::TexCoords(set), Type::Vec2, vertices, used) else { break };
            layers.push(Layer { name, width: 2, values: values.iter().flat_map(|v| [v[0], v[1]]).collect() });
        }
        let mut colours = self.look(Semantic::Colors(0), Type::Vec4, vertices, used);
        if colours.is_none() {
            colours = self.look(Semantic::Colors(0), Type::Vec3, vertices, used);
            colours.iter_mut().flatten().for_each(|colour| colour[3] = 1.0);
        }
        if let Some(colours) = colours {
            let values = colours.iter().flatten().map(|x| x.clamp(0.0, 1.0)).collect();
            layers.push(Layer { name: "COLOR_0".into(), width: 4, values });
        }
        layers
    }

    fn normals(&mut self, vertices: usize, used: &[u32]) -> Vec<Vec3> {
        let normals = self.look(Semantic::Normals, Type::Vec3, vertices, used).unwrap_or_default();
        normals.iter().map(|n| Vec3::from_slice(n).normalize_or_zero()).collect()
    }

    /// An attribute that only the look needs; numbers that it has not are 0.
    fn look(&mut self, semantic: Semantic, shape: Type, vertices: usize, used: &[u32]) -> Option<Vec<[f32; 4]>> {
        let values = self.attribute(semantic).ok().flatten().filter(|_| self.look)?;
        values.expect_shape(shape).and_then(|()| values.expect_len(vertices, "")).ok()?;
        self.budget.take(used.len() as u64, 16, self.whose).ok()?;
        used.iter().map(|&v| values.numbers(v as usize).ok().map(|x| x.map(|x| x as f32))).collect()
    }

    fn attribute(&self, semantic: Semantic) -> Result<Option<Accessor<'a>>, ImportError> {
        let name = semantic.to_string();
        let purpose = format!("{name} of {}", self.whose);
        let Some(index) = self.primitive.attributes.get(&Checked::Valid(semantic)) else { return Ok(None) };
        let decoded = self.unpacked.and_then(|unpacked| unpacked.attributes.get(&name));
        Accessor::over(self.document, self.buffers, index.value(), &purpose, decoded).map(Some)
    }

    /// The vertex numbers of the primitive in the order in which it names them.
    fn corners(&mut self, vertices: usize) -> Result<Vec<u32>, ImportError> {
        let Some(index) = self.primitive.indices else {
            self.budget.take(vertices as u64, 4, self.whose)?;
            return Ok((0..vertices as u32).collect());
        };
        let purpose = format!("indices of {}", self.whose);
        let indices = Accessor::open(self.document, self.buffers, index.value(), &purpose)?;
        indices.expect_shape(Type::Scalar)?;
        self.budget.take(indices.len() as u64, 4, self.whose)?;
        let mut corners = Vec::with_capacity(indices.len());
        for element in 0..indices.len() {
            let [vertex] = indices.integers(element)?;
            if vertex as usize >= vertices {
                return Err(indices.wrong(&format!("names vertex {vertex}, but there are only {vertices} vertices")));
            }
            corners.push(vertex);
        }
        Ok(corners)
    }

    fn targets(&mut self, positions: &Accessor, used: &[u32]) -> Result<Vec<Target>, ImportError> {
        let mut targets = Vec::new();
        for (number, entry) in self.primitive.targets.iter().flatten().enumerate() {
            let mut target = Target::default();
            if let Some(index) = entry.positions {
                let purpose = format!("morph target {number} of {}", self.whose);
                let offsets = Accessor::open(self.document, self.buffers, index.value(), &purpose)?;
                offsets.expect_shape(Type::Vec3)?;
                offsets.expect_len(positions.len(), positions.label())?;
                if !offsets.is_zero() {
                    for (new, &old) in used.iter().enumerate() {
                        let offset = DVec3::from_array(offsets.numbers(old as usize)?);
                        if offset != DVec3::ZERO {
                            target.offsets.push((new as u32, offset.as_vec3()));
                        }
                    }
                    target.offsets.shrink_to_fit();
                    self.budget.take(target.offsets.len() as u64, 16, self.whose)?;
                }
            }
            targets.push(target);
        }
        Ok(targets)
    }

    fn influences(
        &mut self,
        joint_count: usize,
        positions: &Accessor,
        used: &[u32],
    ) -> Result<Option<Influences>, ImportError> {
        let mut sets = Vec::new();
        for set in 0.. {
            let joints = self.attribute(Semantic::Joints(set))?;
            let weights = self.attribute(Semantic::Weights(set))?;
            let (Some(joints), Some(weights)) = (joints, weights) else { break };
            for accessor in [&joints, &weights] {
                accessor.expect_shape(Type::Vec4)?;
                accessor.expect_len(positions.len(), positions.label())?;
            }
            sets.push((joints, weights));
        }
        if sets.is_empty() {
            return Ok(None);
        }
        self.budget.take((sets.len() * used.len()) as u64, 32, self.whose)?;
        let mut influences = Influences { starts: vec![0], entries: Vec::with_capacity(4 * used.len()) };
        for &vertex in used {
            let start = influences.entries.len();
            let mut first = 0;
            for (number, (joints, weights)) in sets.iter().enumerate() {
                let named: [u32; 4] = joints.integers(vertex as usize)?;
                let shares: [f64; 4] = weights.numbers(vertex as usize)?;
                if number == 0 {
                    first = named[0];
                }
                for (joint, share) in named.into_iter().zip(shares).filter(|(_, share)| *share > 0.0) {
                    if joint as usize >= joint_count {
                        return Err(joints.wrong(&format!(
                            "names joint {joint} at vertex {vertex}, but the skin has only {joint_count} joints"
                        )));
                    }
                    influences.entries.push((joint, share as f32));
                }
            }
            normalise(&mut influences.entries, start, first.min(joint_count.saturating_sub(1) as u32));
            influences.starts.push(influences.entries.len() as u32);
        }
        Ok(Some(influences))
    }
}

fn triangles(mode: Mode, corners: &[u32]) -> Vec<[u32; 3]> {
    match mode {
        // Every other triangle of a strip turns the other way round.
        Mode::TriangleStrip => corners
            .windows(3)
            .enumerate()
            .map(|(k, w)| if k % 2 == 0 { [w[0], w[1], w[2]] } else { [w[1], w[0], w[2]] })
            .filter(is_whole)
            .collect(),
        Mode::TriangleFan => {
            corners.first().map(|&hub| corners[1..].windows(2).map(|w| [hub, w[0], w[1]]).collect()).unwrap_or_default()
        }
        _ => corners.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect(),
    }
}

/// The vertices that faces use, ascending, and the faces in numbers of that list.
fn compact(mut faces: Vec<[u32; 3]>, vertices: usize) -> (Vec<u32>, Vec<[u32; 3]>) {
    // An array over all vertices where most are used, a sorted list where few are.
    let mut used: Vec<u32> = if faces.len() * 8 > vertices {
        let mut named = vec![false; vertices];
        faces.iter().flatten().for_each(|&v| named[v as usize] = true);
        (0..vertices as u32).filter(|&v| named[v as usize]).collect()
    } else {
        let mut used: Vec<u32> = faces.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        used
    };
    used.shrink_to_fit();
    if used.len() < vertices {
        for v in faces.iter_mut().flatten() {
            // Every vertex that a face names is in the list.
            *v = used.binary_search(v).unwrap_or(0) as u32;
        }
    }
    (used, faces)
}

/// Makes the weights from `start` on add up to 1; a vertex without weights follows `first` alone.
fn normalise(entries: &mut Vec<(u32, f32)>, start: usize, first: u32) {
    let sum: f64 = entries[start..].iter().map(|(_, w)| f64::from(*w)).sum();
    if sum > 0.0 && sum.is_finite() {
        entries[start..].iter_mut().for_each(|(_, w)| *w = (f64::from(*w) / sum) as f32);
    } else {
        entries.truncate(start);
        entries.push((first, 1.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn strips_and_fans() {
        assert_eq!(triangles(Mode::TriangleStrip, &[0, 1, 2, 3]), [[0, 1, 2], [2, 1, 3]]);
        assert_eq!(triangles(Mode::TriangleStrip, &[0, 1, 2, 2, 4]), [[0, 1, 2]]);
        assert_eq!(triangles(Mode::TriangleFan, &[5, 1, 2, 3]), [[5, 1, 2], [5, 2, 3]]);
        assert!(triangles(Mode::TriangleFan, &[]).is_empty());
        assert!(triangles(Mode::TriangleStrip, &[1]).is_empty());
        assert_eq!(triangles(Mode::Triangles, &[0, 1, 2, 3]), [[0, 1, 2]]);
    }

    #[test]
    fn keeps_only_used_vertices() {
        assert_eq!(compact(vec![[7, 3, 5]], 1000), (vec![3, 5, 7], vec![[2, 0, 1]]));
        assert_eq!(compact(vec![[3, 1, 2]], 5), (vec![1, 2, 3], vec![[2, 0, 1]]));
    }

    #[test]
    fn weights_add_up_to_one() {
        let mut entries = vec![(9, 9.0), (0, 1.0), (1, 3.0)];
        normalise(&mut entries, 1, 0);
        assert_eq!(entries, [(9, 9.0), (0, 0.25), (1, 0.75)]);
        normalise(&mut entries, 3, 4);
        assert_eq!(entries[3], (4, 1.0));
    }
}
