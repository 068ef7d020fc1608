//! The transfer between one source and one target, ready for any pairs.

use super::alignment::{Alignment, align};
use super::bending::Bending;
use super::biharmonic::{self, carried};
use super::checked::{checked, surfaces};
use super::fill::fill;
use super::growth::{grown, growth, shrunk};
use super::joints::Joints;
use super::layers::{self, Pieces};
use super::mend;
use super::posture;
use super::propose::Proposer;
use super::registration::LOST;
use super::rig::Rig;
use super::rig::weights::{Row, averaged, normalised};
use super::surface::{Foot, Surface};
use super::{Method, Pair, Parameters, Skin, Transfer, TransferError};
use crate::observer::Observer;
use crate::sequence::Sequence;
use crate::skinning::Fitter;
use crate::stopwatch::Stopwatch;
use crate::warning::Warning;
use crate::weights::{self, Biharmonic, Weights};
use glam::{DAffine3, DVec3};
use std::sync::Arc;

/// Rounds in which weights on a target of [`SMOOTHED`] vertices are averaged with their neighbours', in proportion on
/// others: about as far on all of them. Finer ones have so many at most.
const SMOOTHING: f64 = 3.0;
const SMOOTHED: f64 = 3000.0;
const MOST_SMOOTHING: f64 = 24.0;
/// While a point is dragged, every so manieth pose is looked at for tears.
const FEWER: usize = 3;
/// Bones that a vertex of the target may follow.
const INFLUENCES: usize = 8;
/// Above this mean distance of the skinned source from the true one, in radii, a person is told.
const ROUGH: f64 = 0.02;

/// What does not change while pairs are placed: the source's bones and the factored systems of the target.
pub struct Prepared {
    parameters: Parameters,
    source: Surface,
    target: Surface,
    poses: Vec<Vec<DVec3>>,
    /// How many times as large as at rest the source is in each pose; by bones, the poses are without that.
    growths: Vec<f64>,
    rig: Rig,
    /// By how much edges of the target may become longer.
    allowed: f64,
    bending: Bending,
    /// Of the source and of the target, for the methods that blend by the weights of the key points.
    weights: Option<[Biharmonic; 2]>,
    /// The weights of the result before, from which the next start while a point is dragged.
    last_weights: Option<[Weights; 2]>,
    /// How motions of the source become motions of the target's handles, since the last result.
    carrier: Option<Carrier>,
    warnings: Vec<Warning>,
    seconds: Vec<(&'static str, f64)>,
}

/// What turns a pose of the source into motions of the target's handles.
enum Carrier {
    /// Of the bones.
    Bones(Joints),
    /// Of the key points, which lie at `points` on the source and on the target.
    KeyPoints { method: Method, fitter: Box<Fitter>, points: Vec<(DVec3, DVec3)>, alignment: Alignment },
}

impl Prepared {
    /// Prepares a source, all of it, and the reference pose of a target.
    pub fn new(
        source: &Sequence,
        target: &Sequence,
        parameters: &Parameters,
        observer: &mut dyn Observer,
    ) -> Result<Self, TransferError> {
        Self::with_proposer(source, target, parameters, None, observer)
    }

