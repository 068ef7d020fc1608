//! A mesh as the transfer sees it: welded, without loose vertices, at unit size.

use super::ties::ties;
use crate::mesh::ball::unit_ball;
use crate::mesh::doctor;
use crate::mesh::face::nearest_in_triangle;
use crate::mesh::kd_tree::KdTree;
use crate::mesh::pieces::{Pieces, pieces};
use crate::mesh::{face, weld};
use crate::sequence::Sequence;
use glam::{DAffine3, DVec3};

/// How far apart, in radii of the mesh, vertices along a seam may lie.
const WELD_TOLERANCE: f64 = 1e-6;

/// A place on a mesh: a face, and the shares of its corners.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SurfacePoint {
    /// The number of the face.
    pub face: u32,
    /// Shares that sum to 1.
    pub shares: [f64; 3],
}

/// The vertices that faces use, one for each place on the surface, about the centre of the mesh and in its radius.
#[derive(Clone, Debug)]
pub struct WeldedSurface {
    /// For each given vertex, its place here; for a vertex without a face the nearest place.
    pub place: Vec<u32>,
    /// For each place, the first given vertex there.
    pub vertex: Vec<u32>,
    /// #N positions in the unit ball.
    pub positions: Vec<DVec3>,
    /// Faces that name three different places, turned to look outwards.
    pub faces: Vec<[u32; 3]>,
    /// #N unit normals (zero where there is none).
    pub normals: Vec<DVec3>,
    /// #N shares of the area, which sum to 1.
    pub mass: Vec<f64>,
    /// The middle of the bounding box, in the units of the sequence.
    pub centre: DVec3,
    /// The largest distance from it, in the units of the sequence.
    pub radius: f64,
    /// Where the faces around each place begin in `around`, #N + 1.
    start: Vec<u32>,
    around: Vec<u32>,
    /// Where the neighbours of each place begin in `beside`, #N + 1.
    neighbour_start: Vec<u32>,
    beside: Vec<u32>,
    /// Pairs of places of different pieces that count as neighbours.
    ties: Vec<(u32, u32)>,
}

impl WeldedSurface {
    /// The surface of a sequence's reference pose. Vertices are one if they agree in the reference and in every pose.
    pub fn new(sequence: &Sequence) -> Self {
        let (centre, radius) = unit_ball(sequence.faces(), sequence.reference());
        let mut poses: Vec<&[DVec3]> = vec![sequence.reference()];
        poses.extend(sequence.poses().iter().map(|pose| pose.positions.as_slice()));
        let stands = weld::weld(&poses, WELD_TOLERANCE * radius);
        let mut used = vec![false; stands.len()];
        for &v in sequence.faces().iter().flatten() {
            used[stands[v as usize] as usize] = true;
        }
        let mut place = vec![u32::MAX; stands.len()];
        let mut vertex = Vec::new();
        for v in 0..stands.len() {
            if stands[v] as usize == v && used[v] {
                place[v] = vertex.len() as u32;
                vertex.push(v as u32);
            }
        }
        for v in 0..stands.len() {
            place[v] = place[stands[v] as usize];
        }
        let faces: Vec<[u32; 3]> = doctor::outward(sequence.faces(), sequence.reference())
            .iter()
            .map(|face| face.map(|v| place[v as usize]))
            .filter(face::is_whole)
            .collect();
        let mut surface = Self {
            place,
            positions: Vec::new(),
            normals: Vec::new(),
            mass: Vec::new(),
            centre,
            radius,
            start: Vec::new(),
            around: Vec::new(),
            neighbour_start: Vec::new(),
            beside: Vec::new(),
            ties: Vec::new(),
            vertex,
            faces,
        };
        surface.positions = surface.unit(sequence.reference());
        surface.normals = surface.normals_of(&surface.positions);
        surface.mass = surface.shares();
        surface.link();
        surface.place_loose(sequence.reference());
        surface
    }

    /// The same surface, bent to other positions (#N).
    pub fn bent(&self, positions: Vec<DVec3>) -> Self {
        let mut bent = Self { normals: self.normals_of(&positions), positions, ..self.clone() };
        bent.mass = bent.shares();
        bent
    }

    /// Whether there is no place: no face.
    pub fn is_empty(&self) -> bool {
        self.vertex.is_empty()
    }

    /// The number of places.
    pub fn len(&self) -> usize {
        self.vertex.len()
    }

    /// #N positions in the unit ball of #V given ones.
    pub fn unit(&self, given: &[DVec3]) -> Vec<DVec3> {
        self.vertex.iter().map(|&v| self.inward(given[v as usize])).collect()
    }

    /// A point of the sequence in the unit ball.
    pub fn inward(&self, point: DVec3) -> DVec3 {
        point / self.radius - self.centre / self.radius
    }

    /// Where a given vertex lies in the unit ball.
    pub fn at(&self, vertex: u32) -> DVec3 {
        self.positions[self.place[vertex as usize] as usize]
    }

    /// Maps in the unit ball as maps in the units of the sequence; those that are not finite change nothing.
    pub fn outward(&self, maps: &[DAffine3]) -> Vec<DAffine3> {
        let Self { centre, radius, .. } = *self;
        let outward = |map: &DAffine3| {
            let translation = radius * map.translation + centre - map.matrix3 * centre;
            DAffine3::from_mat3_translation(map.matrix3, translation)
        };
        maps.iter().map(outward).map(|map| if map.is_finite() { map } else { DAffine3::IDENTITY }).collect()
    }

