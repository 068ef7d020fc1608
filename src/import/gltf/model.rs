//! A glTF file that can be posed: what the scene shows, as one list of vertices and faces.

use super::buffers::Buffers;
use super::clip::Motion;
use super::container;
use super::document::Document;
use super::instancing;
use super::nodes::{Local, Nodes};
use super::shape::{self, Shape};
use super::skin::{self, Skin};
use crate::import::limits::Budget;
use crate::import::{Clip, File, ImportError};
use crate::look::{Layer, Look};
use crate::warning::Warning;
use glam::{DAffine3, DVec3, Vec3};
use std::collections::BTreeMap;
use std::collections::btree_map::Entry;

/// A glTF file that can be posed at any time of any clip.
#[derive(Clone, Debug)]
pub struct Model {
    name: String,
    nodes: Nodes,
    /// Each node's morph weights where no clip moves them.
    weights: Vec<Vec<f64>>,
    skins: Vec<Skin>,
    shapes: Vec<Shape>,
    instances: Vec<Instance>,
    motions: Vec<Motion>,
    faces: Vec<[u32; 3]>,
    vertices: usize,
    /// What the mesh looks like, and its normals, if that was asked for and it looks like something.
    look: Option<(Look, Vec<Vec3>)>,
    pub(super) budget: Budget,
}

/// One primitive shown at one node.
#[derive(Clone, Copy, Debug)]
struct Instance {
    node: usize,
    shape: usize,
    material: Option<u32>,
    skin: Option<usize>,
    /// Where it is in the node's frame.
    place: DAffine3,
}

impl Model {
    /// Reads the glTF or GLB `file`; its buffers are looked for among `files`. With `look`, also what the mesh looks like.
    pub fn read(file: &File, files: &[File], look: bool, warnings: &mut Vec<Warning>) -> Result<Self, ImportError> {
        let container = container::split(&file.name, &file.bytes)?;
        let mut budget = Budget::new(&file.name);
        budget.take(entries(container.json), ENTRY, "the document")?;
        let document = Document::read(&file.name, container.json, warnings)?;
        let buffers = Buffers::find(&file.name, &document, container.binary, files, &mut budget)?;
        let nodes = Nodes::read(&document, warnings)?;
        let mut reader = Reader { document: &document, buffers: &buffers, look, budget, warnings };
        let skins = (0..document.skins.len()).map(|s| Skin::read(&document, &buffers, s)).collect::<Result<_, _>>();
        let skins: Vec<Skin> = if shows_skin(&document, &nodes) { skins? } else { Vec::new() };
        let targets = (0..document.nodes.len()).map(|n| reader.target_count(n)).collect::<Result<Vec<_>, _>>()?;
        let weights =
            targets.iter().enumerate().map(|(n, &count)| reader.default_weights(n, count)).collect::<Result<_, _>>()?;
        let (shapes, instances) = reader.shapes(&nodes, &skins)?;
        let motions = (0..document.animations.len())
            .map(|a| Motion::read(&document, &buffers, a, &targets, &mut reader.budget, reader.warnings))
            .collect::<Result<_, _>>()?;
        let budget = reader.budget;
        let mut model = Self {
            name: file.name.clone(),
            nodes,
            weights,
            skins,
            shapes,
            instances,
            motions,
            faces: Vec::new(),
            vertices: 0,
            look: None,
            budget,
        };
        model.join()?;
        if look && !document.materials.is_empty() {
            let (mut look, normals) = model.joined_look()?;
            document.materials.put(&mut look, &document, &buffers, &mut model.budget, warnings);
            model.look = Some((look, normals));
        }
        Ok(model)
    }

    /// The file's name.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// #F triples of vertex numbers, instance after instance in the order in which one walks the node tree.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// What the mesh looks like and its normals (#V), as far as it has any; taken out.
    pub(super) fn take_look(&mut self) -> Option<(Look, Vec<Vec3>)> {
        self.look.take()
    }

    /// Number of vertices, all instances together.
    pub fn vertices(&self) -> usize {
        self.vertices
    }