    /// As [`Prepared::new`], where there is already a proposer for these two meshes.
    pub fn with_proposer(
        source: &Sequence,
        target: &Sequence,
        parameters: &Parameters,
        proposer: Option<Arc<Proposer>>,
        observer: &mut dyn Observer,
    ) -> Result<Self, TransferError> {
        let mut steps = Stopwatch::new(observer);
        let acting = source.acting();
        let source = acting.as_ref();
        let [here, there] = surfaces(source, target)?;
        let mut poses: Vec<Vec<DVec3>> = source.poses().iter().map(|pose| here.unit(&pose.positions)).collect();
        let mut growths = vec![1.0; poses.len()];
        if parameters.method.by_bones() {
            growths = poses.iter().map(|pose| growth(&here, pose)).collect();
            poses = poses.into_iter().zip(&growths).map(|(pose, &growth)| shrunk(pose, growth)).collect();
        }
        steps.end("surfaces", 0.1)?;
        let made = || Proposer::of(source, target).ok().map(Arc::new);
        let proposer = if parameters.method.by_bones() { proposer.or_else(made) } else { None };
        steps.end("common places", 0.3)?;
        let bending = Bending::new(&here, &there, proposer)?;
        steps.end("systems", 0.5)?;
        let rig = if parameters.method.by_bones() {
            Rig::new(&here, &poses, parameters.bones.max(1))
        } else {
            Rig::default()
        };
        steps.end("bones", 0.9)?;
        let of_source: Vec<&[DVec3]> = source.poses().iter().map(|pose| pose.positions.as_slice()).collect();
        let weights = if parameters.method.by_bones() {
            None
        } else {
            Some([
                Biharmonic::with_poses(source.faces(), source.reference(), &of_source)?,
                Biharmonic::new(target.faces(), target.reference())?,
            ])
        };
        let telling: Vec<&[DVec3]> = rig.telling.iter().filter_map(|&p| Some(poses.get(p)?.as_slice())).collect();
        let allowed = mend::allowed(&here, &telling);
        steps.end("search", 1.0)?;
        let mut warnings = Vec::new();
        if rig.error > ROUGH {
            let message = format!(
                "the source bends everywhere: its bones ({}) follow it to {:.1} % of its radius only, and the target follows no \
                 better",
                rig.bones,
                100.0 * rig.error
            );
            warnings.push(Warning::new("not-rigid", message));
        }
        Ok(Self {
            parameters: parameters.clone(),
            source: here,
            target: there,
            poses,
            growths,
            rig,
            allowed,
            bending,
            weights,
            last_weights: None,
            carrier: None,
            warnings,
            seconds: steps.stop(),
        })
    }

