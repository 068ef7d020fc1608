//! `--compare`: all methods against the truth, as the share of vertices within each distance of it.
//!
//! The curve of Yang, Gao, Lai, Rosin & Xia 2018, Fig. 14.

use super::{BOUNDS, Errors, Transfer};
use crate::Refusal;
use crate::output::{self, say};
use glam::DVec3;
use serde_json::{Value, json};
use sinew::clock;
use sinew::import::Imported;
use sinew::observer::Silent;
use sinew::transfer::gradients::Mover;
use sinew::transfer::{Method, Pair, Parameters, transfer};
use std::path::Path;

/// The methods, and what the report calls them.
const METHODS: [(Method, &str); 5] = [
    (Method::Bones, "bones"),
    (Method::Direct, "direct"),
    (Method::Relative, "relative"),
    (Method::Gradients, "gradients"),
    (Method::Posed, "posed"),
];

struct Row {
    name: &'static str,
    errors: Errors,
    seconds: f64,
}

impl Transfer {
    /// Transfers by every method and writes how far each is from the truth.
    pub(super) fn run_comparison(
        &self,
        path: &Path,
        source: &Imported,
        target: &Imported,
        pairs: &[Pair],
    ) -> Result<(), Refusal> {
        if self.truth.is_empty() {
            return Err(Refusal("--compare needs the target's true poses: --truth FILE...".to_owned()));
        }
        let mut rows = Vec::with_capacity(METHODS.len());
        for (method, name) in METHODS {
            let parameters = Parameters { method, ..self.parameters() };
            let start = clock::seconds();
            let positions = positions(source, target, pairs, &parameters)?;
            let seconds = clock::seconds() - start;
            let sequence = target.sequence.moving_like(&source.sequence, positions)?;
            rows.push(Row { name, errors: self.measure(target, &sequence)?, seconds });
        }
        output::write_report(path, &report(source, target, pairs, &rows))?;
        print(source, target, &rows);
        Ok(())
    }
}

fn positions(
    source: &Imported,
    target: &Imported,
    pairs: &[Pair],
    parameters: &Parameters,
) -> Result<Vec<Vec<DVec3>>, Refusal> {
    let (source, target) = (&source.sequence, &target.sequence);
    if parameters.method.moves_vertices() {
        return Ok(Mover::new(source, target, parameters, &mut Silent)?.transfer(pairs, &mut Silent)?.poses);
    }
    Ok(transfer(source, target, pairs, parameters, &mut Silent)?.poses(target.reference()))
}

fn report(source: &Imported, target: &Imported, pairs: &[Pair], rows: &[Row]) -> Value {
    let of_row = |row: &Row| {
        let mut value = row.errors.json();
        if let Some(object) = value.as_object_mut() {
            object.insert("method".into(), json!(row.name));
            object.insert("seconds".into(), json!(row.seconds));
        }
        value
    };
    json!({
        "source": source.sequence.name(),
        "target": target.sequence.name(),
        "pairs": pairs,
        "bounds": BOUNDS,
        "methods": rows.iter().map(of_row).collect::<Vec<_>>(),
    })
}

fn print(source: &Imported, target: &Imported, rows: &[Row]) {
    say(format_args!(
        "{} moves like {}: share of vertices (%) within a distance of the truth, in radii",
        target.sequence.name(),
        source.sequence.name()
    ));
    let bounds: String = BOUNDS.iter().map(|bound| format!("{bound:>7}")).collect();
    say(format_args!("  {:<10}{bounds}    mean  seconds", ""));
    for Row { name, errors, seconds } in rows {
        let within: String = errors.within.iter().map(|share| format!("{:>7.1}", 100.0 * share)).collect();
        say(format_args!("  {name:<10}{within}  {:.4}  {seconds:>7.2}", errors.mean));
    }
}
