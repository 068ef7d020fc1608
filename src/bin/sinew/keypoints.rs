//! `sinew keypoints`: the few points that govern a motion.

use crate::Refusal;
use crate::input::{Input, print_warnings};
use crate::output::{self, counted, say};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use sinew::clock;
use sinew::import::Imported;
use sinew::keypoints::{KeyPoints, Parameters, Stop, select};
use sinew::mesh::pieces::pieces;
use sinew::observer::Silent;
use std::path::PathBuf;

/// Arguments of `sinew keypoints`.
#[derive(Args)]
pub struct KeyPointsCommand {
    #[command(flatten)]
    input: Input,
    /// How many vertices may become key points (paper: 100)
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    candidates: Option<u32>,
    /// ε, the mean vertex distance in the unit sphere at which there are points enough (paper: 0.03)
    #[arg(long)]
    error: Option<f64>,
    /// The most points, unless --points says how many
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    max: Option<u32>,
    /// Exactly so many points
    #[arg(long, value_parser = clap::value_parser!(u32).range(1..))]
    points: Option<u32>,
    /// When there are points enough
    #[arg(long, value_enum)]
    stop: Option<StopArgument>,
    /// Algorithm 1 by the letter (slow)
    #[arg(long)]
    literal: bool,
    /// λ, the share of rigidity in the energy (paper: 0.5)
    #[arg(long)]
    lambda: Option<f64>,
    /// Another number, another vertex from which the first candidate is sought
    #[arg(long)]
    seed: Option<u64>,
    /// Write points, errors, seconds and what the search saw as JSON
    #[arg(long, value_name = "FILE.json")]
    report: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum StopArgument {
    /// When the error is small enough
    Error,
    /// When one more point takes little off the error
    Flat,
}

impl KeyPointsCommand {
    /// Reads the input, chooses its points, and writes what was asked for.
    pub fn run(&self) -> Result<(), Refusal> {
        let start = clock::seconds();
        let imported = self.input.open()?;
        let reading = clock::seconds() - start;
        let parameters = self.parameters();
        let result = select(&imported.sequence, &parameters, &mut Silent)?;
        if let Some(path) = &self.report {
            output::write_report(path, &report(&imported, &parameters, &result, reading))?;
        }
        print(&imported, &result);
        Ok(())
    }

    fn parameters(&self) -> Parameters {
        let default = Parameters::default();
        Parameters {
            candidates: self.candidates.map_or(default.candidates, |n| n as usize),
            error: self.error.unwrap_or(default.error),
            max: self.max.map_or(default.max, |n| n as usize),
            points: self.points.map(|n| n as usize),
            stop: match self.stop {
                None => default.stop,
                Some(StopArgument::Error) => Stop::Error,
                Some(StopArgument::Flat) => Stop::Flat,
            },
            literal: self.literal,
            lambda: self.lambda.unwrap_or(default.lambda),
            seed: self.seed.unwrap_or(default.seed),
            ..default
        }
    }
}

fn report(imported: &Imported, parameters: &Parameters, result: &KeyPoints, reading: f64) -> Value {
    let sequence = &imported.sequence;
    let sizes = sequence.sizes();
    let warnings: Vec<_> = imported.warnings.iter().chain(&result.warnings).collect();
    json!({
        "name": sequence.name(),
        "parameters": parameters,
        "vertices": sizes.vertices,
        "faces": sizes.faces,
        "components": pieces(sequence.faces(), sizes.vertices).count,
        "poses": sizes.poses,
        "seconds": output::seconds(reading, &result.seconds),
        "key_points": result.key_points,
        "errors": result.errors,
        "pose_errors": result.fits.iter().map(|fit| fit.error).collect::<Vec<_>>(),
        "candidates": result.candidates,
        "steps": result.steps,
        "replacements": result.replacements,
        "kkt_residual": result.weights.kkt_residual,
        "warnings": warnings,
    })
}

fn print(imported: &Imported, result: &KeyPoints) {
    let sizes = imported.sequence.sizes();
    let seconds: f64 = result.seconds.iter().map(|(_, time)| time).sum();
    say(format_args!(
        "{}: {} for {} over {}, error {:.4} in the unit sphere, {seconds:.2} s",
        imported.sequence.name(),
        counted(result.key_points.len(), "key point"),
        counted(sizes.vertices, "vertex").replace("vertexs", "vertices"),
        counted(sizes.poses, "pose"),
        result.errors.last().copied().unwrap_or(0.0)
    ));
    for (number, (point, error)) in result.key_points.iter().zip(&result.errors).enumerate() {
        say(format_args!("  {:<4} vertex {point:<8} error {error:.4}", number + 1));
    }
    print_warnings(&imported.warnings);
    print_warnings(&result.warnings);
}