    /// #N unit normals of the places at other positions.
    pub fn normals_of(&self, positions: &[DVec3]) -> Vec<DVec3> {
        face::vertex_normals(&self.faces, positions)
    }

    /// The same surface, its pieces tied where they touch: places at both ends of a tie are neighbours.
    pub fn tied(mut self) -> Self {
        self.ties = ties(&self);
        if !self.ties.is_empty() {
            self.link();
        }
        self
    }

    /// Pairs of places of different pieces that belong together.
    pub fn ties(&self) -> &[(u32, u32)] {
        &self.ties
    }

    /// What is nearest to a point on the faces around a place, and where that is.
    pub fn nearest_around(&self, place: u32, point: DVec3) -> Option<(SurfacePoint, DVec3)> {
        let at = |&face: &u32| {
            let corners = self.faces[face as usize].map(|v| self.positions[v as usize]);
            let shares = nearest_in_triangle(point, corners);
            let at = corners[0] * shares[0] + corners[1] * shares[1] + corners[2] * shares[2];
            (SurfacePoint { face, shares }, at, at.distance_squared(point))
        };
        let found = self.faces_around(place as usize).iter().map(at).min_by(|a, b| a.2.total_cmp(&b.2))?;
        Some((found.0, found.1))
    }

    /// The faces around a place.
    pub fn faces_around(&self, place: usize) -> &[u32] {
        &self.around[self.start[place] as usize..self.start[place + 1] as usize]
    }

    /// The places that share an edge or a tie with a place.
    pub fn neighbours(&self, place: usize) -> &[u32] {
        &self.beside[self.neighbour_start[place] as usize..self.neighbour_start[place + 1] as usize]
    }

    /// The pairs of places that share an edge or a tie, the lower number first.
    pub fn links(&self) -> impl Iterator<Item = (usize, usize)> + '_ {
        let upward = |v: usize| self.neighbours(v).iter().map(move |&u| (v, u as usize)).filter(|(v, u)| v < u);
        (0..self.len()).flat_map(upward)
    }

    /// The places of each connected piece, in ascending order.
    pub fn pieces(&self) -> Vec<Vec<u32>> {
        let Pieces { count, face } = pieces(&self.faces, self.len());
        let mut places = vec![Vec::new(); count];
        for (v, around) in self.start.windows(2).enumerate() {
            // Every place has a face, unless all faces there were flat.
            if let Some(&f) = self.around[around[0] as usize..around[1] as usize].first() {
                places[face[f as usize] as usize].push(v as u32);
            }
        }
        places
    }

    /// For each place the number of its piece among [`WeldedSurface::pieces`].
    pub fn numbered(&self, pieces: &[Vec<u32>]) -> Vec<u32> {
        let mut number = vec![0; self.len()];
        for (places, n) in pieces.iter().zip(0..) {
            places.iter().for_each(|&v| number[v as usize] = n);
        }
        number
    }

    /// The sides of the box around places.
    pub fn sides(&self, places: &[u32]) -> DVec3 {
        let points = || places.iter().map(|&v| self.positions[v as usize]);
        points().fold(DVec3::NEG_INFINITY, DVec3::max) - points().fold(DVec3::INFINITY, DVec3::min)
    }

    fn shares(&self) -> Vec<f64> {
        let areas = face::areas(&self.faces, &self.positions);
        let total: f64 = areas.iter().sum();
        // Places in flat faces alone count a little, so that no system is singular.
        let mut mass = vec![1e-6 / self.len().max(1) as f64; self.len()];
        if total > 0.0 {
            for (f, area) in self.faces.iter().zip(&areas) {
                f.iter().for_each(|&v| mass[v as usize] += area / (3.0 * total));
            }
        }
        let sum: f64 = mass.iter().sum();
        mass.iter_mut().for_each(|m| *m /= sum.max(f64::MIN_POSITIVE));
        mass
    }

    fn link(&mut self) {
        let corners = self.faces.iter().zip(0_u32..).flat_map(|(face, f)| face.map(|v| (v, f)));
        (self.start, self.around) = lists(self.len(), corners.collect());
        let sides = self.faces.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]);
        let pairs = sides.chain(self.ties.iter().copied()).flat_map(|(a, b)| [(a, b), (b, a)]);
        (self.neighbour_start, self.beside) = lists(self.len(), pairs.collect());
    }

    fn place_loose(&mut self, reference: &[DVec3]) {
        if !self.place.contains(&u32::MAX) {
            return;
        }
        let tree = KdTree::of_points(&self.positions);
        for (v, &given) in reference.iter().enumerate() {
            if self.place[v] == u32::MAX {
                let at = self.inward(given).clamp(DVec3::splat(-1e6), DVec3::splat(1e6));
                self.place[v] = tree.nearest(&at.to_array()).unwrap_or(0);
            }
        }
    }
}

/// Lists of the second numbers by the first, each list ascending and without repetition.
fn lists(count: usize, mut pairs: Vec<(u32, u32)>) -> (Vec<u32>, Vec<u32>) {
    pairs.sort_unstable();
    pairs.dedup();
    let mut start = vec![0; count + 1];
    for &(a, _) in &pairs {
        start[a as usize + 1] += 1;
    }
    for i in 0..count {
        start[i + 1] += start[i];
    }
    (start, pairs.into_iter().map(|(_, b)| b).collect())
}
