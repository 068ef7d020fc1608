//! From a posable model to a sequence: choosing the clip, sampling it, welding seams.

use super::clip::Motion;
use super::model::Model;
use crate::import::seams::{drop_collapsed, extent, weld_seams};
use crate::import::{File, ImportError, Imported, Options, Reference, Sampling, Up, last_part};
use crate::sequence::{Pose, Sequence, SequenceError};
use crate::warning::Warning;
use glam::DVec3;
use std::collections::BTreeMap;

/// A clip moves the mesh if a vertex moves by more than this share of the diagonal.
const MOVES: f64 = 1e-6;
/// Times at which a clip is looked at to see whether it moves the mesh.
const PROBES: usize = 9;

/// Reads a glTF or GLB as a sequence. Its buffers are looked for among `files`.
pub fn open(file: &File, files: &[File], options: &Options) -> Result<Imported, ImportError> {
    let mut warnings = Vec::new();
    let mut model = Model::read(file, files, options.look, &mut warnings)?;
    if model.faces().is_empty() {
        return Err(ImportError(format!(
            "{} shows no triangle mesh; Sinew needs one, with an animation if it is to move",
            model.name()
        )));
    }
    let clip = choose_clip(&model, options, &mut warnings)?;
    let times = match clip.and_then(|clip| model.motions().get(clip)) {
        Some(motion) => sample_times(motion, &model.movers(), options.sampling)?,
        None => Vec::new(),
    };
    // The poses, the reference, and the copies that welding makes.
    model.budget.poses(model.vertices() as u64, times.len() as u64 + 2)?;
    let start = clip.and_then(|clip| model.motions().get(clip)).map_or(0.0, |m| m.start);
    let mut poses: Vec<Pose> = times
        .iter()
        .map(|&time| Pose {
            name: format!("{:.3} s", time - start),
            time: time - start,
            positions: clip.map_or_else(Vec::new, |clip| model.pose(clip, time)),
        })
        .collect();
    let mut reference = match options.reference {
        Reference::Bind => model.bind(),
        Reference::Nodes => model.rest(),
        Reference::FirstFrame => poses.first().map_or_else(|| model.rest(), |pose| pose.positions.clone()),
    };
    let mut faces = model.faces().to_vec();
    let clips = model.clips();
    let name = model.name().to_owned();
    let look = model.take_look();
    drop(model);
    let vertices = reference.len() as u32;
    let welded =
        options.weld.then(|| weld_seams(&mut faces, &mut reference, &mut poses, Some(&mut warnings))).flatten();
    let mut look = look.map(|(mut look, normals)| {
        look.settle(welded.unwrap_or_else(|| (0..vertices).collect()), &normals);
        look
    });
    let input_faces = faces.len();
    let stay = drop_collapsed(&mut faces, &mut warnings);
    if let (Some(look), Some(stay)) = (&mut look, &stay) {
        look.keep_faces(stay);
    }
    if faces.is_empty() {
        return Err(ImportError(format!(
            "all triangles of {name} are collapsed to a point or a line; export it again"
        )));
    }
    let wrong = |error: SequenceError| ImportError(format!("{name}: {error}; the file is damaged, export it again"));
    let mut sequence = Sequence::new(last_part(&name), faces, reference, poses).map_err(wrong)?;
    if let Some(stay) = stay {
        sequence = sequence.with_polygons(stay).map_err(wrong)?;
    }
    Ok(Imported { sequence, up: Up::Y, clips, clip, input_faces, look, warnings: at_most_a_few(warnings) })
}

/// At most a few warnings of each kind, so that a strange file does not bury a person in them.
fn at_most_a_few(warnings: Vec<Warning>) -> Vec<Warning> {
    const FEW: usize = 4;
    let mut seen: BTreeMap<&'static str, usize> = BTreeMap::new();
    let mut kept = Vec::new();
    for warning in warnings {
        let count = seen.entry(warning.code).or_default();
        *count += 1;
        if *count <= FEW {
            kept.push(warning);
        }
    }
    for (code, more) in seen.into_iter().filter_map(|(code, count)| Some((code, count.checked_sub(FEW)?))) {
        if more > 0 {
            kept.push(Warning::new(code, format!("{more} more notes of the kind \"{code}\" are not listed.")));
        }
    }
    kept
}

