//! Which way round the figures lie, and where the source's points come to lie then.
//!
//! That is decided where the rounds end, not by a look at where they begin: a cat's tail has the length of a camel's neck.
//! One more start is where the rounds end the other way round, the target's points looking for places on the source: that
//! often finds what no start from this side finds.

use super::consensus::{Consensus, LAST, Rules};
use super::orientations::{Orientation, half_turns};
use super::point_set::{CONSIDERED, Figures, PointSet, SPREAD};
use super::sampled::SampledSurface;
use super::similarity::Similarity;
use super::starts::{Places, TELLING, WeightedPair, laid, starts};
use crate::transfer::alignment::axis_turns;
use glam::DMat3;

/// How far points listen in the rounds that find the places.
const REACHES: [f64; 7] = [0.2, 0.15, 0.12, 0.1, 0.1, 0.1, 0.1];

/// How much better another turn than none must end: as far as distances tell, an elephant's trunk may be a cat's tail, but
/// figures mostly face the same way.
const CLEARLY: f64 = 0.9;

/// Starts that are tried with every schedule, after one with all.
const PROMISING: usize = 3;

/// A way in which the source may lie, and where its spread ends if nothing is given.
#[derive(Clone, Debug)]
pub struct Placement {
    orientation: Orientation,
    outcome: Outcome,
}

/// Where a set of points ends.
#[derive(Clone, Debug)]
struct Outcome {
    at: Places,
    /// How bad that is.
    badness: f64,
}

impl Outcome {
    fn nowhere(set: &PointSet) -> Self {
        Self { at: vec![None; set.points.len()], badness: f64::MAX }
    }
}

/// The ways in which the figures may lie over each other, the likeliest first: as they are, unless turned they end better.
pub fn placements(figures: Figures) -> Vec<Placement> {
    let set = figures.point_set(SPREAD[1], &[], &[]);
    let placement = |orientation: Orientation| {
        let back = from_the_other_side(figures, &set, orientation);
        Placement { orientation, outcome: outcome(figures, &set, orientation, &[], &back) }
    };
    let mut placements: Vec<Placement> = orientations(figures).into_iter().map(placement).collect();
    let likeliest = likeliest(placements.iter().map(|placement| placement.outcome.badness));
    placements[..=likeliest].rotate_right(1);
    placements
}

/// Where a set of points comes to lie on the target.
pub fn best(figures: Figures, placements: &[Placement], set: &PointSet) -> Places {
    let given: Vec<WeightedPair> =
        set.points.iter().filter_map(|p| Some((1.0, p.place, p.given.as_ref()?.place))).collect();
    let Some(first) = placements.first() else { return vec![None; set.points.len()] };
    let outcome = |placement: &Placement| outcome(figures, set, placement.orientation, &given, &placement.outcome.at);
    match given.len() {
        0 => figures.agree(set, set.placed_from_spread(&first.outcome.at), &REACHES).at,
        1..TELLING => {
            let mut outcomes: Vec<Outcome> = placements.iter().map(outcome).collect();
            outcomes.swap_remove(likeliest(outcomes.iter().map(|outcome| outcome.badness))).at
        }
        _ => {
            let fits_better = |a, b| if misfit(b, &given) < misfit(a, &given) { b } else { a };
            outcome(placements.iter().fold(first, fits_better)).at
        }
    }
}

/// Of outcomes of such badness the first, unless another is clearly better.
fn likeliest(badness: impl Iterator<Item = f64>) -> usize {
    let badness: Vec<f64> = badness.collect();
    let best = (0..badness.len()).min_by(|&a, &b| badness[a].total_cmp(&badness[b])).unwrap_or(0);
    if badness.get(best) < badness.first().map(|first| CLEARLY * first).as_ref() { best } else { 0 }
}

/// Where a set ends if it is laid over the target in one way, or begins with `other` places of its spread.
fn outcome(
    figures: Figures,
    set: &PointSet,
    orientation: Orientation,
    given: &[WeightedPair],
    other: &[Option<u32>],
) -> Outcome {
    let few = set.with_spread(SPREAD[0]);
    let mut starts = starts(figures, &few, orientation, given);
    starts.push(few.placed_from_spread(other));
    starts.sort_unstable();
    starts.dedup();
    let start = best_of(figures, &few, &starts, given.len() >= TELLING);
    let mut consensus = figures.agree(set, set.placed_from(&few, &start.at), &REACHES);
    // Before the round with which badness is measured.
    let at = consensus.at.clone();
    Outcome { at, badness: consensus.badness() }
}

