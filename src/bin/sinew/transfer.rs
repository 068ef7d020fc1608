//! `sinew transfer`: a second mesh moves like the first.

mod compare;
mod faces;

use crate::Refusal;
use crate::input::{Input, Target, print_warnings};
use crate::lists;
use crate::output::{self, counted, say};
use clap::{Args, ValueEnum};
use glam::DVec3;
use serde_json::{Value, json};
use sinew::clock;
use sinew::export::animation::{exact, light_transfer};
use sinew::import::{File, Imported, Up, may_be_needed, natural_order};
use sinew::mesh::ball::unit_ball;
use sinew::observer::Silent;
use sinew::sequence::Sequence;
use sinew::transfer::{Method, Pair, Parameters, Transfer as Transferred, transfer};
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

/// Bounds on the distance of a vertex from the truth, in radii, for the share of vertices within them.
const BOUNDS: [f64; 10] = [0.0025, 0.005, 0.0075, 0.01, 0.015, 0.02, 0.03, 0.05, 0.075, 0.1];

/// Arguments of `sinew transfer`.
#[derive(Args)]
pub struct Transfer {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    target: Target,
    /// Corresponding vertices: [{"source": 12, "target": 34}, …], lines of two numbers (.cons), or a report of proposals
    #[arg(long, value_name = "FILE")]
    pairs: PathBuf,
    /// The family of methods
    #[arg(long, value_enum, default_value_t = MethodArgument::Biharmonic)]
    method: MethodArgument,
    /// Which of the family
    #[arg(long, value_enum, default_value_t = Variant::Default)]
    variant: Variant,
    /// The most bones that are sought in the source, by the default method and variant
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..=256))]
    bones: Option<u32>,
    /// Write the moving target
    #[arg(long, value_name = "FILE.glb")]
    out: Option<PathBuf>,
    /// With --out: a skin whose joints are the handles, small whatever the number of poses, instead of exact shapes; the
    /// report says what error that adds
    #[arg(long, requires = "out")]
    light: bool,
    /// Write one OBJ a pose, with the target's own vertices, polygons and axes
    #[arg(long, value_name = "DIR")]
    out_poses: Option<PathBuf>,
    /// Write parameters, seconds, errors and warnings as JSON
    #[arg(long, value_name = "FILE.json")]
    report: Option<PathBuf>,
    /// The target's true poses in its own axes, to measure the result against: files, or a folder of files in natural order
    /// (glTF and STL: with --no-weld, for points that meet in one pose only would be joined)
    #[arg(long, value_name = "FILE", num_args = 1..)]
    truth: Vec<PathBuf>,
    /// Transfer by every method and write how far each is from the truth
    #[arg(long, value_name = "FILE.json", requires = "truth")]
    #[arg(conflicts_with_all = ["out", "out_poses", "report", "method", "variant"])]
    compare: Option<PathBuf>,
    /// By gradients or posed: vertices of the target that go exactly as far as the source does there, as feet that stand
    #[arg(long, value_name = "VERTEX", value_delimiter = ',')]
    pin: Vec<u32>,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum MethodArgument {
    /// As a skin: of near-rigid bones, or of the key points by their biharmonic weights (see --variant)
    Biharmonic,
    /// What each face does, asked of the target's faces (Sumner & Popović 2004)
    Gradients,
    /// The same, after the target was turned into the source's posture part by part
    Posed,
}

#[derive(Clone, Copy, PartialEq, ValueEnum)]
enum Variant {
    /// Near-rigid bones, joint on joint
    Default,
    /// The affine motion of each key point, as it is
    Direct,
    /// The affine motion of each key point about itself
    Relative,
}

impl Transfer {
    /// Reads, transfers, and writes what was asked for.
    pub fn run(&self) -> Result<(), Refusal> {
        let start = clock::seconds();
        let source = self.input.open()?;
        let target = self.input.open_target(&self.target)?;
        let pairs = lists::pairs(&self.pairs)?;
        let reading = clock::seconds() - start;
        if let Some(path) = &self.compare {
            return self.run_comparison(path, &source, &target, &pairs);
        }
        let parameters = self.parameters();
        self.refuse_what_the_method_does_not_know(parameters.method)?;
        if parameters.method.moves_vertices() {
            return self.run_by_faces(&source, &target, &pairs, &parameters, reading);
        }
        let result = transfer(&source.sequence, &target.sequence, &pairs, &parameters, &mut Silent)?;
        let begun = clock::seconds();
        let positions = result.poses(target.sequence.reference());
        let blending = clock::seconds() - begun;
        let moved = target.sequence.moving_like(&source.sequence, positions)?;
        let errors = if self.truth.is_empty() { None } else { Some(self.measure(&target, &moved)?) };
        if let Some(folder) = &self.out_poses {
            write_poses(folder, &moved, target.up)?;
        }
        let mut added = None;
        if let Some(path) = &self.out {
            if self.light {
                added = Some(write_light(path, &source.sequence, &target, &result)?);
            } else {
                output::write(path, exact(&moved, target.look.as_ref()))?;
            }
        }
        if let Some(path) = &self.report {
            let mut report =
                report(&source, &target, &pairs, &parameters, &result, errors.as_ref(), [reading, blending]);
            if let (Some([rms, largest]), Some(report)) = (added, report.as_object_mut()) {
                report.insert("light".into(), json!({ "rms": rms, "largest": largest }));
            }
            output::write_report(path, &report)?;
        }
        print(&source, &target, &pairs, &result, errors.as_ref());
        if let Some([rms, largest]) = added {
            say(format_args!(
                "  the skin in the file adds {:.2} % of the diagonal, at most {:.2} %",
                100.0 * rms,
                100.0 * largest
            ));
        }
        Ok(())
    }

