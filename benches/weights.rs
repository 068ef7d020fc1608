//! How long bounded biharmonic weights take a handle, by size: natively, on one core; and the joint form against them.

#[path = "../tests/common/npz.rs"]
mod npz;

use glam::DVec3;
use sinew::clock;
use sinew::weights::{Biharmonic, Parameters, Weights};
use sinew::zoo::{self, Recipe};

const HANDLES: usize = 12;

/// Beyond so many vertices the joint form takes minutes.
const MOST_JOINT: usize = 3_000;

type Mesh = (Vec<[u32; 3]>, Vec<DVec3>);

/// A horse of about so many vertices.
fn made(vertices: usize) -> Mesh {
    let recipe = Recipe { name: "horse".into(), faces: 2 * vertices, poses: 1, exact: false, ..Recipe::default() };
    let sequence = zoo::make(&recipe).expect("a creature of that name").sequence;
    (sequence.faces().to_vec(), sequence.reference().to_vec())
}

/// Vertices far from each other and from where the mesh begins.
fn handles(positions: &[DVec3]) -> Vec<u32> {
    let mut nearest = vec![f64::INFINITY; positions.len()];
    let mut chosen = Vec::new();
    let mut next = 0;
    for _ in 0..HANDLES {
        chosen.push(next as u32);
        nearest.iter_mut().zip(positions).for_each(|(d, p)| *d = d.min(p.distance(positions[next])));
        next = (0..positions.len()).fold(next, |far, v| if nearest[v] > nearest[far] { v } else { far });
    }
    chosen
}

fn run(solver: &Biharmonic, handles: &[u32], joint: bool) -> (f64, Weights) {
    let start = clock::seconds();
    let weights = solver.weights(handles, &Parameters { joint }).expect("weights");
    (clock::seconds() - start, weights)
}

fn measure(name: &str, (faces, positions): &Mesh) {
    let start = clock::seconds();
    let solver = Biharmonic::new(faces, positions).expect("a mesh");
    let prepared = clock::seconds() - start;
    let handles = handles(positions);
    let (seconds, weights) = run(&solver, &handles, false);
    println!(
        "{name}, {} vertices: prepared in {prepared:.2} s, {:.3} s a handle of {HANDLES}, residual {:.1e}",
        positions.len(),
        seconds / HANDLES as f64,
        weights.kkt_residual
    );
    if positions.len() <= MOST_JOINT {
        let (joint, weights) = run(&solver, &handles, true);
        println!(
            "  joint form {joint:.2} s, {:.1} times as long, residual {:.1e}",
            joint / seconds,
            weights.kkt_residual
        );
    }
    if let Some(peak) = peak_megabytes() {
        println!("  peak memory of this process so far: {peak:.0} MB");
    }
}

/// The largest resident size of this process, where the system tells.
fn peak_megabytes() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? / 1024.0)
}

fn main() {
    measure("made horse", &made(2_500));
    measure("made horse", &made(8_400));
    if let Some(data) = npz::data("the public horse") {
        let horse = npz::sequence(&data.join("sumner/horse.npz"));
        measure("public horse", &(horse.faces().to_vec(), horse.reference().to_vec()));
    }
    // `cargo bench --bench weights -- large`: a minute or more.
    if std::env::args().any(|argument| argument == "large") {
        measure("made horse", &made(200_000));
    }
}
