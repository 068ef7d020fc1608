//! The command line: the same engine, for batches and for measuring.

mod input;
mod inspect;
mod keypoints;
mod lists;
mod output;
mod picture;
mod propose;
mod segment;
mod transfer;
mod weights;
mod zoo;

use clap::{Parser, Subcommand};
use std::process::ExitCode;

/// See how a mesh bends; make another one bend the same way.
#[derive(Parser)]
#[command(version)]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Sizes, connected pieces, poses, clips and what is odd about a mesh
    Inspect(inspect::Inspect),
    /// Cut an animated mesh into near-rigid parts
    Segment(segment::Segment),
    /// Choose the few points that govern a motion
    Keypoints(keypoints::KeyPointsCommand),
    /// Find where points of one mesh lie on another
    Propose(propose::Propose),
    /// Make another mesh move like an animated one
    Transfer(transfer::Transfer),
    /// Bounded biharmonic weights of given vertices
    Weights(weights::WeightsCommand),
    /// Make a creature
    Zoo(zoo::Zoo),
}

/// One sentence for a person, with the exit status 2.
pub struct Refusal(String);

impl<E: std::error::Error> From<E> for Refusal {
    fn from(error: E) -> Self {
        Self(error.to_string())
    }
}

fn main() -> ExitCode {
    let result = match Arguments::parse().command {
        Command::Inspect(command) => command.run(),
        Command::Segment(command) => command.run(),
        Command::Keypoints(command) => command.run(),
        Command::Transfer(command) => command.run(),
        Command::Weights(command) => command.run(),
        Command::Propose(command) => command.run(),
        Command::Zoo(command) => command.run(),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(Refusal(why)) => {
            eprintln!("sinew: {why}");
            ExitCode::from(2)
        }
    }
}
