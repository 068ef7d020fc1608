//! The target bent onto the source: from what the pairs say and what the surfaces seem to have in common, or from the pairs
//! alone if that fits better.
//!
//! Few pairs leave much open: where one of them has to do for a head that is held another way, the nearest points are
//! those of the wrong side of it. What proposals would be made all over the figure ([`Proposer::guides`]) is not exact,
//! but tells which way a limb goes; the surfaces say the rest.

use super::alignment::Alignment;
use super::propose::{Proposer, guides};
use super::registration::{ClosestPoints, Effort, Known, LOST, Pin, Registration, closest_points, shape_to_keep};
use super::spline::Spline;
use super::surface::{SurfacePoint, WeldedSurface};
use super::{Pair, TransferError};
use glam::DVec3;
use std::sync::Arc;

/// A [`misfit`] below which no other is sought.
const WELL: f64 = 0.01;
/// Above that, guides are believed if they take the misfit below this share of that of the pairs alone: between figures
/// that have little in common they mislead.
const BETTER: f64 = 0.8;

/// What is needed to bend one target onto one source, and the last result.
pub struct Bending {
    closest: ClosestPoints,
    registration: Registration,
    /// Who gives guides, if anybody does.
    proposer: Option<Arc<Proposer>>,
    last: Option<Bent>,
}

/// A target bent onto its source, both in the source's unit ball: #N positions of its vertices.
struct Bent {
    /// Where they were thought to lie before the points of the pairs came to theirs.
    thought: Vec<DVec3>,
    /// Where they lie.
    at: Vec<DVec3>,
    /// What was thought of some of them.
    hints: Vec<Pin>,
}

impl Bending {
    /// Factors the systems of the target.
    pub fn new(
        source: &WeldedSurface,
        target: &WeldedSurface,
        proposer: Option<Arc<Proposer>>,
    ) -> Result<Self, TransferError> {
        let registration = Registration::new(target).map_err(|_| TransferError::Degenerate { side: "target" })?;
        Ok(Self { closest: ClosestPoints::new(source), registration, proposer, last: None })
    }

    /// #N positions of the target's vertices, bent onto the source. If it is to be `quick`, from the result before, if
    /// there is one.
    pub fn bend(
        &mut self,
        surfaces: (&WeldedSurface, &WeldedSurface),
        pairs: &[Pair],
        alignment: Alignment,
        quick: bool,
    ) -> Vec<DVec3> {
        let (source, target) = surfaces;
        let rest: Vec<DVec3> = target.positions.iter().map(|&p| alignment.invert(p)).collect();
        let pins = pinned(source, target, pairs);
        let bent = match self.last.take().filter(|_| quick) {
            Some(Bent { thought, at, hints }) => {
                let (placed, start) = (displaced(&rest, &thought, &pins), displaced(&rest, &at, &pins));
                let at = self.registration.bend(
                    (source, &self.closest),
                    target,
                    &shape_to_keep(&rest, &placed),
                    start,
                    Known { pins: &pins, hints: &hints },
                    Effort::Last,
                );
                Bent { thought, at, hints }
            }
            None => self.afresh(surfaces, rest, pairs, &pins),
        };
        let at = bent.at.clone();
        self.last = Some(bent);
        at
    }

    /// For each vertex of the bent target the closest point of the source, and how far that is.
    pub fn closest_points(
        &self,
        source: &WeldedSurface,
        target: &WeldedSurface,
        bent: &[DVec3],
    ) -> Vec<Option<(SurfacePoint, f64)>> {
        closest_points(source, &self.closest, target, bent)
    }

    /// What comes of pairs and guides, or of the pairs alone if that is better.
    fn afresh(
        &self,
        surfaces: (&WeldedSurface, &WeldedSurface),
        rest: Vec<DVec3>,
        pairs: &[Pair],
        pins: &[Pin],
    ) -> Bent {
        let (source, target) = surfaces;
        let from = |thought: Vec<DVec3>, hints: Vec<Pin>| {
            let placed = displaced(&rest, &thought, pins);
            let at = self.registration.bend(
                (source, &self.closest),
                target,
                &shape_to_keep(&rest, &placed),
                placed,
                Known { pins, hints: &hints },
                Effort::Whole,
            );
            Bent { thought, at, hints }
        };
        let alone = || from(rest.clone(), Vec::new());
        let guides = guides(self.proposer.as_deref(), pairs);
        if guides.is_empty() {
            return alone();
        }
        let hints = pinned(source, target, &guides);
        let guided = from(smoothed(&rest, &[&hints, pins].concat()), hints);
        let misfit = |bent: &Bent| misfit(source, target, &bent.at);
        let found = misfit(&guided);
        if found < WELL {
            return guided;
        }
        let alone = alone();
        if found < BETTER * misfit(&alone) { guided } else { alone }
    }
}

/// Vertices of the target and where they belong on the source.
fn pinned(source: &WeldedSurface, target: &WeldedSurface, pairs: &[Pair]) -> Vec<Pin> {
    let pin = |pair: &Pair| {
        let [from, to] = [target.place[pair.target as usize], source.place[pair.source as usize]];
        Pin { vertex: from, point: source.positions[to as usize] }
    };
    pairs.iter().map(pin).collect()
}

/// Points displaced smoothly so that pinned ones come to lie where they belong; the spline is over the points at `rest`.
fn displaced(rest: &[DVec3], points: &[DVec3], pins: &[Pin]) -> Vec<DVec3> {
    let missing = |pin: &Pin| (rest[pin.vertex as usize], pin.point - points[pin.vertex as usize]);
    let spline = Spline::new(&pins.iter().map(missing).collect::<Vec<_>>());
    points.iter().zip(rest).map(|(&p, &r)| p + spline.at(r)).collect()
}

/// The same from `rest`, where pins are not exact.
fn smoothed(rest: &[DVec3], pins: &[Pin]) -> Vec<DVec3> {
    let missing = |pin: &Pin| (rest[pin.vertex as usize], pin.point - rest[pin.vertex as usize]);
    let spline = Spline::loose(&pins.iter().map(missing).collect::<Vec<_>>());
    rest.iter().map(|&r| r + spline.at(r)).collect()
}

/// How badly a bent target lies on the source: the mean distance of the source from it, over its area. What is farther than
/// [`LOST`] has no twin, however far it is. That the target has more than the source is no fault.
fn misfit(source: &WeldedSurface, target: &WeldedSurface, bent: &[DVec3]) -> f64 {
    let lying = target.bent(bent.to_vec());
    let found = closest_points(&lying, &ClosestPoints::new(&lying), source, &source.positions);
    let far = found.iter().zip(&source.mass).map(|(on, mass)| mass * on.map_or(LOST, |(_, far)| far.min(LOST)));
    far.sum::<f64>() / source.mass.iter().sum::<f64>().max(f64::MIN_POSITIVE)
}
