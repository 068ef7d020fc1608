//! What is exported comes back: both forms of an animation, read by the importer.
#![cfg(not(target_arch = "wasm32"))]

#[path = "common/skinned.rs"]
mod skinned;

use glam::{DAffine3, DQuat, DVec3};
use proptest::prelude::*;
use sinew::export::animation::{Influences, LightError, Skin, SkinPose, exact, light};
use sinew::import::{File, Imported, Options, Sampling, open};
use skinned::Made;

fn read(bytes: Vec<u8>, sampling: Sampling) -> Imported {
    let options = Options { weld: false, sampling, ..Options::default() };
    open(&[File { name: "made.glb".into(), bytes }], &options).expect("what was written can be read")
}

fn farthest(a: &[DVec3], b: &[DVec3]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max)
}

/// So many poses a second as the creature has.
fn rate(made: &Made) -> Sampling {
    let poses = made.sequence.poses();
    Sampling::Rate(1.0 / (poses[1].time - poses[0].time))
}

#[test]
fn the_exact_form_comes_back_as_it_was() {
    let made = Made::new("horse", 2000, 8, 4);
    let imported = read(exact(&made.sequence, None), rate(&made));
    assert_eq!(imported.warnings, [], "nothing to mend");
    let (was, is) = (&made.sequence, &imported.sequence);
    assert_eq!(was.faces(), is.faces());
    assert_eq!(is.poses().len(), 9, "one more closes the loop");
    for (pose, back) in was.poses().iter().chain(&was.poses()[..1]).zip(is.poses()) {
        assert!(farthest(&pose.positions, &back.positions) < 1e-6 * was.diagonal());
    }
}

#[test]
fn the_light_form_comes_back_with_the_error_it_states() {
    for (name, handles) in [("horse", 14), ("snake", 9), ("person", 40)] {
        let made = Made::new(name, 2000, 8, handles);
        let poses = made.poses();
        let diagonal = made.sequence.diagonal();
        let mut errors = Vec::new();
        for influences in [Influences::Four, Influences::Eight] {
            let file = light(&made.skin(&poses), influences).expect("a skin");
            let imported = read(file.bytes, rate(&made));
            assert_eq!(imported.warnings, [], "nothing to mend");
            assert_eq!(made.sequence.faces(), imported.sequence.faces());
            assert!(farthest(made.sequence.reference(), imported.sequence.reference()) < 1e-6 * diagonal);
            assert_eq!(imported.sequence.poses().len(), 9);
            let (mut squares, mut largest, mut number) = (0.0, 0.0_f64, 0.0);
            for (pose, back) in imported.sequence.poses()[..8].iter().enumerate() {
                let wanted = made.blend(pose);
                largest = largest.max(farthest(&wanted, &back.positions) / diagonal);
                squares += wanted.iter().zip(&back.positions).map(|(a, b)| a.distance_squared(*b)).sum::<f64>();
                number += wanted.len() as f64;
            }
            let rms = (squares / number).sqrt() / diagonal;
            println!("{name}, {handles} handles, {influences:?}: {rms:.6} {largest:.6} (plain {:.6})", file.plain_rms);
            assert!((rms - file.rms).abs() < 1e-6, "{rms} is not {}", file.rms);
            assert!((largest - file.largest).abs() < 2e-6, "{largest} is not {}", file.largest);
            assert!(file.rms <= file.plain_rms && file.rms < 0.004, "{} against {}", file.rms, file.plain_rms);
            errors.push(file.rms);
        }
        assert!(errors[1] < 0.5 * errors[0], "{errors:?}");
    }
}

#[test]
fn rigid_handles_with_few_weights_cost_nothing() {
    let made = Made::new("snake", 1500, 6, 5);
    let nearest: Vec<f64> = made
        .weights
        .chunks_exact(5)
        .flat_map(|row| {
            let best = (0..5).max_by(|&a, &b| row[a].total_cmp(&row[b])).unwrap();
            (0..5).map(move |h| {
                if h == best {
                    0.75
                } else if h == (best + 1) % 5 {
                    0.25
                } else {
                    0.0
                }
            })
        })
        .collect();
    let maps: Vec<Vec<DAffine3>> = (0..6)
        .map(|p| {
            let turn = |h: usize| DQuat::from_rotation_y(0.3 * (p * (h + 1)) as f64);
            (0..5).map(|h| DAffine3::from_rotation_translation(turn(h), DVec3::X * h as f64)).collect()
        })
        .collect();
    let poses: Vec<SkinPose> =
        maps.iter().enumerate().map(|(p, maps)| SkinPose { name: "", time: p as f64 * 0.5, maps }).collect();
    let skin = Skin { weights: &nearest, ..made.skin(&poses) };
    let file = light(&skin, Influences::Four).unwrap();
    assert!(file.largest < 1e-6, "{}", file.largest);
    let text = String::from_utf8_lossy(&file.bytes);
    assert!(text.contains("handle 5") && !text.contains("shear"), "no second nodes for rigid handles");
}

