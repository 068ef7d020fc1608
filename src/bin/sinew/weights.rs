//! `sinew weights`: bounded biharmonic weights of given handles.

use crate::Refusal;
use crate::input::{Input, print_warnings};
use crate::lists;
use crate::output::{self, counted, say};
use clap::Args;
use serde_json::json;
use sinew::clock;
use sinew::weights::{Biharmonic, Parameters, Weights};
use std::path::PathBuf;

/// Arguments of `sinew weights`.
#[derive(Args)]
pub struct WeightsCommand {
    #[command(flatten)]
    input: Input,
    /// Vertex numbers from 0, separated by white space or as a JSON list, or a report of key points
    #[arg(long, value_name = "FILE")]
    handles: PathBuf,
    /// Partition of unity as a constraint (slow)
    #[arg(long)]
    joint: bool,
    /// Write the weights as a NumPy array, vertices × handles
    #[arg(long, value_name = "FILE.npy")]
    out: Option<PathBuf>,
    /// Write sizes, seconds and the optimality residual as JSON
    #[arg(long, value_name = "FILE.json")]
    report: Option<PathBuf>,
}

impl WeightsCommand {
    /// Reads the mesh and the handles, and writes what was asked for.
    pub fn run(&self) -> Result<(), Refusal> {
        let imported = self.input.open_at_rest()?;
        let sequence = &imported.sequence;
        let handles = lists::vertices(&self.handles)?;
        let parameters = Parameters { joint: self.joint };
        let poses: Vec<_> = sequence.poses().iter().map(|pose| pose.positions.as_slice()).collect();
        let start = clock::seconds();
        let solver = Biharmonic::with_poses(sequence.faces(), sequence.reference(), &poses)?;
        let prepared = clock::seconds();
        let weights = solver.weights(&handles, &parameters)?;
        let end = clock::seconds();
        if let Some(path) = &self.out {
            output::write(path, npy(&weights))?;
        }
        if let Some(path) = &self.report {
            let sizes = sequence.sizes();
            let warnings: Vec<_> = imported.warnings.iter().chain(&weights.warnings).collect();
            let report = json!({
                "name": sequence.name(),
                "parameters": parameters,
                "vertices": sizes.vertices,
                "faces": sizes.faces,
                "handles": handles,
                "kkt_residual": weights.kkt_residual,
                "energies": weights.energies,
                "seconds": { "prepare": prepared - start, "solve": end - prepared, "total": end - start },
                "warnings": warnings,
            });
            output::write_report(path, &report)?;
        }
        say(format_args!(
            "{}: {} on {}, optimality residual {:.1e}, {:.2} s",
            sequence.name(),
            counted(handles.len(), "handle"),
            format_args!("{} vertices", weights.vertices()),
            weights.kkt_residual,
            end - start
        ));
        print_warnings(&imported.warnings);
        print_warnings(&weights.warnings);
        Ok(())
    }
}

/// The weights as a NumPy file, format 1.0: little-endian doubles, vertices × handles, row by row.
fn npy(weights: &Weights) -> Vec<u8> {
    let (rows, columns) = (weights.vertices(), weights.count());
    let mut header = format!("{{'descr': '<f8', 'fortran_order': False, 'shape': ({rows}, {columns}), }}");
    // The header is padded so that the numbers start at a multiple of 64.
    let padding = 63 - (10 + header.len()) % 64;
    header.push_str(&" ".repeat(padding));
    header.push('\n');
    let mut bytes = b"\x93NUMPY\x01\x00".to_vec();
    bytes.extend((header.len() as u16).to_le_bytes());
    bytes.extend(header.as_bytes());
    weights.values.iter().for_each(|value| bytes.extend(value.to_le_bytes()));
    bytes
}
