//! The retained solver of a mesh: whatever does not depend on the handles is computed once.

use super::box_problem::{self, Column, State};
use super::follow;
use super::quadratic::Quadratic;
use super::surface::Surface;
use super::{Parameters, Weights, WeightsError};
use crate::mesh::laplacian::Laplacian;
use crate::warning::Warning;
use glam::DVec3;

/// The residual above which weights are said not to be optimal.
const OPTIMAL: f64 = 1e-6;

/// A mesh ready for the weights of any handles.
#[derive(Debug)]
pub struct Biharmonic {
    surface: Surface,
    quadratic: Quadratic,
    /// The welded vertices of each piece.
    members: Vec<Vec<u32>>,
    mollified: usize,
}

impl Biharmonic {
    /// Prepares a mesh. `faces` is #F triples of vertex numbers, `positions` #V points. Vertices at one place are taken as
    /// one.
    pub fn new(faces: &[[u32; 3]], positions: &[DVec3]) -> Result<Self, WeightsError> {
        Self::with_poses(faces, positions, &[])
    }

    /// Prepares a mesh whose vertices are one only if they agree in other poses, too: lips that touch in the reference
    /// pose stay apart. Poses that do not have #V points are left out.
    pub fn with_poses(faces: &[[u32; 3]], positions: &[DVec3], poses: &[&[DVec3]]) -> Result<Self, WeightsError> {
        let surface = Surface::new(faces, positions, poses)?;
        let laplacian = Laplacian::new(&surface.faces, &surface.positions);
        let quadratic = Quadratic::new(&laplacian);
        let mut members = vec![Vec::new(); surface.pieces];
        for (v, &p) in surface.piece.iter().enumerate() {
            members[p as usize].push(v as u32);
        }
        Ok(Self { surface, quadratic, members, mollified: laplacian.mollified })
    }

    /// The number of vertices of the mesh as given.
    pub fn vertices(&self) -> usize {
        self.surface.welded.len()
    }

    /// The weights of handles, which are vertices of the mesh as given.
    pub fn weights(&self, handles: &[u32], parameters: &Parameters) -> Result<Weights, WeightsError> {
        let places = self.places(handles)?;
        let columns = (0..handles.len()).map(|j| self.column(&places, j)).collect();
        Ok(self.finish(handles, &places, columns, parameters))
    }

    /// The weights of handles of which most were in `before`, and so are their weights, or nearly: much faster than
    /// [`Biharmonic::weights`], with the same result.
    pub fn update(&self, before: &Weights, handles: &[u32], parameters: &Parameters) -> Result<Weights, WeightsError> {
        let (found, expected) = (before.vertices(), self.vertices());
        if found != expected {
            return Err(WeightsError::OtherMesh { found, expected });
        }
        self.weights(handles, parameters)
    }

    /// The welded vertices of handles.
    fn places(&self, handles: &[u32]) -> Result<Vec<u32>, WeightsError> {
        if handles.is_empty() {
            return Err(WeightsError::NoHandles);
        }
        let vertices = self.vertices();
        let place = |&handle: &u32| match self.surface.welded.get(handle as usize) {
            Some(&place) => Ok(place),
            None => Err(WeightsError::HandleOutOfRange { handle, vertices }),
        };
        let places = handles.iter().map(place).collect::<Result<Vec<u32>, _>>()?;
        let mut sorted: Vec<(u32, u32)> = places.iter().copied().zip(handles.iter().copied()).collect();
        sorted.sort_unstable();
        match sorted.windows(2).find(|pair| pair[0].0 == pair[1].0) {
            Some(&[(_, first), (_, second)]) if first == second => Err(WeightsError::DuplicateHandle { handle: first }),
            Some(&[(_, first), (_, second)]) => Err(WeightsError::SamePlace { first, second }),
            _ => Ok(places),
        }
    }

    fn column(&self, places: &[u32], handle: usize) -> Column {
        let n = self.surface.positions.len();
        let piece = self.surface.piece[places[handle] as usize];
        let members = &self.members[piece as usize];
        let mut states = vec![State::Fixed; n];
        let mut weights = vec![0.0; n];
        members.iter().for_each(|&v| states[v as usize] = State::Free);
        places.iter().for_each(|&v| states[v as usize] = State::Fixed);
        weights[places[handle] as usize] = 1.0;
        box_problem::solve(&self.quadratic, members, Column { weights, states, energy: 0.0, residual: 0.0 })
    }

    fn finish(&self, handles: &[u32], places: &[u32], raw: Vec<Column>, _parameters: &Parameters) -> Weights {
        let rows = follow::rows(&self.surface, places, &raw);
        let count = handles.len();
        let of_vertex = |&v: &u32| rows[v as usize * count..(v as usize + 1) * count].iter().copied();
        let values = self.surface.welded.iter().flat_map(of_vertex).collect();
        let kkt_residual = raw.iter().map(|c| c.residual).fold(0.0, f64::max);
        let energies = raw.iter().map(|c| c.energy * self.surface.radius.powi(2)).collect();
        let warnings = self.warnings(places, kkt_residual);
        Weights { handles: handles.to_vec(), values, kkt_residual, energies, warnings, raw }
    }

    fn warnings(&self, places: &[u32], residual: f64) -> Vec<Warning> {
        let mut warnings = Vec::new();
        if self.mollified > 0 {
            let message = format!("{} degenerate triangles were given a little width", self.mollified);
            warnings.push(Warning::new("degenerate-faces", message));
        }
        let mut held = vec![false; self.surface.pieces];
        places.iter().for_each(|&v| held[self.surface.piece[v as usize] as usize] = true);
        let without = held.iter().filter(|held| !**held).count();
        if without > 0 {
            let message = format!("{without} pieces without a handle follow the nearest piece that has one");
            warnings.push(Warning::new("pieces-without-handle", message));
        }
        if residual > OPTIMAL {
            let message = format!("the weights are not quite optimal: their residual is {residual:.1e}");
            warnings.push(Warning::new("not-optimal", message));
        }
        warnings
    }
}