    /// The clips.
    pub fn clips(&self) -> Vec<Clip> {
        self.motions.iter().map(|m| Clip { name: m.name.clone(), seconds: m.end - m.start }).collect()
    }

    /// The clips with their keys.
    pub(super) fn motions(&self) -> &[Motion] {
        &self.motions
    }

    /// World positions of all vertices (#V) with every node where the file puts it.
    pub fn rest(&self) -> Vec<DVec3> {
        self.place(&self.nodes.locals, &self.weights)
    }

    /// World positions of all vertices (#V) at `time` (in the file's own seconds) of clip `clip`; the resting ones
    /// for a clip that does not exist.
    pub fn pose(&self, clip: usize, time: f64) -> Vec<DVec3> {
        let (mut locals, mut weights) = (self.nodes.locals.clone(), self.weights.clone());
        if let Some(motion) = self.motions.get(clip) {
            motion.apply(time, &mut locals, &mut weights);
        }
        self.place(&locals, &weights)
    }

    /// World positions of all vertices (#V) in the pose in which the skins were bound.
    pub fn bind(&self) -> Vec<DVec3> {
        let worlds = self.nodes.worlds(&self.nodes.locals);
        let bind = skin::bind_pose(&self.skins, &self.nodes, &worlds);
        let mut out = Vec::with_capacity(self.vertices);
        for instance in &self.instances {
            let shape = &self.shapes[instance.shape];
            let map = match (instance.skin, &shape.influences) {
                (Some(skin), Some(_)) => bind.skins[skin],
                _ => bind.worlds[instance.node] * instance.place,
            };
            out.extend(shape.morphed(&self.weights[instance.node]).iter().map(|p| map.transform_point3(*p)));
        }
        out
    }

    /// The nodes whose motion can move a vertex: those shown with a mesh or followed as joints, and all above them.
    pub(super) fn movers(&self) -> Vec<bool> {
        let mut movers = vec![false; self.nodes.parents.len()];
        for instance in &self.instances {
            let followed = instance.skin.filter(|_| self.shapes[instance.shape].influences.is_some());
            movers[instance.node] = true;
            followed.iter().flat_map(|&s| &self.skins[s].joints).for_each(|&joint| movers[joint] = true);
        }
        for &node in self.nodes.order.iter().rev() {
            if let Some(parent) = self.nodes.parents[node] {
                movers[parent] |= movers[node];
            }
        }
        movers
    }

    fn place(&self, locals: &[Local], weights: &[Vec<f64>]) -> Vec<DVec3> {
        let worlds = self.nodes.worlds(locals);
        let skins: Vec<Vec<DAffine3>> = self.skins.iter().map(|skin| skin.matrices(&worlds)).collect();
        let mut out = Vec::with_capacity(self.vertices);
        for instance in &self.instances {
            let shape = &self.shapes[instance.shape];
            let positions = shape.morphed(&weights[instance.node]);
            match (instance.skin, &shape.influences) {
                (Some(skin), Some(influences)) => out.extend(influences.blend(&positions, &skins[skin])),
                _ => {
                    let world = worlds[instance.node] * instance.place;
                    out.extend(positions.iter().map(|p| world.transform_point3(*p)));
                }
            }
        }
        out
    }

    /// Numbers the vertices of all instances in one list.
    fn join(&mut self) -> Result<(), ImportError> {
        let worlds = self.nodes.worlds(&self.nodes.locals);
        let mirroring: Vec<bool> = self.skins.iter().map(|skin| is_mirroring(&skin.matrices(&worlds))).collect();
        for instance in &self.instances {
            let shape = &self.shapes[instance.shape];
            // The budget keeps the number of vertices far below 2³².
            let first = self.vertices as u32;
            self.budget.take(shape.positions.len() as u64, 24, "the mesh")?;
            self.budget.take(shape.faces.len() as u64, 12, "the mesh")?;
            // glTF 2.0, 3.7.4: a mirror image is wound the other way round.
            let mirrored = match (instance.skin, &shape.influences) {
                (Some(skin), Some(_)) => mirroring[skin],
                _ => (worlds[instance.node] * instance.place).matrix3.determinant() < 0.0,
            };
            let wound = |&[a, b, c]: &[u32; 3]| if mirrored { [a, c, b] } else { [a, b, c] };
            self.faces.extend(shape.faces.iter().map(|face| wound(face).map(|v| v + first)));
            self.vertices += shape.positions.len();
        }
        Ok(())
    }

