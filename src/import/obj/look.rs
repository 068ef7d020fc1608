//! What an OBJ says of its look: coordinates of pictures, normals, and which faces have which material.
//!
//! Nothing here keeps anyone from their mesh: what is broken is left out.

use super::mtl::{self, Material};
use crate::import::File;
use crate::import::beside::{beside, picture_kind};
use crate::import::limits::Budget;
use crate::import::polygons::PolygonMesh;
use crate::import::text::words;
use crate::look::{Layer, Look, MOST_COMPARED};
use glam::Vec3;
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// In place of a number that is not there.
const NONE: u32 = u32::MAX;
/// Files of materials, beyond which no more are looked for.
const LIBRARIES: usize = 64;
/// Bytes that a line with coordinates and a corner take while a look is made; more than they take in the end.
const VALUES: u64 = 40;
const CORNER: u64 = 160;

/// What was said, line by line.
#[derive(Debug)]
pub struct Said {
    coordinates: Vec<[f32; 2]>,
    normals: Vec<Vec3>,
    /// Numbers of both for all polygons' corners.
    corners: Vec<[u32; 2]>,
    /// #P + 1 starts of the polygons' corners.
    starts: Vec<u32>,
    /// #P numbers in `names`.
    materials: Vec<u32>,
    /// The materials that are used.
    names: Vec<String>,
    numbers: BTreeMap<String, usize>,
    /// The files with the materials, each line as it is.
    libraries: Vec<String>,
    material: u32,
    /// What there is room for; nothing more once it was exceeded.
    budget: Option<Budget>,
}

impl Said {
    /// Nothing yet, of the file called `name`.
    pub fn new(name: &str) -> Self {
        Self {
            coordinates: Vec::new(),
            normals: Vec::new(),
            corners: Vec::new(),
            starts: vec![0],
            materials: Vec::new(),
            names: Vec::new(),
            numbers: BTreeMap::new(),
            libraries: Vec::new(),
            material: NONE,
            budget: Some(Budget::new(name)),
        }
    }

    /// Hears a statement of the file.
    #[inline(never)]
    pub fn hear(&mut self, line: &[u8]) {
        let (key, rest) = mtl::cut(line);
        match key {
            b"vt" if self.room(VALUES) => {
                let [u, v, _] = numbers(rest);
                // A picture begins at its upper end in glTF.
                self.coordinates.push([u, 1.0 - v]);
            }
            b"vn" if self.room(VALUES) => self.normals.push(Vec3::from_array(numbers(rest)).normalize_or(Vec3::Y)),
            b"f" | b"fo" => {
                for word in words(rest) {
                    if !self.room(CORNER) {
                        return;
                    }
                    let mut parts = word.split(|&b| b == b'/').skip(1);
                    let mut index = |count: usize| place(parts.next(), count);
                    self.corners.push([index(self.coordinates.len()), index(self.normals.len())]);
                }
                self.starts.push(self.corners.len() as u32);
                self.materials.push(self.material);
            }
            b"usemtl" if self.room(VALUES + rest.len() as u64) => {
                let (name, next) = (mtl::text(rest), self.names.len());
                self.material = number_of(&mut self.numbers, &name, next) as u32;
                if self.material as usize == next {
                    self.names.push(name);
                }
            }
            b"mtllib" if self.room(VALUES + rest.len() as u64) => self.libraries.push(mtl::text(rest)),
            _ => {}
        }
    }

    fn room(&mut self, bytes: u64) -> bool {
        if self.budget.as_mut().is_some_and(|budget| budget.grow(bytes).is_err()) {
            self.budget = None;
        }
        self.budget.is_some()
    }

    /// The look of the mesh that was read from the same file, called `name`, and cut into `faces`; `polygons` has for each
    /// the polygon it is of. Materials and pictures are looked for among `files`.
    pub fn look(
        mut self,
        name: &str,
        files: &[File],
        mesh: &PolygonMesh,
        (faces, polygons): (&[[u32; 3]], &[u32]),
    ) -> Option<Look> {
        let mut look = Look::default();
        let pictured = self.dress(&mut look, name, files)?;
        if self.budget.is_none() || self.materials.len() != mesh.len() {
            return None;
        }
        // Lists of the vertices of the look in each vertex of the mesh: the last one, and before each the one before.
        let (mut last, mut before) = (vec![NONE; mesh.positions.len()], Vec::new());
        let (mut vertices, mut places, mut directions) = (Vec::new(), Vec::new(), Vec::new());
        let (mut current, mut first) = (NONE, 0);
        for (f, (face, &polygon)) in faces.iter().zip(polygons).enumerate() {
            if polygon != current {
                (current, first) = (polygon, f);
            }
            let (corners, start) = (mesh.polygon(polygon as usize), self.starts[polygon as usize] as usize);
            look.materials.push(Some(self.materials[polygon as usize]));
            let mut numbers = [0; 3];
            for (k, &vertex) in face.iter().enumerate() {
                // Large polygons are cut as fans: there it is one of the first that are looked at.
                let from = if k == 0 { 0 } else { f - first };
                let at = (from..corners.len()).chain(0..from).find(|&at| corners[at] == vertex)?;
                let [t, n] = self.corners[start + at];
                let place = self.coordinates.get(t as usize).filter(|_| pictured).copied().unwrap_or_default();
                // Without normals it is smooth, as it is while it is looked at.
                let direction = self.normals.get(n as usize).copied().unwrap_or(Vec3::Y);
                let mut number = last[vertex as usize];
                let mut compared = 0;
                while number != NONE && (places[number as usize], directions[number as usize]) != (place, direction) {
                    compared += 1;
                    number = if compared < MOST_COMPARED { before[number as usize] } else { NONE };
                }
                if number == NONE {
                    number = vertices.len() as u32;
                    before.push(std::mem::replace(&mut last[vertex as usize], number));
                    vertices.push(vertex);
                    places.push(place);
                    directions.push(direction);
                }
                numbers[k] = number;
            }
            look.faces.push(numbers);
        }
        if pictured {
            look.layers = vec![Layer { name: "TEXCOORD_0".into(), width: 2, values: places.into_flattened() }];
        }
        look.settle(vertices, &directions);
        Some(look)
    }

