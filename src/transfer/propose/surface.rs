//! A surface thinned out to some thousand points, with the distances between all of them.
//!
//! Samples are geodesic farthest points, so that the first of them are a coarser sampling of the same surface. What lies
//! nearest to a sample is its cell; cells that meet at a face make a coarse triangle (the dual of the geodesic Voronoi
//! diagram: G. Peyré and L. Cohen, *Geodesic remeshing using front propagation*, International Journal of Computer
//! Vision 69(1), 2006, pp. 145–156). That asks nothing of the mesh: seams, holes, edges with many faces, many pieces.

use super::paths::{Graph, Paths};
use crate::mesh::doctor::outward;
use crate::mesh::weld::weld;
use glam::DVec3;

/// Samples of a surface; more cost memory and time by their square.
pub const SAMPLES: usize = 1200;

/// Samples over whose mean distance sizes are compared.
const FIRST: usize = 100;

/// What the mean distance between samples is made: as in shares of the diagonal of many a figure.
const TYPICAL: f64 = 0.4;

/// A sampled surface. Places are relative to the centre of the bounding box. Lengths are such that the mean distance along
/// the surface is [`TYPICAL`]: unlike the box, that does not depend on how limbs are held.
#[derive(Clone, Debug)]
pub struct Surface {
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
    /// #samples × #samples distances along the surface, row by row.
    distances: Vec<f32>,
    /// #samples mean distances from the first samples: large at tips.
    pub remote: Vec<f32>,
    /// Triangles between samples whose cells meet.
    pub coarse: Vec<[u32; 3]>,
    /// The coarse graph.
    pub graph: Graph,
    /// #samples lists of the vertices in each cell.
    pub members: Vec<Vec<u32>>,
    /// Sides of the bounding box.
    pub sides: DVec3,
}

/// A place as a mean of samples with weights that add up to one.
pub type Reading = [(u32, f32); 3];

impl Surface {
    /// `faces` is #F triples of vertex numbers, `positions` #V points. Faces with vertices out of range or named twice
    /// are left out. `None` without a vertex.
    pub fn new(faces: &[[u32; 3]], positions: &[DVec3], samples: usize) -> Option<Self> {
        let (mut points, sides, diagonal) = normalised(faces, positions)?;
        points.iter_mut().filter(|p| !p.is_finite()).for_each(|p| *p = DVec3::ZERO);
        let stands = weld(&[&points], 1e-7);
        let welded: Vec<[u32; 3]> = sound(&outward(faces, &points), &stands);
        let used = used(&welded, &stands, diagonal);
        let fine = Graph::new(points.len(), &edges(&welded, &points));
        let (samples, mut paths) = farthest(&fine, &points, &used, samples.max(1));
        reach_all(&mut paths, &stands, &samples, &points);
        let cell = paths.label;
        let places: Vec<DVec3> = samples.iter().map(|&v| points[v as usize]).collect();
        let coarse = coarse_faces(&welded, &cell);
        let graph = coarse_graph(&coarse, &places);
        let distances = all_pairs(&graph);
        let (vertex_normals, normals) = normals(&welded, &points, &stands, &cell, samples.len());
        let readings = readings(&points, &cell, &coarse, &places);
        let proper = |[a, b, c]: &[u32; 3]| a != b && b != c && c != a;
        let coarse = coarse.into_iter().filter(proper).collect();
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
            graph,
            members,
            sides,
        };
        surface.resize(TYPICAL / f64::from(surface.typical()).max(1e-6));
        let among = FIRST.min(surface.len());
        let mean = |s: u32| surface.row(s)[..among].iter().sum::<f32>() / among as f32;
        surface.remote = (0..surface.len() as u32).map(mean).collect();
        Some(surface)
    }

    /// The mean distance between the first samples.
    fn typical(&self) -> f32 {
        let among = FIRST.min(self.len());
        let sum: f32 = (0..among as u32).flat_map(|s| &self.row(s)[..among]).sum();
        if among > 1 { sum / (among * (among - 1)) as f32 } else { TYPICAL as f32 }
    }

    fn resize(&mut self, by: f64) {
        self.points.iter_mut().chain(&mut self.places).for_each(|p| *p *= by);
        self.distances.iter_mut().for_each(|d| *d *= by as f32);
        self.sides *= by;
    }

    /// How many samples.
    pub fn len(&self) -> usize {
        self.samples.len()
    }

    /// Distances of all samples from one of them.
    pub fn row(&self, sample: u32) -> &[f32] {
        let n = self.len();
        &self.distances[sample as usize * n..(sample as usize + 1) * n]
    }

    /// The vertices in the cell of a sample and in those beside it.
    pub fn around(&self, sample: u32) -> impl Iterator<Item = u32> + '_ {
        let cells = std::iter::once(sample).chain(self.graph.links(sample).iter().map(|l| l.0));
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
    welded.filter(|[a, b, c]| a != b && b != c && c != a).collect()
}

