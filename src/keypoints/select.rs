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
use crate::weights::Weights;

/// Vertices of the coarse mesh on which sets are tried.
const COARSE: usize = 600;

/// Meshes of more vertices than this have their error curve measured on the coarse mesh, but for its end.
const MEASURED: usize = 1_500;

/// Points of a mesh that does not move, if nobody says how many.
const STILL: usize = 12;

/// How often every point may be replaced; three times are many.
const ROUNDS: usize = 20;

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

    watch.begin("coarse mesh", 0.05)?;
    let full = prepared(sequence, &surface, parameters)?;
    let choice = if surface.poses.is_empty() {
        let message = "the mesh has no other pose: its points are spread evenly over the surface";
        warnings.push(Warning::new("still-mesh", message));
        let count = parameters.points.unwrap_or(STILL).min(parameters.max);
        let points: Vec<u32> = names.iter().take(count).copied().collect();
        let end = Measured { errors: vec![0.0; points.len()], weights: full.weights(&points, None)?, points };
        Choice { end, steps: Vec::new(), replacements: Vec::new() }
    } else if parameters.literal {
        by_the_letter(&full, parameters, &names, &mut watch)?
    } else {
        let gammas = [parameters.gamma_rotation, parameters.gamma_shear];
        let coarse = Coarse::new(&surface, &found, &poses::spread(&surface), COARSE, gammas);
        on_the_coarse_mesh(&coarse, &full, parameters, &mut watch)?
    };

    watch.begin("fits", 0.95)?;
    let Choice { end: Measured { points, errors, weights }, steps, replacements } = choice;
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
        steps,
        replacements,
        weights: fitted.weights,
        groups: fitted.groups,
        fits: fitted.fits,
        rounds: fitted.rounds,
        warnings,
        seconds: watch.stop(),
    })
}

/// Weights, groups and fits for points given by hand (vertices of the sequence, no two at one place).
pub fn fit_all(sequence: &Sequence, points: &[u32], parameters: &Parameters) -> Result<Fitted, KeyPointError> {
    parameters.check()?;
    let surface = Surface::new(sequence);
    let full = prepared(sequence, &surface, parameters)?;
    let weights = full.weights(points, None)?;
    Ok(full.fitted(weights))
}

fn prepared<'a>(sequence: &Sequence, surface: &'a Surface, parameters: &Parameters) -> Result<Full<'a>, KeyPointError> {
    let gammas = [parameters.gamma_rotation, parameters.gamma_shear];
    let features = surface.features(&poses::spread(surface), gammas);
    Ok(Full::new(sequence, surface, features, parameters.fit())?)
}

/// What a search chose.
struct Choice {
    end: Measured,
    steps: Vec<Step>,
    replacements: Vec<Replacement>,
}

/// Points in their order, the error with the first 1, 2, … of them, and the weights of all.
struct Measured {
    points: Vec<u32>,
    errors: Vec<f64>,
    weights: Weights,
}

/// The error curve of points in their order.
///
/// On large meshes, `estimates` of it are taken from the coarse mesh, by the factor by which they are wrong at the end;
/// the end itself is always measured on the mesh. With a sufficient error `enough`, the curve ends there.
fn measured(
    full: &Full,
    points: &[u32],
    estimates: Option<&[f64]>,
    enough: Option<f64>,
    watch: &mut Watch,
) -> Result<Measured, KeyPointError> {
    let mut errors = Vec::new();
    let mut weights = None;
    let mut from = 1;
    if let Some(estimates) = estimates.filter(|_| full.surface.reference.len() > MEASURED) {
        let all = full.weights(points, None)?;
        let error = full.error(&all, &full.groups(&all));
        let factor = estimates.last().map_or(1.0, |&e| if e > 0.0 { error / e } else { 1.0 });
        errors.extend(estimates.iter().map(|e| e * factor));
        let sufficient = |e: &f64| enough.is_some_and(|enough| *e <= enough);
        from = errors.iter().position(sufficient).map_or(points.len(), |place| place + 1);
        if from == points.len() {
            return Ok(Measured { points: points.to_vec(), errors, weights: all });
        }
        errors.truncate(from - 1);
        weights = Some(all);
    }
    for count in from..=points.len() {
        watch.tell(0.8 + 0.15 * count as f64 / points.len() as f64)?;
        let of_these = full.weights(&points[..count], weights.as_ref())?;
        let error = full.error(&of_these, &full.groups(&of_these));
        errors.push(error);
        weights = Some(of_these);
        if enough.is_some_and(|enough| error <= enough) {
            break;
        }
    }
    let weights = match weights {
        Some(weights) => weights,
        None => full.weights(points, None)?,
    };
    Ok(Measured { points: points[..errors.len()].to_vec(), errors, weights })
}

