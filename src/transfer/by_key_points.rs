//! The transfer by the key points: their motions on the source, blended by the target's own biharmonic weights.

use super::alignment::Alignment;
use super::biharmonic;
use super::rig::weights::{Row, normalised};
use super::surface::WeldedSurface;
use super::{Method, Pair, Skin, TransferError};
use crate::sequence::Sequence;
use crate::skinning::Fitter;
use crate::stopwatch::Stopwatch;
use crate::weights::{self, Biharmonic, Weights};
use glam::{DAffine3, DVec3};

/// The factored systems of both meshes' weights.
pub struct KeyPointTransfer {
    method: Method,
    /// Of the source, in its unit ball.
    poses: Vec<Vec<DVec3>>,
    /// Of the source and of the target.
    weights: [Biharmonic; 2],
    /// The weights of the result before, from which the next start while a point is dragged.
    last: Option<[Weights; 2]>,
    /// How poses of the source become motions of the key points on the target, since the last result.
    carrier: Option<Carrier>,
}

/// The motions of the key points on the source, and where these are on both.
struct Carrier {
    fitter: Fitter,
    /// Where the key points lie on the source and on the target.
    points: Vec<(DVec3, DVec3)>,
    alignment: Alignment,
}

impl KeyPointTransfer {
    /// Factors the systems.
    pub fn new(
        (source, target): (&Sequence, &Sequence),
        here: &WeldedSurface,
        method: Method,
        steps: &mut Stopwatch<'_>,
    ) -> Result<Self, TransferError> {
        let poses = source.poses().iter().map(|pose| here.unit(&pose.positions)).collect();
        let of_source: Vec<&[DVec3]> = source.poses().iter().map(|pose| pose.positions.as_slice()).collect();
        let weights = [
            Biharmonic::with_poses(source.faces(), source.reference(), &of_source)?,
            Biharmonic::new(target.faces(), target.reference())?,
        ];
        steps.end("systems", 1.0)?;
        Ok(Self { method, poses, weights, last: None, carrier: None })
    }

    /// The target as a skin over the key points in all poses; if it is to be `quick`, from the result before. `points` are
    /// where the pairs lie, in unit balls.
    pub fn transfer(
        &mut self,
        (source, target): (&WeldedSurface, &WeldedSurface),
        pairs: &[Pair],
        points: Vec<(DVec3, DVec3)>,
        alignment: Alignment,
        quick: bool,
        steps: &mut Stopwatch<'_>,
    ) -> Result<Skin, TransferError> {
        let [here, there] = self.weights_of(pairs, self.last.as_ref().filter(|_| quick))?;
        steps.end("weights", 0.8)?;
        let rows: Vec<f64> = source.vertex.iter().flat_map(|&v| here.row(v as usize).iter().copied()).collect();
        let places: Vec<u32> = pairs.iter().map(|pair| source.place[pair.source as usize]).collect();
        let fitter = biharmonic::fitter(source, &places, &rows, &self.poses);
        let carrier = Carrier { fitter, points, alignment };
        let maps = self.poses.iter().map(|pose| carrier.maps(self.method, target, pose)).collect();
        let row = |&v: &u32| {
            let shares = there.row(v as usize).iter().zip(0_u32..).map(|(&w, h)| (h, w));
            let mut row: Row = shares.filter(|entry| entry.1 > 0.0).collect();
            row.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
            normalised(row)
        };
        let rows: Vec<Row> = target.vertex.iter().map(row).collect();
        self.last = Some([here, there]);
        self.carrier = Some(carrier);
        let handles = pairs.iter().map(|pair| pair.target).collect();
        Ok(Skin { handles, ..Skin::new(target, pairs.len(), &rows, maps) })
    }

    /// The maps of the key points on the target for any other pose in the source's unit ball; `None` before there was a
    /// result.
    pub fn maps(&self, target: &WeldedSurface, pose: &[DVec3]) -> Option<Vec<DAffine3>> {
        Some(self.carrier.as_ref()?.maps(self.method, target, pose))
    }

    /// The weights of the key points on the source and on the target, from those `before` if there are any.
    fn weights_of(&self, pairs: &[Pair], before: Option<&[Weights; 2]>) -> Result<[Weights; 2], TransferError> {
        let [here, there] = &self.weights;
        let [sources, targets] = [|pair: &Pair| pair.source, |pair: &Pair| pair.target]
            .map(|side| pairs.iter().map(side).collect::<Vec<u32>>());
        let parameters = weights::Parameters::default();
        Ok(match before {
            Some([a, b]) => [here.update(a, &sources, &parameters)?, there.update(b, &targets, &parameters)?],
            None => [here.weights(&sources, &parameters)?, there.weights(&targets, &parameters)?],
        })
    }
}

impl Carrier {
    fn maps(&self, method: Method, target: &WeldedSurface, pose: &[DVec3]) -> Vec<DAffine3> {
        let maps = self.fitter.fit(pose).maps;
        let there = maps.iter().zip(&self.points);
        let there = there.map(|(map, &pair)| biharmonic::carried(method, self.alignment, pair, map));
        target.outward(&there.collect::<Vec<_>>())
    }
}
