//! Bounded biharmonic weights against their definition and on meshes as they are.
#![cfg(all(feature = "solvers", not(target_arch = "wasm32")))]

#[path = "common/npz.rs"]
mod npz;

use glam::DVec3;
use sinew::weights::{Biharmonic, Parameters, Weights};

fn check(weights: &Weights) {
    for v in 0..weights.vertices() {
        let row = weights.row(v);
        assert!((row.iter().sum::<f64>() - 1.0).abs() <= 1e-12, "{v}: {row:?}");
        assert!(row.iter().all(|x| (0.0..=1.0 + 1e-12).contains(x)), "{v}: {row:?}");
    }
    for (j, &handle) in weights.handles.iter().enumerate() {
        assert!((weights.row(handle as usize)[j] - 1.0).abs() < 1e-12);
    }
    assert!(weights.kkt_residual <= 1e-6, "residual {}", weights.kkt_residual);
}

#[test]
fn a_horse_has_optimal_weights() {
    let creature = sinew::zoo::make(&sinew::zoo::Recipe { name: "horse".into(), faces: 5000, poses: 1, exact: false });
    let sequence = creature.expect("a horse").sequence;
    let solver = Biharmonic::new(sequence.faces(), sequence.reference()).expect("a solver");
    let n = sequence.reference().len() as u32;
    let handles: Vec<u32> = (0..12).map(|i| i * n / 12).collect();
    let start = sinew::clock::seconds();
    let weights = solver.weights(&handles, &Parameters::default()).expect("weights");
    println!("{n} vertices: {:.1} ms a handle", (sinew::clock::seconds() - start) / 12.0 * 1000.0);
    check(&weights);
}
#[allow(unused)]
fn unused(_: DVec3) {}