/// Vertices of faces; of a mesh without any, all that stand for themselves.
fn used(faces: &[[u32; 3]], stands: &[u32], diagonal: f64) -> Vec<u32> {
    let mut used = vec![faces.is_empty() || diagonal <= 0.0; stands.len()];
    faces.iter().flatten().for_each(|&v| used[v as usize] = true);
    (0..stands.len() as u32).filter(|&v| used[v as usize] && stands[v as usize] == v).collect()
}

fn edges(faces: &[[u32; 3]], points: &[DVec3]) -> Vec<(u32, u32, f64)> {
    let length = |a: u32, b: u32| points[a as usize].distance(points[b as usize]).max(1e-12);
    faces.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).map(|(a, b)| (a, b, length(a, b))).collect()
}

/// Farthest point sampling among `used`, from the vertex farthest from the middle; with the cells.
fn farthest(graph: &Graph, points: &[DVec3], used: &[u32], count: usize) -> (Vec<u32>, Paths) {
    let mut paths = Paths::new(points.len());
    let mut samples = Vec::new();
    let middle = used.iter().map(|&v| points[v as usize]).sum::<DVec3>() / used.len().max(1) as f64;
    let first = used.iter().copied().max_by(|&a, &b| {
        let d = |v: u32| points[v as usize].distance_squared(middle);
        d(a).total_cmp(&d(b)).then(b.cmp(&a))
    });
    let mut next = first;
    while let Some(sample) = next {
        paths.add(graph, sample, samples.len() as u32);
        samples.push(sample);
        if samples.len() >= count {
            break;
        }
        let far = |v: &u32| paths.distance[*v as usize];
        next = used.iter().copied().max_by(|a, b| far(a).total_cmp(&far(b)).then(b.cmp(a))).filter(|v| far(v) > 0.0);
    }
    (samples, paths)
}

/// Vertices without a sample in reach join the nearest as the crow flies; welded vertices the one that stands for them.
fn reach_all(paths: &mut Paths, stands: &[u32], samples: &[u32], points: &[DVec3]) {
    for v in 0..stands.len() {
        if paths.label[v] != u32::MAX {
            continue;
        }
        let stand = paths.label[stands[v] as usize];
        paths.label[v] = if stand != u32::MAX { stand } else { nearest(samples, points, points[v]) };
    }
}

fn nearest(samples: &[u32], points: &[DVec3], to: DVec3) -> u32 {
    let d = |i: &u32| points[samples[*i as usize] as usize].distance_squared(to);
    (0..samples.len() as u32).min_by(|a, b| d(a).total_cmp(&d(b))).unwrap_or(0)
}

/// Triangles between three cells that meet at a face, each once.
fn coarse_faces(faces: &[[u32; 3]], cell: &[u32]) -> Vec<[u32; 3]> {
    let cells = faces.iter().map(|f| f.map(|v| cell[v as usize]));
    let mut coarse: Vec<[u32; 3]> = cells.filter(|[a, b, c]| a != b || b != c).map(rotated).collect();
    coarse.sort_unstable();
    coarse.dedup();
    coarse
}

