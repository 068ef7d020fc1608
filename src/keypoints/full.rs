//! Sets of key points on the mesh itself: weights, groups, fits.

use super::result::{Fitted, Rounds};
use super::welded::WeldedSequence;
use crate::crew::Crew;
use crate::sequence::Sequence;
use crate::skinning::{Fit, FitParameters, Fitter, Rows, SkinnedMesh, clusters};
use crate::weights::{Biharmonic, Weights, WeightsError};
use glam::{DAffine3, DVec3};

/// A sequence, ready for any set of points.
pub struct Full<'a> {
    /// The welded mesh.
    pub surface: &'a WeldedSequence,
    biharmonic: Biharmonic,
    /// #V rows of rotations and stretches.
    features: Vec<f64>,
    fit: FitParameters,
}

impl<'a> Full<'a> {
    /// Prepares the weights of a sequence, whose welded form is `surface`.
    pub fn new(
        sequence: &Sequence,
        surface: &'a WeldedSequence,
        features: Vec<f64>,
        fit: FitParameters,
    ) -> Result<Self, WeightsError> {
        let poses: Vec<&[DVec3]> = sequence.poses().iter().map(|pose| pose.positions.as_slice()).collect();
        let biharmonic = Biharmonic::with_poses(sequence.faces(), sequence.reference(), &poses)?;
        Ok(Self { surface, biharmonic, features, fit })
    }

    /// The weights of points (vertices of the sequence), from weights of nearly the same points where there are some.
    pub async fn weights(
        &self,
        crew: &impl Crew,
        points: &[u32],
        before: Option<&Weights>,
    ) -> Result<Weights, WeightsError> {
        match before {
            Some(before) => self.biharmonic.update_by(crew, before, points).await,
            None => self.biharmonic.weights_by(crew, points).await,
        }
    }

    /// Groups of the welded vertices.
    pub fn groups(&self, weights: &Weights) -> Vec<u32> {
        let surface = self.surface;
        clusters(&self.welded(weights), &self.features, &self.handles(weights), &surface.counts)
    }

    /// A fitter of the welded mesh, in the unit sphere.
    pub fn fitter(&self, weights: &Weights, groups: &[u32]) -> Fitter {
        let surface = self.surface;
        let rows = Rows::new(&self.welded(weights), weights.count());
        let mesh = SkinnedMesh {
            reference: &surface.reference,
            edges: &surface.laplacian.edges,
            stiffness: &surface.laplacian.cotangents,
            mass: &surface.counts,
            handles: &self.handles(weights),
            weights: &rows,
            groups,
            ball: (DVec3::ZERO, 1.0),
        };
        Fitter::new(&mesh, &self.fit)
    }

    /// The mean error over all poses.
    pub fn error(&self, weights: &Weights, groups: &[u32]) -> f64 {
        let fitter = self.fitter(weights, groups);
        mean(self.surface.poses.iter().map(|pose| fitter.fit(pose).error))
    }

    /// Groups and fits for all poses, in mesh units and for the vertices of the sequence.
    pub fn fitted(&self, weights: Weights) -> Fitted {
        let groups = self.groups(&weights);
        let fitter = self.fitter(&weights, &groups);
        let in_mesh_units =
            |maps: &[DAffine3]| -> Vec<DAffine3> { maps.iter().map(|m| rescaled(m, self.surface.ball)).collect() };
        let each = self.surface.poses.iter().map(|pose| {
            let (fit, rounds) = fitter.fit_in_rounds(pose);
            (Fit { maps: in_mesh_units(&fit.maps), ..fit }, rounds.iter().map(|maps| in_mesh_units(maps)).collect())
        });
        let (fits, rounds): (Vec<Fit>, Vec<Rounds>) = each.unzip();
        let error = mean(fits.iter().map(|fit| fit.error));
        let groups = self.surface.number.iter().map(|&n| groups[n as usize]).collect();
        Fitted { weights, groups, fits, rounds, error }
    }

    /// Rows of the welded vertices.
    fn welded(&self, weights: &Weights) -> Vec<f64> {
        self.surface.origin.iter().flat_map(|&v| weights.row(v as usize).iter().copied()).collect()
    }

    fn handles(&self, weights: &Weights) -> Vec<u32> {
        weights.handles.iter().map(|&v| self.surface.number[v as usize]).collect()
    }
}

fn mean(values: impl Iterator<Item = f64>) -> f64 {
    let (sum, count) = values.fold((0.0, 0), |(sum, count), x| (sum + x, count + 1));
    sum / f64::from(count.max(1))
}

/// A map of the unit sphere as one of the mesh.
fn rescaled(map: &DAffine3, (centre, radius): (DVec3, f64)) -> DAffine3 {
    let translation = map.translation * radius + centre - map.matrix3 * centre;
    DAffine3 { matrix3: map.matrix3, translation }
}
