//! What is wrong with a mesh, what was done about it, and what it means for the result.
//!
//! A check a file; each looks at the same `Chart` and finds one thing or nothing. A mesh of 200,000 faces takes a
//! fraction of a second: sorting is the slowest step.
//!
//! | file | finds |
//! |---|---|
//! | `finite` | coordinates that are no numbers |
//! | `outliers` | vertices so far away that the size of the mesh means nothing |
//! | `distant` | meshes so far from the origin that digits are lost |
//! | `winding` | faces wound against their neighbours, surfaces with one side only |
//! | `inside_out` | closed pieces that show their inside |
//! | `normals` | vertices whose faces look in all directions at once |
//! | `crowded` | edges with three faces or more |
//! | `duplicates` | faces that are there more than once |
//! | `degenerate` | faces without area |
//! | `slivers` | needles |
//! | `mirrored` | poses that are mirror images |
//! | `turned` | faces that turn over, or shrink to nothing, in a pose |
//! | `exploding` | poses in which vertices fly away |
//! | `holes` | open borders |
//! | `pieces` | pieces that hang together by nothing, and those that stand still |
//! | `seams` | vertices stored more than once |
//! | `unused` | vertices without a face |

mod chart;
mod crowded;
mod degenerate;
mod distant;
mod duplicates;
mod exploding;
mod finite;
mod holes;
mod inside_out;
mod mirrored;
mod normals;
mod orientation;
mod outliers;
mod outward;
mod pieces;
mod seams;
mod slivers;
mod turned;
mod unused;
mod winding;
mod words;

pub use outward::outward;

use crate::sequence::Sequence;
use crate::warning::Warning;
use chart::Chart;
use glam::DVec3;
use serde::{Deserialize, Serialize};

/// A mesh as it lies before the doctor.
#[derive(Clone, Debug)]
pub struct Mesh<'a> {
    /// #F triples of vertex numbers below #V.
    pub faces: &'a [[u32; 3]],
    /// #V positions.
    pub reference: &'a [DVec3],
    /// The other poses, #V positions each. One of another length is passed over.
    pub poses: Vec<&'a [DVec3]>,
}

/// What is wrong with a mesh.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
pub struct Diagnosis {
    /// One sentence about the whole.
    pub summary: String,
    /// What was found, the gravest first.
    pub findings: Vec<Finding>,
}

/// One thing that was found.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Finding {
    /// What it is.
    pub code: Code,
    /// How much it matters.
    pub severity: Severity,
    /// How often it is there: in holes, edges, faces, vertices, pieces or poses, as `what` says.
    pub count: usize,
    /// What was found, in a few words: `3 open borders`.
    pub what: String,
    /// What was done about it.
    pub done: String,
    /// What it means for the result.
    pub means: String,
    /// The faces concerned, ascending; empty where it concerns no faces.
    pub faces: Vec<u32>,
}

/// How much a finding matters.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Severity {
    /// Results are worth little.
    Grave,
    /// Results may be worse where it is.
    Care,
    /// It is worth knowing, and disturbs nothing.
    Harmless,
}

/// What can be found.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Code {
    /// Coordinates that are NaN or infinite.
    NotFinite,
    /// Vertices very far from all others.
    FarVertices,
    /// A mesh so far from the origin that digits are lost.
    FarFromOrigin,
    /// Poses in which vertices fly away.
    ExplodingPoses,
    /// Poses that are mirror images.
    MirroredPoses,
    /// Faces wound against their neighbours.
    FlippedFaces,
    /// Surfaces with one side only.
    OneSided,
    /// Closed pieces that show their inside.
    InsideOut,
    /// Vertices whose faces look in all directions at once.
    ContradictingNormals,
    /// Edges with three faces or more.
    CrowdedEdges,
    /// Faces that are there more than once.
    DuplicateFaces,
    /// Faces without area.
    DegenerateFaces,
    /// Needles.
    Slivers,
    /// Faces that turn over in a pose.
    TurnedOver,
    /// Faces that shrink to nothing in a pose.
    Vanishing,
    /// Open borders.
    Holes,
    /// More than one piece.
    Pieces,
    /// Pieces that stand still while others move.
    StillPieces,
    /// Vertices stored more than once, which the algorithms take as one.
    Seams,
    /// Vertices that were joined when the file was read.
    Welded,
    /// Vertices without a face.
    UnusedVertices,
}

impl Diagnosis {
    /// Examines a sequence; `notes` are what its importer noticed.
    pub fn of(sequence: &Sequence, notes: &[Warning]) -> Self {
        let poses = sequence.poses().iter().map(|pose| pose.positions.as_slice()).collect();
        Self::of_mesh(&Mesh { faces: sequence.faces(), reference: sequence.reference(), poses }, notes)
    }

    /// Examines a mesh; `notes` are what its importer noticed. Faces that name vertices which do not exist are passed
    /// over.
    pub fn of_mesh(mesh: &Mesh, notes: &[Warning]) -> Self {
        let chart = Chart::new(mesh);
        let mut findings = Vec::new();
        findings.extend(finite::check(&chart));
        findings.extend(outliers::check(&chart));
        findings.extend(distant::check(&chart));
        findings.extend(exploding::check(&chart));
        findings.extend(mirrored::check(&chart));
        findings.extend(winding::check(&chart));
        findings.extend(inside_out::check(&chart));
        findings.extend(normals::check(&chart));
        findings.extend(crowded::check(&chart));
        findings.extend(duplicates::check(&chart));
        findings.extend(degenerate::check(&chart, notes));
        findings.extend(slivers::check(&chart));
        findings.extend(turned::check(&chart));
        findings.extend(holes::check(&chart));
        findings.extend(pieces::check(&chart));
        findings.extend(seams::check(&chart, notes));
        findings.extend(unused::check(&chart));
        // Stable: of equal weight in the order above.
        findings.sort_by_key(|finding| finding.severity);
        Self { summary: summary(&findings), findings }
    }

    /// The finding of a kind, if there is one.
    pub fn finding(&self, code: Code) -> Option<&Finding> {
        self.findings.iter().find(|finding| finding.code == code)
    }
}

fn summary(findings: &[Finding]) -> String {
    let matter = findings.iter().filter(|finding| finding.severity < Severity::Harmless).count();
    match (findings.len(), matter) {
        (0, _) => "Nothing is wrong with this mesh.".into(),
        (_, 0) => "Nothing here disturbs the result.".into(),
        (_, 1) => "One thing may disturb the result.".into(),
        (_, n) => format!("{n} things may disturb the result."),
    }
}

#[cfg(test)]
mod tests;
