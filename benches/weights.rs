//! How long bounded biharmonic weights take a handle, by size: on all cores, and how much time of processors; and the
//! joint form against them.
//!
//! `cargo bench --bench weights -- MESH.obj …` measures meshes of your own; `libigl_weights.py` beside this file tells the
//! same of libigl. `cargo bench --bench weights -- large` adds 200,000 vertices.

#[path = "../tests/common/npz.rs"]
mod npz;

use glam::DVec3;
use sinew::clock;
use sinew::import::{self, File, Options};
use sinew::weights::{Biharmonic, Parameters, Weights};
use sinew::zoo::{self, Recipe};

const HANDLES: usize = 12;

/// Beyond so many vertices the joint form takes minutes.
const MOST_JOINT: usize = 3_000;

/// Up to so many vertices weights are computed some times over, and handles moved.
const SMALL: usize = 20_000;

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

/// What a computation took, in seconds.
#[derive(Clone, Copy)]
struct Taken {
    wall: f64,
    /// Of all processors together, where the system tells.
    processor: Option<f64>,
}

fn timed<T>(work: impl FnOnce() -> T) -> (Taken, T) {
    let (wall, processor) = (clock::seconds(), processor_seconds());
    let result = work();
    let spent = processor.and_then(|before| Some(processor_seconds()? - before));
    (Taken { wall: clock::seconds() - wall, processor: spent }, result)
}

/// Seconds that all threads of this process have run, in hundredths.
fn processor_seconds() -> Option<f64> {
    let stat = std::fs::read_to_string("/proc/self/stat").ok()?;
    let (_, fields) = stat.rsplit_once(')')?;
    let ticks = |field: usize| fields.split_whitespace().nth(field)?.parse::<f64>().ok();
    Some((ticks(11)? + ticks(12)?) / 100.0)
}

fn weights(solver: &Biharmonic, handles: &[u32], joint: bool) -> Weights {
    solver.weights(handles, &Parameters { joint }).expect("weights")
}

/// Each handle in turn moves to a vertex about so many radii away.
fn moves(solver: &Biharmonic, positions: &[DVec3], handles: &[u32], away: f64) {
    let before = weights(solver, handles, false);
    let radius = positions.iter().map(|p| p.distance(positions[0])).fold(0.0, f64::max) / 2.0;
    let (taken, ()) = timed(|| {
        for j in 0..handles.len() {
            let from = positions[handles[j] as usize];
            let off = |v: usize| (positions[v].distance(from) - away * radius).abs();
            let mut moved = handles.to_vec();
            moved[j] = (0..positions.len()).fold(0, |best, v| if off(v) < off(best) { v } else { best }) as u32;
            // A handle that would stand on another one stays.
            let _ = solver.update(&before, &moved, &Parameters::default());
        }
    });
    println!("  a handle moved by {away} radii: {:.1} ms", 1e3 * taken.wall / handles.len() as f64);
}

fn measure(name: &str, (faces, positions): &Mesh) {
    let (prepared, solver) = timed(|| Biharmonic::new(faces, positions).expect("a mesh"));
    let handles = handles(positions);
    let runs = if positions.len() <= SMALL { 4 } else { 1 };
    let (taken, results) = timed(|| (0..runs).map(|_| weights(&solver, &handles, false)).collect::<Vec<_>>());
    let a_handle = |seconds: f64| 1e3 * seconds / (runs * HANDLES) as f64;
    let processor = taken.processor.map(|s| format!(" ({:.1} ms of processors)", a_handle(s))).unwrap_or_default();
    println!(
        "{name}, {} vertices: prepared in {:.2} s, {:.1} ms a handle of {HANDLES}{processor}, residual {:.1e}",
        positions.len(),
        prepared.wall,
        a_handle(taken.wall),
        results[0].kkt_residual
    );
    if positions.len() <= SMALL {
        [0.05, 0.2].iter().for_each(|&away| moves(&solver, positions, &handles, away));
    }
    if positions.len() <= MOST_JOINT {
        let (joint, joined) = timed(|| weights(&solver, &handles, true));
        println!(
            "  joint form {:.2} s, {:.1} times as long, residual {:.1e}",
            joint.wall,
            joint.wall * runs as f64 / taken.wall,
            joined.kkt_residual
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

/// A mesh from a file.
fn read(path: &str) -> Mesh {
    let file = File { name: path.into(), bytes: std::fs::read(path).expect("a file that can be read") };
    let sequence = import::open_in_order(&[file], &Options::default()).expect("a mesh").sequence;
    (sequence.faces().to_vec(), sequence.reference().to_vec())
}

fn main() {
    let own: Vec<String> = std::env::args().skip(1).filter(|argument| argument.ends_with(".obj")).collect();
    if !own.is_empty() {
        own.iter().for_each(|path| measure(path, &read(path)));
        return;
    }
    measure("made horse", &made(2_500));
    measure("made horse", &made(8_400));
    if let Some(data) = npz::data("the public horse") {
        let horse = npz::sequence(&data.join("sumner/horse.npz"));
        measure("public horse", &(horse.faces().to_vec(), horse.reference().to_vec()));
    }
    if std::env::args().any(|argument| argument == "large") {
        measure("made horse", &made(200_000));
    }
}
