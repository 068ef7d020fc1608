//! The transfer between one source and one target, ready for any pairs.

use super::alignment::align;
use super::by_bones::BoneTransfer;
use super::by_key_points::KeyPointTransfer;
use super::checked::{checked, surfaces};
use super::propose::Proposer;
use super::surface::WeldedSurface;
use super::{Pair, Parameters, Transfer, TransferError};
use crate::observer::Observer;
use crate::sequence::Sequence;
use crate::stopwatch::Stopwatch;
use crate::warning::Warning;
use glam::{DAffine3, DVec3};
use std::sync::Arc;

/// What does not change while pairs are placed: what is known of both meshes, and the factored systems.
pub struct Prepared {
    source: WeldedSurface,
    target: WeldedSurface,
    family: Family,
    seconds: Vec<(&'static str, f64)>,
}

/// What handles the target has.
enum Family {
    Bones(Box<BoneTransfer>),
    KeyPoints(Box<KeyPointTransfer>),
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
        parameters.check()?;
        let mut steps = Stopwatch::new(observer);
        let acting = source.acting();
        let sequences = (acting.as_ref(), target);
        let [here, there] = surfaces(sequences.0, target)?;
        steps.end("surfaces", 0.1)?;
        let family = if parameters.method.by_bones() {
            let bones = BoneTransfer::new(sequences, (&here, &there), parameters.bones, proposer, &mut steps)?;
            Family::Bones(Box::new(bones))
        } else {
            Family::KeyPoints(Box::new(KeyPointTransfer::new(sequences, &here, parameters.method, &mut steps)?))
        };
        Ok(Self { source: here, target: there, family, seconds: steps.stop() })
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
    /// positions of the source's vertices. [`Skin::posed`](super::Skin::posed) puts the target there. `None` before there
    /// was a result, or if positions are missing or not finite.
    pub fn maps(&self, pose: &[DVec3]) -> Option<Vec<DAffine3>> {
        if pose.len() != self.source.place.len() || !pose.iter().all(|p| p.is_finite()) {
            return None;
        }
        let pose = self.source.unit(pose);
        match &self.family {
            Family::Bones(bones) => bones.maps((&self.source, &self.target), pose),
            Family::KeyPoints(points) => points.maps(&self.target, &pose),
        }
    }

    fn run(&mut self, pairs: &[Pair], quick: bool, observer: &mut dyn Observer) -> Result<Transfer, TransferError> {
        let mut steps = Stopwatch::new(observer);
        let Self { source, target, family, .. } = self;
        let (source, target) = (&*source, &*target);
        let mut warnings: Vec<Warning> = match family {
            Family::Bones(bones) => bones.rough().into_iter().collect(),
            Family::KeyPoints(_) => Vec::new(),
        };
        let pairs = checked(source, target, pairs, &mut warnings)?;
        let points: Vec<(DVec3, DVec3)> =
            pairs.iter().map(|pair| (source.at(pair.source), target.at(pair.target))).collect();
        let alignment = align(&points);
        let (skin, bones, source_error) = match family {
            Family::Bones(bones) => {
                let told = (&mut steps, &mut warnings);
                let skin = bones.transfer((source, target), &pairs, alignment, quick, told)?;
                (skin, bones.count(), bones.error())
            }
            Family::KeyPoints(handles) => {
                let skin = handles.transfer((source, target), &pairs, points, alignment, quick, &mut steps)?;
                (skin, 0, 0.0)
            }
        };
        steps.end("maps", 1.0)?;
        Ok(Transfer { skin, alignment, bones, source_error, warnings, seconds: steps.stop() })
    }
}
