//! `sinew segment`: near-rigid parts.

use crate::Refusal;
use crate::input::{Input, print_warnings};
use crate::output::{self, counted, say};
use clap::{Args, ValueEnum};
use serde_json::{Value, json};
use sinew::clock;
use sinew::export::labels;
use sinew::import::Imported;
use sinew::mesh::pieces::pieces;
use sinew::observer::Silent;
use sinew::segmentation::{Method, Parameters, Segmentation, Smoothing, segment};
use std::path::PathBuf;

/// Arguments of `sinew segment`.
#[derive(Args)]
pub struct Segment {
    #[command(flatten)]
    input: Input,
    /// The number of parts (default: from the data)
    #[arg(long, conflicts_with = "paper", value_parser = clap::value_parser!(u32).range(1..))]
    parts: Option<u32>,
    /// The paper by the letter
    #[arg(long)]
    paper: bool,
    /// δ, the share of geodesic distance in the weight of a dual edge (paper: 0.1 to 0.2)
    #[arg(long)]
    delta: Option<f64>,
    /// ε, the weight above which a face is deformable (paper: 0.3 to 0.8; default: from the data)
    #[arg(long)]
    epsilon: Option<f64>,
    /// γ, the squared difference of gradients below which regions merge (paper: 0.4 to 1.6; default: from the method)
    #[arg(long)]
    gamma: Option<f64>,
    /// α, the share of deformation in the price of a cut (paper: below 0.1)
    #[arg(long)]
    alpha: Option<f64>,
    /// The share of the area below which influence regions end the search for features
    #[arg(long)]
    min_area: Option<f64>,
    /// Average distances from all pairs of faces instead of from landmarks (slow)
    #[arg(long)]
    exact: bool,
    /// How boundaries are smoothed
    #[arg(long, value_enum)]
    smoothing: Option<SmoothingArgument>,
    /// Write the number of each face's part, one a line, in the input's order
    #[arg(long, value_name = "FILE")]
    labels: Option<PathBuf>,
    /// Write the moving mesh painted by parts
    #[arg(long, value_name = "FILE.glb")]
    out: Option<PathBuf>,
    /// Write parameters, sizes, seconds and quality as JSON
    #[arg(long, value_name = "FILE.json")]
    report: Option<PathBuf>,
}

#[derive(Clone, Copy, ValueEnum)]
enum SmoothingArgument {
    /// Not at all
    None,
    /// Along what deforms
    Deformable,
    /// As Eq. 8 is printed
    Printed,
}

impl Segment {
    /// Reads the input, finds its parts, and writes what was asked for.
    pub fn run(&self) -> Result<(), Refusal> {
        let start = clock::seconds();
        let imported = self.input.open()?;
        let reading = clock::seconds() - start;
        let parameters = self.parameters();
        let result = segment(&imported.sequence, &parameters, &mut Silent)?;
        if let Some(path) = &self.labels {
            let of_faces = labels::of_input_faces(&imported.sequence, &result.labels, imported.input_faces);
            output::write(path, labels::text(&of_faces))?;
        }
        if let Some(path) = &self.report {
            output::write_report(path, &report(&imported, &parameters, &result, reading))?;
        }
        if let Some(path) = &self.out {
            output::write_glb(path, &imported.sequence, &result.labels, &[])?;
        }
        print(&imported, &result);
        Ok(())
    }

    fn parameters(&self) -> Parameters {
        let default = Parameters::default();
        Parameters {
            method: if self.paper { Method::Paper } else { default.method },
            delta: self.delta.unwrap_or(default.delta),
            epsilon: self.epsilon.or(default.epsilon),
            gamma: self.gamma.or(default.gamma),
            alpha: self.alpha.unwrap_or(default.alpha),
            min_area: self.min_area.unwrap_or(default.min_area),
            parts: self.parts.map(|parts| parts as usize),
            smoothing: match self.smoothing {
                None => default.smoothing,
                Some(SmoothingArgument::None) => Smoothing::None,
                Some(SmoothingArgument::Deformable) => Smoothing::Deformable,
                Some(SmoothingArgument::Printed) => Smoothing::Printed,
            },
            exact: self.exact,
            ..default
        }
    }
}

fn report(imported: &Imported, parameters: &Parameters, result: &Segmentation, reading: f64) -> Value {
    let sequence = &imported.sequence;
    let sizes = sequence.sizes();
    let warnings: Vec<_> = imported.warnings.iter().chain(&result.warnings).collect();
    json!({
        "name": sequence.name(),
        "parameters": parameters,
        "vertices": sizes.vertices,
        "faces": sizes.faces,
        "input_faces": imported.input_faces,
        "components": pieces(sequence.faces(), sizes.vertices).count,
        "poses": sizes.poses,
        "seconds": output::seconds(reading, &result.seconds),
        "parts": result.parts.len(),
        "part_list": result.parts,
        "rigid_residual": result.rigid_residual,
        "residual_before_smoothing": result.residual_before_smoothing,
        "epsilon": result.steps.epsilon,
        "gamma": result.steps.gamma,
        "warnings": warnings,
    })
}

fn print(imported: &Imported, result: &Segmentation) {
    let sizes = imported.sequence.sizes();
    let seconds: f64 = result.seconds.iter().map(|(_, time)| time).sum();
    say(format_args!(
        "{}: {} of {} over {}, rigid residual {:.4} of the diagonal, {seconds:.2} s",
        imported.sequence.name(),
        counted(result.parts.len(), "part"),
        counted(sizes.faces, "face"),
        counted(sizes.poses, "pose"),
        result.rigid_residual
    ));
    for (number, part) in result.parts.iter().enumerate() {
        let area = 100.0 * part.area;
        say(format_args!(
            "  part {number:<4} {:>8} faces  {area:>5.1} % of the area  residual {:.4}",
            part.faces, part.residual
        ));
    }
    print_warnings(&imported.warnings);
    print_warnings(&result.warnings);
}
