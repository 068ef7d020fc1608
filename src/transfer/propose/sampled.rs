//! A surface thinned out to some thousand points, with the distances between all of them.
//!
//! Samples are geodesic farthest points, so that the first of them are a coarser sampling of the same surface. What lies
//! nearest to a sample is its cell; cells that meet at a face make a coarse triangle (the dual of the geodesic Voronoi
//! diagram: G. Peyré and L. Cohen, *Geodesic remeshing using front propagation*, International Journal of Computer
//! Vision 69(1), 2006, pp. 145–156). That asks nothing of the mesh: seams, holes, edges with many faces, many pieces.

use super::coarse;
use super::distances::Distances;
use crate::mesh::doctor::outward;
use crate::mesh::face::{self, is_whole, nearest_in_triangle};
use crate::mesh::kd_tree::KdTree;
use crate::mesh::paths::{Graph, Paths};
use crate::mesh::pieces::pieces;
use crate::mesh::weld::weld;
use glam::DVec3;
use std::collections::BinaryHeap;

/// Samples of a surface; more cost memory and time by their square.
pub const SAMPLES: usize = 1200;

/// What share of the area of a surface in very many pieces is sampled.
const COVERED: f64 = 0.8;

/// Samples over whose mean distance sizes are compared.
const FIRST: usize = 100;

/// What the mean distance between samples is made: as in shares of the diagonal of many a figure.
const TYPICAL: f64 = 0.4;

/// A sampled surface. Places are relative to the centre of the bounding box. Lengths are such that the mean distance along
/// the surface is [`TYPICAL`]: unlike the box, that does not depend on how limbs are held.
#[derive(Clone, Debug)]
pub struct SampledSurface {
    /// #V places of the mesh's own vertices.
    pub points: Vec<DVec3>,
    /// #V directions of the surface at the vertices (length one or zero).
    pub vertex_normals: Vec<DVec3>,
    /// #V: each vertex as a mean of three samples.
    pub readings: Vec<Reading>,
    /// #V numbers of the sample in whose cell each vertex lies.
    pub cell: Vec<u32>,
    /// #samples vertex numbers, far apart from each other, the farthest first.
    pub samples: Vec<u32>,
    /// #samples places.
    pub places: Vec<DVec3>,
    /// #samples directions of the surface, a mean over the cell.
    pub normals: Vec<DVec3>,
    /// Along the surface, between samples.
    distances: Distances,
    /// #samples mean distances from the first samples: large at tips.
    pub remote: Vec<f32>,
    /// Triangles between samples whose cells meet.
    pub coarse: Vec<[u32; 3]>,
    /// #samples lists of the vertices in each cell.
    pub members: Vec<Vec<u32>>,
    /// Sides of the bounding box.
    pub sides: DVec3,
}

/// A place as a mean of samples with weights that add up to one.
pub type Reading = [(u32, f32); 3];

impl SampledSurface {
    /// `faces` is #F triples of vertex numbers, `positions` #V points. Faces with vertices out of range or named twice
    /// are left out. `None` without a vertex.
    pub fn new(faces: &[[u32; 3]], positions: &[DVec3], samples: usize) -> Option<Self> {
        let (mut points, sides, diagonal) = normalised(faces, positions)?;
        points.iter_mut().filter(|p| !p.is_finite()).for_each(|p| *p = DVec3::ZERO);
        let stands = weld(&[&points], 1e-7);
        let welded: Vec<[u32; 3]> = sound(&outward(faces, &points), &stands);
        let used = used(&welded, &stands, diagonal);
        let eligible = of_large_pieces(&welded, &points, &used, samples.max(2) / 2);
        let fine = Graph::new(points.len(), &coarse::edges(&welded, &points));
        let (samples, mut paths) = farthest(&fine, &points, &eligible, samples.max(1));
        reach_all(&mut paths, &stands, &samples, &points);
        let cell = paths.label;
        let places: Vec<DVec3> = samples.iter().map(|&v| points[v as usize]).collect();
        let coarse = coarse::faces(&welded, &cell);
        let distances = Distances::new(coarse::graph(&coarse, &places));
        let (vertex_normals, normals) = normals(&welded, &points, &stands, &cell, samples.len());
        let readings = readings(&points, &cell, &coarse, &places);
        let coarse = coarse.into_iter().filter(is_whole).collect();
        let mut members = vec![Vec::new(); samples.len()];
        for &v in &used {
            members[cell[v as usize] as usize].push(v);
        }
        let mut surface = Self {
            points,
            vertex_normals,
            readings,
            cell,
            samples,
            places,
            normals,
            distances,
            remote: Vec::new(),
            coarse,
            members,
            sides,
        };
        surface.resize(TYPICAL / f64::from(surface.typical()).max(1e-6));
        surface.remote = surface.remote();
        Some(surface)
    }

