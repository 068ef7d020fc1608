//! `sinew propose`: where key points of one mesh lie on another.

use crate::Refusal;
use crate::input::{Input, Target, print_warnings};
use crate::lists;
use crate::output::{self, say};
use clap::Args;
use serde_json::json;
use sinew::clock;
use sinew::transfer::propose::{ENOUGH, Proposer};
use sinew::warning::Warning;
use std::path::PathBuf;

/// Arguments of `sinew propose`.
#[derive(Args)]
pub struct Propose {
    #[command(flatten)]
    input: Input,
    #[command(flatten)]
    target: Target,
    /// Vertex numbers of the source, separated by white space or as a JSON list, or a report of key points
    #[arg(long, value_name = "FILE")]
    points: PathBuf,
    /// Pairs that are known, of these or other points: [{"source": 12, "target": 34}, …], lines of two numbers (.cons), or a
    /// report of proposals
    #[arg(long, value_name = "FILE")]
    pairs: Option<PathBuf>,
    /// Write the proposals as JSON
    #[arg(long, value_name = "FILE.json")]
    report: Option<PathBuf>,
}

impl Propose {
    /// Reads both meshes, proposes, and prints or writes the proposals.
    pub fn run(&self) -> Result<(), Refusal> {
        let source = self.input.open_at_rest()?;
        let target = self.input.open_target(&self.target)?;
        let points = lists::vertices(&self.points)?;
        let pairs = self.pairs.as_deref().map(lists::pairs).transpose()?.unwrap_or_default();
        // What is known of other points tells where these lie as well: it comes last, and is not told again.
        let others: Vec<u32> = pairs.iter().map(|pair| pair.source).filter(|source| !points.contains(source)).collect();
        let others = others.iter().step_by(others.len().div_ceil(ENOUGH).max(1));
        let all: Vec<u32> = points.iter().chain(others).copied().collect();
        let known: Vec<Option<u32>> =
            all.iter().map(|&p| pairs.iter().find(|pair| pair.source == p).map(|pair| pair.target)).collect();
        let (from, to) = (&source.sequence, &target.sequence);
        let start = clock::seconds();
        let proposer = Proposer::of(from, to)?;
        let prepared = clock::seconds();
        let proposals = proposer.propose(&all, &known)?;
        let done = clock::seconds();
        for (point, proposal) in points.iter().zip(&proposals.points) {
            say(format_args!("{point:>8} → {:<8} confidence {:.2}", proposal.target, proposal.confidence));
        }
        if let Some(next) = proposals.next.and_then(|next| points.get(next)) {
            say(format_args!("most worth placing by hand: {next}"));
        }
        let warnings: Vec<Warning> = source.warnings.iter().chain(&target.warnings).cloned().collect();
        print_warnings(&warnings);
        let Some(path) = &self.report else { return Ok(()) };
        let list: Vec<_> = points
            .iter()
            .zip(&proposals.points)
            .map(|(source, p)| json!({ "source": source, "target": p.target, "confidence": p.confidence }))
            .collect();
        let report = json!({
            "pairs": list,
            "next": proposals.next,
            "seconds": { "prepare": prepared - start, "propose": done - prepared },
            "warnings": warnings,
        });
        output::write_report(path, &report)
    }
}
