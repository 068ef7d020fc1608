//! What was noticed on the way and mended or left out: collected, shown to the visitor, never printed or lost.

use serde::Serialize;

/// One thing that a person should know about their input or about a result.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Warning {
    /// A short stable name, such as `degenerate-faces`, for programs and tests.
    pub code: &'static str,
    /// One sentence for a person: what was found, how much of it, and what was done about it.
    pub message: String,
    /// The faces concerned (indices into the sequence's faces), if it concerns faces.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub faces: Vec<u32>,
}

impl Warning {
    /// A warning that concerns no particular faces.
    pub fn new(code: &'static str, message: impl Into<String>) -> Self {
        Self { code, message: message.into(), faces: Vec::new() }
    }

    /// A warning about the given faces.
    pub fn on_faces(code: &'static str, message: impl Into<String>, faces: Vec<u32>) -> Self {
        Self { code, message: message.into(), faces }
    }
}