    /// The mean distance between the first samples.
    fn typical(&self) -> f32 {
        let among = FIRST.min(self.len());
        let sum: f32 = (0..among as u32).flat_map(|s| &self.row(s)[..among]).sum();
        if among > 1 { sum / (among * (among - 1)) as f32 } else { TYPICAL as f32 }
    }

    /// The mean distances of all samples from the first.
    fn remote(&self) -> Vec<f32> {
        let among = FIRST.min(self.len());
        let mut sums = vec![0.0; self.len()];
        for first in 0..among as u32 {
            sums.iter_mut().zip(self.row(first)).for_each(|(sum, d)| *sum += d);
        }
        sums.iter().map(|sum| sum / among as f32).collect()
    }

    fn resize(&mut self, by: f64) {
        self.points.iter_mut().chain(&mut self.places).for_each(|p| *p *= by);
        self.distances.scale(by as f32);
        self.sides *= by;
    }

    /// How many samples.
    pub fn len(&self) -> usize {
        self.samples.len()
    }

    /// Distances of all samples from one of them.
    pub fn row(&self, sample: u32) -> &[f32] {
        self.distances.row(sample)
    }

    /// The vertices in the cell of a sample and in those beside it.
    pub fn around(&self, sample: u32) -> impl Iterator<Item = u32> + '_ {
        let cells = std::iter::once(sample).chain(self.distances.graph().links(sample).iter().map(|l| l.0));
        cells.flat_map(|cell| self.members[cell as usize].iter().copied())
    }

    /// The vertex nearest to the place `share` of the way from one vertex to another, that faces as one of them does.
    pub fn between(&self, from: u32, to: u32, share: f64) -> u32 {
        let [a, b] = [from, to].map(|v| self.points[v as usize]);
        let place = a.lerp(b, share);
        let normals = [from, to].map(|v| self.vertex_normals[v as usize]);
        let near = [from, to].into_iter().flat_map(|v| self.around(self.cell[v as usize]));
        let alike = |v: &u32| normals.iter().any(|n| n.dot(self.vertex_normals[*v as usize]) > 0.0);
        let far = |v: u32| self.points[v as usize].distance_squared(place);
        near.filter(alike).min_by(|&u, &v| far(u).total_cmp(&far(v)).then(u.cmp(&v))).unwrap_or(to)
    }

    /// Distances of all samples from a place between samples.
    pub fn distances_from(&self, reading: &Reading) -> Vec<f32> {
        let rows = reading.map(|(sample, _)| self.row(sample));
        let [a, b, c] = reading.map(|(_, w)| w);
        (0..self.len()).map(|i| a * rows[0][i] + b * rows[1][i] + c * rows[2][i]).collect()
    }
}

/// Places relative to the middle of the bounding box in shares of its diagonal, its sides, and the diagonal.
fn normalised(faces: &[[u32; 3]], positions: &[DVec3]) -> Option<(Vec<DVec3>, DVec3, f64)> {
    let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let mut extend = |p: &DVec3| {
        if p.is_finite() {
            (low, high) = (low.min(*p), high.max(*p));
        }
    };
    faces.iter().flatten().filter_map(|&v| positions.get(v as usize)).for_each(&mut extend);
    if faces.is_empty() {
        positions.iter().for_each(&mut extend);
    }
    if positions.is_empty() || !low.is_finite() {
        return None;
    }
    let (middle, diagonal) = (0.5 * (low + high), (high - low).length());
    let size = if diagonal > 0.0 && diagonal.is_finite() { diagonal } else { 1.0 };
    Some((positions.iter().map(|&p| (p - middle) / size).collect(), (high - low) / size, diagonal))
}