    /// Seconds of the steps of the preparation.
    pub fn seconds(&self) -> &[(&'static str, f64)] {
        &self.seconds
    }

    /// Transfers all poses by the given pairs.
    pub fn transfer(&mut self, pairs: &[Pair], observer: &mut dyn Observer) -> Result<Transfer, TransferError> {
        self.run(pairs, false, observer)
    }

    /// As [`Prepared::transfer`], but starting from the result before: for pairs that are being dragged. What a fresh start
    /// would give may differ a little.
    pub fn follow(&mut self, pairs: &[Pair], observer: &mut dyn Observer) -> Result<Transfer, TransferError> {
        self.run(pairs, true, observer)
    }

    /// The maps of the target's handles, those of the skin of the last result, for any other pose of the source: #V
    /// positions of the source's vertices. [`Skin::posed`] puts the target there. `None` before there was a result, or if
    /// positions are missing or not finite.
    pub fn maps(&self, pose: &[DVec3]) -> Option<Vec<DAffine3>> {
        let carrier = self.carrier.as_ref()?;
        if pose.len() != self.source.place.len() || !pose.iter().all(|p| p.is_finite()) {
            return None;
        }
        let pose = self.source.unit(pose);
        Some(match carrier {
            Carrier::Bones(joints) => {
                let growth = growth(&self.source, &pose);
                let bones = self.rig.follow(&self.source, &shrunk(pose, growth));
                self.carried(joints, &bones, growth)
            }
            carrier => self.by_points(carrier, &pose),
        })
    }

    fn run(&mut self, pairs: &[Pair], quick: bool, observer: &mut dyn Observer) -> Result<Transfer, TransferError> {
        let mut steps = Stopwatch::new(observer);
        let mut warnings = self.warnings.clone();
        let pairs = checked(&self.source, &self.target, pairs, &mut warnings)?;
        let points: Vec<(DVec3, DVec3)> = pairs.iter().map(|pair| self.points(pair)).collect();
        let alignment = align(&points);
        let skin = match self.parameters.method {
            Method::Bones | Method::Gradients | Method::Posed => {
                let bent = self.bending.bend((&self.source, &self.target), &pairs, alignment, quick);
                steps.end("correspondence", 0.8)?;
                let step = if quick { FEWER } else { 1 };
                let (skin, joints) = self.by_bones(alignment, &pairs, &bent, step, &mut warnings);
                self.carrier = Some(Carrier::Bones(joints));
                skin
            }
            method => {
                let weights = self.weights_of(&pairs, self.last_weights.as_ref().filter(|_| quick))?;
                self.last_weights = Some(weights.clone());
                steps.end("weights", 0.8)?;
                let (skin, carrier) = self.by_key_points(method, &pairs, points, alignment, weights);
                self.carrier = Some(carrier);
                skin
            }
        };
        steps.end("maps", 1.0)?;
        Ok(Transfer {
            skin,
            alignment,
            bones: self.rig.bones,
            source_error: self.rig.error,
            warnings,
            seconds: steps.stop(),
        })
    }

    fn points(&self, pair: &Pair) -> (DVec3, DVec3) {
        let at = |surface: &Surface, vertex: u32| surface.positions[surface.place[vertex as usize] as usize];
        (at(&self.source, pair.source), at(&self.target, pair.target))
    }

    /// Every `step`th of the telling poses is looked at for tears.
    fn by_bones(
        &self,
        alignment: Alignment,
        pairs: &[Pair],
        bent: &[DVec3],
        step: usize,
        warnings: &mut Vec<Warning>,
    ) -> (Skin, Joints) {
        let feet = self.bending.feet(&self.source, &self.target, bent);
        let mut rows: Vec<Row> = feet.iter().map(|foot| self.pulled(foot.map(|f| f.0))).collect();
        let lost: Vec<bool> = feet.iter().map(|foot| foot.is_none_or(|f| f.1 > LOST)).collect();
        fill(&self.target, &mut rows, &lost);
        let rounds = (SMOOTHING * self.target.len() as f64 / SMOOTHED).min(MOST_SMOOTHING);
        rows = averaged(&self.target, rows, INFLUENCES, rounds);
        let (here, there) = self.pieces(pairs);
        let feet: Vec<Option<Foot>> = feet.iter().map(|foot| foot.map(|f| f.0)).collect();
        layers::lay((&self.source, &self.target), (&here, &there), &feet, &mut rows, INFLUENCES);
        let joints = |rows: &[Row]| Joints::new(&self.source, &self.rig, &self.target, rows, alignment);
        let first = joints(&rows);
        let seen = self.rig.telling.iter().step_by(step).filter_map(|&pose| self.rig.maps.get(pose));
        let seen: Vec<Vec<DAffine3>> = seen.map(|maps| first.carry(maps)).collect();
        let seen: Vec<&[DAffine3]> = seen.iter().map(Vec::as_slice).collect();
        mend::close(&self.target, &mut rows, &seen, self.allowed, INFLUENCES);
        mend::stiffen(&self.target, &mut rows, INFLUENCES);
        let joints = joints(&rows);
        let moments = self.rig.maps.iter().zip(&self.growths);
        let maps = moments.map(|(maps, &growth)| self.carried(&joints, maps, growth)).collect();
        let rest: Vec<DVec3> = self.target.positions.iter().map(|&p| alignment.invert(p)).collect();
        warnings.extend(posture::differ(&rest, bent, &rows, &there.areas(&self.target), self.rig.bones));
        (self.skin(self.rig.bones, &rows, maps), joints)
    }

    /// The pieces of the source and of the target, marked where there is a pair.
    fn pieces(&self, pairs: &[Pair]) -> (Pieces, Pieces) {
        let here = pairs.iter().map(|pair| self.source.place[pair.source as usize]);
        let there = pairs.iter().map(|pair| self.target.place[pair.target as usize]);
        (Pieces::new(&self.source, here), Pieces::new(&self.target, there))
    }

    /// The maps of the bones on the target, in its own units, of those on the source, which is so many times as large as at
    /// rest.
    fn carried(&self, joints: &Joints, maps: &[DAffine3], growth: f64) -> Vec<DAffine3> {
        let there: Vec<DAffine3> = joints.carry(maps).iter().map(|map| grown(map, growth)).collect();
        self.outward(&there)
    }

    /// The weights of the source at a place on it.
    fn pulled(&self, foot: Option<Foot>) -> Row {
        let Some(foot) = foot else { return vec![(0, 1.0)] };
        let mut row: Row = Vec::new();
        for (&v, share) in self.source.faces[foot.face as usize].iter().zip(foot.shares) {
            for &(bone, weight) in self.rig.rows.get(v as usize).into_iter().flatten() {
                match row.iter_mut().find(|entry| entry.0 == bone) {
                    Some(entry) => entry.1 += share * weight,
                    None => row.push((bone, share * weight)),
                }
            }
        }
        normalised(row)
    }

    /// The weights of the key points on the source and on the target, from those `before` if there are any.
    fn weights_of(&self, pairs: &[Pair], before: Option<&[Weights; 2]>) -> Result<[Weights; 2], TransferError> {
        let Some([here, there]) = &self.weights else { return Err(TransferError::NoPairs) };
        let [sources, targets] = [|pair: &Pair| pair.source, |pair: &Pair| pair.target]
            .map(|side| pairs.iter().map(side).collect::<Vec<u32>>());
        let parameters = weights::Parameters::default();
        Ok(match before {
            Some([a, b]) => [here.update(a, &sources, &parameters)?, there.update(b, &targets, &parameters)?],
            None => [here.weights(&sources, &parameters)?, there.weights(&targets, &parameters)?],
        })
    }

    fn by_key_points(
        &self,
        method: Method,
        pairs: &[Pair],
        points: Vec<(DVec3, DVec3)>,
        alignment: Alignment,
        [here, weights]: [Weights; 2],
    ) -> (Skin, Carrier) {
        let rows: Vec<f64> = self.source.vertex.iter().flat_map(|&v| here.row(v as usize).iter().copied()).collect();
        let places: Vec<u32> = pairs.iter().map(|pair| self.source.place[pair.source as usize]).collect();
        let fitter = Box::new(biharmonic::fitter(&self.source, &places, &rows, &self.poses));
        let carrier = Carrier::KeyPoints { method, fitter, points, alignment };
        let maps = self.poses.iter().map(|pose| self.by_points(&carrier, pose)).collect();
        let row = |&v: &u32| {
            let shares = weights.row(v as usize).iter().zip(0_u32..).map(|(&w, h)| (h, w));
            let mut row: Row = shares.filter(|entry| entry.1 > 0.0).collect();
            row.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
            normalised(row)
        };
        let rows: Vec<Row> = self.target.vertex.iter().map(row).collect();
        let mut skin = self.skin(pairs.len(), &rows, maps);
        skin.handles = pairs.iter().map(|pair| pair.target).collect();
        (skin, carrier)
    }

    /// The maps of the key points on the target for a pose in the source's unit ball.
    fn by_points(&self, carrier: &Carrier, pose: &[DVec3]) -> Vec<DAffine3> {
        let Carrier::KeyPoints { method, fitter, points, alignment } = carrier else { return Vec::new() };
        let maps = fitter.fit(pose).maps;
        let there: Vec<DAffine3> =
            maps.iter().zip(points).map(|(map, &pair)| carried(*method, *alignment, pair, map)).collect();
        self.outward(&there)
    }

    /// Maps in the target's unit ball as maps in its own units.
    fn outward(&self, maps: &[DAffine3]) -> Vec<DAffine3> {
        let Surface { centre, radius, .. } = self.target;
        let outward = |map: &DAffine3| {
            let translation = radius * map.translation + centre - map.matrix3 * centre;
            DAffine3::from_mat3_translation(map.matrix3, translation)
        };
        maps.iter().map(outward).map(|map| if map.is_finite() { map } else { DAffine3::IDENTITY }).collect()
    }

    /// A skin of all given vertices, of rows for the places.
    fn skin(&self, count: usize, rows: &[Row], maps: Vec<Vec<DAffine3>>) -> Skin {
        let mut strongest = vec![(0.0, 0); count];
        for (row, &vertex) in rows.iter().zip(&self.target.vertex) {
            for &(handle, share) in row {
                if share > strongest[handle as usize].0 {
                    strongest[handle as usize] = (share, vertex);
                }
            }
        }
        Skin {
            handles: strongest.into_iter().map(|best| best.1).collect(),
            rows: self.target.place.iter().map(|&place| rows[place as usize].clone()).collect(),
            maps,
        }
    }
}
