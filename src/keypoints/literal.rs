//! Algorithm 1 by the letter, on the mesh itself: the oracle of the search.
//!
//! Every candidate at every step: weights of all handles, fits of all poses. Groups are found once for every set that is
//! accepted.

use super::full::Full;
use super::result::{Replacement, Step, Tried};
use crate::crew::Crew;
use crate::weights::WeightsError;

/// A replacement must gain more than this share of the error, and than this: below it, errors are rounding.
const WORTH: f64 = 1e-6;
const ROUNDING: f64 = 1e-12;

/// How often every point may be replaced; three times are many.
const ROUNDS: usize = 20;

/// What the letter finds.
pub struct Found {
    /// Vertices of the sequence, in the order chosen.
    pub points: Vec<u32>,
    /// Step by step.
    pub steps: Vec<Step>,
    /// In the order they were made.
    pub replacements: Vec<Replacement>,
}

/// Runs both stages. `enough` hears the number of points and the error and says whether to stop adding. `None` where
/// `keep_going` says so.
pub async fn search(
    crew: &impl Crew,
    full: &Full<'_>,
    candidates: &[u32],
    enough: &mut dyn FnMut(usize, f64) -> bool,
    keep_going: &mut dyn FnMut() -> bool,
) -> Result<Option<Found>, WeightsError> {
    let mut points: Vec<u32> = candidates.iter().take(1).copied().collect();
    let (mut steps, mut replacements) = (Vec::new(), Vec::new());
    let (mut groups, mut error) = accepted(crew, full, &points).await?;
    while !enough(points.len(), error) {
        let rest: Vec<u32> = candidates.iter().copied().filter(|c| !points.contains(c)).collect();
        let tried = tried(crew, full, &points, &rest, &groups, keep_going).await?;
        let Some(tried) = tried else { return Ok(None) };
        let Some(best) = best(&tried) else { break };
        points.push(best.vertex);
        (groups, error) = accepted(crew, full, &points).await?;
        steps.push(Step { tried, chosen: best.vertex, error: best.error });
    }
    for _ in 0..ROUNDS {
        let before = replacements.len();
        for place in 0..points.len() {
            let mut others = points.clone();
            let gone = others.remove(place);
            let rest: Vec<u32> = candidates.iter().copied().filter(|c| !points.contains(c)).collect();
            let tried = tried(crew, full, &others, &rest, &groups, keep_going).await?;
            let Some(tried) = tried else { return Ok(None) };
            if let Some(best) = best(&tried).filter(|best| best.error < error * (1.0 - WORTH) - ROUNDING) {
                let mut next = points.clone();
                next[place] = best.vertex;
                let (next_groups, next_error) = accepted(crew, full, &next).await?;
                // New groups change the error a little: only what is better with them is an improvement.
                if next_error < error {
                    (points, groups, error) = (next, next_groups, next_error);
                    replacements.push(Replacement { from: gone, to: best.vertex, error });
                }
            }
        }
        if replacements.len() == before {
            break;
        }
    }
    Ok(Some(Found { points, steps, replacements }))
}

/// The groups of a set and its error with them.
async fn accepted(crew: &impl Crew, full: &Full<'_>, points: &[u32]) -> Result<(Vec<u32>, f64), WeightsError> {
    let weights = full.weights(crew, points, None).await?;
    let groups = full.groups(&weights);
    let error = full.error(&weights, &groups);
    Ok((groups, error))
}

/// The error of the set with each of `rest`; `None` where `keep_going` says so.
async fn tried(
    crew: &impl Crew,
    full: &Full<'_>,
    points: &[u32],
    rest: &[u32],
    groups: &[u32],
    keep_going: &mut dyn FnMut() -> bool,
) -> Result<Option<Vec<Tried>>, WeightsError> {
    let mut tried = Vec::with_capacity(rest.len());
    let mut set = points.to_vec();
    for &vertex in rest {
        if !keep_going() {
            return Ok(None);
        }
        set.push(vertex);
        let weights = full.weights(crew, &set, None).await?;
        tried.push(Tried { vertex, error: full.error(&weights, groups) });
        set.pop();
    }
    Ok(Some(tried))
}

fn best(tried: &[Tried]) -> Option<Tried> {
    tried.iter().copied().reduce(|best, t| if t.error < best.error { t } else { best })
}
