//! Writing files.

use crate::Refusal;
use serde_json::{Map, Value, json};
use sinew::export::glb;
use sinew::sequence::Sequence;
use sinew::view::colour::srgb_to_linear;
use sinew::view::palette::part_colours;
use std::fmt::Display;
use std::io::Write;
use std::path::Path;

/// Prints a line for a person or a pipe. That nobody reads on (`sinew … | head`) is no error.
pub fn say(line: impl Display) {
    let _ = writeln!(std::io::stdout(), "{line}");
}

/// Writes bytes, or says why not.
pub fn write(path: &Path, bytes: impl AsRef<[u8]>) -> Result<(), Refusal> {
    std::fs::write(path, bytes).map_err(|error| Refusal(format!("{} cannot be written: {error}", path.display())))
}

/// `1 part`, `2 parts`.
pub fn counted(count: usize, one: &str) -> String {
    format!("{count} {one}{}", if count == 1 { "" } else { "s" })
}

/// Writes a report as JSON.
pub fn write_report(path: &Path, report: &Value) -> Result<(), Refusal> {
    write(path, format!("{report:#}\n"))
}

/// The seconds of reading, of each step, and of all, for a report.
pub fn seconds(reading: f64, steps: &[(&'static str, f64)]) -> Value {
    let mut seconds = Map::new();
    seconds.insert("import".into(), json!(reading));
    for (step, time) in steps {
        seconds.insert((*step).into(), json!(time));
    }
    seconds.insert("total".into(), json!(reading + steps.iter().map(|(_, time)| time).sum::<f64>()));
    seconds.into()
}

/// Writes a moving mesh painted by its parts in the colours of the page, `labels` being #F part numbers and `names` the
/// parts' names.
pub fn write_glb(path: &Path, sequence: &Sequence, labels: &[u32], names: &[String]) -> Result<(), Refusal> {
    let linear = |colour| srgb_to_linear(colour).to_array();
    let colours: Vec<[f32; 3]> = part_colours(sequence.faces(), labels).into_iter().map(linear).collect();
    write(path, glb::named_parts(sequence, labels, &colours, names))
}
