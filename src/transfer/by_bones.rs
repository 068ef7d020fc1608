//! The transfer by near-rigid bones: the source's motion is taken apart, and set into the target joint on joint.

use super::alignment::Alignment;
use super::bending::Bending;
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
use super::surface::{SurfacePoint, WeldedSurface};
use super::{Pair, Skin, TransferError};
use crate::sequence::Sequence;
use crate::stopwatch::Stopwatch;
use crate::warning::Warning;
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

/// The source's bones and what finds the target on the source.
pub struct BoneTransfer {
    rig: Rig,
    /// How many times as large as at rest the source is in each pose; the bones do not know of that.
    growths: Vec<f64>,
    /// By how much edges of the target may become longer.
    allowed: f64,
    bending: Bending,
    /// How motions of the bones become those on the target, since the last result.
    joints: Option<Joints>,
}

impl BoneTransfer {
    /// Takes the source apart into `most` bones at most, and prepares the target to be bent onto it. If there is no
    /// `proposer` for these two, one is made.
    pub fn new(
        (source, target): (&Sequence, &Sequence),
        (here, there): (&WeldedSurface, &WeldedSurface),
        most: usize,
        proposer: Option<Arc<Proposer>>,
        steps: &mut Stopwatch<'_>,
    ) -> Result<Self, TransferError> {
        let poses: Vec<Vec<DVec3>> = source.poses().iter().map(|pose| here.unit(&pose.positions)).collect();
        let growths: Vec<f64> = poses.iter().map(|pose| growth(here, pose)).collect();
        let poses: Vec<Vec<DVec3>> =
            poses.into_iter().zip(&growths).map(|(pose, &growth)| shrunk(pose, growth)).collect();
        let proposer = proposer.or_else(|| Proposer::of(source, target).ok().map(Arc::new));
        steps.end("common places", 0.3)?;
        let bending = Bending::new(here, there, proposer)?;
        steps.end("systems", 0.5)?;
        let rig = Rig::new(here, &poses, most);
        steps.end("bones", 0.9)?;
        let telling: Vec<&[DVec3]> = rig.telling.iter().filter_map(|&p| Some(poses.get(p)?.as_slice())).collect();
        let allowed = mend::allowed(here, &telling);
        steps.end("search", 1.0)?;
        Ok(Self { rig, growths, allowed, bending, joints: None })
    }

    /// How many bones there are.
    pub fn count(&self) -> usize {
        self.rig.bones
    }

    /// Mean distance of the source's own skin from the source, in its radii.
    pub fn error(&self) -> f64 {
        self.rig.error
    }

    /// Warns of a source that bones do not follow well.
    pub fn rough(&self) -> Option<Warning> {
        (self.rig.error > ROUGH).then(|| {
            let message = format!(
                "the source bends everywhere: its bones ({}) follow it to {:.1} % of its radius only, and the target \
                 follows no better",
                self.rig.bones,
                100.0 * self.rig.error
            );
            Warning::new("not-rigid", message)
        })
    }

