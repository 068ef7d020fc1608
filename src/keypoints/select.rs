//! The steps of the selection in their order.

use super::candidates::candidates;
use super::coarse::Coarse;
use super::full::Full;
use super::geodesic::Graph;
use super::literal;
use super::poses;
use super::result::{Fitted, KeyPointError, KeyPoints, Replacement, Step};
use super::search::Search;
use super::surface::Surface;
use super::watch::Watch;
use super::{Parameters, Stop};
use crate::observer::Observer;
use crate::sequence::Sequence;
use crate::warning::Warning;

/// Vertices of the coarse mesh on which sets are tried.
const COARSE: usize = 600;

/// Points of a mesh that does not move, if nobody says how many.
const STILL: usize = 12;

/// A point is worth it, where the curve is to become flat, if it takes this share off the error…
const STEEP: f64 = 0.04;

/// …and below this error nobody sees any difference.
const INVISIBLE: f64 = 1e-3;

/// Chooses key points.
pub fn select(
    sequence: &Sequence,
    parameters: &Parameters,
    observer: &mut dyn Observer,
) -> Result<KeyPoints, KeyPointError> {
    parameters.check()?;
    let mut watch = Watch::new(observer);
    watch.begin("welding", 0.0)?;
    let surface = Surface::new(sequence);
    if surface.faces.is_empty() {
        return Err(KeyPointError::NoFaces);
    }
    watch.begin("candidates", 0.02)?;
    let graph = Graph::new(&surface.faces, &surface.reference);
    let found = candidates(&surface, &graph, parameters.candidates, parameters.seed);
    let names: Vec<u32> = found.iter().map(|&c| surface.origin[c as usize]).collect();
    let mut warnings = Vec::new();
    let gammas = [parameters.gamma_rotation, parameters.gamma_shear];

    let choice = if surface.poses.is_empty() {
        let message = "the mesh has no other pose: its points are spread evenly over the surface";
        warnings.push(Warning::new("still-mesh", message));
        let count = parameters.points.unwrap_or(STILL).min(parameters.max);
        Choice { points: names.iter().take(count).copied().collect(), ..Choice::default() }
    } else if parameters.literal {
        watch.begin("literal search", 0.05)?;
        let full = Full::new(sequence, &surface, surface.features(gammas), parameters.fit())?;
        by_the_letter(&full, parameters, &names, &mut watch)?
    } else {
        watch.begin("coarse mesh", 0.05)?;
        let coarse = Coarse::new(&surface, &found, &poses::spread(&surface), COARSE, gammas);
        on_the_coarse_mesh(&coarse, &surface, parameters, &mut watch)?
    };

    watch.begin("weights", 0.8)?;
    let full = Full::new(sequence, &surface, surface.features(gammas), parameters.fit())?;
    let mut points = choice.points;
    let mut errors = Vec::new();
    let mut weights = None;
    for count in 1..=points.len() {
        watch.tell(0.8 + 0.15 * count as f64 / points.len() as f64)?;
        let of_these = full.weights(&points[..count], weights.as_ref())?;
        errors.push(full.error(&of_these, &full.groups(&of_these)));
        weights = Some(of_these);
        let enough = errors[count - 1] <= parameters.error && parameters.stop == Stop::Error;
        if enough && parameters.points.is_none() && !surface.poses.is_empty() {
            points.truncate(count);
            break;
        }
    }
    watch.begin("fits", 0.95)?;
    let weights = match weights {
        Some(weights) => weights,
        None => full.weights(&points, None)?,
    };
    let fitted = full.fitted(weights);
    if let Some(wanted) = parameters.points.filter(|&wanted| points.len() < wanted) {
        let message = format!("only {} points instead of {wanted}: there are no more candidates", points.len());
        warnings.push(Warning::new("few-candidates", message));
    }
    warnings.extend(fitted.weights.warnings.iter().cloned());
    Ok(KeyPoints {
        key_points: points,
        errors,
        candidates: names,
        steps: choice.steps,
        replacements: choice.replacements,
        weights: fitted.weights,
        groups: fitted.groups,
        fits: fitted.fits,
        warnings,
        seconds: watch.stop(),
    })
}

