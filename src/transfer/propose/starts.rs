//! Where to begin: the figures laid over each other in several ways.

use super::consensus::{Consensus, LAST, Rules};
use super::similarity::Similarity;
use super::surface::Surface;
use super::{COMPANY, CONSIDERED, Crowd, Proposer, tips};
use glam::{DMat3, DVec3};

/// What facing away costs when samples look for the nearest place.
const FACING: f64 = 0.02;

/// How far a stretch to the target's box may go, either way, from its mean.
const STRETCH: [f64; 2] = [0.6, 1.6];

/// How much better another turn than the given one must be.
const CLEARLY: f64 = 0.8;

/// How the source is laid over the target.
#[derive(Clone, Copy, Debug)]
pub struct Orientation {
    /// A turn, then perhaps a stretch to the target's box.
    pub map: DMat3,
}

/// Places of a crowd.
pub(super) struct Start {
    /// #points samples of the target.
    pub at: Vec<Option<u32>>,
    /// How bad it is.
    pub badness: f64,
}

impl Start {
    /// The places in a crowd with more company: the newcomers have none yet.
    pub fn spread(&self, count: usize, company: [usize; 2], asked: usize) -> Vec<Option<u32>> {
        let mut at = vec![None; count];
        let first = company[0].min(self.at.len() - asked);
        at[..first].copy_from_slice(&self.at[..first]);
        at[count - asked..].copy_from_slice(&self.at[self.at.len() - asked..]);
        at
    }
}

/// The start that ends best for a crowd.
pub(super) fn best(proposer: &Proposer, crowd: &Crowd) -> Start {
    let mut starts: Vec<Vec<Option<u32>>> = Vec::new();
    let lay = |map: &dyn Fn(DVec3) -> DVec3, turn: DMat3| laid(&proposer.target, crowd, map, turn);
    for orientation in &proposer.orientations {
        starts.push(lay(&|p| orientation.map * p, orientation.map));
    }
    for orientation in &proposer.orientations {
        let mut at = vec![None; crowd.points.len()];
        for (point, sample) in tips::assign(&proposer.source, &proposer.target, crowd, orientation.map) {
            at[point as usize] = Some(sample);
        }
        starts.push(at);
    }
    let given = crowd.points.iter().filter_map(|p| Some((1.0, p.place, p.given.as_ref()?.place)));
    if given.clone().count() >= 3 {
        let motion = Similarity::fit(given);
        starts.push(lay(&|p| motion.apply(p), motion.rotation));
    }
    let schedules: [&[Rules]; 2] = [
        &[rules(1.0, 0.75), rules(0.5, 0.75), rules(0.3, 0.75), rules(0.2, 0.75)],
        &[rules(1.0, 0.15), rules(1.0, 0.15), rules(0.5, 0.3), rules(0.3, 0.75), rules(0.2, 0.75)],
    ];
    let mut best: Option<Start> = None;
    for start in &starts {
        for schedule in schedules {
            let outcome = run(&proposer.target, crowd, start.clone(), schedule);
            if best.as_ref().is_none_or(|b| outcome.badness < b.badness) {
                best = Some(outcome);
            }
        }
    }
    best.unwrap_or(Start { at: vec![None; crowd.points.len()], badness: f64::MAX })
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

/// The turns worth trying: the figures as they stand, and stretched to the same box; another turn if the shapes clearly
/// agree better so.
pub(super) fn orientations(proposer: &Proposer) -> Vec<Orientation> {
    let crowd = proposer.crowd(COMPANY[0], &[], &[]);
    let score = |turn: DMat3| {
        let start = laid(&proposer.target, &crowd, &|p| turn * p, turn);
        run(&proposer.target, &crowd, start, &[rules(1.0, 0.75), rules(0.3, 0.75)]).badness
    };
    let as_given = score(DMat3::IDENTITY);
    let mut best = (DMat3::IDENTITY, as_given * CLEARLY);
    for turn in turns() {
        let badness = score(turn);
        if badness < best.1 {
            best = (turn, badness);
        }
    }
    let turn = best.0;
    let stretch = stretch(proposer.source.sides, proposer.target.sides, turn);
    vec![Orientation { map: turn }, Orientation { map: DMat3::from_diagonal(stretch) * turn }]
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
