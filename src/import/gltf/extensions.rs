//! Extensions of glTF that concern the shape, and which others a file asks for.
//!
//! The `gltf` crate drops extensions that it does not know, so they are taken out of the JSON before.

use super::meshopt;
use crate::import::ImportError;
use crate::warning::Warning;
use serde::Deserialize;
use serde::de::DeserializeOwned;
use serde_json::{Map, Value};
use std::collections::BTreeMap;

/// `KHR_draco_mesh_compression` of a primitive.
#[derive(Clone, Debug, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Draco {
    /// The buffer view with the compressed mesh.
    pub buffer_view: usize,
    /// What Draco calls the attributes, by their glTF names.
    pub attributes: BTreeMap<String, u32>,
}

/// `EXT_mesh_gpu_instancing` of a node: accessors by the names TRANSLATION, ROTATION and SCALE.
#[derive(Clone, Debug, Deserialize)]
pub struct Instancing {
    /// The accessors.
    pub attributes: BTreeMap<String, usize>,
}

/// The extensions of a document that concern the shape.
#[derive(Clone, Debug, Default)]
pub struct Extensions {
    /// Compressed buffer views, by their numbers.
    pub meshopt: BTreeMap<usize, meshopt::Compressed>,
    /// Compressed primitives, by the numbers of mesh and primitive.
    pub draco: BTreeMap<(usize, usize), Draco>,
    /// Nodes that repeat their mesh, by their numbers.
    pub instancing: BTreeMap<usize, Instancing>,
}

const DRACO: &str = "KHR_draco_mesh_compression";
const INSTANCING: &str = "EXT_mesh_gpu_instancing";

/// What is read here, besides those of [`meshopt::NAMES`].
const READ: &[&str] = &[DRACO, INSTANCING, "KHR_mesh_quantization", "KHR_animation_pointer"];

/// Beginnings of the names of extensions that leave the shape alone.
const LOOK: &[&str] = &[
    "KHR_materials_",
    "KHR_texture_",
    "KHR_lights_",
    "KHR_xmp",
    "EXT_texture_",
    "EXT_lights_",
    "EXT_mesh_features",
    "EXT_structural_metadata",
    "EXT_instance_features",
    "MSFT_texture_",
    "MSFT_packing_",
    "ADOBE_materials_",
    "VRM",
];

impl Extensions {
    /// Finds the extensions in the entries of a document; `name` is the file's.
    pub fn find(views: &[Value], meshes: &[Value], nodes: &[Value], name: &str) -> Result<Self, ImportError> {
        let mut found = Self::default();
        for (number, view) in views.iter().enumerate() {
            for extension in meshopt::NAMES {
                let whose = || format!("buffer view {number}");
                found.meshopt.extend(read(view, extension, name, whose)?.map(|c| (number, c)));
            }
        }
        for (number, mesh) in meshes.iter().enumerate() {
            let primitives = mesh.get("primitives").and_then(Value::as_array).into_iter().flatten();
            for (part, primitive) in primitives.enumerate() {
                let whose = || format!("primitive {part} of mesh {number}");
                found.draco.extend(read(primitive, DRACO, name, whose)?.map(|d| ((number, part), d)));
            }
        }
        for (number, node) in nodes.iter().enumerate() {
            let whose = || format!("node {number}");
            found.instancing.extend(read(node, INSTANCING, name, whose)?.map(|i| (number, i)));
        }
        Ok(found)
    }
}

fn read<T: DeserializeOwned>(
    entry: &Value,
    extension: &str,
    name: &str,
    whose: impl Fn() -> String,
) -> Result<Option<T>, ImportError> {
    let Some(value) = entry.get("extensions").and_then(|e| e.get(extension)) else { return Ok(None) };
    T::deserialize(value)
        .map(Some)
        .map_err(|error| ImportError(format!("{extension} of {} of {name} cannot be read ({error})", whose())))
}