#[test]
fn what_does_not_fit_together_is_refused() {
    let made = Made::new("snake", 1000, 2, 3);
    let poses = made.poses();
    let skin = made.skin(&poses);
    let refusal = |skin: &Skin| light(skin, Influences::Four).unwrap_err();
    assert!(matches!(refusal(&Skin { weights: &made.weights[1..], ..skin }), LightError::Count { .. }));
    assert!(matches!(refusal(&Skin { handles: 0, weights: &[], ..skin }), LightError::Count { .. }));
    assert_eq!(refusal(&Skin { faces: &[[0, 1, u32::MAX]], ..skin }), LightError::Face(0));
    let mut weights = made.weights.clone();
    weights[7] = f64::NAN;
    assert_eq!(refusal(&Skin { weights: &weights, ..skin }), LightError::NotFinite("the weights"));
    let few = [SkinPose { maps: &made.maps[0][1..], ..poses[0] }];
    assert!(matches!(refusal(&Skin { poses: &few, ..skin }), LightError::Count { found: 2, expected: 3, .. }));
    let mut maps = made.maps[0].clone();
    maps[1].translation.x = f64::INFINITY;
    let wild = [SkinPose { maps: &maps, ..poses[0] }];
    assert_eq!(refusal(&Skin { poses: &wild, ..skin }), LightError::NotFinite("a map"));
}

#[test]
fn still_and_empty_skins_are_files_too() {
    let made = Made::new("snake", 1000, 1, 3);
    let still = light(&made.skin(&[]), Influences::Four).unwrap();
    let imported = read(still.bytes, Sampling::Keys);
    assert_eq!((imported.sequence.poses().len(), imported.clips.len()), (0, 0));
    let nothing = Skin { name: "", faces: &[], reference: &[], weights: &[], handles: 1, poses: &[], look: None };
    let file = light(&nothing, Influences::Four).unwrap();
    assert_eq!((file.rms, file.largest), (0.0, 0.0));
    assert!(file.bytes.starts_with(b"glTF"));
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 24, failure_persistence: None, ..ProptestConfig::default() })]
    #[test]
    fn any_maps_come_back(
        maps in prop::collection::vec(prop::collection::vec(prop::array::uniform12(-1.5..1.5f64), 4), 1..5),
        raw in prop::collection::vec(prop::array::uniform4(0.01..1.0f64), 12),
    ) {
        let reference: Vec<DVec3> = (0..12).map(|v| DVec3::new((v * v % 7) as f64, v as f64, (5 * v % 3) as f64)).collect();
        let faces: Vec<[u32; 3]> = (0..10).map(|f| [f, f + 1, f + 2]).collect();
        let weights: Vec<f64> = raw.iter().flat_map(|row| row.map(|w| w / row.iter().sum::<f64>())).collect();
        let maps: Vec<Vec<DAffine3>> = maps.iter().map(|m| m.iter().map(DAffine3::from_cols_array).collect()).collect();
        let poses: Vec<SkinPose> = maps.iter().enumerate()
            .map(|(p, maps)| SkinPose { name: "pose", time: p as f64, maps }).collect();
        let skin = Skin { name: "any", faces: &faces, reference: &reference, weights: &weights, handles: 4, poses: &poses, look: None };
        let file = light(&skin, Influences::Four).unwrap();
        prop_assert!(file.largest < 2e-6, "{}", file.largest);
        let imported = read(file.bytes, Sampling::Rate(1.0));
        for (pose, back) in maps.iter().zip(imported.sequence.poses()) {
            for (v, &x) in reference.iter().enumerate() {
                let wanted: DVec3 = (0..4).map(|h| weights[4 * v + h] * pose[h].transform_point3(x)).sum();
                prop_assert!(wanted.distance(back.positions[v]) < 1e-4, "{wanted} {}", back.positions[v]);
            }
        }
    }
}
