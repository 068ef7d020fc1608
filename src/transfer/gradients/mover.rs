//! One source and one target, ready for any pairs.

use super::carry::{Scene, carry};
use super::operator::gradients;
use crate::linalg::cholesky::NotPositiveDefinite;
use crate::mesh::bvh::Bvh;
use crate::mesh::face::is_whole;
use crate::observer::Observer;
use crate::segmentation;
use crate::sequence::Sequence;
use crate::stopwatch::Stopwatch;
use crate::transfer::alignment::{Alignment, align};
use crate::transfer::checked::{checked, surfaces};
use crate::transfer::correspondence::fit::Marker;
use crate::transfer::correspondence::{Correspondence, Fit, Quality};
use crate::transfer::posed::{Posture, posture};
use crate::transfer::propose::{Proposer, guides};
use crate::transfer::surface::WeldedSurface;
use crate::transfer::{Method, Pair, Parameters, TransferError};
use crate::warning::Warning;
use glam::DVec3;
use std::sync::Arc;

/// Below this coverage a person is told that the fit is poor.
const POOR: f64 = 0.9;
/// The target is turned into the source's posture so often, each time with the correspondence of the time before.
const TURNS: usize = 3;

/// A source in motion and a target.
pub struct Mover {
    parameters: Parameters,
    source: WeldedSurface,
    target: WeldedSurface,
    poses: Vec<Vec<DVec3>>,
    /// Who gives hints, if anybody does.
    proposer: Option<Arc<Proposer>>,
    /// #F part numbers of the source's faces; empty where parts are not needed.
    parts: Vec<u32>,
    seconds: Vec<(&'static str, f64)>,
}

/// The source bent into the target.
#[derive(Clone, Debug, Default)]
pub struct Bent {
    /// At first and after each round #V positions of the source's vertices, in the target's own frame and scale. By
    /// [`Method::Posed`] of the last time that it was bent, into the target in the source's posture.
    pub shapes: Vec<Vec<DVec3>>,
    /// How well it covers the target.
    pub quality: Quality,
}

/// The target in motion.
#[derive(Clone, Debug)]
pub struct Moved {
    /// For each pose of the source #V positions of the target's vertices, in its own frame and scale.
    pub poses: Vec<Vec<DVec3>>,
    /// The source bent into the target.
    pub bent: Bent,
    /// How the target as a whole lies to the source, both in their unit balls.
    pub alignment: Alignment,
    /// The number of parts that were turned into the source's posture (0 by [`Method::Gradients`]).
    pub parts: usize,
    /// What a person should know.
    pub warnings: Vec<Warning>,
    /// Seconds by step.
    pub seconds: Vec<(&'static str, f64)>,
}

impl Mover {
    /// Prepares a source, all of it, and the reference pose of a target.
    pub fn new(
        source: &Sequence,
        target: &Sequence,
        parameters: &Parameters,
        observer: &mut dyn Observer,
    ) -> Result<Self, TransferError> {
        Self::with_proposer(source, target, parameters, None, observer)
    }

    /// As [`Mover::new`], where there is already a proposer for these two meshes.
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
        let source = acting.as_ref();
        let still = target.reference_alone();
        let [here, there] = surfaces(source, &still)?;
        if gradients(&here).iter().all(Option::is_none) {
            return Err(TransferError::Degenerate { side: "source" });
        }
        let poses: Vec<Vec<DVec3>> = source.poses().iter().map(|pose| here.unit(&pose.positions)).collect();
        steps.end("surfaces", 0.2)?;
        let proposer = proposer.or_else(|| Proposer::of(source, &still).ok().map(Arc::new));
        steps.end("common places", 0.5)?;
        let parts = if parameters.method == Method::Posed {
            parts_of(source, &here, &mut |stage: &'static str, done: f64| steps.at(stage, 0.5 + 0.5 * done))?
        } else {
            Vec::new()
        };
        steps.end("parts", 1.0)?;
        Ok(Self {
            parameters: parameters.clone(),
            source: here,
            target: there,
            poses,
            proposer,
            parts,
            seconds: steps.stop(),
        })
    }