/// The same triangle with its smallest number first.
fn rotated([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a <= b && a <= c {
        [a, b, c]
    } else if b <= a && b <= c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// Links along the coarse edges, straight across pairs of triangles, and between pieces.
fn coarse_graph(coarse: &[[u32; 3]], places: &[DVec3]) -> Graph {
    let mut links = edges(coarse, places);
    links.extend(across(coarse, places));
    let graph = Graph::new(places.len(), &links);
    let piece = pieces(&graph);
    let bridges = bridges(&piece, places);
    if bridges.is_empty() {
        return graph;
    }
    let spacing = links.iter().map(|link| link.2).sum::<f64>() / links.len().max(1) as f64;
    for &(a, b, gap) in &bridges {
        links.extend(contacts(&piece, [piece[a as usize], piece[b as usize]], gap + spacing, places));
    }
    links.extend(bridges);
    Graph::new(places.len(), &links)
}

/// Links between the two corners opposite a coarse edge, over the two triangles laid flat: paths along edges alone are
/// too long by a tenth and depend on how the edges happen to run.
fn across(coarse: &[[u32; 3]], places: &[DVec3]) -> Vec<(u32, u32, f64)> {
    let mut sides: Vec<(u32, u32, u32)> = coarse
        .iter()
        .filter(|[a, b, c]| a != b && b != c && c != a)
        .flat_map(|&[a, b, c]| [(a.min(b), a.max(b), c), (b.min(c), b.max(c), a), (c.min(a), c.max(a), b)])
        .collect();
    sides.sort_unstable();
    let mut links = Vec::new();
    for pair in sides.windows(2) {
        let [(a, b, c), (a2, b2, d)] = [pair[0], pair[1]];
        if (a, b) != (a2, b2) || c == d {
            continue;
        }
        let [pa, pb, pc, pd] = [a, b, c, d].map(|i| places[i as usize]);
        let length = pa.distance(pb);
        let along = (pb - pa) / length.max(1e-12);
        let flat = |p: DVec3| {
            let x = (p - pa).dot(along);
            (x, (p - pa - x * along).length())
        };
        let ((x1, y1), (x2, y2)) = (flat(pc), flat(pd));
        let crossing = x1 + (x2 - x1) * y1 / (y1 + y2).max(1e-300);
        if crossing >= 0.0 && crossing <= length {
            links.push((c, d, (x1 - x2).hypot(y1 + y2)));
        }
    }
    links
}

/// For each node of a graph the number of its connected piece.
fn pieces(graph: &Graph) -> Vec<u32> {
    let mut piece = vec![u32::MAX; graph.len()];
    let mut count = 0;
    for first in 0..graph.len() as u32 {
        if piece[first as usize] != u32::MAX {
            continue;
        }
        let mut stack = vec![first];
        piece[first as usize] = count;
        while let Some(node) = stack.pop() {
            for &(next, _) in graph.links(node) {
                if piece[next as usize] == u32::MAX {
                    piece[next as usize] = count;
                    stack.push(next);
                }
            }
        }
        count += 1;
    }
    piece
}

/// Links between two pieces all along where they lie against each other, within `reach`: a shirt that hung on the trousers
/// at one place would hang on them at another place of another figure.
fn contacts(piece: &[u32], [p, q]: [u32; 2], reach: f64, places: &[DVec3]) -> Vec<(u32, u32, f64)> {
    let of = |wanted: u32| (0..piece.len() as u32).filter(move |&s| piece[s as usize] == wanted);
    let distance = |a: u32, b: u32| places[a as usize].distance(places[b as usize]);
    let nearest = |a: u32, other: u32| {
        let to = of(other).map(|b| (a, b, distance(a, b))).min_by(|x, y| x.2.total_cmp(&y.2));
        to.filter(|link| link.2 <= reach)
    };
    of(p).filter_map(|a| nearest(a, q)).chain(of(q).filter_map(|b| nearest(b, p))).collect()
}

/// Straight links that join the pieces of a graph into one, each time between the two nearest.
fn bridges(piece: &[u32], places: &[DVec3]) -> Vec<(u32, u32, f64)> {
    let n = piece.len();
    let count = piece.iter().max().map_or(0, |&last| last + 1);
    // Prim's spanning tree over the samples, where links within a piece are free.
    let mut best = vec![(f64::INFINITY, 0_u32); n];
    let mut inside = vec![false; count as usize];
    let mut links = Vec::new();
    let mut next = piece.first().copied();
    while let Some(joined) = next {
        inside[joined as usize] = true;
        for a in (0..n).filter(|&a| piece[a] == joined) {
            for b in (0..n).filter(|&b| !inside[piece[b] as usize]) {
                let d = places[a].distance(places[b]);
                if d < best[b].0 {
                    best[b] = (d, a as u32);
                }
            }
        }
        let outside = (0..n).filter(|&b| !inside[piece[b] as usize]);
        let nearest = outside.min_by(|&a, &b| best[a].0.total_cmp(&best[b].0));
        next = nearest.map(|b| {
            links.push((best[b].1, b as u32, best[b].0.max(1e-12)));
            piece[b]
        });
    }
    links
}

fn all_pairs(graph: &Graph) -> Vec<f32> {
    let n = graph.len();
    let mut distances = Vec::with_capacity(n * n);
    let mut paths = Paths::new(n);
    for sample in 0..n as u32 {
        paths.clear();
        paths.add(graph, sample, 0);
        distances.extend(paths.distance.iter().map(|&d| if d.is_finite() { d as f32 } else { 2.0 }));
    }
    distances
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
        let [a, b, c] = face.map(|v| points[v as usize]);
        let normal = (b - a).cross(c - a);
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
            let weights = nearest_on_triangle(p, corners.map(|s| places[s as usize]));
            let at: DVec3 = corners.iter().zip(weights).map(|(&s, w)| w * places[s as usize]).sum();
            let reading: Reading = std::array::from_fn(|k| (corners[k], weights[k] as f32));
            (at.distance_squared(p), reading)
        };
        let choices = std::iter::once(alone).chain(around[own as usize].iter().map(on));
        choices.min_by(|a, b| a.0.total_cmp(&b.0)).map_or(alone.1, |best| best.1)
    };
    points.iter().zip(cell).map(reading).collect()
}

