//! The JSON document of a glTF file, read entry by entry.
//!
//! Each entry is read by itself, so that an error names the entry, and only what concerns geometry and motion is
//! read, so that an odd material or texture does not keep anyone from their mesh: these are kept as they are. The
//! entries are the types of the `gltf` crate; nothing in them is checked yet: every index may be out of range.

use super::extensions::{self, Extensions};
use super::look::Materials;
use crate::import::ImportError;
use crate::warning::Warning;
use gltf::json::{self, Accessor, Animation, Buffer, Mesh, Node, Scene, Skin, buffer};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};

/// What Sinew needs of a glTF document.
#[derive(Debug)]
pub struct Document {
    /// The file's name, for sentences about it.
    pub name: String,
    /// Accessors.
    pub accessors: Vec<Accessor>,
    /// Animations, without channels that target no node.
    pub animations: Vec<Animation>,
    /// Buffers.
    pub buffers: Vec<Buffer>,
    /// Extensions that concern the shape.
    pub extensions: Extensions,
    /// Materials and textures.
    pub materials: Materials,
    /// Meshes.
    pub meshes: Vec<Mesh>,
    /// Nodes.
    pub nodes: Vec<Node>,
    /// The default scene.
    pub scene: Option<usize>,
    /// Scenes.
    pub scenes: Vec<Scene>,
    /// Skins.
    pub skins: Vec<Skin>,
    /// Buffer views.
    pub views: Vec<buffer::View>,
}

impl Document {
    /// Reads the document of the file called `name`.
    pub fn read(name: &str, text: &[u8], warnings: &mut Vec<Warning>) -> Result<Self, ImportError> {
        let value: Value = serde_json::from_slice(text).map_err(|error| {
            ImportError(format!("{name} is not a readable glTF document ({error}); export it again as glTF 2.0"))
        })?;
        let Value::Object(mut root) = value else {
            return Err(ImportError(format!("{name} is not a glTF document: its JSON is not an object")));
        };
        check_version(name, &root)?;
        extensions::note_required(&root, warnings);
        let scene = match root.get("scene") {
            None | Some(Value::Null) => None,
            Some(number) => Some(number.as_u64().and_then(|n| usize::try_from(n).ok()).ok_or_else(|| {
                ImportError(format!("{name}: the default scene is {}, which is not a number", short(number)))
            })?),
        };
        let mut animations = take(&mut root, "animations", name)?;
        let aimless: usize = animations.iter_mut().map(extensions::resolve_pointers).sum();
        if aimless > 0 {
            warnings.push(Warning::new(
                "channels-left-out",
                format!("{aimless} animation channels target no node and were left out."),
            ));
        }
        let views = take(&mut root, "bufferViews", name)?;
        let nodes = take(&mut root, "nodes", name)?;
        let mut meshes = take(&mut root, "meshes", name)?;
        let extensions = Extensions::find(&views, &meshes, &nodes, name)?;
        let materials = Materials::find(&mut root, &meshes);
        meshes.iter_mut().for_each(drop_materials);
        let mut scenes = take(&mut root, "scenes", name)?;
        scenes.iter_mut().filter_map(Value::as_object_mut).for_each(|scene| {
            scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
        });
        Ok(Self {
            name: name.to_owned(),
            accessors: read_all(take(&mut root, "accessors", name)?, "accessor", name)?,
            animations: read_all(animations, "animation", name)?,
            buffers: read_all(take(&mut root, "buffers", name)?, "buffer", name)?,
            extensions,
            materials,
            meshes: read_all(meshes, "mesh", name)?,
            nodes: read_all(nodes, "node", name)?,
            scene,
            scenes: read_all(scenes, "scene", name)?,
            skins: read_all(take(&mut root, "skins", name)?, "skin", name)?,
            views: read_all(views, "buffer view", name)?,
        })
    }

    /// The name of a node, or its number, for sentences.
    pub fn node_name(&self, node: usize) -> String {
        label("node", node, self.nodes.get(node).and_then(|n| n.name.as_deref()))
    }

    /// The name of a mesh, or its number, for sentences.
    pub fn mesh_name(&self, mesh: usize) -> String {
        label("mesh", mesh, self.meshes.get(mesh).and_then(|m| m.name.as_deref()))
    }
}

fn label(kind: &str, index: usize, name: Option<&str>) -> String {
    match name {
        Some(name) if !name.is_empty() => format!("{kind} \"{name}\""),
        _ => format!("{kind} {index}"),
    }
}

fn check_version(name: &str, root: &Map<String, Value>) -> Result<(), ImportError> {
    match root.get("asset").and_then(|asset| asset.get("version")).and_then(Value::as_str) {
        Some(version) if version == "2" || version.starts_with("2.") => Ok(()),
        Some(version) => Err(ImportError(format!(
            "{name} is glTF of version {version}, but only 2.0 is read; convert it to glTF 2.0"
        ))),
        None => Err(ImportError(format!("{name} is not glTF 2.0: it has no asset.version; export it as glTF 2.0"))),
    }
}

/// Takes an array out of the document; absent is empty.
fn take(root: &mut Map<String, Value>, key: &str, name: &str) -> Result<Vec<Value>, ImportError> {
    match root.remove(key) {
        None | Some(Value::Null) => Ok(Vec::new()),
        Some(Value::Array(entries)) => Ok(entries),
        Some(other) => Err(ImportError(format!(
            "{name}: \"{key}\" is {} instead of a list; the file is damaged, export it again",
            short(&other)
        ))),
    }
}

fn read_all<T: DeserializeOwned>(entries: Vec<Value>, kind: &str, name: &str) -> Result<Vec<T>, ImportError> {
    let read = |(index, mut entry): (usize, Value)| {
        if let Some(object) = entry.as_object_mut() {
            object.remove("extensions");
            object.remove("extras");
            if object.get("name").is_some_and(|name| !name.is_string()) {
                object.remove("name");
            }
        }
        json::deserialize::from_value(entry).map_err(|error| {
            ImportError(format!("{kind} {index} of {name} cannot be read ({error}); export the file again"))
        })
    };
    entries.into_iter().enumerate().map(read).collect()
}

/// Removes what a primitive says of its look.
fn drop_materials(mesh: &mut Value) {
    let primitives = mesh.get_mut("primitives").and_then(Value::as_array_mut).into_iter().flatten();
    for primitive in primitives.filter_map(Value::as_object_mut) {
        for key in ["material", "extensions", "extras"] {
            primitive.remove(key);
        }
    }
}

/// A JSON value, short enough for a sentence.
fn short(value: &Value) -> String {
    match value {
        Value::Array(_) => "a list".into(),
        Value::Object(_) => "an object".into(),
        other => {
            let text = other.to_string();
            if text.chars().count() > 40 { format!("{}…", text.chars().take(40).collect::<String>()) } else { text }
        }
    }
}
