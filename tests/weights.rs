//! Bounded biharmonic weights against their definition, against other programs, and on meshes as they are.
#![cfg(all(feature = "solvers", not(target_arch = "wasm32")))]

#[path = "common/npz.rs"]
mod npz;

use glam::DVec3;
use proptest::prelude::*;
use sinew::weights::{Biharmonic, Parameters, Weights, WeightsError};
use sinew::zoo::{self, Recipe};

/// Finite, within bounds, rows that sum to one.
fn assert_shares(weights: &Weights) {
    for v in 0..weights.vertices() {
        let row = weights.row(v);
        assert!((row.iter().sum::<f64>() - 1.0).abs() <= 1e-12, "{v}: {row:?}");
        assert!(row.iter().all(|x| (0.0..=1.0 + 1e-12).contains(x)), "{v}: {row:?}");
    }
}

fn assert_optimal(weights: &Weights) {
    assert_shares(weights);
    assert!(weights.kkt_residual <= 1e-6, "residual {}", weights.kkt_residual);
    for (j, &handle) in weights.handles.iter().enumerate() {
        assert!((weights.row(handle as usize)[j] - 1.0).abs() < 1e-12);
    }
}

fn horse(faces: usize) -> sinew::sequence::Sequence {
    zoo::make(&Recipe { name: "horse".into(), faces, poses: 1, exact: false, ..Recipe::default() })
        .expect("a horse")
        .sequence
}

fn solver(faces: &[[u32; 3]], positions: &[DVec3]) -> Biharmonic {
    Biharmonic::new(faces, positions).expect("a mesh")
}

fn solve(faces: &[[u32; 3]], positions: &[DVec3], handles: &[u32]) -> Weights {
    solver(faces, positions).weights(handles, &Parameters::default()).expect("weights")
}

/// A flat square of `side` × `side` vertices.
fn grid(side: u32) -> (Vec<[u32; 3]>, Vec<DVec3>) {
    let at = |i: u32| DVec3::new(f64::from(i % side), f64::from(i / side), 0.0);
    let cells = (0..side * (side - 1)).filter(|i| i % side + 1 != side);
    let faces = cells.flat_map(|i| [[i, i + 1, i + side + 1], [i, i + side + 1, i + side]]).collect();
    (faces, (0..side * side).map(at).collect())
}