    /// How far the moving target is from the truth, in whose files the same axis is up as in the target's.
    fn measure(&self, target: &Imported, moved: &Sequence) -> Result<Errors, Refusal> {
        let files = truth_files(&self.truth)?;
        let (_, radius) = unit_ball(target.sequence.faces(), target.sequence.reference());
        if files.len() != moved.poses().len() {
            let [truth, poses] = [counted(files.len(), "true pose"), counted(moved.poses().len(), "pose")];
            return Err(Refusal(format!("there are {truth} for {poses}; one file a pose is needed")));
        }
        let mut errors = Errors { mean: 0.0, of_poses: Vec::new(), within: vec![0.0; BOUNDS.len()] };
        for (path, pose) in files.iter().zip(moved.poses()) {
            let truth = self.input.open_still(path, Some(target.up))?.sequence;
            if truth.reference().len() != pose.positions.len() {
                let [found, expected] = [truth.reference().len(), pose.positions.len()];
                return Err(Refusal(format!("{} has {found} vertices, the target has {expected}", path.display())));
            }
            let distances = distances(&pose.positions, truth.reference(), radius);
            let count = distances.len().max(1) as f64;
            errors.of_poses.push(distances.iter().sum::<f64>() / count);
            for (within, bound) in errors.within.iter_mut().zip(BOUNDS) {
                *within += distances.iter().filter(|d| **d <= bound).count() as f64 / count / files.len() as f64;
            }
        }
        errors.mean = errors.of_poses.iter().sum::<f64>() / errors.of_poses.len().max(1) as f64;
        Ok(errors)
    }

    fn refuse_what_the_method_does_not_know(&self, method: Method) -> Result<(), Refusal> {
        let refuse = |what: &str| Err(Refusal(what.to_owned()));
        match method.moves_vertices() {
            true if self.light => refuse("a skin needs handles, and this method has none: leave --light out"),
            true if self.variant != Variant::Default => refuse("this method has no variants: leave --variant out"),
            false if !self.pin.is_empty() => refuse("--pin is for the methods gradients and posed"),
            _ if self.bones.is_some() && method != Method::Bones => {
                refuse("only the method biharmonic without a variant seeks bones: leave --bones out")
            }
            _ => Ok(()),
        }
    }

    fn parameters(&self) -> Parameters {
        let default = Parameters::default();
        Parameters {
            method: match (self.method, self.variant) {
                (MethodArgument::Gradients, _) => Method::Gradients,
                (MethodArgument::Posed, _) => Method::Posed,
                (MethodArgument::Biharmonic, Variant::Default) => default.method,
                (MethodArgument::Biharmonic, Variant::Direct) => Method::Direct,
                (MethodArgument::Biharmonic, Variant::Relative) => Method::Relative,
            },
            pinned: self.pin.clone(),
            bones: self.bones.map_or(default.bones, |bones| bones as usize),
            ..default
        }
    }
}

/// How far the result is from the truth, in radii of the target's unit ball.
struct Errors {
    mean: f64,
    of_poses: Vec<f64>,
    /// The share of vertices and poses within each of [`BOUNDS`].
    within: Vec<f64>,
}

impl Errors {
    fn json(&self) -> Value {
        json!({ "mean": self.mean, "of_poses": self.of_poses, "bounds": BOUNDS, "within": self.within })
    }

    fn say(&self) {
        say(format_args!("  mean distance from the truth {:.4} of the radius; share of vertices within", self.mean));
        for (bound, within) in BOUNDS.iter().zip(&self.within) {
            say(format_args!("  {bound:<7} {:>5.1} %", 100.0 * within));
        }
    }
}

/// The truth's files: the meshes of a folder in natural order, without its reference pose.
fn truth_files(paths: &[PathBuf]) -> Result<Vec<PathBuf>, Refusal> {
    let [folder] = paths else { return Ok(paths.to_vec()) };
    if !folder.is_dir() {
        return Ok(paths.to_vec());
    }
    let cannot = |error| Refusal(format!("{} cannot be read: {error}", folder.display()));
    let entries = std::fs::read_dir(folder).map_err(cannot)?;
    let mut files = Vec::new();
    for entry in entries {
        let path = entry.map_err(cannot)?.path();
        let rest = path.file_stem().is_some_and(|stem| stem == "rest" || stem == "reference");
        let name = path.display().to_string();
        if path.is_file() && may_be_needed(&name, false) && !rest {
            files.push(File { name, bytes: Vec::new() });
        }
    }
    natural_order(&mut files);
    Ok(files.into_iter().map(|file| PathBuf::from(file.name)).collect())
}

