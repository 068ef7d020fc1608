//! Coarser and coarser copies of the mesh, to guess where weights are at a bound.
//!
//! Which weights are at a bound is settled a ring of vertices a round; on a coarse mesh the rings are wide and the rounds
//! cheap. (Nested iteration, as in multigrid methods for obstacle problems: R. Kornhuber. *Monotone multigrid methods for
//! elliptic variational inequalities*. Numerische Mathematik 69, 1994.) The copies need not be good meshes: what they say
//! is only a first guess.

use super::box_problem::{self, Column, State};
use super::quadratic::Quadratic;
use super::surface::Surface;
use crate::mesh::face;
use crate::mesh::laplacian::Laplacian;

/// Meshes with fewer vertices are not made coarser.
const COARSEST: usize = 200;

/// A coarser mesh must have at most this share of the vertices.
const SHRINK: f64 = 0.7;

/// A weight is first held at zero if at least this share of what lies around it is so on the coarser mesh.
const MOSTLY: f64 = 0.7;

/// A mesh with its energy, and its pieces.
#[derive(Debug)]
pub struct Level {
    /// The mesh; on a coarse level, its `welded` leads from the vertices of the next finer one.
    pub surface: Surface,
    /// Its energy.
    pub quadratic: Quadratic,
    /// The vertices of each piece, ascending.
    pub members: Vec<Vec<u32>>,
    /// Triangles that were mollified.
    pub mollified: usize,
}

impl Level {
    fn new(surface: Surface) -> Self {
        let laplacian = Laplacian::new(&surface.faces, &surface.positions);
        let mut members = vec![Vec::new(); surface.pieces];
        for (v, &p) in surface.piece.iter().enumerate() {
            members[p as usize].push(v as u32);
        }
        Self { quadratic: Quadratic::new(&laplacian), surface, members, mollified: laplacian.mollified }
    }

    /// The vertices of the piece that a vertex is in.
    pub fn members_around(&self, place: u32) -> &[u32] {
        &self.members[self.surface.piece[place as usize] as usize]
    }

    /// Whether no other of the handles is on the piece of `own`.
    pub fn is_alone(&self, places: &[u32], own: u32) -> bool {
        let piece = self.surface.piece[own as usize];
        places.iter().all(|&place| place == own || self.surface.piece[place as usize] != piece)
    }

    /// The column of a handle that is alone on its piece: all of it follows.
    pub fn whole(&self, places: &[u32], own: u32) -> Column {
        let mut column = self.open(places, own);
        self.members_around(own).iter().for_each(|&v| column.weights[v as usize] = 1.0);
        column
    }

    /// A column of zeros, free but at handles and on other pieces; `own` is its handle.
    pub fn open(&self, places: &[u32], own: u32) -> Column {
        let n = self.surface.positions.len();
        let mut states = vec![State::Fixed; n];
        let mut weights = vec![0.0; n];
        self.members_around(own).iter().for_each(|&v| states[v as usize] = State::Free);
        places.iter().for_each(|&v| states[v as usize] = State::Fixed);
        weights[own as usize] = 1.0;
        Column { weights, states, energy: 0.0, residual: 0.0, factor: None }
    }
}

/// The levels of a mesh, finest first.
pub fn levels(surface: Surface) -> Vec<Level> {
    let mut levels = vec![Level::new(surface)];
    while let Some(coarser) = levels.last().and_then(|finest| coarser(&finest.surface)) {
        levels.push(Level::new(coarser));
    }
    levels
}

/// A mesh of about a quarter of the vertices: far enough from each other, each with the vertices around it as its cell,
/// and a face wherever three cells meet.
fn coarser(fine: &Surface) -> Option<Surface> {
    let n = fine.positions.len();
    if n < COARSEST {
        return None;
    }
    let mut cell = vec![u32::MAX; n];
    let mut centres = Vec::new();
    for v in 0..n as u32 {
        if cell[v as usize] == u32::MAX && fine.rings.of(v).iter().all(|&u| !centre(&cell, &centres, u)) {
            cell[v as usize] = centres.len() as u32;
            centres.push(v);
        }
    }
    for v in 0..n {
        if cell[v] == u32::MAX {
            let distance = |u: u32| fine.positions[u as usize].distance_squared(fine.positions[v]);
            let near = fine.rings.of(v as u32).iter().copied().filter(|&u| centre(&cell, &centres, u));
            let nearest = near.min_by(|&a, &b| distance(a).total_cmp(&distance(b)).then(a.cmp(&b)));
            cell[v] = nearest.map_or(0, |u| cell[u as usize]);
        }
    }
    if centres.len() as f64 > SHRINK * n as f64 {
        return None;
    }
    let mut faces: Vec<[u32; 3]> = fine.faces.iter().map(|face| face.map(|v| cell[v as usize])).collect();
    faces.retain(face::is_whole);
    faces.iter_mut().for_each(|face| face.sort_unstable());
    faces.sort_unstable();
    faces.dedup();
    let positions = centres.iter().map(|&v| fine.positions[v as usize]).collect();
    Some(Surface::dissected(cell, positions, faces, fine.radius))
}

/// Whether a vertex is the centre of a cell.
fn centre(cell: &[u32], centres: &[u32], v: u32) -> bool {
    centres.get(cell[v as usize] as usize) == Some(&v)
}

/// A column with its first guess. `places` are the handles' vertices on the finest of `levels`, `own` the column's.
pub fn guess(levels: &[Level], places: &[u32], own: u32) -> Column {
    let Some((fine, coarser)) = levels.split_first() else { return Column::default() };
    let mut column = fine.open(places, own);
    let Some(coarse) = coarser.first() else { return column };
    let up = |place: u32| coarse.surface.welded[place as usize];
    let above: Vec<u32> = places.iter().map(|&place| up(place)).collect();
    let start = guess(coarser, &above, up(own));
    let members = coarse.members_around(up(own));
    let found = box_problem::estimate(&coarse.quadratic, members, start);
    let piece = coarse.surface.piece[up(own) as usize];
    for &v in fine.members_around(own) {
        if column.states[v as usize] == State::Fixed {
            continue;
        }
        let around = || std::iter::once(v).chain(fine.surface.rings.of(v).iter().copied()).map(up);
        let count = around().count() as f64;
        let known = around().all(|u| coarse.surface.piece[u as usize] == piece);
        let held =
            |u: u32| matches!(found.states[u as usize], State::Low | State::Fixed) && found.weights[u as usize] == 0.0;
        let low = around().filter(|&u| held(u)).count() as f64 >= MOSTLY * count;
        let high = around().all(|u| found.states[u as usize] == State::High);
        column.states[v as usize] = match (known, low, high) {
            (true, true, _) => State::Low,
            (true, _, true) => State::High,
            _ => State::Free,
        };
        column.weights[v as usize] = around().map(|u| found.weights[u as usize].clamp(0.0, 1.0)).sum::<f64>() / count;
    }
    column
}
