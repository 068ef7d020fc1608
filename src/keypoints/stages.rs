//! The search from stage to stage: points are added, replaced and moved on one coarse mesh; then moved, exchanged,
//! replaced and put in order on a finer one.
//!
//! Adding the best and then replacing one at a time (§3.5) ends where the first points happen to lead. More points than
//! wanted and then fewer again (P. Pudil, J. Novovičová, J. Kittler. *Floating search methods in feature selection*.
//! Pattern Recognition Letters 15(11), 1994), and steps to vertices that are not among the candidates, make up for it.

use super::coarse::CoarseMesh;
use super::full::Full;
use super::result::{KeyPointError, Replacement, Step};
use super::search::{Search, Set, WORTH};
use super::select::{Choice, is_enough, measured};
use super::welded::WeldedSequence;
use super::{Parameters, Stop};
use crate::crew::Crew;
use crate::stopwatch::Stopwatch;

/// Vertices of the coarse mesh on which sets are sought, and of the one on which they are settled.
const COARSE: [usize; 2] = [600, 900];

/// Candidates that are tried again on the finer mesh: the first that were found, which lie all over.
const AGAIN: usize = 60;

/// Points that are added and taken away again.
const MORE: usize = 3;

/// How often every point may be replaced or moved; three times are many.
const ROUNDS: usize = 20;

/// Points after which progress has come most of the way.
const MANY: f64 = 12.0;

/// Points replaced so far, by their vertices in the sequence.
struct Trail<'a> {
    surface: &'a WeldedSequence,
    replacements: Vec<Replacement>,
}

impl Trail<'_> {
    /// The vertex of the sequence that a vertex of a coarse mesh is.
    fn name(&self, coarse: &CoarseMesh, vertex: u32) -> u32 {
        self.surface.origin[coarse.surface.origin[vertex as usize] as usize]
    }

    fn add(&mut self, coarse: &CoarseMesh, from: u32, to: u32, error: f64) {
        let (from, to) = (self.name(coarse, from), self.name(coarse, to));
        self.replacements.push(Replacement { from, to, error });
    }
}

/// Chooses among candidates, `found` on the surface, and vertices near them.
pub async fn run(
    crew: &impl Crew,
    found: &[u32],
    full: &Full<'_>,
    parameters: &Parameters,
    watch: &mut Stopwatch<'_>,
) -> Result<Choice, KeyPointError> {
    let surface = full.surface;
    let gammas = [parameters.gamma_rotation, parameters.gamma_shear];
    let poses = surface.telling_poses();
    let coarse = CoarseMesh::new(surface, found, &poses, COARSE[0], gammas);
    let mut steps = Vec::new();
    let mut trail = Trail { surface, replacements: Vec::new() };
    watch.begin("adding points", 0.1)?;
    let mut search = Search::new(crew, &coarse, parameters.fit()).await;
    let mut curve = vec![search.set.error];
    let mut more = !is_enough(parameters, &curve);
    loop {
        watch.begin("adding points", 0.1)?;
        while more {
            watch.tell(0.1 + 0.25 * (1.0 - (-(curve.len() as f64) / MANY).exp()))?;
            let Some(mut tried) = search.add(crew).await else { break };
            tried.iter_mut().for_each(|t| t.vertex = surface.origin[t.vertex as usize]);
            let chosen = search.set.members.last().map_or(0, |&m| trail.name(&coarse, m));
            steps.push(Step { tried, chosen, error: search.set.error });
            curve.push(search.set.error);
            more = !is_enough(parameters, &curve);
        }
        watch.begin("replacing points", 0.35)?;
        in_turn(crew, &mut search, Search::replaced, [0.35, 0.42], &coarse, &mut trail, watch).await?;
        watch.begin("moving points", 0.42)?;
        in_turn(crew, &mut search, Search::shifted, [0.42, 0.5], &coarse, &mut trail, watch).await?;
        let count = search.set.members.len();
        let mut kept: Vec<u32> = search.set.members.iter().map(|&m| coarse.surface.origin[m as usize]).collect();
        let others: Vec<u32> = found.iter().copied().filter(|v| !kept.contains(v)).take(AGAIN).collect();
        kept.extend(others);
        let finer = CoarseMesh::new(surface, &kept, &poses, COARSE[1], gammas);
        let mut last = Search::from_points(&finer, parameters.fit(), &finer.candidates[..count]);
        settle(crew, &mut last, &finer, &mut trail, watch).await?;
        watch.begin("ordering points", 0.75)?;
        let (order, estimates) = last.order(crew).await;
        let points: Vec<u32> = order.into_iter().map(|m| trail.name(&finer, m)).collect();
        watch.begin("error curve", 0.8)?;
        let by_error = parameters.points.is_none() && parameters.stop == Stop::Error;
        let enough = by_error.then_some(parameters.error);
        let end = measured(crew, full, &points, Some(&estimates), enough, watch).await?;
        // The coarse mesh may have been too hopeful.
        let reached = end.errors.last().is_none_or(|&error| error <= parameters.error);
        let most = parameters.max.min(coarse.candidates.len());
        if !by_error || reached || points.len() >= most {
            return Ok(Choice { end, steps, replacements: trail.replacements });
        }
        more = true;
    }
}

