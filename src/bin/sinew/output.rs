//! Writing files.

use crate::Refusal;
use serde_json::Value;
use sinew::sequence::Sequence;
use std::path::Path;

/// Writes bytes, or says why not.
pub fn write(path: &Path, bytes: impl AsRef<[u8]>) -> Result<(), Refusal> {
    std::fs::write(path, bytes).map_err(|error| Refusal(format!("{} cannot be written: {error}", path.display())))
}

/// Writes a report as JSON.
pub fn write_report(path: &Path, report: &Value) -> Result<(), Refusal> {
    write(path, format!("{report:#}\n"))
}

/// Writes a moving mesh painted by its parts.
pub fn write_glb(path: &Path, sequence: &Sequence, labels: &[u32]) -> Result<(), Refusal> {
    let _ = (sequence, labels);
    Err(Refusal(format!("{} cannot be written: this build has no GLB export", path.display())))
}