/// Faces between three different welded vertices.
fn sound(faces: &[[u32; 3]], stands: &[u32]) -> Vec<[u32; 3]> {
    let inside = |f: &&[u32; 3]| f.iter().all(|&v| (v as usize) < stands.len());
    let welded = faces.iter().filter(inside).map(|f| f.map(|v| stands[v as usize]));
    welded.filter(is_whole).collect()
}

/// Vertices of faces; of a mesh without any, all that stand for themselves.
fn used(faces: &[[u32; 3]], stands: &[u32], diagonal: f64) -> Vec<u32> {
    let mut used = vec![faces.is_empty() || diagonal <= 0.0; stands.len()];
    faces.iter().flatten().for_each(|&v| used[v as usize] = true);
    (0..stands.len() as u32).filter(|&v| used[v as usize] && stands[v as usize] == v).collect()
}

/// Those of the vertices that may become samples: of a surface in more than `most` pieces, such as a body with thousands
/// of hairs, those on the largest pieces, which make up [`COVERED`] of it, and no more than `most` of them. Every piece
/// gets a sample before any gets another, and none would be left for the body.
fn of_large_pieces(faces: &[[u32; 3]], points: &[DVec3], used: &[u32], most: usize) -> Vec<u32> {
    let pieces = pieces(faces, points.len());
    if pieces.count <= most {
        return used.to_vec();
    }
    let mut areas = vec![0.0; pieces.count];
    for (&piece, area) in pieces.face.iter().zip(face::areas(faces, points)) {
        areas[piece as usize] += area;
    }
    // As in `farthest_now`: the largest first, and of equals the first.
    let mut waiting: BinaryHeap<(u64, u32)> =
        areas.iter().zip(0..).map(|(a, piece): (&f64, u32)| (a.to_bits(), !piece)).collect();
    let mut left = COVERED * areas.iter().sum::<f64>();
    let mut large = vec![false; pieces.count];
    for _ in 0..most {
        let Some((_, reversed)) = waiting.pop().filter(|_| left >= 0.0) else { break };
        large[!reversed as usize] = true;
        left -= areas[!reversed as usize];
    }
    let mut eligible = vec![false; points.len()];
    for (corners, &piece) in faces.iter().zip(&pieces.face) {
        corners.iter().for_each(|&v| eligible[v as usize] |= large[piece as usize]);
    }
    used.iter().copied().filter(|&v| eligible[v as usize]).collect()
}

/// Farthest point sampling among `used`, from the vertex farthest from the middle; with the cells.
fn farthest(graph: &Graph, points: &[DVec3], used: &[u32], count: usize) -> (Vec<u32>, Paths) {
    let mut paths = Paths::new(graph);
    let mut samples = Vec::new();
    let middle = used.iter().map(|&v| points[v as usize]).sum::<DVec3>() / used.len().max(1) as f64;
    let first = used.iter().copied().max_by(|&a, &b| {
        let d = |v: u32| points[v as usize].distance_squared(middle);
        d(a).total_cmp(&d(b)).then(b.cmp(&a))
    });
    let mut waiting = used.iter().map(|&v| (f64::INFINITY.to_bits(), !v)).collect();
    let mut next = first;
    while let Some(sample) = next {
        paths.add(graph, sample, samples.len() as u32);
        samples.push(sample);
        if samples.len() >= count {
            break;
        }
        next = farthest_now(&mut waiting, &paths.distance);
    }
    (samples, paths)
}