fn choose_clip(model: &Model, options: &Options, warnings: &mut Vec<Warning>) -> Result<Option<usize>, ImportError> {
    let motions = model.motions();
    if let Some(wanted) = &options.clip {
        let by_name = motions.iter().position(|m| &m.name == wanted);
        let by_number = || wanted.parse().ok().filter(|&number: &usize| number < motions.len());
        let Some(clip) = by_name.or_else(by_number) else {
            let names: Vec<String> = motions.iter().take(20).map(|m| format!("\"{}\"", m.name)).collect();
            let there_are =
                if names.is_empty() { "it has none".into() } else { format!("it has {}", names.join(", ")) };
            return Err(ImportError(format!("{} has no clip \"{wanted}\"; {there_are}", model.name())));
        };
        if !moves(model, clip) {
            warnings.push(Warning::new(
                "clip-moves-nothing",
                format!("Clip \"{}\" moves no vertex of the mesh.", motions[clip].name),
            ));
        }
        return Ok(Some(clip));
    }
    let found = (0..motions.len()).find(|&clip| moves(model, clip));
    if found.is_none() {
        let what = match motions.len() {
            0 => "The file has no animation, so the mesh stands still; an animation is what is missing to find parts.",
            _ => "No clip of the file moves the mesh, so it stands still; a clip that moves it is what is missing.",
        };
        warnings.push(Warning::new("no-animation", what));
    }
    Ok(found)
}

/// True if a clip moves some vertex.
fn moves(model: &Model, clip: usize) -> bool {
    let Some(motion) = model.motions().get(clip) else { return false };
    let movers = model.movers();
    if !motion.channels.iter().any(|c| movers[c.node]) {
        return false;
    }
    let rest = model.rest();
    let tolerance = MOVES * extent(&rest);
    let first = model.pose(clip, motion.start);
    let differs = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).any(|(p, q)| p.distance(*q) > tolerance);
    // A clip of one key is a pose: it moves the mesh if it differs from the resting one.
    if motion.end <= motion.start {
        return differs(&rest, &first);
    }
    let step = (motion.end - motion.start) / PROBES as f64;
    (1..=PROBES).any(|k| differs(&first, &model.pose(clip, motion.start + step * k as f64)))
}

/// Times of the poses, in the file's seconds: ascending, first and last moment included.
fn sample_times(motion: &Motion, movers: &[bool], sampling: Sampling) -> Result<Vec<f64>, ImportError> {
    let seconds = motion.end - motion.start;
    match sampling {
        Sampling::Rate(rate) => {
            if !(rate.is_finite() && rate > 0.0) {
                return Err(ImportError(format!("poses a second must be a number above 0, not {rate}")));
            }
            // Beyond this no file fits into memory; the estimate that follows says so in words.
            let gaps = (seconds * rate).round().clamp(if seconds > 0.0 { 1.0 } else { 0.0 }, 1e9) as usize;
            if gaps >= 10_000_000 {
                return Err(ImportError(format!(
                    "{rate} poses a second for {seconds:.1} s are more than ten million poses; take fewer poses a second"
                )));
            }
            Ok((0..=gaps).map(|k| motion.start + seconds * (k as f64 / gaps.max(1) as f64)).collect())
        }
        Sampling::Keys => {
            let channels = motion.channels.iter().filter(|c| movers[c.node]);
            let mut times: Vec<f64> = channels.flat_map(|c| c.times.iter().copied()).collect();
            times.sort_by(f64::total_cmp);
            // The same moment, written by different channels with different rounding.
            times.dedup_by(|a, b| (*a - *b).abs() <= 1e-6 * seconds.max(1e-3));
            Ok(times)
        }
    }
}