    /// The look of all instances, without materials, and the normals (#V, or none).
    fn joined_look(&mut self) -> Result<(Look, Vec<Vec3>), ImportError> {
        // The faces with their materials; two numbers, and a normal, a vertex.
        self.budget.take(self.faces.len() as u64, 20, "the look")?;
        self.budget.take(self.vertices as u64, 20, "the look")?;
        let mut look = Look { faces: self.faces.clone(), ..Look::default() };
        let shapes = || self.instances.iter().map(|instance| &self.shapes[instance.shape]);
        for layer in shapes().flat_map(|shape| &shape.layers) {
            if look.layers.iter().all(|known| known.name != layer.name) {
                self.budget.take(self.vertices as u64, 4 * layer.width as u64, "the look")?;
                look.layers.push(Layer { values: Vec::with_capacity(layer.width * self.vertices), ..layer.clone() });
            }
        }
        for joined in &mut look.layers {
            joined.values.clear();
            for shape in shapes() {
                match shape.layers.iter().find(|layer| layer.name == joined.name) {
                    Some(layer) => joined.values.extend(&layer.values),
                    // White, where others have colours.
                    None => joined.values.resize(joined.values.len() + joined.width * shape.positions.len(), 1.0),
                }
            }
        }
        for instance in &self.instances {
            let faces = self.shapes[instance.shape].faces.len();
            look.materials.extend(std::iter::repeat_n(instance.material, faces));
        }
        let all = shapes().all(|shape| !shape.normals.is_empty());
        let normals = if all { shapes().flat_map(|shape| shape.normals.iter().copied()).collect() } else { Vec::new() };
        Ok((look, normals))
    }
}

impl Shape {
    /// The positions with morph targets applied.
    fn morphed(&self, weights: &[f64]) -> Vec<DVec3> {
        let mut positions = self.positions.clone();
        for (target, &weight) in self.targets.iter().zip(weights).filter(|(_, weight)| **weight != 0.0) {
            for (vertex, offset) in &target.offsets {
                positions[*vertex as usize] += weight * offset.as_dvec3();
            }
        }
        positions
    }
}

impl shape::Influences {
    /// Linear blend skinning.
    fn blend<'s>(&'s self, positions: &'s [DVec3], matrices: &'s [DAffine3]) -> impl Iterator<Item = DVec3> + 's {
        positions.iter().zip(self.starts.windows(2)).map(|(p, range)| {
            let entries = &self.entries[range[0] as usize..range[1] as usize];
            entries.iter().map(|&(j, w)| f64::from(w) * matrices[j as usize].transform_point3(*p)).sum()
        })
    }
}

/// Whether most of a skin's joints show a mirror image.
fn is_mirroring(joints: &[DAffine3]) -> bool {
    2 * joints.iter().filter(|joint| joint.matrix3.determinant() < 0.0).count() > joints.len()
}

/// What reading a file's parts needs at hand.
struct Reader<'a, 'w> {
    document: &'a Document,
    buffers: &'a Buffers<'a>,
    look: bool,
    budget: Budget,
    warnings: &'w mut Vec<Warning>,
}

impl Reader<'_, '_> {
    /// The number of morph targets of a node's mesh, 0 without one.
    fn target_count(&self, node: usize) -> Result<usize, ImportError> {
        let Some(mesh) = self.document.nodes[node].mesh else { return Ok(0) };
        let Some(entry) = self.document.meshes.get(mesh.value()) else {
            return Err(ImportError(format!(
                "{} of {} shows mesh {}, which does not exist; the file is damaged, export it again",
                self.document.node_name(node),
                self.document.name,
                mesh.value()
            )));
        };
        Ok(entry.primitives.iter().map(|p| p.targets.as_ref().map_or(0, Vec::len)).max().unwrap_or(0))
    }

