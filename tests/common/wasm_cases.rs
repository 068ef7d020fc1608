//! What must hold of the crate wherever its wasm runs.

#[path = "hinge.rs"]
mod hinge;

use glam::DVec3;
use sinew::segmentation::{Parameters, SegmentationError, segment};
use sinew::sequence::{Pose, Sequence, SequenceError};
use sinew::{clock, observer::Silent};
use wasm_bindgen_test::wasm_bindgen_test;

/// The bar in `poses` poses, bent up to 70°.
fn bending_bar(poses: usize) -> Sequence {
    let (positions, faces) = hinge::bar(24);
    let points = |positions: &[[f64; 3]]| positions.iter().copied().map(DVec3::from).collect::<Vec<_>>();
    let pose = |number: usize| {
        let share = number as f64 / poses as f64;
        let positions = points(&hinge::bend(&positions, share * 70_f64.to_radians()));
        Pose { name: format!("{number}"), time: share, positions }
    };
    Sequence::new("hinge", faces, points(&positions), (1..=poses).map(pose).collect()).expect("the bar is a sequence")
}

#[wasm_bindgen_test]
fn a_sequence_knows_its_sizes() {
    let bar = bending_bar(6);
    let sizes = bar.sizes();
    assert_eq!((sizes.vertices, sizes.faces, sizes.poses), (24 * 12 + 2, 24 * 24, 6));
    let expected = (2.0_f64.powi(2) + 2.0 * 0.25_f64.powi(2)).sqrt();
    assert!((bar.diagonal() - expected).abs() < 1e-12, "{}", bar.diagonal());
}

#[wasm_bindgen_test]
fn bad_arrays_are_refused() {
    let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let outside = Sequence::new("bad", vec![[0, 1, 3]], points.clone(), Vec::new());
    assert_eq!(outside, Err(SequenceError::FaceOutOfRange { face: 0, vertex: 3, vertices: 3 }));
    let mut infinite = points.clone();
    infinite[1].y = f64::NAN;
    let pose = Pose { name: "torn".into(), time: 0.0, positions: infinite };
    let torn = Sequence::new("bad", vec![[0, 1, 2]], points, vec![pose]);
    assert_eq!(torn, Err(SequenceError::NotFinite { pose: "torn".into(), vertex: 1 }));
}

#[wasm_bindgen_test]
fn the_clock_goes_on() {
    let start = clock::seconds();
    let mut last = start;
    while last < start + 0.02 {
        let now = clock::seconds();
        assert!(now >= last, "{now} after {last}");
        last = now;
    }
}

#[wasm_bindgen_test]
fn a_hinge_is_cut_at_the_hinge() {
    let bar = bending_bar(6);
    let result = segment(&bar, &Parameters::default(), &mut Silent).expect("the bar can be segmented");
    assert_eq!(result.parts.len(), 2, "{:?}", result.parts);
    assert!(result.rigid_residual < 0.01, "{}", result.rigid_residual);
    // Every face that lies wholly on one side belongs to that side's part.
    let side = |face: &[u32; 3]| face.map(|v| bar.reference()[v as usize].x > 0.0);
    let of = |all: bool| bar.faces().iter().position(|face| side(face) == [all; 3]).expect("the bar has both sides");
    let (left, right) = (result.labels[of(false)], result.labels[of(true)]);
    assert_ne!(left, right);
    for (face, &label) in bar.faces().iter().zip(&result.labels) {
        match side(face) {
            [false, false, false] => assert_eq!(label, left, "{face:?}"),
            [true, true, true] => assert_eq!(label, right, "{face:?}"),
            _ => assert!(label == left || label == right, "{face:?}"),
        }
    }
}

#[wasm_bindgen_test]
fn the_same_input_gives_the_same_parts() {
    let bar = bending_bar(4);
    let run = || segment(&bar, &Parameters::default(), &mut Silent).map(|result| (result.labels, result.parts));
    assert_eq!(run(), run());
}

#[wasm_bindgen_test]
fn nothing_to_segment_is_said() {
    let nothing = Sequence::new("nothing", Vec::new(), Vec::new(), Vec::new()).expect("no faces is a sequence");
    let result = segment(&nothing, &Parameters::default(), &mut Silent);
    assert_eq!(result.err(), Some(SegmentationError::NoFaces));
}