/// Barycentric weights of the point of a triangle that is nearest to `p` (C. Ericson, *Real-Time Collision Detection*,
/// 2005, section 5.1.5).
fn nearest_on_triangle(p: DVec3, [a, b, c]: [DVec3; 3]) -> [f64; 3] {
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(ap), ac.dot(ap));
    if d1 <= 0.0 && d2 <= 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let bp = p - b;
    let (d3, d4) = (ab.dot(bp), ac.dot(bp));
    if d3 >= 0.0 && d4 <= d3 {
        return [0.0, 1.0, 0.0];
    }
    let cp = p - c;
    let (d5, d6) = (ab.dot(cp), ac.dot(cp));
    if d6 >= 0.0 && d5 <= d6 {
        return [0.0, 0.0, 1.0];
    }
    let share = |part: f64, whole: f64| if whole > 0.0 { (part / whole).clamp(0.0, 1.0) } else { 0.0 };
    let vc = d1 * d4 - d3 * d2;
    if vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0 {
        let v = share(d1, d1 - d3);
        return [1.0 - v, v, 0.0];
    }
    let vb = d5 * d2 - d1 * d6;
    if vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0 {
        let w = share(d2, d2 - d6);
        return [1.0 - w, 0.0, w];
    }
    let va = d3 * d6 - d5 * d4;
    if va <= 0.0 && d4 >= d3 && d5 >= d6 {
        let w = share(d4 - d3, (d4 - d3) + (d5 - d6));
        return [0.0, 1.0 - w, w];
    }
    let sum = va + vb + vc;
    if sum > 0.0 { [va / sum, vb / sum, vc / sum] } else { [1.0, 0.0, 0.0] }
}
