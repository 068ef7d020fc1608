//! Writing files.

use crate::Refusal;
use serde_json::Value;
use sinew::export::glb;
use sinew::sequence::Sequence;
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

/// Writes a moving mesh painted by its parts, `labels` being #F part numbers and `names` the parts' names.
pub fn write_glb(path: &Path, sequence: &Sequence, labels: &[u32], names: &[String]) -> Result<(), Refusal> {
    let parts = labels.iter().max().map_or(0, |&last| last as usize + 1);
    let colours: Vec<[f32; 3]> = (0..parts).map(colour).collect();
    write(path, glb::named_parts(sequence, labels, &colours, names))
}

/// The colour of a part in linear RGB: equal lightness and chroma in Oklab (Ottosson, *A perceptual color space
/// for image processing*, 2020), hues a golden angle apart, so that parts of near numbers differ most.
fn colour(part: usize) -> [f32; 3] {
    const LIGHTNESS: f64 = 0.74;
    const CHROMA: f64 = 0.12;
    const GOLDEN_ANGLE: f64 = 2.399_963_229_728_653;
    let (b, a) = (0.5 + GOLDEN_ANGLE * part as f64).sin_cos();
    let (a, b) = (CHROMA * a, CHROMA * b);
    let l = (LIGHTNESS + 0.396_337_777_4 * a + 0.215_803_757_3 * b).powi(3);
    let m = (LIGHTNESS - 0.105_561_345_8 * a - 0.063_854_172_8 * b).powi(3);
    let s = (LIGHTNESS - 0.089_484_177_5 * a - 1.291_485_548 * b).powi(3);
    [
        4.076_741_662_1 * l - 3.307_711_591_3 * m + 0.230_969_929_2 * s,
        -1.268_438_004_6 * l + 2.609_757_401_1 * m - 0.341_319_396_5 * s,
        -0.004_196_086_3 * l - 0.703_418_614_7 * m + 1.707_614_701 * s,
    ]
    .map(|x| x.clamp(0.0, 1.0) as f32)
}