/// Moves, exchanges and replaces points on the finer mesh, where they come to lie elsewhere.
async fn settle<'a>(
    crew: &impl Crew,
    search: &mut Search<'a>,
    finer: &'a CoarseMesh,
    trail: &mut Trail<'_>,
    watch: &mut Stopwatch<'_>,
) -> Result<(), KeyPointError> {
    watch.begin("moving points", 0.5)?;
    in_turn(crew, search, Search::shifted, [0.5, 0.57], finer, trail, watch).await?;
    watch.begin("exchanging points", 0.57)?;
    search.probe(crew).await;
    let before = search.set.error;
    exchange(crew, search, [0.57, 0.65], finer, trail, watch).await?;
    watch.begin("replacing points", 0.65)?;
    in_turn(crew, search, Search::replaced, [0.65, 0.7], finer, trail, watch).await?;
    if search.set.error < before {
        watch.begin("moving points", 0.7)?;
        in_turn(crew, search, Search::shifted, [0.7, 0.75], finer, trail, watch).await?;
    }
    Ok(())
}

/// Adds some points and takes the same number away, whichever can be spared, if that is for the better. Progress goes
/// `from` … `to`.
async fn exchange(
    crew: &impl Crew,
    search: &mut Search<'_>,
    [from, to]: [f64; 2],
    coarse: &CoarseMesh,
    trail: &mut Trail<'_>,
    watch: &mut Stopwatch<'_>,
) -> Result<(), KeyPointError> {
    let before = search.state();
    let old = search.set.members.clone();
    let error = search.set.error;
    for _ in 0..MORE {
        watch.tell(from)?;
        if search.add(crew).await.is_none() {
            break;
        }
    }
    while search.set.members.len() > old.len() {
        watch.tell(0.5 * (from + to))?;
        if search.remove(crew).await.is_none() {
            break;
        }
    }
    if search.set.error >= error * (1.0 - WORTH) {
        search.restore(before);
        return Ok(());
    }
    let members = &search.set.members;
    let gone = old.iter().filter(|m| !members.contains(m));
    let come = members.iter().filter(|m| !old.contains(m));
    gone.zip(come).for_each(|(&from, &to)| trail.add(coarse, from, to, search.set.error));
    Ok(())
}

/// Replaces or moves points in turn until none can be for the better, while progress goes `from` … `to`.
async fn in_turn<'a>(
    crew: &impl Crew,
    search: &mut Search<'a>,
    attempt: fn(&Search<'a>, usize) -> Option<Set>,
    [from, to]: [f64; 2],
    coarse: &CoarseMesh,
    trail: &mut Trail<'_>,
    watch: &mut Stopwatch<'_>,
) -> Result<(), KeyPointError> {
    let count = search.set.members.len();
    let (mut done, mut place, mut left) = (from, 0, ROUNDS * count);
    // Points that have not been tried since something changed around them.
    let mut open = vec![true; count];
    loop {
        let places: Vec<usize> = (place..place + count).map(|p| p % count).filter(|&p| open[p]).take(left).collect();
        watch.tell(done)?;
        let found = crew.until(places.len(), &|i| attempt(search, places[i]), &Option::is_some).await;
        let tried = &places[..found.len()];
        done += (to - done) * (0.02 * tried.len() as f64).min(1.0);
        left -= tried.len();
        tried.iter().for_each(|&p| open[p] = false);
        let (Some(&last), Some(better)) = (tried.last(), found.into_iter().next_back().flatten()) else { break };
        place = last + 1;
        let old = search.set.members[last];
        for p in search.accept_instead(last, better) {
            open[p] = true;
        }
        trail.add(coarse, old, search.set.members[last], search.set.error);
    }
    Ok(())
}