#[test]
fn a_horse_has_optimal_weights_that_follow_a_moved_handle() {
    let horse = horse(3000);
    let n = horse.reference().len() as u32;
    let solver = solver(horse.faces(), horse.reference());
    let mut handles: Vec<u32> = (0..8).map(|i| i * n / 8).collect();
    let weights = solver.weights(&handles, &Parameters::default()).expect("weights");
    assert_optimal(&weights);
    handles[3] += 5;
    let moved = solver.update(&weights, &handles, &Parameters::default()).expect("weights");
    assert_optimal(&moved);
    let direct = solver.weights(&handles, &Parameters::default()).expect("weights");
    let apart = moved.values.iter().zip(&direct.values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    assert!(apart < 1e-4, "{apart}");
}

#[test]
fn a_fine_mesh_has_optimal_weights() {
    let horse = horse(110_000);
    let n = horse.reference().len() as u32;
    assert!(n > 50_000);
    assert_optimal(&solve(horse.faces(), horse.reference(), &[0, n / 3, 2 * n / 3, n - 1]));
}

#[test]
fn weights_do_not_depend_on_the_unit_of_length() {
    let (faces, positions) = grid(15);
    let handles = [0, 14, 112, 210];
    let weights = solve(&faces, &positions, &handles);
    assert_optimal(&weights);
    for scale in [1e-3, 1e3] {
        let scaled: Vec<DVec3> = positions.iter().map(|p| *p * scale).collect();
        let other = solve(&faces, &scaled, &handles);
        let apart = weights.values.iter().zip(&other.values).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(apart < 1e-5, "{scale}: {apart}");
    }
}

#[test]
fn pieces_without_a_handle_and_loose_vertices_follow() {
    let (mut faces, mut positions) = grid(9);
    faces.push([81, 82, 83]);
    positions.extend([0.0, 0.1, 0.2].map(|x| DVec3::new(7.5 + x, 7.5 - x * x, 0.3)));
    positions.push(DVec3::new(0.0, 0.0, 1.0));
    let weights = solve(&faces, &positions, &[0, 80]);
    assert_optimal(&weights);
    assert_eq!(weights.row(81), weights.row(83));
    assert!(weights.row(82)[1] > 0.7);
    assert_eq!(weights.row(84), [1.0, 0.0]);
    assert!(weights.warnings.iter().any(|w| w.code == "pieces-without-handle"));
}

#[test]
fn a_piece_with_one_handle_follows_it_whole() {
    let horse = horse(1500);
    let solver = solver(horse.faces(), horse.reference());
    let one = solver.weights(&[7], &Parameters::default()).expect("weights");
    assert_optimal(&one);
    assert!(one.values.iter().all(|&w| w == 1.0) && one.warnings.is_empty(), "{:?}", one.warnings);
    // Back and forth between one and two.
    let two = solver.update(&one, &[7, 200], &Parameters::default()).expect("weights");
    assert_optimal(&two);
    let again = solver.update(&two, &[7], &Parameters::default()).expect("weights");
    assert_eq!(again.values, one.values);
}

#[test]
fn a_seam_is_no_boundary() {
    let (faces, mut positions) = grid(9);
    let whole = solve(&faces, &positions, &[0, 8, 72]);
    // The middle row once more, for the upper half.
    let copy = |v: u32| if (36..45).contains(&v) { v + 45 } else { v };
    let split: Vec<[u32; 3]> =
        faces.iter().map(|face| if face.iter().any(|v| *v > 44) { face.map(copy) } else { *face }).collect();
    positions.extend_from_within(36..45);
    let cut = solve(&split, &positions, &[0, 8, 72]);
    for v in 0..81 {
        assert!(whole.row(v).iter().zip(cut.row(v)).all(|(a, b)| (a - b).abs() < 1e-5), "{v}");
    }
    assert_eq!(cut.row(40), cut.row(85));
}

#[test]
fn bad_handles_are_refused_in_words() {
    let (faces, mut positions) = grid(3);
    positions.push(positions[4]);
    let solver = solver(&faces, &positions);
    let refusal = |handles: &[u32]| solver.weights(handles, &Parameters::default()).expect_err("a refusal");
    assert_eq!(refusal(&[]), WeightsError::NoHandles);
    assert_eq!(refusal(&[1, 2, 1]), WeightsError::DuplicateHandle { handle: 1 });
    assert_eq!(refusal(&[10]), WeightsError::HandleOutOfRange { handle: 10, vertices: 10 });
    assert_eq!(refusal(&[4, 9]), WeightsError::SamePlace { first: 4, second: 9 });
    assert!(Biharmonic::new(&[[0, 1, 99]], &positions).is_err());
    assert!(Biharmonic::new(&[], &[DVec3::NAN]).is_err());
}

#[test]
fn as_good_as_libigl() {
    let Some(data) = npz::data("libigl's weights") else { return };
    for name in ["grid31", "knight502", "bumpy1250"] {
        let path = data.join(format!("reference/{name}_bbw.npz"));
        let (positions, faces, handles) = (npz::points(&path, "V"), npz::numbers(&path, "F"), npz::numbers(&path, "b"));
        let faces: Vec<[u32; 3]> = faces.chunks_exact(3).map(|f| [f[0], f[1], f[2]]).collect();
        let weights = solve(&faces, &positions, &handles);
        assert_optimal(&weights);
        let (_, radius) = sinew::mesh::ball::unit_ball(&faces, &positions);
        for (j, (ours, theirs)) in weights.energies.iter().zip(npz::values(&path, "energy")).enumerate() {
            let theirs = theirs * radius * radius;
            println!("{name} {j}: {ours:.9} against {theirs:.9}, residual {:.1e}", weights.kkt_residual);
            assert!(*ours <= theirs * (1.0 + 1e-6), "{name} {j}: {ours} > {theirs}");
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(150))]

    #[test]
    fn hostile_meshes_get_shares(
        faces in prop::collection::vec([0_u32..14, 0..14, 0..14], 0..30),
        coordinates in prop::collection::vec([-2_i32..3, -2..3, -2..3], 14),
        stretch in prop::sample::select(vec![1.0, 1e-7, 1e5, 1e-150]),
        handles in prop::sample::subsequence((0_u32..14).collect::<Vec<_>>(), 1..5),
    ) {
        let positions: Vec<DVec3> =
            coordinates.iter().map(|&[x, y, z]| DVec3::new(f64::from(x), f64::from(y) * stretch, f64::from(z))).collect();
        let solver = solver(&faces, &positions);
        for joint in [false, true] {
            match solver.weights(&handles, &Parameters { joint }) {
                Ok(weights) => assert_shares(&weights),
                Err(error) => assert!(matches!(error, WeightsError::SamePlace { .. }), "{error}"),
            }
        }
    }
}