/// Says once which required extensions are left out, and whether that is known to leave the shape alone.
pub fn note_required(root: &Map<String, Value>, warnings: &mut Vec<Warning>) {
    let required = root.get("extensionsRequired").and_then(Value::as_array).into_iter().flatten();
    let mut left_out: Vec<&str> = required.filter_map(Value::as_str).collect();
    left_out.retain(|name| !READ.contains(name) && !meshopt::NAMES.contains(name));
    left_out.sort_unstable();
    left_out.dedup();
    let (look, unknown): (Vec<&str>, Vec<&str>) =
        left_out.into_iter().partition(|name| LOOK.iter().any(|known| name.starts_with(known)));
    if !look.is_empty() {
        let what = format!("{} left out: only the look depends on it, not the shape.", list(&look));
        warnings.push(Warning::new("look-left-out", what));
    }
    if !unknown.is_empty() {
        let what = format!("The file requires {}, not known here; what that adds was left out.", list(&unknown));
        warnings.push(Warning::new("unknown-extension", what));
    }
}

/// The first few of some names, each cut to a length that a sentence bears.
fn list(names: &[&str]) -> String {
    const FEW: usize = 5;
    let short: Vec<String> = names.iter().take(FEW).map(|name| name.chars().take(60).collect()).collect();
    let more = names.len().saturating_sub(FEW);
    if more > 0 { format!("{} and {more} more", short.join(", ")) } else { short.join(", ") }
}

/// Makes channels of `KHR_animation_pointer` that point at a place or the weights of a node into channels of that
/// node, and removes the other channels without a node, which the `gltf` crate cannot represent. Returns how many
/// were removed.
pub fn resolve_pointers(animation: &mut Value) -> usize {
    let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) else { return 0 };
    let before = channels.len();
    for target in channels.iter_mut().filter_map(|channel| channel.get_mut("target")).filter_map(Value::as_object_mut) {
        let pointer = target.get("extensions").and_then(|e| e.get("KHR_animation_pointer")?.get("pointer")?.as_str());
        if let Some((node, path)) = pointer.and_then(node_property) {
            target.insert("node".into(), node.into());
            target.insert("path".into(), path.into());
        }
    }
    channels.retain(|channel| channel.get("target").is_none_or(|target| target.get("node").is_some()));
    before - channels.len()
}

/// `/nodes/3/rotation` as 3 and `rotation`.
fn node_property(pointer: &str) -> Option<(u32, &'static str)> {
    let (node, path) = pointer.strip_prefix("/nodes/")?.split_once('/')?;
    let path = ["translation", "rotation", "scale", "weights"].into_iter().find(|known| *known == path)?;
    Some((node.parse().ok()?, path))
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn required_extensions_are_noted_once() {
        let mut warnings = Vec::new();
        let root = json!({"extensionsRequired": [
            "KHR_materials_unlit", "KHR_texture_basisu", "KHR_draco_mesh_compression", "EXT_meshopt_compression",
            "ACME_wobble", "ACME_wobble", 7,
        ]});
        note_required(root.as_object().unwrap(), &mut warnings);
        let said: Vec<_> = warnings.iter().map(|w| (w.code, w.message.contains("meshopt"))).collect();
        assert_eq!(said, [("look-left-out", false), ("unknown-extension", false)]);
        assert!(warnings[0].message.starts_with("KHR_materials_unlit, KHR_texture_basisu left out"));
        assert!(warnings[1].message.contains("requires ACME_wobble, not"));
    }

    #[test]
    fn pointers_to_nodes_become_channels() {
        let pointer = |pointer: &str| {
            json!({"target": {"path": "pointer", "extensions": {
            "KHR_animation_pointer": {"pointer": pointer}}}})
        };
        let mut animation = json!({"channels": [
            pointer("/nodes/3/rotation"), pointer("/materials/0/emissiveFactor"), pointer("/nodes/x/scale"), {},
        ]});
        assert_eq!(resolve_pointers(&mut animation), 2);
        let target = &animation["channels"][0]["target"];
        assert_eq!((&target["node"], &target["path"]), (&json!(3), &json!("rotation")));
        assert_eq!(resolve_pointers(&mut json!({"channels": 3})), 0);
    }

    #[test]
    fn broken_extensions_are_refused_in_words() {
        let view = json!({"extensions": {"EXT_meshopt_compression": {"buffer": -1}}});
        let why = Extensions::find(&[view], &[], &[], "a.glb").unwrap_err().0;
        assert!(why.contains("EXT_meshopt_compression of buffer view 0 of a.glb"), "{why}");
    }
}
