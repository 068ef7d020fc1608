//! Where to begin: the figures laid over each other in several ways, also pulled to given pairs and to tips.

use super::consensus::{Consensus, LAST, Rules};
use super::similarity::Similarity;
use super::surface::Surface;
use super::{COMPANY, CONSIDERED, Crowd, Proposer, tips};
use glam::{DMat3, DVec3};

/// What facing away costs when samples look for the nearest place.
const FACING: f64 = 0.02;

/// How far a stretch to the target's box may go, either way, from its mean.
const STRETCH: [f64; 2] = [0.6, 1.6];

/// Within this distance of a pair, what it says counts about the same.
const PULL: f64 = 0.2;

/// What a squared distance between the places of tips costs, where one of distances along the surface costs one: so that
/// either settles which tip is which. A cat's tail has the length of a camel's neck, but is not where that is.
const TIPS_BY_PLACE: [f64; 2] = [0.2, 4.0];

/// How much better another turn than none must end.
const CLEARLY: f64 = 0.85;

/// From so many given pairs on, they tell how the figures stand.
const TELLING: usize = 2;

/// A point of the source and its place on the target, after a weight.
type Pair = (f64, DVec3, DVec3);

/// A way in which the source may stand, to be laid over the target.
#[derive(Clone, Copy, Debug)]
pub struct Stand {
    /// One of the turns of a cube.
    turn: DMat3,
    /// The turn, and the turn with a stretch to the target's box.
    maps: [DMat3; 2],
}

impl Stand {
    fn new(proposer: &Proposer, turn: DMat3) -> Self {
        let stretch = stretch(proposer.source.sides, proposer.target.sides, turn);
        Self { turn, maps: [turn, DMat3::from_diagonal(stretch) * turn] }
    }
}

/// Places of a crowd.
pub(super) struct Start {
    /// #points samples of the target.
    pub at: Vec<Option<u32>>,
    /// How bad it is.
    pub badness: f64,
}

impl Start {
    /// No places at all.
    fn nowhere(crowd: &Crowd) -> Self {
        Self { at: vec![None; crowd.points.len()], badness: f64::MAX }
    }

    /// The places in a crowd with more company: the newcomers have none yet.
    pub fn spread(&self, count: usize, company: [usize; 2], asked: usize) -> Vec<Option<u32>> {
        let mut at = vec![None; count];
        let first = company[0].min(self.at.len() - asked);
        at[..first].copy_from_slice(&self.at[..first]);
        at[count - asked..].copy_from_slice(&self.at[self.at.len() - asked..]);
        at
    }
}

/// The start that ends best for a crowd, among those of the stand that given pairs speak for. Where too few are given,
/// the figures stand as they are, unless turned they end clearly better.
pub(super) fn best(proposer: &Proposer, crowd: &Crowd) -> Start {
    let given: Vec<Pair> = crowd.points.iter().filter_map(|p| Some((1.0, p.place, p.given.as_ref()?.place))).collect();
    let ends = |stand: &Stand| best_of(proposer, crowd, stand, &given);
    let Some((as_they_are, turned)) = proposer.stands.split_first() else { return Start::nowhere(crowd) };
    if given.len() >= TELLING {
        let fits_better = |a, b| if misfit(b, &given) < misfit(a, &given) { b } else { a };
        return ends(turned.iter().fold(as_they_are, fits_better));
    }
    let first = ends(as_they_are);
    let clearly_better = |end: &Start| end.badness < CLEARLY * first.badness;
    turned.iter().map(ends).find(clearly_better).unwrap_or(first)
}

/// How far given pairs stay apart when the turned source is only shifted and made larger or smaller, in squares.
fn misfit(stand: &Stand, given: &[Pair]) -> f64 {
    let motion = Similarity::fit(given.iter().map(|&(w, p, q)| (w, stand.turn * p, q)));
    let off = |&(_, p, q): &Pair| {
        let (from, to) = (stand.turn * p - motion.from, q - motion.to);
        (motion.scale * from).distance_squared(to)
    };
    given.iter().map(off).sum()
}

/// By how much pairs move what is near them once `map` has laid the source over the target: without it, the legs
/// of a creature whose neck is much longer lie nearest to the other's neck.
///
/// Inverse distance weighting (D. Shepard, *A two-dimensional interpolation function for irregularly-spaced data*,
/// Proceedings of the 23rd ACM National Conference, 1968, pp. 517–524), softened.
fn pull(pairs: &[Pair], map: DMat3, place: DVec3) -> DVec3 {
    let weight = |from: DVec3| (place.distance_squared(from) + PULL * PULL).powi(-2);
    let total: f64 = pairs.iter().map(|&(_, from, _)| weight(from)).sum();
    pairs.iter().map(|&(_, from, to)| weight(from) / total * (to - map * from)).sum()
}

