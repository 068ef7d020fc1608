//! The steps of the selection in their order.

use super::candidates::candidates;
use super::full::Full;
use super::geodesic;
use super::literal;
use super::result::{Fitted, KeyPointError, KeyPoints, Replacement, Step};
use super::stages;
use super::welded::WeldedSequence;
use super::{Parameters, Stop};
use crate::crew::{Crew, Threads, at_once};
use crate::observer::Observer;
use crate::sequence::Sequence;
use crate::stopwatch::Stopwatch;
use crate::warning::Warning;
use crate::weights::Weights;

/// Meshes of more vertices than this have their error curve measured on the coarse mesh, but for its end.
const MEASURED: usize = 1_500;

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
    at_once(select_by(&Threads, sequence, parameters, observer))
}

/// [`select`], whose trials a crew shares out.
pub async fn select_by(
    crew: &impl Crew,
    sequence: &Sequence,
    parameters: &Parameters,
    observer: &mut dyn Observer,
) -> Result<KeyPoints, KeyPointError> {
    parameters.check()?;
    let mut watch = Stopwatch::new(observer);
    watch.begin("welding", 0.0)?;
    let surface = WeldedSequence::new(sequence);
    if surface.faces.is_empty() {
        return Err(KeyPointError::NoFaces);
    }
    watch.begin("candidates", 0.02)?;
    let graph = geodesic::graph(&surface.faces, &surface.reference);
    let found = candidates(&surface, &graph, parameters.candidates, parameters.seed);
    let mut names: Vec<u32> = found.iter().map(|&c| surface.origin[c as usize]).collect();
    let mut warnings = Vec::new();

    watch.begin("coarse mesh", 0.05)?;
    let full = prepared(sequence, &surface, parameters)?;
    let choice = if surface.poses.is_empty() {
        let message = "the mesh has no other pose: its points are spread evenly over the surface";
        warnings.push(Warning::new("still-mesh", message));
        let count = parameters.points.unwrap_or(STILL.min(parameters.max));
        let points: Vec<u32> = names.iter().take(count).copied().collect();
        let end =
            Measured { errors: vec![0.0; points.len()], weights: full.weights(crew, &points, None).await?, points };
        Choice { end, steps: Vec::new(), replacements: Vec::new() }
    } else if parameters.literal {
        by_the_letter(crew, &full, parameters, &names, &mut watch).await?
    } else {
        stages::run(crew, &found, &full, parameters, &mut watch).await?
    };

    watch.begin("fits", 0.95)?;
    let Choice { end: Measured { points, errors, weights }, steps, replacements } = choice;
    let fitted = full.fitted(weights);
    if let Some(wanted) = parameters.points.filter(|&wanted| points.len() < wanted) {
        let message = format!("only {} points instead of {wanted}: there are no more candidates", points.len());
        warnings.push(Warning::new("few-candidates", message));
    }
    warnings.extend(fitted.weights.warnings.iter().cloned());
    let moved: Vec<u32> = points.iter().copied().filter(|p| !names.contains(p)).collect();
    names.extend(moved);
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
    at_once(fit_all_by(&Threads, sequence, points, parameters))
}

/// [`fit_all`], whose weights a crew shares out.
pub async fn fit_all_by(
    crew: &impl Crew,
    sequence: &Sequence,
    points: &[u32],
    parameters: &Parameters,
) -> Result<Fitted, KeyPointError> {
    parameters.check()?;
    let surface = WeldedSequence::new(sequence);
    let full = prepared(sequence, &surface, parameters)?;
    let weights = full.weights(crew, points, None).await?;
    Ok(full.fitted(weights))
}

fn prepared<'a>(
    sequence: &Sequence,
    surface: &'a WeldedSequence,
    parameters: &Parameters,
) -> Result<Full<'a>, KeyPointError> {
    let gammas = [parameters.gamma_rotation, parameters.gamma_shear];
    let features = surface.features(&surface.telling_poses(), gammas);
    Ok(Full::new(sequence, surface, features, parameters.fit())?)
}

/// What a search chose.
pub struct Choice {
    /// The points.
    pub end: Measured,
    /// What was tried when points were added.
    pub steps: Vec<Step>,
    /// What was replaced.
    pub replacements: Vec<Replacement>,
}

/// Points in their order, the error with the first 1, 2, … of them, and the weights of all.
pub struct Measured {
    /// Vertices of the sequence.
    pub points: Vec<u32>,
    /// Errors.
    pub errors: Vec<f64>,
    /// Weights.
    pub weights: Weights,
}

/// The error curve of points in their order.
///
/// On large meshes, `estimates` of it are taken from the coarse mesh, by the factor by which they are wrong at the end;
/// the end itself is always measured on the mesh. With a sufficient error `enough`, the curve ends there.
pub async fn measured(
    crew: &impl Crew,
    full: &Full<'_>,
    points: &[u32],
    estimates: Option<&[f64]>,
    enough: Option<f64>,
    watch: &mut Stopwatch<'_>,
) -> Result<Measured, KeyPointError> {
    let mut errors = Vec::new();
    let mut weights = None;
    let mut from = 1;
    if let Some(estimates) = estimates.filter(|_| full.surface.reference.len() > MEASURED) {
        let all = full.weights(crew, points, None).await?;
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
        let of_these = full.weights(crew, &points[..count], weights.as_ref()).await?;
        let error = full.error(&of_these, &full.groups(&of_these));
        errors.push(error);
        weights = Some(of_these);
        if enough.is_some_and(|enough| error <= enough) {
            break;
        }
    }
    let weights = match weights {
        Some(weights) => weights,
        None => full.weights(crew, points, None).await?,
    };
    Ok(Measured { points: points[..errors.len()].to_vec(), errors, weights })
}

async fn by_the_letter(
    crew: &impl Crew,
    full: &Full<'_>,
    parameters: &Parameters,
    candidates: &[u32],
    watch: &mut Stopwatch<'_>,
) -> Result<Choice, KeyPointError> {
    watch.begin("literal search", 0.05)?;
    let mut curve = Vec::new();
    let mut enough = |_: usize, error: f64| {
        curve.push(error);
        is_enough(parameters, &curve)
    };
    let found = literal::search(crew, full, candidates, &mut enough, &mut || watch.go_on(0.1)).await?;
    let found = found.ok_or(KeyPointError::Cancelled)?;
    watch.begin("error curve", 0.8)?;
    let end = measured(crew, full, &found.points, None, None, watch).await?;
    Ok(Choice { end, steps: found.steps, replacements: found.replacements })
}

/// Whether there are points enough; `curve` is the error after each.
pub fn is_enough(parameters: &Parameters, curve: &[f64]) -> bool {
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