    /// Seconds of the steps of the preparation.
    pub fn seconds(&self) -> &[(&'static str, f64)] {
        &self.seconds
    }

    /// Transfers all poses by the given pairs.
    pub fn transfer(&self, pairs: &[Pair], observer: &mut dyn Observer) -> Result<Moved, TransferError> {
        let mut steps = Stopwatch::new(observer);
        let mut warnings = Vec::new();
        let pairs = checked(&self.source, &self.target, pairs, &mut warnings)?;
        let markers = self.places(&pairs);
        let hints = self.places(&guides(self.proposer.as_deref(), &pairs));
        let points: Vec<(DVec3, DVec3)> = markers
            .iter()
            .map(|&[here, there]| (self.source.positions[here as usize], self.target.positions[there as usize]))
            .collect();
        let alignment = align(&points);
        let (posture, correspondence, shapes) = self.postured(alignment, [&markers, &hints], &mut steps)?;
        let pins = self.pins(&mut warnings);
        let scene = Scene {
            source: &self.source,
            poses: &self.poses,
            target: &self.target,
            alignment,
            correspondence: &correspondence,
            turns: &posture.turns,
            turned: &posture.positions,
            pins: &pins,
            doubt: self.parameters.doubt,
        };
        let poses = carry(&scene).map_err(degenerate)?;
        steps.end("poses", 1.0)?;
        if correspondence.quality.coverage < POOR {
            warnings.push(Warning::new(
                "poor-fit",
                format!(
                    "bent into the target by these pairs, the source covers {:.0} % of it only; more pairs help, at the tips \
                     of limbs and where they part",
                    100.0 * correspondence.quality.coverage
                ),
            ));
        }
        Ok(Moved {
            poses: poses.into_iter().map(|pose| self.outward(&self.target, &pose)).collect(),
            bent: Bent {
                shapes: shapes.iter().map(|shape| self.outward(&self.source, shape)).collect(),
                quality: correspondence.quality,
            },
            alignment,
            parts: posture.parts,
            warnings,
            seconds: steps.stop(),
        })
    }

    /// The places of pairs of vertices on the source and on the target.
    fn places(&self, pairs: &[Pair]) -> Vec<[u32; 2]> {
        let places = |pair: &Pair| [self.source.place[pair.source as usize], self.target.place[pair.target as usize]];
        pairs.iter().map(places).collect()
    }

    /// The places of the target that are pinned, ascending.
    fn pins(&self, warnings: &mut Vec<Warning>) -> Vec<u32> {
        let place = |&vertex: &u32| self.target.place.get(vertex as usize).copied();
        let mut pins: Vec<u32> = self.parameters.pinned.iter().filter_map(place).collect();
        if pins.len() < self.parameters.pinned.len() {
            warnings.push(Warning::new("no-such-pin", "some pinned vertices do not exist on the target".to_owned()));
        }
        pins.sort_unstable();
        pins.dedup();
        pins
    }

    /// The target in the source's posture, by [`Method::Posed`], and the source bent into it: posture and correspondence
    /// tell each other in turn. The shapes are those of the last bending.
    fn postured(
        &self,
        alignment: Alignment,
        both: [&[[u32; 2]]; 2],
        steps: &mut Stopwatch<'_>,
    ) -> Result<(Posture, Correspondence, Vec<Vec<DVec3>>), TransferError> {
        let rounds = if self.parameters.method == Method::Posed { TURNS } else { 0 };
        let share = |round: usize, done: f64| 0.8 * (round as f64 + done) / (rounds + 1) as f64;
        let mut posture = Posture::unturned(&self.target);
        let mut round = 0;
        loop {
            let told = |done: f64| steps.at("correspondence", share(round, done));
            let (correspondence, shapes) = self.correspond(alignment, both, &posture.positions, told)?;
            steps.end("correspondence", share(round, 1.0))?;
            if round == rounds {
                return Ok((posture, correspondence, shapes));
            }
            round += 1;
            posture = self.posture(&correspondence, alignment)?;
            steps.end("posture", share(round, 0.0))?;
        }
    }

    /// Bends the source into the target at `positions` (#N) by places that belong together and others that may, and pairs
    /// their faces; all shapes on the way.
    fn correspond(
        &self,
        alignment: Alignment,
        both: [&[[u32; 2]]; 2],
        positions: &[DVec3],
        mut progress: impl FnMut(f64) -> bool,
    ) -> Result<(Correspondence, Vec<Vec<DVec3>>), TransferError> {
        let target = self.target.bent(positions.to_vec());
        let rest: Vec<DVec3> = self.source.positions.iter().map(|&p| alignment.apply(p)).collect();
        let [markers, hints] = both.map(|places| -> Vec<Marker> {
            places.iter().map(|&[here, there]| (here, target.positions[there as usize])).collect()
        });
        let fitting = &self.parameters.fitting;
        let fit = Fit::new(&self.source, rest.clone(), &markers, fitting).map_err(degenerate_source)?;
        let tree = Bvh::new(&target.faces, &target.positions, |_| true);
        let mut shapes = vec![rest];
        let mut going = true;
        let bent = fit
            .bend(&tree, fitting, &hints, |shape, done| {
                shapes.push(shape.to_vec());
                going = progress(0.9 * done);
                going
            })
            .map_err(degenerate_source)?;
        if !going {
            return Err(TransferError::Cancelled);
        }
        let sound: Vec<bool> = gradients(&self.source).iter().map(Option::is_some).collect();
        Ok((Correspondence::new(&self.source, &bent, &sound, &target, &tree), shapes))
    }

    fn posture(&self, correspondence: &Correspondence, alignment: Alignment) -> Result<Posture, TransferError> {
        posture(&self.source, &self.parts, &self.target, correspondence, alignment).map_err(degenerate)
    }

    /// #V positions in the target's units of the given vertices of a surface, of #N in the target's unit ball.
    fn outward(&self, surface: &WeldedSurface, positions: &[DVec3]) -> Vec<DVec3> {
        let WeldedSurface { centre, radius, .. } = self.target;
        surface.place.iter().map(|&place| radius * positions[place as usize] + centre).collect()
    }
}

fn degenerate(_: NotPositiveDefinite) -> TransferError {
    TransferError::Degenerate { side: "target" }
}

fn degenerate_source(_: NotPositiveDefinite) -> TransferError {
    TransferError::Degenerate { side: "source" }
}

/// #F part numbers of the faces of a sequence's surface, by the segmentation.
fn parts_of(
    source: &Sequence,
    surface: &WeldedSurface,
    observer: &mut dyn Observer,
) -> Result<Vec<u32>, TransferError> {
    let parts = segmentation::segment(source, &segmentation::Parameters::default(), observer);
    let labels = match parts {
        Ok(parts) => parts.labels,
        Err(segmentation::SegmentationError::Cancelled) => return Err(TransferError::Cancelled),
        Err(_) => return Err(TransferError::Degenerate { side: "source" }),
    };
    let kept = |face: &[u32; 3]| is_whole(&face.map(|v| surface.place[v as usize]));
    Ok(source.faces().iter().zip(labels).filter(|(face, _)| kept(face)).map(|(_, label)| label).collect())
}
