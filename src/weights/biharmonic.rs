//! The retained solver of a mesh: whatever does not depend on the handles is computed once.

use super::box_problem::{self, Column, State};
use super::follow;
use super::joint;
use super::levels::{self, Level};
use super::surface::Surface;
use super::{Parameters, Weights, WeightsError};
use crate::crew::{Crew, Threads, at_once};
use crate::warning::Warning;
use glam::DVec3;

/// The residual above which weights are said not to be optimal.
const OPTIMAL: f64 = 1e-6;

/// A handle that has moved to where its weight was at least so much starts from its former weights.
const NEAR: f64 = 0.5;

/// A mesh ready for the weights of any handles.
#[derive(Debug)]
pub struct Biharmonic {
    /// The mesh and coarser copies of it, finest first; never empty.
    levels: Vec<Level>,
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
        Ok(Self { levels: levels::levels(surface) })
    }

    fn finest(&self) -> &Level {
        &self.levels[0]
    }

    /// The number of vertices of the mesh as given.
    pub fn vertices(&self) -> usize {
        self.finest().surface.welded.len()
    }

    /// The weights of handles, which are vertices of the mesh as given.
    pub fn weights(&self, handles: &[u32], parameters: &Parameters) -> Result<Weights, WeightsError> {
        let places = self.places(handles)?;
        let columns = at_once(self.columns(&Threads, &places));
        Ok(self.finish(handles, &places, columns, parameters))
    }

    /// [`Biharmonic::weights`] by the default parameters, their handles shared out by a crew.
    pub async fn weights_by(&self, crew: &impl Crew, handles: &[u32]) -> Result<Weights, WeightsError> {
        let places = self.places(handles)?;
        let columns = self.columns(crew, &places).await;
        Ok(self.finish(handles, &places, columns, &Parameters::default()))
    }

    /// The weights of handles of which most were in `before`, and so are their weights, or nearly: much faster than
    /// [`Biharmonic::weights`], with the same result.
    pub fn update(&self, before: &Weights, handles: &[u32], parameters: &Parameters) -> Result<Weights, WeightsError> {
        let places = self.places_like(before, handles)?;
        let columns = at_once(self.columns_like(&Threads, before, &places));
        Ok(self.finish(handles, &places[0], columns, parameters))
    }

    /// [`Biharmonic::update`] by the default parameters, their handles shared out by a crew.
    pub async fn update_by(
        &self,
        crew: &impl Crew,
        before: &Weights,
        handles: &[u32],
    ) -> Result<Weights, WeightsError> {
        let places = self.places_like(before, handles)?;
        let columns = self.columns_like(crew, before, &places).await;
        Ok(self.finish(handles, &places[0], columns, &Parameters::default()))
    }

    async fn columns(&self, crew: &impl Crew, places: &[u32]) -> Vec<Column> {
        crew.each(places.len(), &|j| self.column(places, j)).await
    }

    async fn columns_like(&self, crew: &impl Crew, before: &Weights, [places, old]: &[Vec<u32>; 2]) -> Vec<Column> {
        let known = |place: u32| old.iter().position(|&p| p == place).and_then(|i| before.raw.get(i));
        let column = |j: usize| match known(places[j]) {
            _ if self.finest().is_alone(places, places[j]) => self.column(places, j),
            Some(column) => self.updated(column, places, old, j),
            None => match self.moved(before, places, old, j) {
                Some(column) => self.carried(column, places, j),
                None => self.column(places, j),
            },
        };
        crew.each(places.len(), &column).await
    }

    /// The welded vertices of handles, and of those of former weights.
    fn places_like(&self, before: &Weights, handles: &[u32]) -> Result<[Vec<u32>; 2], WeightsError> {
        let (found, expected) = (before.vertices(), self.vertices());
        if found != expected {
            return Err(WeightsError::OtherMesh { found, expected });
        }
        Ok([self.places(handles)?, self.places(&before.handles)?])
    }

    /// The welded vertices of handles.
    fn places(&self, handles: &[u32]) -> Result<Vec<u32>, WeightsError> {
        if handles.is_empty() {
            return Err(WeightsError::NoHandles);
        }
        let vertices = self.vertices();
        let place = |&handle: &u32| match self.finest().surface.welded.get(handle as usize) {
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

    /// A column from nothing. Its factor is not kept: most weights are never updated, and memory that the next handle
    /// uses again need not be fetched.
    fn column(&self, places: &[u32], handle: usize) -> Column {
        let own = places[handle];
        let fine = self.finest();
        if fine.is_alone(places, own) {
            return fine.whole(places, own);
        }
        let start = levels::guess(&self.levels, places, own);
        Column { factor: None, ..box_problem::solve(&fine.quadratic, fine.members_around(own), start) }
    }

    /// The column of a handle that has stayed, while others came and went.
    fn updated(&self, before: &Column, places: &[u32], old_places: &[u32], handle: usize) -> Column {
        let members = self.finest().members_around(places[handle]);
        let piece = self.finest().surface.piece[places[handle] as usize];
        let here = |place: &&u32| self.finest().surface.piece[**place as usize] == piece;
        let gone: Vec<u32> = old_places.iter().filter(here).filter(|p| !places.contains(p)).copied().collect();
        let new: Vec<u32> = places.iter().filter(here).filter(|p| !old_places.contains(p)).copied().collect();
        let mut column = before.clone();
        // A weight that was held at zero by a handle is as well held there by its bound, unless it is drawn up.
        let mut same = new.iter().all(|&v| before.weights[v as usize] == 0.0);
        for &v in &gone {
            let force = self.finest().quadratic.force(v as usize, &before.weights);
            same &= force >= 0.0;
            column.states[v as usize] = if force >= 0.0 { State::Low } else { State::Free };
        }
        for &v in &new {
            column.states[v as usize] = State::Fixed;
            column.weights[v as usize] = 0.0;
        }
        if same { column } else { box_problem::solve(&self.finest().quadratic, members, column) }
    }

    /// The column of the handle that stood where this one does in `before`, if this one is new, that one is gone, and it
    /// has not gone far.
    fn moved<'b>(&self, before: &'b Weights, places: &[u32], old_places: &[u32], handle: usize) -> Option<&'b Column> {
        let (&from, &to) = (old_places.get(handle)?, places.get(handle)?);
        let column = before.raw.get(handle)?;
        let near = column.weights[to as usize] >= NEAR;
        (places.len() == old_places.len() && !places.contains(&from) && near).then_some(column)
    }

    /// The column of a handle that has moved: nearly what it was.
    fn carried(&self, before: &Column, places: &[u32], handle: usize) -> Column {
        let members = self.finest().members_around(places[handle]);
        let mut column = self.finest().open(places, places[handle]);
        for &v in members {
            let v = v as usize;
            if column.states[v] != State::Fixed {
                column.weights[v] = before.weights[v];
                column.states[v] = if before.states[v] == State::Fixed { State::Free } else { before.states[v] };
            }
        }
        column.factor = before.factor.clone();
        box_problem::solve(&self.finest().quadratic, members, column)
    }

    fn finish(&self, handles: &[u32], places: &[u32], raw: Vec<Column>, parameters: &Parameters) -> Weights {
        let joint = parameters.joint.then(|| joint::solve(self.finest(), places, &raw));
        let columns = joint.as_deref().unwrap_or(&raw);
        let rows = follow::rows(&self.finest().surface, columns);
        let count = handles.len();
        let of_vertex = |&v: &u32| rows[v as usize * count..(v as usize + 1) * count].iter().copied();
        let values = self.finest().surface.welded.iter().flat_map(of_vertex).collect();
        let sum = |&v: &u32| columns.iter().map(|column| column.weights[v as usize]).sum();
        let sums = self.finest().surface.welded.iter().map(sum).collect();
        let kkt_residual = columns.iter().map(|c| c.residual).fold(0.0, f64::max);
        let energies = columns.iter().map(|c| c.energy * self.finest().surface.radius.powi(2)).collect();
        let warnings = self.warnings(places, kkt_residual);
        Weights { handles: handles.to_vec(), values, sums, kkt_residual, energies, warnings, raw }
    }

    fn warnings(&self, places: &[u32], residual: f64) -> Vec<Warning> {
        let mut warnings = Vec::new();
        if self.finest().mollified > 0 {
            let message = format!("{} degenerate triangles were given a little width", self.finest().mollified);
            warnings.push(Warning::new("degenerate-faces", message));
        }
        let mut held = vec![false; self.finest().surface.pieces];
        places.iter().for_each(|&v| held[self.finest().surface.piece[v as usize] as usize] = true);
        let without = held.iter().filter(|held| !**held).count();
        if without > 0 {
            let (pieces, follow, have) =
                if without == 1 { ("piece", "follows", "has") } else { ("pieces", "follow", "has") };
            let message = format!("{without} {pieces} without a handle {follow} the nearest piece that {have} one");
            warnings.push(Warning::new("pieces-without-handle", message));
        }
        if residual > OPTIMAL {
            let message = format!("the weights are not quite optimal: their residual is {residual:.1e}");
            warnings.push(Warning::new("not-optimal", message));
        }
        warnings
    }
}
