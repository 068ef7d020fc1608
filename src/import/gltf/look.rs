//! Materials and textures, kept as they are to be written again.
//!
//! Nothing here keeps anyone from their mesh: what is broken is left out.

use super::buffers::Buffers;
use super::document::Document;
use crate::import::beside::picture_kind;
use crate::import::limits::Budget;
use crate::look::Look;
use crate::warning::Warning;
use serde_json::{Map, Value};
use std::borrow::Cow;

/// What a document says of the look of its meshes.
#[derive(Clone, Debug, Default)]
pub struct Materials {
    /// The materials of each mesh's primitives.
    of: Vec<Vec<Option<u64>>>,
    materials: Vec<Value>,
    textures: Vec<Value>,
    samplers: Vec<Value>,
    images: Vec<Value>,
    required: Vec<String>,
}

impl Materials {
    /// Finds them in a document.
    pub fn find(root: &mut Map<String, Value>, meshes: &[Value]) -> Self {
        let material = |primitive: &Value| primitive.get("material").and_then(Value::as_u64);
        let primitives = |mesh: &Value| {
            let list = mesh.get("primitives").and_then(Value::as_array).map_or(&[][..], Vec::as_slice);
            list.iter().map(material).collect()
        };
        let mut take = |key: &str| match root.remove(key) {
            Some(Value::Array(entries)) => entries,
            _ => Vec::new(),
        };
        let required = take("extensionsRequired").into_iter().filter_map(|name| name.as_str().map(str::to_owned));
        Self {
            of: meshes.iter().map(primitives).collect(),
            required: required.collect(),
            materials: take("materials"),
            textures: take("textures"),
            samplers: take("samplers"),
            images: take("images"),
        }
    }

    /// The material of a primitive, if it exists.
    pub fn of(&self, mesh: usize, primitive: usize) -> Option<u32> {
        let material = (*self.of.get(mesh)?.get(primitive)?)?;
        u32::try_from(material).ok().filter(|&material| (material as usize) < self.materials.len())
    }

    /// Whether there is anything to be seen.
    pub fn is_empty(&self) -> bool {
        self.materials.is_empty()
    }

    /// Writes the lists and the images into a look that has its layers.
    pub fn put(
        &self,
        look: &mut Look,
        document: &Document,
        buffers: &Buffers,
        budget: &mut Budget,
        warnings: &mut Vec<Warning>,
    ) {
        let mut images = Vec::new();
        // For each image of the file its new number.
        let mut numbers: Vec<Option<usize>> = Vec::new();
        for (number, image) in self.images.iter().enumerate() {
            let found = read(image, document, buffers).and_then(|bytes| Some((picture_kind(&bytes)?, bytes)));
            let found = found.filter(|(_, bytes)| budget.take(bytes.len() as u64, 1, "an image").is_ok());
            numbers.push(found.as_ref().map(|_| images.len()));
            let Some((kind, bytes)) = found else { continue };
            let mut entry = Map::from_iter([("mimeType".to_owned(), kind.into())]);
            let name =
                image.get("name").and_then(Value::as_str).map_or_else(|| format!("image {number}"), str::to_owned);
            entry.insert("name".into(), name.into());
            images.push(Value::Object(entry));
            look.images.push(bytes.into_owned());
        }
        let missing = numbers.iter().filter(|number| number.is_none()).count();
        if missing > 0 {
            let what = if missing == 1 { "An image was" } else { "Images were" };
            let message = format!("{what} not found or cannot be read, and the textures with them left out.");
            warnings.push(Warning::new("image-left-out", message));
        }
        let textures: Vec<Value> = self.textures.iter().map(|t| texture(t, &numbers, self.samplers.len())).collect();
        let sets = (0..).take_while(|set| look.layers.iter().any(|l| l.name == format!("TEXCOORD_{set}"))).count();
        let usable = |texture: &Value| {
            let index = texture.get("index").and_then(Value::as_u64).and_then(|i| usize::try_from(i).ok());
            let set = texture.get("texCoord").and_then(Value::as_u64).unwrap_or(0);
            index.and_then(|i| textures.get(i)).is_some_and(shows) && set < sets as u64
        };
        let materials = self.materials.iter().map(|material| {
            let mut material = object(material);
            drop_textures(&mut material, &usable);
            material
        });
        let mut lists = Map::new();
        lists.insert("materials".into(), materials.collect());
        lists.insert("textures".into(), textures.into());
        lists.insert("samplers".into(), self.samplers.iter().map(object).collect());
        lists.insert("images".into(), images.into());
        let mut used = Vec::new();
        lists.values().for_each(|list| extensions(list, &mut used));
        let required: Value = self.required.iter().filter(|name| used.contains(name)).cloned().collect();
        lists.insert("extensionsRequired".into(), required);
        lists.insert("extensionsUsed".into(), used.into_iter().collect());
        lists.retain(|_, list| list.as_array().is_some_and(|list| !list.is_empty()));
        look.document = lists;
    }
}

