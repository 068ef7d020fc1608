//! `sinew inspect`: what is in a file.

use crate::Refusal;
use crate::input::{Input, print_warnings};
use crate::output::say;
use clap::Args;
use serde_json::{Value, json};
use sinew::import::Imported;
use sinew::mesh::doctor::{Diagnosis, Finding, Severity};
use sinew::mesh::pieces::{census, pieces};

/// Arguments of `sinew inspect`.
#[derive(Args)]
pub struct Inspect {
    #[command(flatten)]
    input: Input,
    /// Print the report as JSON
    #[arg(long)]
    json: bool,
}

impl Inspect {
    /// Reads the input and prints what is in it.
    pub fn run(&self) -> Result<(), Refusal> {
        let imported = self.input.open()?;
        if self.json {
            say(format_args!("{:#}", report(&imported)));
        } else {
            print(&imported);
        }
        Ok(())
    }
}

fn report(imported: &Imported) -> Value {
    let sequence = &imported.sequence;
    let sizes = sequence.sizes();
    let census = census(sequence.faces(), sizes.vertices);
    json!({
        "name": sequence.name(),
        "vertices": sizes.vertices,
        "faces": sizes.faces,
        "input_faces": imported.input_faces,
        "up": imported.up,
        "components": pieces(sequence.faces(), sizes.vertices).count,
        "poses": sizes.poses,
        "seconds": sequence.poses().last().map_or(0.0, |pose| pose.time),
        "clips": imported.clips,
        "clip": imported.clip,
        "diagonal": sequence.diagonal(),
        "boundary_edges": census.boundary_edges,
        "nonmanifold_edges": census.nonmanifold_edges,
        "collapsed_faces": census.collapsed_faces,
        "unused_vertices": census.unused_vertices,
        "warnings": imported.warnings,
        "diagnosis": Diagnosis::of(sequence, &imported.warnings),
    })
}

fn print(imported: &Imported) {
    let sequence = &imported.sequence;
    let sizes = sequence.sizes();
    say(sequence.name());
    say(format_args!("  vertices    {}", sizes.vertices));
    say(format_args!("  faces       {}", sizes.faces));
    say(format_args!("  components  {}", pieces(sequence.faces(), sizes.vertices).count));
    say(format_args!("  poses       {}", sizes.poses));
    say(format_args!("  diagonal    {:.4}", sequence.diagonal()));
    for (number, clip) in imported.clips.iter().enumerate() {
        let taken = if imported.clip == Some(number) { "  (taken)" } else { "" };
        say(format_args!("  clip {number}      {} {:.2} s{taken}", clip.name, clip.seconds));
    }
    let diagnosis = Diagnosis::of(sequence, &imported.warnings);
    say(format_args!("  {}", diagnosis.summary));
    diagnosis.findings.iter().for_each(print_finding);
    let told = |code: &str| matches!(code, "welded" | "collapsed-faces");
    let warnings: Vec<_> = imported.warnings.iter().filter(|warning| !told(warning.code)).cloned().collect();
    print_warnings(&warnings);
}

/// Faces of a finding that are named; of more, `--json` names all.
const NAMED: usize = 8;

fn print_finding(finding: &Finding) {
    let mark = match finding.severity {
        Severity::Grave => "!!",
        Severity::Care => " !",
        Severity::Harmless => " ·",
    };
    say(format_args!("  {mark} {}", finding.what));
    say(format_args!("     {} {}", finding.done, finding.means));
    if !finding.faces.is_empty() {
        let named: Vec<String> = finding.faces.iter().take(NAMED).map(u32::to_string).collect();
        let more = if finding.faces.len() > NAMED { ", …" } else { "" };
        say(format_args!("     faces {}{more}", named.join(", ")));
    }
}