/// The start that ends best, of those that lay the figures over each other in one way.
fn best_of(proposer: &Proposer, crowd: &Crowd, stand: &Stand, given: &[Pair]) -> Start {
    let schedules: [&[Rules]; 3] = [
        &[rules(1.0, 0.75), rules(0.5, 0.75), rules(0.3, 0.75), rules(0.2, 0.75)],
        &[rules(1.0, 0.15), rules(1.0, 0.15), rules(0.5, 0.3), rules(0.3, 0.75), rules(0.2, 0.75)],
        // What is far may be of another length: it would undo a good start.
        &[rules(0.3, 0.75), rules(0.3, 0.75), rules(0.2, 0.75), rules(0.2, 0.75)],
    ];
    // Where enough is given, the rest gains nothing.
    let schedules = if given.len() < TELLING { &schedules } else { &schedules[..2] };
    let mut best: Option<Start> = None;
    for start in starts(proposer, crowd, stand, given) {
        for schedule in schedules {
            let outcome = run(&proposer.target, crowd, start.clone(), schedule);
            if best.as_ref().is_none_or(|b| outcome.badness < b.badness) {
                best = Some(outcome);
            }
        }
    }
    best.unwrap_or_else(|| Start::nowhere(crowd))
}

/// Places (#points samples of the target) to begin with, in one way in which the source may stand.
fn starts(proposer: &Proposer, crowd: &Crowd, stand: &Stand, given: &[Pair]) -> Vec<Vec<Option<u32>>> {
    let mut starts = Vec::new();
    let laid = |map: DMat3, pairs: &[Pair]| laid(&proposer.target, crowd, &|p| map * p + pull(pairs, map, p), map);
    let by_place = if given.len() < TELLING { &TIPS_BY_PLACE[..] } else { &TIPS_BY_PLACE[..1] };
    for map in stand.maps {
        starts.push(laid(map, &[]));
        if !given.is_empty() {
            starts.push(laid(map, given));
        }
        for &by_place in by_place {
            let tips = tips::assign(&proposer.source, &proposer.target, crowd, map, by_place);
            let mut at = vec![None; crowd.points.len()];
            tips.iter().for_each(|&(point, sample)| at[point as usize] = Some(sample));
            starts.push(at);
            if given.len() < TELLING {
                let tip = |&(point, sample): &(u32, u32)| {
                    (1.0, crowd.points[point as usize].place, proposer.target.places[sample as usize])
                };
                starts.push(laid(map, &given.iter().copied().chain(tips.iter().map(tip)).collect::<Vec<_>>()));
            }
        }
    }
    starts
}

fn rules(reach: f64, place: f64) -> Rules {
    Rules { reach, place, ..LAST }
}

fn run(target: &Surface, crowd: &Crowd, start: Vec<Option<u32>>, schedule: &[Rules]) -> Start {
    let mut consensus = Consensus::new(target, CONSIDERED, &crowd.points, &crowd.distances, start);
    schedule.iter().for_each(|rules| consensus.round(rules));
    let badness = consensus.badness();
    Start { at: consensus.at, badness }
}

/// The stands worth trying: first the figures as they are, then, if the shapes agree better so at first sight, turned.
///
/// First sight is not enough to decide: a cat's tail has the length of a camel's neck.
pub(super) fn stands(proposer: &Proposer) -> Vec<Stand> {
    let crowd = proposer.crowd(COMPANY[0], &[], &[]);
    let score = |turn: DMat3| {
        let start = laid(&proposer.target, &crowd, &|p| turn * p, turn);
        run(&proposer.target, &crowd, start, &[rules(1.0, 0.75), rules(0.3, 0.75)]).badness
    };
    let mut best = (DMat3::IDENTITY, score(DMat3::IDENTITY));
    for turn in turns() {
        let badness = score(turn);
        if badness < best.1 {
            best = (turn, badness);
        }
    }
    let turned = (best.0 != DMat3::IDENTITY).then_some(best.0);
    [DMat3::IDENTITY].into_iter().chain(turned).map(|turn| Stand::new(proposer, turn)).collect()
}

/// The 23 turns of a cube other than none.
fn turns() -> Vec<DMat3> {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];
    let all = axes.iter().flat_map(|&x| axes.iter().map(move |&y| (x, y)));
    let square = all.filter(|(x, y)| x.dot(*y) == 0.0).map(|(x, y)| DMat3::from_cols(x, y, x.cross(y)));
    square.filter(|turn| *turn != DMat3::IDENTITY).collect()
}

/// Factors along the axes that bring a turned box to another, within bounds about their geometric mean.
fn stretch(from: DVec3, to: DVec3, turn: DMat3) -> DVec3 {
    let from = (turn * from).abs();
    let factor = |a: f64, b: f64| if a > 1e-6 && b > 1e-6 { b / a } else { 1.0 };
    let factors = DVec3::new(factor(from.x, to.x), factor(from.y, to.y), factor(from.z, to.z));
    let mean = factors.element_product().cbrt();
    (factors / mean).clamp(DVec3::splat(STRETCH[0]), DVec3::splat(STRETCH[1])) * mean
}

/// For each point, the considered sample of the target nearest to where a map puts it, that faces the same way.
fn laid(target: &Surface, crowd: &Crowd, map: &dyn Fn(DVec3) -> DVec3, turn: DMat3) -> Vec<Option<u32>> {
    let considered = CONSIDERED.min(target.len());
    let nearest = |point: &super::Point| {
        let (place, normal) = (map(point.place), (turn * point.normal).normalize_or_zero());
        let cost = |s: u32| {
            target.places[s as usize].distance_squared(place) + FACING * (1.0 - target.normals[s as usize].dot(normal))
        };
        let costs = (0..considered as u32).map(|s| (s, cost(s)));
        costs.min_by(|a, b| a.1.total_cmp(&b.1)).map(|best| best.0)
    };
    crowd.points.iter().map(nearest).collect()
}
