//! From a field to a well-shaped closed mesh with the wanted number of triangles.
//!
//! The surface is extracted ([`extract`]) with more triangles than wanted. The shortest edges are collapsed until
//! the number is right, then edges are flipped and vertices relaxed along the surface (after Botsch and Kobbelt,
//! *A remeshing approach to multiresolution modeling*, SGP 2004, §4). Thin limbs get smaller triangles than the
//! trunk, unless there are so many triangles that all are small.

use super::extract::{Atlas, extract};
use super::field::Field;
use super::surface::{Surface, next};
use glam::DVec3;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Triangles of the extracted mesh per wanted triangle.
const SURPLUS: f64 = 1.5;
/// Rounds of flips and relaxation.
const ROUNDS: usize = 5;

/// Meshes the zero surface of a field with about `faces` triangles; `None` if there is no surface.
///
/// `thinnest` is the thickness below which parts of the body may be lost.
pub fn mesh(field: &Field, faces: usize, thinnest: f64) -> Option<(Vec<DVec3>, Vec<[u32; 3]>)> {
    let sizing = Sizing::for_faces(faces);
    let (cell, atlas, mut surface) = fine_enough(field, faces, thinnest)?;
    surface.keep_largest();
    let sizes: Vec<f64> = surface.positions.iter().map(|&p| sizing.size(atlas.value(field, p).radius)).collect();
    // Where nothing more can be collapsed well, relaxed faces and laxer rules help; few faces need it.
    for (straight, height) in [(0.7, 0.15), (0.7, 0.15), (0.6, 0.12), (0.5, 0.1), (0.4, 0.1), (0.3, 0.1), (0.2, 0.1)] {
        thin_out(&mut surface, &sizes, faces, |s, h| s.can_collapse(h, straight, height));
        if surface.face_count() <= faces {
            break;
        }
        flip(&mut surface);
        relax(&mut surface, &sizes, field, &atlas, cell, false);
    }
    for round in 0..ROUNDS {
        flip(&mut surface);
        relax(&mut surface, &sizes, field, &atlas, cell, round + 1 == ROUNDS);
    }
    flip(&mut surface);
    Some(surface.into_mesh())
}

/// How long edges should be, by the thickness of the limb.
struct Sizing {
    exponent: f64,
}

impl Sizing {
    fn for_faces(faces: usize) -> Self {
        Self { exponent: 0.5 * (1.0 - (faces as f64 / 20_000.0).log10()).clamp(0.0, 1.0) }
    }

    /// Relative length of edges where the limb has the given radius.
    fn size(&self, radius: f64) -> f64 {
        radius.clamp(0.02, 0.3).powf(self.exponent)
    }
}

/// Extracts with enough triangles and with cells that miss nothing.
fn fine_enough(field: &Field, faces: usize, thinnest: f64) -> Option<(f64, Atlas, Surface)> {
    let mut cell = thinnest;
    let wanted = SURPLUS * faces as f64;
    // The number of triangles goes with the inverse square of the cell size.
    for attempt in 0..4 {
        let extracted = extract(field, cell);
        let found = extracted.faces.len() as f64;
        if found == 0.0 {
            return None;
        }
        if found >= 0.9 * wanted || attempt == 3 {
            let surface = Surface::new(extracted.positions, &extracted.faces)?;
            return Some((cell, extracted.atlas, surface));
        }
        cell *= (found / (1.02 * wanted)).sqrt().min(0.99);
    }
    None
}

/// Collapses the edges that are shortest for their place until only `faces` are left.
fn thin_out(surface: &mut Surface, sizes: &[f64], faces: usize, allowed: impl Fn(&Surface, u32) -> bool) {
    // The bits of numbers that are not negative are in the order of the numbers, and faster to compare.
    let length = |s: &Surface, h: u32| {
        let (a, b) = (s.from(h), s.to(h));
        (s.at(a).distance(s.at(b)) / (sizes[a as usize] + sizes[b as usize])).to_bits()
    };
    let entries: Vec<_> = surface
        .half_edges()
        .filter(|&h| surface.from(h) < surface.to(h))
        .map(|h| Reverse((length(surface, h), h)))
        .collect();
    let mut queue = BinaryHeap::from(entries);
    while surface.face_count() > faces {
        let Some(Reverse((old, h))) = queue.pop() else { return };
        // Entries are not updated when their surroundings change; a wrong length gives them away.
        if !surface.exists(h) || length(surface, h) != old {
            continue;
        }
        let o = surface.opposite(h);
        // Keep the end with more neighbours: the other one leaves a smaller hole.
        let (first, second) = if surface.valence(h) >= surface.valence(o) { (h, o) } else { (o, h) };
        let Some(chosen) = [first, second].into_iter().find(|&e| allowed(surface, e)) else { continue };
        let keep = surface.from(chosen);
        surface.collapse(chosen);
        let Some(h) = surface.leaving(keep) else { continue };
        for edge in surface.around(h) {
            queue.push(Reverse((length(surface, edge), edge)));
        }
    }
}

/// Flips edges until smallest angles stop growing (or enough is enough).
fn flip(surface: &mut Surface) {
    let edges: Vec<u32> = surface.half_edges().collect();
    for _ in 0..4 {
        let mut flipped = 0;
        for &h in &edges {
            if surface.from(h) < surface.to(h) && surface.flip_if_better(h) {
                flipped += 1;
            }
        }
        if flipped * 200 < edges.len() {
            return;
        }
    }
}

/// Moves every vertex towards the weighted mean of its faces, along the surface, and back onto the field.
fn relax(surface: &mut Surface, sizes: &[f64], field: &Field, atlas: &Atlas, cell: f64, last: bool) {
    let moved: Vec<DVec3> = (0..surface.positions.len() as u32)
        .map(|v| match surface.leaving(v) {
            Some(h) => {
                let target = mean_of_faces(surface, sizes, h);
                settle(field, atlas, surface.at(v), target, cell, if last { 3 } else { 1 })
            }
            None => surface.at(v),
        })
        .collect();
    surface.positions = moved;
}

/// Mean of the centres of the faces around the start of `h`, weighted by area over wanted area; pulled into the
/// tangent plane.
fn mean_of_faces(surface: &Surface, sizes: &[f64], h: u32) -> DVec3 {
    let p = surface.at(surface.from(h));
    let (mut sum, mut weight, mut normal) = (DVec3::ZERO, 0.0, DVec3::ZERO);
    for edge in surface.around(h) {
        let (b, c) = (surface.to(edge), surface.from(super::surface::previous(edge)));
        let face = surface.normal(edge);
        let size = sizes[b as usize] + sizes[c as usize] + sizes[surface.from(edge) as usize];
        let w = face.length() / (size * size);
        sum += w * (p + surface.at(b) + surface.at(c)) / 3.0;
        weight += w;
        normal += face;
    }
    debug_assert_eq!(surface.from(next(h)), surface.to(h));
    if weight <= 0.0 {
        return p;
    }
    let step = sum / weight - p;
    let normal = normal.normalize_or_zero();
    p + 0.8 * (step - normal * step.dot(normal))
}

/// Newton steps from `target` onto the field; stays at `start` if that leads astray.
fn settle(field: &Field, atlas: &Atlas, start: DVec3, target: DVec3, cell: f64, steps: usize) -> DVec3 {
    let mut p = target;
    for _ in 0..steps {
        let value = atlas.value(field, p);
        let steepness = value.gradient.length_squared().max(0.25);
        p -= value.gradient * (value.distance / steepness).clamp(-cell, cell);
    }
    if p.is_finite() && p.distance(target) <= 2.0 * cell + target.distance(start) { p } else { start }
}