/// Distances of vertices from the truth in radii, the mean difference removed.
fn distances(found: &[DVec3], truth: &[DVec3], radius: f64) -> Vec<f64> {
    let off: Vec<DVec3> = found.iter().zip(truth).map(|(a, b)| (*a - *b) / radius).collect();
    let mean = off.iter().sum::<DVec3>() / off.len().max(1) as f64;
    off.into_iter().map(|d| (d - mean).length()).collect()
}

/// The moving target as a skin over its handles; the root mean square and the largest error that this form adds, over the
/// diagonal.
fn write_light(path: &Path, source: &Sequence, target: &Imported, result: &Transferred) -> Result<[f64; 2], Refusal> {
    let light = light_transfer(source, &target.sequence, &result.skin, target.look.as_ref())?;
    output::write(path, &light.bytes)?;
    Ok([light.rms, light.largest])
}

/// One OBJ a pose, with the axis up that was up in the target's file. Where faces were cut from polygons, the polygons are
/// put together again.
fn write_poses(folder: &Path, moved: &Sequence, up: Up) -> Result<(), Refusal> {
    std::fs::create_dir_all(folder)
        .map_err(|error| Refusal(format!("{} cannot be made: {error}", folder.display())))?;
    let faces = polygons(moved);
    let digits = moved.poses().len().to_string().len().max(3);
    for (number, pose) in moved.poses().iter().enumerate() {
        let mut text = String::new();
        for p in pose.positions.iter().map(|&p| up.lowered(p)) {
            // Writing to a string cannot fail.
            let _ = writeln!(text, "v {} {} {}", p.x, p.y, p.z);
        }
        for face in &faces {
            text.push('f');
            for v in face {
                let _ = write!(text, " {}", v + 1);
            }
            text.push('\n');
        }
        output::write(&folder.join(format!("pose_{number:0digits$}.obj")), text)?;
    }
    Ok(())
}

/// The input's polygons: fans of triangles with one number, joined again.
fn polygons(sequence: &Sequence) -> Vec<Vec<u32>> {
    let Some(numbers) = sequence.polygons() else {
        return sequence.faces().iter().map(|face| face.to_vec()).collect();
    };
    let mut polygons: Vec<(u32, Vec<u32>)> = Vec::new();
    for (&face, &number) in sequence.faces().iter().zip(numbers) {
        let joined = polygons.last_mut().is_some_and(|(last, corners)| *last == number && insert(corners, face));
        if !joined {
            polygons.push((number, face.to_vec()));
        }
    }
    polygons.into_iter().map(|polygon| polygon.1).collect()
}

/// Adds a triangle to a polygon along the edge that they share; `false` if they share none.
fn insert(corners: &mut Vec<u32>, face: [u32; 3]) -> bool {
    let n = corners.len();
    for i in 0..n {
        let (a, b) = (corners[i], corners[(i + 1) % n]);
        for k in 0..3 {
            if face[k] == b && face[(k + 1) % 3] == a && !corners.contains(&face[(k + 2) % 3]) {
                corners.insert(i + 1, face[(k + 2) % 3]);
                return true;
            }
        }
    }
    false
}

fn report(
    source: &Imported,
    target: &Imported,
    pairs: &[Pair],
    parameters: &Parameters,
    result: &Transferred,
    errors: Option<&Errors>,
    [reading, blending]: [f64; 2],
) -> Value {
    let steps = [result.seconds.as_slice(), &[("blending", blending)]].concat();
    let warnings: Vec<_> = source.warnings.iter().chain(&target.warnings).chain(&result.warnings).collect();
    json!({
        "source": source.sequence.name(),
        "target": target.sequence.name(),
        "parameters": parameters,
        "pairs": pairs,
        "source_vertices": source.sequence.sizes().vertices,
        "vertices": target.sequence.sizes().vertices,
        "faces": target.sequence.sizes().faces,
        "poses": source.sequence.sizes().poses,
        "handles": result.skin.handles,
        "most_influences": result.skin.most_influences(),
        "bones": result.bones,
        "source_error": result.source_error,
        "size": result.alignment.size,
        "turn": result.alignment.turn.to_cols_array_2d(),
        "seconds": output::seconds(reading, &steps),
        "error": errors.map(Errors::json),
        "warnings": warnings,
    })
}

fn print(source: &Imported, target: &Imported, pairs: &[Pair], result: &Transferred, errors: Option<&Errors>) {
    let seconds: f64 = result.seconds.iter().map(|(_, time)| time).sum();
    say(format_args!(
        "{} moves like {}: {} by {}, {}, {seconds:.2} s",
        target.sequence.name(),
        source.sequence.name(),
        counted(source.sequence.sizes().poses, "pose"),
        counted(pairs.len(), "pair"),
        counted(result.skin.handles.len(), "handle"),
    ));
    errors.into_iter().for_each(Errors::say);
    print_warnings(&source.warnings);
    print_warnings(&target.warnings);
    print_warnings(&result.warnings);
}