/// Places of a set to begin with: where the other figure's sample is that comes to lie nearest to each.
fn from_the_other_side(figures: Figures, set: &PointSet, orientation: Orientation) -> Places {
    let back = figures.reversed();
    let others = back.point_set(SPREAD[0], &[], &[]);
    let there = best_of(back, &others, &starts(back, &others, orientation.reversed(figures), &[]), false).at;
    let nearest = |sample: u32| {
        let row = figures.source.row(sample);
        let far = (0..).zip(&there).filter_map(|(other, at)| Some((other, row[(*at)? as usize])));
        far.min_by(|a, b| a.1.total_cmp(&b.1)).map(|nearest| nearest.0)
    };
    (0..set.spread as u32).map(nearest).collect()
}

/// The outcome that is best, of several starts. `told`: given pairs tell how the figures lie.
fn best_of(figures: Figures, set: &PointSet, starts: &[Places], told: bool) -> Outcome {
    let schedules: [&[Rules]; 3] = [
        // What is far may be of another length: it would undo a good start.
        &[rules(0.3, 0.75), rules(0.3, 0.75), rules(0.2, 0.75), rules(0.2, 0.75)],
        &[rules(1.0, 0.75), rules(0.5, 0.75), rules(0.3, 0.75), rules(0.2, 0.75)],
        &[rules(1.0, 0.15), rules(1.0, 0.15), rules(0.5, 0.3), rules(0.3, 0.75), rules(0.2, 0.75)],
    ];
    // Where enough is given, the first gains nothing.
    let schedules = if told { &schedules[1..] } else { &schedules };
    let run = |start: &Places, schedule: &[Rules]| run(figures.target, set, start.clone(), schedule);
    let mut outcomes: Vec<(Outcome, &Places)> = starts.iter().map(|start| (run(start, schedules[0]), start)).collect();
    outcomes.sort_by(|a, b| a.0.badness.total_cmp(&b.0.badness));
    let again =
        outcomes.iter().take(PROMISING).flat_map(|(_, start)| schedules[1..].iter().map(|rest| run(start, rest)));
    let again: Vec<Outcome> = again.collect();
    let all = outcomes.into_iter().map(|(outcome, _)| outcome).chain(again);
    all.min_by(|a, b| a.badness.total_cmp(&b.badness)).unwrap_or_else(|| Outcome::nowhere(set))
}

fn rules(reach: f64, place: f64) -> Rules {
    Rules { reach, place, ..LAST }
}

fn run(target: &SampledSurface, set: &PointSet, start: Places, schedule: &[Rules]) -> Outcome {
    let mut consensus = Consensus::new(target, CONSIDERED, &set.points, &set.distances, start);
    schedule.iter().for_each(|rules| consensus.round(rules));
    let badness = consensus.badness();
    Outcome { at: consensus.at, badness }
}

/// How far given pairs stay apart when the turned source is only shifted and made larger or smaller, in squares.
fn misfit(placement: &Placement, given: &[WeightedPair]) -> f64 {
    let motion = Similarity::fit(given.iter().map(|&(w, p, q)| (w, placement.orientation.turn * p, q)));
    let off = |&(_, p, q): &WeightedPair| {
        let (from, to) = (placement.orientation.turn * p - motion.from, q - motion.to);
        (motion.scale * from).distance_squared(to)
    };
    given.iter().map(off).sum()
}

/// The orientations worth trying: as the figures are, turned as the shapes agree best at first sight, and the better of the two
/// turned half round. First sight tells the axes, but not front from back.
fn orientations(figures: Figures) -> Vec<Orientation> {
    let set = figures.point_set(SPREAD[0], &[], &[]);
    let score = |&turn: &DMat3| {
        let start = laid(figures.target, &set, &|p| turn * p, turn);
        run(figures.target, &set, start, &[rules(1.0, 0.75), rules(0.3, 0.75)]).badness
    };
    let best = |turns: Vec<DMat3>| {
        let scored = turns.into_iter().map(|turn| (score(&turn), turn));
        scored.min_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or((f64::MAX, DMat3::IDENTITY))
    };
    let turned = best(axis_turns().skip(1).collect());
    let first = if turned.0 < score(&DMat3::IDENTITY) { turned.1 } else { DMat3::IDENTITY };
    let half_round = best(half_turns().map(|half| half * first).to_vec());
    let mut turns = vec![DMat3::IDENTITY];
    for turn in [turned.1, half_round.1] {
        if !turns.contains(&turn) {
            turns.push(turn);
        }
    }
    turns.into_iter().map(|turn| Orientation::new(figures, turn)).collect()
}
