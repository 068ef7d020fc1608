//! `--method gradients` and `--method posed`: what each face does is carried over.

use super::{Errors, Transfer, write_poses};
use crate::Refusal;
use crate::input::print_warnings;
use crate::output::{self, counted, say};
use serde_json::{Value, json};
use sinew::export::animation::exact;
use sinew::import::Imported;
use sinew::observer::Silent;
use sinew::transfer::gradients::{Moved, Mover};
use sinew::transfer::{Pair, Parameters};

impl Transfer {
    /// Transfers by the faces, and writes what was asked for. `reading` are the seconds that it took to read.
    pub(super) fn run_by_faces(
        &self,
        source: &Imported,
        target: &Imported,
        pairs: &[Pair],
        parameters: &Parameters,
        reading: f64,
    ) -> Result<(), Refusal> {
        let mover = Mover::new(&source.sequence, &target.sequence, parameters, &mut Silent)?;
        let mut result = mover.transfer(pairs, &mut Silent)?;
        result.seconds.splice(0..0, mover.seconds().iter().copied());
        let sequence = target.sequence.moving_like(&source.sequence, std::mem::take(&mut result.poses))?;
        let errors = if self.truth.is_empty() { None } else { Some(self.measure(target, &sequence)?) };
        if let Some(folder) = &self.out_poses {
            write_poses(folder, &sequence, target.up)?;
        }
        if let Some(path) = &self.out {
            output::write(path, exact(&sequence, target.look.as_ref()))?;
        }
        if let Some(path) = &self.report {
            output::write_report(path, &report(source, target, pairs, parameters, &result, errors.as_ref(), reading))?;
        }
        print(source, target, pairs, &result, errors.as_ref());
        Ok(())
    }
}

fn report(
    source: &Imported,
    target: &Imported,
    pairs: &[Pair],
    parameters: &Parameters,
    result: &Moved,
    errors: Option<&Errors>,
    reading: f64,
) -> Value {
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
        "fit": result.bent.quality,
        "parts": result.parts,
        "size": result.alignment.size,
        "turn": result.alignment.turn.to_cols_array_2d(),
        "seconds": output::seconds(reading, &result.seconds),
        "error": errors.map(Errors::json),
        "warnings": warnings,
    })
}

fn print(source: &Imported, target: &Imported, pairs: &[Pair], result: &Moved, errors: Option<&Errors>) {
    let seconds: f64 = result.seconds.iter().map(|(_, time)| time).sum();
    let quality = result.bent.quality;
    say(format_args!(
        "{} moves like {}: {} by {}, {seconds:.2} s",
        target.sequence.name(),
        source.sequence.name(),
        counted(source.sequence.sizes().poses, "pose"),
        counted(pairs.len(), "pair"),
    ));
    say(format_args!(
        "  bent into the target, the source covers {:.1} % of it at a mean distance of {:.4} of the radius; {:.1} % face the \
         wrong way",
        100.0 * quality.coverage,
        quality.distance,
        100.0 * quality.flipped
    ));
    errors.into_iter().for_each(Errors::say);
    print_warnings(&source.warnings);
    print_warnings(&target.warnings);
    print_warnings(&result.warnings);
}