    /// Finds the materials that are used, and what is on them; returns whether there are pictures, and `None` if there
    /// is nothing to be seen.
    fn dress(&mut self, look: &mut Look, name: &str, files: &[File]) -> Option<bool> {
        let mut read: Vec<&str> = Vec::new();
        let mut known: Vec<(Material, &str)> = Vec::new();
        let mut numbers: BTreeMap<String, usize> = BTreeMap::new();
        for wanted in self.libraries.iter().flat_map(|line| libraries(line)).take(LIBRARIES) {
            let Some(library) = beside(name, wanted, files) else { continue };
            if read.contains(&library.name.as_str()) {
                continue;
            }
            read.push(&library.name);
            for material in mtl::read(&library.bytes) {
                number_of(&mut numbers, &material.name, known.len());
                known.push((material, &library.name));
            }
        }
        if !self.names.iter().any(|name| numbers.contains_key(name)) {
            return None;
        }
        if self.materials.contains(&NONE) {
            let plain = self.names.len() as u32;
            self.materials.iter_mut().filter(|number| **number == NONE).for_each(|number| *number = plain);
            self.names.push("none".into());
        }
        let (mut materials, mut images): (Vec<Value>, Vec<Value>) = (Vec::new(), Vec::new());
        let mut pictures: BTreeMap<String, usize> = BTreeMap::new();
        for name in &self.names {
            let Some((material, library)) = numbers.get(name).map(|&number| &known[number]) else {
                materials.push(Material::plain(name).entry(None));
                continue;
            };
            let picture = material.picture.as_ref().filter(|_| !self.coordinates.is_empty());
            let file = picture.and_then(|picture| beside(library, picture, files));
            let kind = file.and_then(|file| picture_kind(&file.bytes));
            let mut texture = None;
            if let (Some(file), Some(kind @ ("image/png" | "image/jpeg"))) = (file, kind) {
                let number = number_of(&mut pictures, &file.name, images.len());
                if number == images.len() {
                    self.budget.as_mut()?.grow(file.bytes.len() as u64).ok()?;
                    let last = file.name.rsplit(['/', '\\']).next().unwrap_or_default();
                    images.push(json!({ "mimeType": kind, "name": last }));
                    look.images.push(file.bytes.clone());
                }
                texture = Some(number);
            }
            materials.push(material.entry(texture));
        }
        let textures: Value = (0..images.len()).map(|source| json!({ "source": source })).collect();
        let pictured = !images.is_empty();
        look.document.insert("materials".into(), materials.into());
        if pictured {
            look.document.insert("textures".into(), textures);
            look.document.insert("images".into(), images.into());
        }
        Some(pictured)
    }
}

/// The files that a line names: its whole, or one in each word.
fn libraries(line: &str) -> impl Iterator<Item = &str> {
    let words = line.split_ascii_whitespace().filter(move |&word| word != line);
    std::iter::once(line).chain(words)
}

/// Files that an OBJ needs for its look, or that a list of materials (`.mtl`) does, as they are written there.
pub fn needed(file: &File) -> Vec<String> {
    if file.name.to_ascii_lowercase().ends_with(".mtl") {
        return mtl::read(&file.bytes).into_iter().filter_map(|material| material.picture).collect();
    }
    let mut lines = crate::import::text::Lines::new("", &file.bytes);
    let mut found = Vec::new();
    while let Some(line) = lines.next_line() {
        if let Some(line) = line.trim_ascii().strip_prefix(b"mtllib") {
            found.extend(libraries(&mtl::text(line.trim_ascii())).map(str::to_owned));
        }
    }
    found
}

/// The number that a name has, `next` if it has none so far.
#[inline(never)]
fn number_of(numbers: &mut BTreeMap<String, usize>, name: &str, next: usize) -> usize {
    let known = numbers.get(name).copied();
    known.unwrap_or_else(|| {
        numbers.insert(name.to_owned(), next);
        next
    })
}

/// The first numbers of a line, 0 for each that is none.
fn numbers(line: &[u8]) -> [f32; 3] {
    let mut words = words(line);
    [(); 3].map(|()| {
        words.next().and_then(mtl::float).map(|value| value as f32).filter(|value| value.is_finite()).unwrap_or(0.0)
    })
}

/// What a part of a corner counts, from 0: from the first, or from the last of `count` where it is negative.
fn place(word: Option<&[u8]>, count: usize) -> u32 {
    let number = word.and_then(|word| std::str::from_utf8(word).ok()?.parse::<i64>().ok()).unwrap_or(0);
    let index = if number < 0 { number.saturating_add(count as i64) } else { number - 1 };
    u32::try_from(index).unwrap_or(NONE)
}