/// Weights, groups and fits for points given by hand (vertices of the sequence, no two at one place).
pub fn fit_all(sequence: &Sequence, points: &[u32], parameters: &Parameters) -> Result<Fitted, KeyPointError> {
    parameters.check()?;
    let surface = Surface::new(sequence);
    let gammas = [parameters.gamma_rotation, parameters.gamma_shear];
    let full = Full::new(sequence, &surface, surface.features(gammas), parameters.fit())?;
    let weights = full.weights(points, None)?;
    Ok(full.fitted(weights))
}

/// What a search chose.
#[derive(Default)]
struct Choice {
    points: Vec<u32>,
    steps: Vec<Step>,
    replacements: Vec<Replacement>,
}

fn by_the_letter(
    full: &Full,
    parameters: &Parameters,
    candidates: &[u32],
    watch: &mut Watch,
) -> Result<Choice, KeyPointError> {
    let mut curve = Vec::new();
    let mut enough = |_: usize, error: f64| {
        curve.push(error);
        is_enough(parameters, &curve)
    };
    let found = literal::search(full, candidates, &mut enough, &mut || watch.go_on(0.1))?;
    let found = found.ok_or(KeyPointError::Cancelled)?;
    Ok(Choice { points: found.points, steps: found.steps, replacements: found.replacements })
}

fn on_the_coarse_mesh(
    coarse: &Coarse,
    surface: &Surface,
    parameters: &Parameters,
    watch: &mut Watch,
) -> Result<Choice, KeyPointError> {
    let name = |member: usize| surface.origin[coarse.surface.origin[coarse.candidates[member] as usize] as usize];
    let mut search = Search::new(coarse, parameters.fit());
    let mut choice = Choice::default();
    watch.begin("adding points", 0.1)?;
    let mut curve = vec![search.set.error];
    let likely = parameters.points.unwrap_or(STILL) as f64;
    while !is_enough(parameters, &curve) {
        let done = 0.1 + 0.3 * (1.0 - (-(curve.len() as f64) / likely).exp());
        let Some(mut tried) = search.add(&mut || watch.go_on(done)) else {
            watch.tell(done)?;
            break;
        };
        tried.iter_mut().for_each(|t| t.vertex = surface.origin[t.vertex as usize]);
        let chosen = search.set.members.last().map_or(0, |&m| name(m));
        choice.steps.push(Step { tried, chosen, error: search.set.error });
        curve.push(search.set.error);
    }
    watch.begin("replacing points", 0.4)?;
    let mut done = 0.4;
    let mut idle = 0;
    while idle < search.set.members.len() {
        for place in 0..search.set.members.len() {
            done += (0.75 - done) * 0.02;
            let from = search.set.members[place];
            let better = search.replace(place, &mut || watch.go_on(done)).ok_or(KeyPointError::Cancelled)?;
            idle = if better { 0 } else { idle + 1 };
            if better {
                let (from, to) = (name(from), name(search.set.members[place]));
                choice.replacements.push(Replacement { from, to, error: search.set.error });
            }
            if idle >= search.set.members.len() {
                break;
            }
        }
    }
    watch.begin("ordering points", 0.76)?;
    let order = search.order(&mut || watch.go_on(0.78)).ok_or(KeyPointError::Cancelled)?;
    choice.points = order.into_iter().map(name).collect();
    Ok(choice)
}

/// Whether there are points enough; `curve` is the error after each.
fn is_enough(parameters: &Parameters, curve: &[f64]) -> bool {
    if let Some(points) = parameters.points {
        return curve.len() >= points;
    }
    let error = curve.last().copied().unwrap_or(f64::INFINITY);
    let flat = |n: usize| curve.len() > n && curve[curve.len() - n - 1] - error < n as f64 * STEEP * error;
    let enough = match parameters.stop {
        Stop::Error => error <= parameters.error,
        Stop::Flat => error <= INVISIBLE || flat(2),
    };
    enough || curve.len() >= parameters.max
}