    /// Morph weights of a node where no clip moves them: its own, else its mesh's, else 0.
    fn default_weights(&self, node: usize, count: usize) -> Result<Vec<f64>, ImportError> {
        let entry = &self.document.nodes[node];
        let mesh = entry.mesh.and_then(|mesh| self.document.meshes.get(mesh.value()));
        let given = entry.weights.as_ref().or(mesh.and_then(|m| m.weights.as_ref()));
        let mut weights: Vec<f64> = given.iter().flat_map(|w| w.iter()).take(count).map(|&w| f64::from(w)).collect();
        if weights.iter().any(|w| !w.is_finite()) {
            return Err(ImportError(format!(
                "{} of {} has a morph weight that is not a finite number; export the file again",
                self.document.node_name(node),
                self.document.name
            )));
        }
        weights.resize(count, 0.0);
        Ok(weights)
    }

    /// Reads every primitive that the scene shows, once for each way in which it is shown.
    fn shapes(&mut self, nodes: &Nodes, skins: &[Skin]) -> Result<(Vec<Shape>, Vec<Instance>), ImportError> {
        let mut shapes = Vec::new();
        let mut instances = Vec::new();
        // Primitives read already, by mesh, number and joints of the skin (which bound the joints' numbers).
        let mut known: BTreeMap<(usize, usize, Option<usize>), Option<usize>> = BTreeMap::new();
        for &node in &nodes.shown {
            let entry = &self.document.nodes[node];
            let Some(mesh) = entry.mesh.map(|m| m.value()) else { continue };
            let skin = entry.skin.map(|s| s.value());
            let joints = match skin {
                Some(skin) if skin >= skins.len() => {
                    return Err(ImportError(format!(
                        "{} of {} follows skin {skin}, which does not exist; the file is damaged, export it again",
                        self.document.node_name(node),
                        self.document.name
                    )));
                }
                Some(skin) => Some(skins[skin].joints.len()),
                None => None,
            };
            // A skinned mesh is where its joints are; copies of it would all be in one place.
            let places = match skin {
                Some(_) => vec![DAffine3::IDENTITY],
                None => instancing::places(self.document, self.buffers, node, &mut self.budget)?,
            };
            let primitives = self.document.meshes.get(mesh).map_or(0, |m| m.primitives.len());
            for number in 0..primitives {
                let shape = match known.entry((mesh, number, joints)) {
                    Entry::Occupied(entry) => *entry.get(),
                    Entry::Vacant(entry) => {
                        let primitive = (mesh, number);
                        let (document, buffers) = (self.document, self.buffers);
                        let wanted = (joints, self.look);
                        let read = shape::read(document, buffers, primitive, wanted, &mut self.budget, self.warnings)?;
                        let first_free = shapes.len();
                        shapes.extend(read);
                        *entry.insert((shapes.len() > first_free).then_some(first_free))
                    }
                };
                if let Some(shape) = shape {
                    let material = self.document.materials.of(mesh, number);
                    instances.extend(places.iter().map(|&place| Instance { node, shape, material, skin, place }));
                }
            }
        }
        Ok((shapes, instances))
    }
}

/// The most bytes that a document takes for each of its [`entries`], once it is read: `{}` for a node is the worst.
const ENTRY: u64 = 256;

/// How many values a document has, at the most, counted without reading it.
fn entries(json: &[u8]) -> u64 {
    json.iter().filter(|byte| matches!(byte, b'{' | b'[' | b',' | b':')).count() as u64
}

/// True if a node that the scene shows has a skin: a broken skin that nothing uses does no harm.
fn shows_skin(document: &Document, nodes: &Nodes) -> bool {
    nodes.shown.iter().any(|&n| document.nodes[n].skin.is_some() && document.nodes[n].mesh.is_some())
}