/// The vertex that is farthest, the first of equals; `None` if all distances are zero. `waiting` has the bits of distances,
/// which are ordered as these are, from before some became shorter, and vertices upside down, so that the first is largest.
fn farthest_now(waiting: &mut BinaryHeap<(u64, u32)>, distance: &[f64]) -> Option<u32> {
    loop {
        let (then, reversed) = waiting.pop()?;
        let now = distance[!reversed as usize].to_bits();
        if now == then {
            return (now > 0).then_some(!reversed);
        }
        waiting.push((now, reversed));
    }
}

/// Vertices without a sample in reach join the nearest as the crow flies; welded vertices the one that stands for them.
fn reach_all(paths: &mut Paths, stands: &[u32], samples: &[u32], points: &[DVec3]) {
    let tree = KdTree::of_points(&samples.iter().map(|&v| points[v as usize]).collect::<Vec<_>>());
    for v in 0..stands.len() {
        if paths.label[v] != u32::MAX {
            continue;
        }
        let stand = paths.label[stands[v] as usize];
        paths.label[v] = if stand != u32::MAX { stand } else { tree.nearest(&points[v].to_array()).unwrap_or(0) };
    }
}

/// Normals of the vertices and of the cells.
fn normals(
    faces: &[[u32; 3]],
    points: &[DVec3],
    stands: &[u32],
    cell: &[u32],
    cells: usize,
) -> (Vec<DVec3>, Vec<DVec3>) {
    let mut of_vertex = vec![DVec3::ZERO; points.len()];
    let mut of_cell = vec![DVec3::ZERO; cells];
    for face in faces {
        let normal = face::double_area_normal(face::corners(points, *face));
        for &v in face {
            of_vertex[v as usize] += normal;
            of_cell[cell[v as usize] as usize] += normal;
        }
    }
    let of_vertex = stands.iter().map(|&s| of_vertex[s as usize].normalize_or_zero()).collect();
    (of_vertex, of_cell.into_iter().map(DVec3::normalize_or_zero).collect())
}

/// Each vertex as a mean of the corners of the coarse triangle nearest to it, among those at its cell's sample.
fn readings(points: &[DVec3], cell: &[u32], coarse: &[[u32; 3]], places: &[DVec3]) -> Vec<Reading> {
    let mut around = vec![Vec::new(); places.len()];
    for (number, face) in coarse.iter().enumerate() {
        face.iter().for_each(|&s| around[s as usize].push(number));
    }
    let reading = |(&p, &own): (&DVec3, &u32)| {
        let alone = (places[own as usize].distance_squared(p), [(own, 1.0), (own, 0.0), (own, 0.0)]);
        let on = |&number: &usize| {
            let corners = coarse[number];
            let weights = nearest_in_triangle(p, corners.map(|s| places[s as usize]));
            let at: DVec3 = corners.iter().zip(weights).map(|(&s, w)| w * places[s as usize]).sum();
            let reading: Reading = std::array::from_fn(|k| (corners[k], weights[k] as f32));
            (at.distance_squared(p), reading)
        };
        let choices = std::iter::once(alone).chain(around[own as usize].iter().map(on));
        choices.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(alone.1, |best| best.1)
    };
    points.iter().zip(cell).map(reading).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_body_with_thousands_of_hairs_is_sampled_itself() {
        // A row of quads, and a thousand tiny triangles about it, first in the file.
        let hair =
            |i: u32| [0.0, 0.01, 0.02].map(|x| DVec3::new(x + f64::from(i % 20), x * x + 0.1, f64::from(i / 20)));
        let mut points: Vec<DVec3> = (0..1000).flat_map(hair).collect();
        let mut faces: Vec<[u32; 3]> = (0..1000).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let first = points.len() as u32;
        for i in 0..200 {
            points.extend([DVec3::new(0.1 * f64::from(i), 0.0, -1.0), DVec3::new(0.1 * f64::from(i), 0.0, 5.0)]);
        }
        faces.extend((0..398).map(|i| [first + i, first + i + 1, first + i + 2]));
        let surface = SampledSurface::new(&faces, &points, 100).expect("a surface");
        assert_eq!(surface.len(), 100);
        assert!(surface.samples.iter().all(|&v| v >= first));
        assert!(surface.cell.iter().all(|&cell| cell < 100));
    }
}