fn by_the_letter(
    full: &Full,
    parameters: &Parameters,
    candidates: &[u32],
    watch: &mut Watch,
) -> Result<Choice, KeyPointError> {
    watch.begin("literal search", 0.05)?;
    let mut curve = Vec::new();
    let mut enough = |_: usize, error: f64| {
        curve.push(error);
        is_enough(parameters, &curve)
    };
    let found = literal::search(full, candidates, &mut enough, &mut || watch.go_on(0.1))?;
    let found = found.ok_or(KeyPointError::Cancelled)?;
    watch.begin("error curve", 0.8)?;
    let end = measured(full, &found.points, None, None, watch)?;
    Ok(Choice { end, steps: found.steps, replacements: found.replacements })
}

fn on_the_coarse_mesh(
    coarse: &Coarse,
    full: &Full,
    parameters: &Parameters,
    watch: &mut Watch,
) -> Result<Choice, KeyPointError> {
    let surface = full.surface;
    let name = |member: usize| surface.origin[coarse.surface.origin[coarse.candidates[member] as usize] as usize];
    let (mut steps, mut replacements) = (Vec::new(), Vec::new());
    watch.begin("adding points", 0.1)?;
    let mut search = Search::new(coarse, parameters.fit());
    let mut curve = vec![search.set.error];
    let mut more = !is_enough(parameters, &curve);
    loop {
        watch.begin("adding points", 0.1)?;
        while more {
            let done = 0.1 + 0.3 * (1.0 - (-(curve.len() as f64) / STILL as f64).exp());
            let Some(mut tried) = search.add(&mut || watch.go_on(done)) else {
                watch.tell(done)?;
                break;
            };
            tried.iter_mut().for_each(|t| t.vertex = surface.origin[t.vertex as usize]);
            let chosen = search.set.members.last().map_or(0, |&m| name(m));
            steps.push(Step { tried, chosen, error: search.set.error });
            curve.push(search.set.error);
            more = !is_enough(parameters, &curve);
        }
        watch.begin("replacing points", 0.4)?;
        replace(&mut search, &name, &mut replacements, watch)?;
        watch.begin("ordering points", 0.76)?;
        let (order, estimates) = search.order(&mut || watch.go_on(0.78)).ok_or(KeyPointError::Cancelled)?;
        let points: Vec<u32> = order.into_iter().map(name).collect();
        watch.begin("error curve", 0.8)?;
        let by_error = parameters.points.is_none() && parameters.stop == Stop::Error;
        let end = measured(full, &points, Some(&estimates), by_error.then_some(parameters.error), watch)?;
        // The coarse mesh may have been too hopeful.
        let reached = end.errors.last().is_none_or(|&error| error <= parameters.error);
        let most = parameters.max.min(coarse.candidates.len());
        if !by_error || reached || points.len() >= most {
            return Ok(Choice { end, steps, replacements });
        }
        more = true;
    }
}

/// Replaces points in turn until none can be replaced for the better.
fn replace(
    search: &mut Search,
    name: &dyn Fn(usize) -> u32,
    replacements: &mut Vec<Replacement>,
    watch: &mut Watch,
) -> Result<(), KeyPointError> {
    let count = search.set.members.len();
    let (mut done, mut idle, mut place) = (0.4, 0, 0);
    for _ in 0..ROUNDS * count {
        if idle >= count {
            break;
        }
        done += (0.75 - done) * 0.02;
        let from = search.set.members[place];
        let better = search.replace(place, &mut || watch.go_on(done)).ok_or(KeyPointError::Cancelled)?;
        if better {
            let (from, to) = (name(from), name(search.set.members[place]));
            replacements.push(Replacement { from, to, error: search.set.error });
        }
        idle = if better { 0 } else { idle + 1 };
        place = (place + 1) % count;
    }
    Ok(())
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