    /// The target as a skin over the bones in all poses; if it is to be `quick`, from the result before.
    pub fn transfer(
        &mut self,
        (source, target): (&WeldedSurface, &WeldedSurface),
        pairs: &[Pair],
        alignment: Alignment,
        quick: bool,
        (steps, warnings): (&mut Stopwatch<'_>, &mut Vec<Warning>),
    ) -> Result<Skin, TransferError> {
        let bent = self.bending.bend((source, target), pairs, alignment, quick);
        steps.end("correspondence", 0.8)?;
        let (here, there) = pieces(source, target, pairs);
        let rows = self.rows((source, target), (&here, &there), alignment, &bent, if quick { FEWER } else { 1 });
        let joints = Joints::new(source, &self.rig, target, &rows, alignment);
        let moments = self.rig.maps.iter().zip(&self.growths);
        let maps = moments.map(|(maps, &growth)| carried(target, &joints, maps, growth)).collect();
        let rest: Vec<DVec3> = target.positions.iter().map(|&p| alignment.invert(p)).collect();
        warnings.extend(posture::differ(&rest, &bent, &rows, &there.areas(target), self.rig.bones));
        self.joints = Some(joints);
        Ok(Skin::new(target, self.rig.bones, &rows, maps))
    }

    /// The maps of the bones on the target for any other pose in the source's unit ball; `None` before there was a result.
    pub fn maps(&self, (source, target): (&WeldedSurface, &WeldedSurface), pose: Vec<DVec3>) -> Option<Vec<DAffine3>> {
        let joints = self.joints.as_ref()?;
        let growth = growth(source, &pose);
        Some(carried(target, joints, &self.rig.follow(source, &shrunk(pose, growth)), growth))
    }

    /// #N rows of bones on the target, `bent` onto the source. Every `step`th of the telling poses is looked at for tears.
    fn rows(
        &self,
        (source, target): (&WeldedSurface, &WeldedSurface),
        pieces: (&Pieces, &Pieces),
        alignment: Alignment,
        bent: &[DVec3],
        step: usize,
    ) -> Vec<Row> {
        let closest = self.bending.closest_points(source, target, bent);
        let lying: Vec<Option<SurfacePoint>> = closest.iter().map(|found| found.map(|(on, _)| on)).collect();
        let mut rows: Vec<Row> = lying.iter().map(|&on| self.pulled(source, on)).collect();
        let lost: Vec<bool> = closest.iter().map(|found| found.is_none_or(|(_, far)| far > LOST)).collect();
        fill(target, &mut rows, &lost);
        let rounds = (SMOOTHING * target.len() as f64 / SMOOTHED).min(MOST_SMOOTHING);
        rows = averaged(target, rows, INFLUENCES, rounds);
        layers::lay((source, target), pieces, &lying, &mut rows, INFLUENCES);
        let first = Joints::new(source, &self.rig, target, &rows, alignment);
        let seen = self.rig.telling.iter().step_by(step).filter_map(|&pose| self.rig.maps.get(pose));
        let seen: Vec<Vec<DAffine3>> = seen.map(|maps| first.carry(maps)).collect();
        let seen: Vec<&[DAffine3]> = seen.iter().map(Vec::as_slice).collect();
        mend::close(target, &mut rows, &seen, self.allowed, INFLUENCES);
        mend::stiffen(target, &mut rows, INFLUENCES);
        rows
    }

    /// The weights of the source at a place on it.
    fn pulled(&self, source: &WeldedSurface, on: Option<SurfacePoint>) -> Row {
        let Some(on) = on else { return vec![(0, 1.0)] };
        let mut row: Row = Vec::new();
        for (&v, share) in source.faces[on.face as usize].iter().zip(on.shares) {
            for &(bone, weight) in self.rig.rows.get(v as usize).into_iter().flatten() {
                match row.iter_mut().find(|entry| entry.0 == bone) {
                    Some(entry) => entry.1 += share * weight,
                    None => row.push((bone, share * weight)),
                }
            }
        }
        normalised(row)
    }
}

/// The pieces of the source and of the target, marked where there is a pair.
fn pieces(source: &WeldedSurface, target: &WeldedSurface, pairs: &[Pair]) -> (Pieces, Pieces) {
    let here = pairs.iter().map(|pair| source.place[pair.source as usize]);
    let there = pairs.iter().map(|pair| target.place[pair.target as usize]);
    (Pieces::new(source, here), Pieces::new(target, there))
}

/// The maps of the bones on the target, in its own units, of those on the source, which is so many times as large as at
/// rest.
fn carried(target: &WeldedSurface, joints: &Joints, maps: &[DAffine3], growth: f64) -> Vec<DAffine3> {
    let there: Vec<DAffine3> = joints.carry(maps).iter().map(|map| grown(map, growth)).collect();
    target.outward(&there)
}
