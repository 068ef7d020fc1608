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
use super::thin::Thin;
use super::watch::Watch;
use super::{Parameters, Stop};
use crate::observer::Observer;
use crate::sequence::Sequence;
use crate::warning::Warning;

/// Vertices of the coarse mesh on which sets are tried.
const COARSE: usize = 600;

/// Meshes of more vertices than this have the first part of their error curve measured on about so many.
const MEASURED: usize = 6_000;

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

    watch.begin("coarse mesh", 0.05)?;
    let thin = (surface.reference.len() > 2 * MEASURED).then(|| Thin::new(sequence, &surface, &found, MEASURED));
    let full = prepared(sequence, &surface, parameters)?;
    let mut scale = Scale { full, thin: None };
    if let Some(thin) = &thin {
        scale.thin = Some((thin, prepared(&thin.sequence, &thin.surface, parameters)?));
    }
    let choice = if surface.poses.is_empty() {
        let message = "the mesh has no other pose: its points are spread evenly over the surface";
        warnings.push(Warning::new("still-mesh", message));
        let count = parameters.points.unwrap_or(STILL).min(parameters.max);
        let points: Vec<u32> = names.iter().take(count).copied().collect();
        Choice { errors: vec![0.0; points.len()], points, ..Choice::default() }
    } else if parameters.literal {
        by_the_letter(&scale, parameters, &names, &mut watch)?
    } else {
        let gammas = [parameters.gamma_rotation, parameters.gamma_shear];
        let coarse = Coarse::new(&surface, &found, &poses::spread(&surface), COARSE, gammas);
        on_the_coarse_mesh(&coarse, &scale, parameters, &mut watch)?
    };

    watch.begin("fits", 0.95)?;
    let Choice { points, mut errors, steps, replacements } = choice;
    let fitted = scale.full.fitted(scale.full.weights(&points, None)?);
    // The same, but for a mesh whose curve was measured on a thinner one.
    if let Some(last) = errors.last_mut() {
        *last = fitted.error;
    }
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

fn prepared<'a>(
    sequence: &Sequence,
    surface: &'a Surface,
    parameters: &Parameters,
) -> Result<Full<'a>, KeyPointError> {
    let gammas = [parameters.gamma_rotation, parameters.gamma_shear];
    let features = surface.features(&poses::spread(surface), gammas);
    Ok(Full::new(sequence, surface, features, parameters.fit())?)
}

/// What a search chose.
#[derive(Default)]
struct Choice {
    points: Vec<u32>,
    errors: Vec<f64>,
    steps: Vec<Step>,
    replacements: Vec<Replacement>,
}

/// What errors are measured on.
struct Scale<'a> {
    full: Full<'a>,
    thin: Option<(&'a Thin, Full<'a>)>,
}

impl Scale<'_> {
    /// The error with the first 1, 2, … points, up to the first that is at most `enough`.
    fn curve(&self, points: &[u32], enough: f64, watch: &mut Watch) -> Result<Vec<f64>, KeyPointError> {
        let (full, points) = match &self.thin {
            Some((thin, full)) => (full, points.iter().map(|&v| thin.number(v)).collect()),
            None => (&self.full, points.to_vec()),
        };
        let mut errors = Vec::new();
        let mut before = None;
        for count in 1..=points.len() {
            watch.tell(0.8 + 0.15 * count as f64 / points.len() as f64)?;
            let weights = full.weights(&points[..count], before.as_ref())?;
            let error = full.error(&weights, &full.groups(&weights));
            errors.push(error);
            if error <= enough {
                break;
            }
            before = Some(weights);
        }
        Ok(errors)
    }
}

fn by_the_letter(
    scale: &Scale,
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
    let found = literal::search(&scale.full, candidates, &mut enough, &mut || watch.go_on(0.1))?;
    let found = found.ok_or(KeyPointError::Cancelled)?;
    watch.begin("error curve", 0.8)?;
    let errors = scale.curve(&found.points, -1.0, watch)?;
    Ok(Choice { points: found.points, errors, steps: found.steps, replacements: found.replacements })
}

fn on_the_coarse_mesh(
    coarse: &Coarse,
    scale: &Scale,
    parameters: &Parameters,
    watch: &mut Watch,
) -> Result<Choice, KeyPointError> {
    let surface = scale.full.surface;
    let name = |member: usize| surface.origin[coarse.surface.origin[coarse.candidates[member] as usize] as usize];
    let mut choice = Choice::default();
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
            choice.steps.push(Step { tried, chosen, error: search.set.error });
            curve.push(search.set.error);
            more = !is_enough(parameters, &curve);
        }
        watch.begin("replacing points", 0.4)?;
        replace(&mut search, &name, &mut choice.replacements, watch)?;
        watch.begin("ordering points", 0.76)?;
        let order = search.order(&mut || watch.go_on(0.78)).ok_or(KeyPointError::Cancelled)?;
        choice.points = order.into_iter().map(name).collect();
        watch.begin("error curve", 0.8)?;
        let by_error = parameters.points.is_none() && parameters.stop == Stop::Error;
        let enough = if by_error { parameters.error } else { -1.0 };
        choice.errors = scale.curve(&choice.points, enough, watch)?;
        choice.points.truncate(choice.errors.len());
        // The coarse mesh may have been too hopeful.
        let reached = choice.errors.last().is_none_or(|&error| error <= parameters.error);
        let count = search.set.members.len();
        if !by_error || reached || count >= parameters.max.min(coarse.candidates.len()) {
            return Ok(choice);
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
    while idle < count {
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