/// The bytes of an image.
fn read<'a>(image: &Value, document: &Document, buffers: &'a Buffers) -> Option<Cow<'a, [u8]>> {
    match image.get("bufferView").and_then(Value::as_u64) {
        Some(view) => buffers.view(document, usize::try_from(view).ok()?).ok().map(Cow::Borrowed),
        None => buffers.beside(&document.name, image.get("uri")?.as_str()?).ok(),
    }
}

/// An entry of a list without what it says beside the specification; an empty one for what is no object.
fn object(entry: &Value) -> Value {
    let mut entry = entry.as_object().cloned().unwrap_or_default();
    entry.remove("extras");
    if entry.get("name").is_some_and(|name| !name.is_string()) {
        entry.remove("name");
    }
    Value::Object(entry)
}

/// A texture with the new numbers of its images, those that do not exist left out.
fn texture(entry: &Value, images: &[Option<usize>], samplers: usize) -> Value {
    let mut texture = object(entry);
    let renumber = |holder: &mut Map<String, Value>| {
        let Some(source) = holder.get("source") else { return };
        let source = source.as_u64().and_then(|s| *images.get(usize::try_from(s).ok()?)?);
        match source {
            Some(number) => holder.insert("source".into(), number.into()),
            None => holder.remove("source"),
        };
    };
    if let Some(texture) = texture.as_object_mut() {
        renumber(texture);
        if texture.get("sampler").is_some_and(|s| s.as_u64().is_none_or(|s| s >= samplers as u64)) {
            texture.remove("sampler");
        }
        if let Some(extensions) = texture.get_mut("extensions").and_then(Value::as_object_mut) {
            extensions.values_mut().filter_map(Value::as_object_mut).for_each(renumber);
            extensions.retain(|_, extension| extension.get("source").is_some());
            if extensions.is_empty() {
                texture.remove("extensions");
            }
        }
    }
    texture
}

/// Whether a texture has an image.
fn shows(texture: &Value) -> bool {
    texture.get("source").is_some() || texture.get("extensions").is_some()
}

/// Removes the textures that are not usable, in extensions of the material too.
fn drop_textures(value: &mut Value, usable: &impl Fn(&Value) -> bool) {
    let Some(object) = value.as_object_mut() else { return };
    object.retain(|key, value| !key.ends_with("Texture") || usable(value));
    object.values_mut().for_each(|value| drop_textures(value, usable));
}

/// Adds the names of the extensions in a value.
fn extensions(value: &Value, names: &mut Vec<String>) {
    match value {
        Value::Array(entries) => entries.iter().for_each(|entry| extensions(entry, names)),
        Value::Object(object) => {
            for (name, _) in object.get("extensions").and_then(Value::as_object).into_iter().flatten() {
                if !names.contains(name) {
                    names.push(name.clone());
                }
            }
            object.values().for_each(|entry| extensions(entry, names));
        }
        _ => {}
    }
}
