//! Near-rigid segmentation against ground truth, against its literal self, and on meshes as they are.
#![cfg(not(target_arch = "wasm32"))]

#[path = "common/agreement.rs"]
mod agreement;
#[path = "common/floor.rs"]
mod floor;
#[path = "common/hinge.rs"]
mod hinge;
#[path = "common/npz.rs"]
mod npz;

use agreement::agreement;
use glam::{DAffine3, DMat3, DVec3};
use proptest::prelude::*;
use sinew::mesh::DualGraph;
use sinew::observer::Silent;
use sinew::segmentation::{Method, Parameters, Segmentation, SegmentationError, Segmenter, Smoothing, segment};
use sinew::sequence::{Pose, Sequence};
use sinew::zoo::{self, Creature, Recipe};
use std::f64::consts::TAU;

fn creature(name: &str, faces: usize, exact: bool) -> Creature {
    zoo::make(&Recipe { name: name.into(), faces, poses: 12, exact, ..Recipe::default() })
        .expect("a creature of that name")
}

fn by_default(sequence: &Sequence) -> Segmentation {
    segment(sequence, &Parameters::default(), &mut Silent).expect("a segmentation")
}

/// Every part of every connected piece of the mesh hangs together.
fn assert_parts_in_one_piece(sequence: &Sequence, labels: &[u32]) {
    let graph = DualGraph::new(sequence.faces());
    let (piece, _) = graph.pieces();
    let (region, regions) = graph.pieces_where(|a, b| labels[a as usize] == labels[b as usize]);
    let mut pairs: Vec<(u32, u32)> = piece.iter().copied().zip(labels.iter().copied()).collect();
    pairs.sort_unstable();
    pairs.dedup();
    assert_eq!(pairs.len(), regions, "a part fell apart ({} regions)", region.iter().max().map_or(0, |m| m + 1));
}

/// Creatures whose smooth skin still tells all of their bones apart.
const TOLD_APART: [&str; 7] = ["horse", "camel", "person", "person-arms-out", "dinosaur", "snake", "hand"];

#[test]
fn exactly_skinned_creatures_come_back_as_their_bones() {
    // The cloth has one part, and is no skin around bones. Thirty small bones in a trunk or in eight arms are not all told apart.
    let least = |bones: usize| if bones > 30 { 0.93 } else { 0.95 };
    for &name in zoo::NAMES.iter().filter(|&&name| name != "cloth") {
        let creature = creature(name, 8_000, true);
        let result = by_default(&creature.sequence);
        let agreement = agreement(&creature.sequence, &result.labels, &creature.labels);
        println!("{name}: {} parts for {} bones, agreement {agreement:.3}", result.parts.len(), creature.parts.len());
        assert!(agreement >= least(creature.parts.len()), "{name}: {agreement}");
        assert_parts_in_one_piece(&creature.sequence, &result.labels);
    }
}

#[test]
fn smoothly_skinned_creatures_come_close_to_their_bones() {
    for name in TOLD_APART {
        let creature = creature(name, 8_000, false);
        let result = by_default(&creature.sequence);
        let agreement = agreement(&creature.sequence, &result.labels, &creature.labels);
        println!("{name}: {} parts for {} bones, agreement {agreement:.3}", result.parts.len(), creature.parts.len());
        assert!(agreement >= 0.75, "{name}: {agreement}");
        assert!(result.rigid_residual <= 1.1 * result.residual_before_smoothing, "smoothing costs too much");
    }
}

#[test]
fn a_coarser_or_finer_mesh_has_the_same_parts() {
    for faces in [3_000, 40_000] {
        let creature = creature("person", faces, true);
        let result = by_default(&creature.sequence);
        assert_eq!(result.parts.len(), creature.parts.len(), "{faces} faces");
        assert!(agreement(&creature.sequence, &result.labels, &creature.labels) >= 0.95, "{faces} faces");
    }
}

#[test]
fn a_hinge_is_cut_at_the_hinge() {
    let (positions, faces) = hinge::bar(24);
    let points = |p: &[[f64; 3]]| p.iter().copied().map(DVec3::from_array).collect::<Vec<_>>();
    let poses = (1..4).map(|t| Pose {
        name: t.to_string(),
        time: f64::from(t),
        positions: points(&hinge::bend(&positions, 0.3 * f64::from(t))),
    });
    let sequence = Sequence::new("hinge", faces, points(&positions), poses.collect()).expect("a sequence");
    let result = by_default(&sequence);
    assert_eq!(result.parts.len(), 2);
    let moved = |f: usize| result.labels[f] != result.steps.unsmoothed[f];
    let band = |f: usize| result.steps.band[f] == 1;
    let faces = 0..sequence.faces().len();
    assert!(faces.clone().any(band) && !faces.clone().all(band), "the band is around the hinge");
    assert!(faces.clone().all(|f| band(f) || !moved(f)), "only the band moves");
    for (face, &label) in sequence.faces().iter().zip(&result.labels) {
        let x: f64 = face.iter().map(|&v| positions[v as usize][0]).sum::<f64>() / 3.0;
        assert!(x.abs() < 0.1 || (label == result.labels[0]) == (x < 0.0), "a face at {x} is on the wrong side");
    }
}

/// The sequence with every pose replaced by a rigid motion of the reference.
fn rigidly_moved(sequence: &Sequence) -> Sequence {
    let poses = (0..4)
        .map(|t| {
            let turn = DMat3::from_euler(glam::EulerRot::XYZ, 0.3 * f64::from(t), 0.1, 1.0 - f64::from(t));
            let positions = sequence.reference().iter().map(|&p| turn * p + DVec3::splat(f64::from(t))).collect();
            Pose { name: t.to_string(), time: f64::from(t), positions }
        })
        .collect();
    Sequence::new("rigid", sequence.faces().to_vec(), sequence.reference().to_vec(), poses).expect("a sequence")
}

/// Two sequences side by side as one mesh of two pieces; the poses of the first are repeated where there are fewer.
fn side_by_side(a: &Sequence, b: &Sequence) -> Sequence {
    let shift = |p: &DVec3| *p + DVec3::new(3.0, 0.0, 0.0);
    let join = |x: &[DVec3], y: &[DVec3]| x.iter().copied().chain(y.iter().map(shift)).collect::<Vec<_>>();
    let first = a.reference().len() as u32;
    let faces = a.faces().iter().copied().chain(b.faces().iter().map(|f| f.map(|v| v + first))).collect();
    let poses = b
        .poses()
        .iter()
        .zip(a.poses().iter().cycle())
        .map(|(q, p)| Pose { positions: join(&p.positions, &q.positions), ..q.clone() })
        .collect();
    Sequence::new("two", faces, join(a.reference(), b.reference()), poses).expect("a sequence")
}

#[test]
fn what_moves_as_one_is_one_part_however_many_pieces_it_has() {
    let person = creature("person", 2_000, false).sequence;
    let one = rigidly_moved(&person);
    assert_eq!(by_default(&one).parts.len(), 1);
    let two = rigidly_moved(&side_by_side(&person, &person));
    assert_eq!(by_default(&two).parts.len(), 1);
    let still = Sequence::new("still", one.faces().to_vec(), one.reference().to_vec(), Vec::new()).expect("a mesh");
    let result = by_default(&still);
    assert_eq!(result.parts.len(), 1);
    assert!(result.warnings.iter().any(|w| w.code == "no-poses"));
}

#[test]
fn clothes_belong_to_what_they_cover() {
    let person = creature("person", 6_000, true);
    let body = &person.sequence;
    let first = body.reference().len() as u32;
    let worn = |p: &[DVec3]| p.iter().copied().chain(p.iter().map(|&p| p + DVec3::new(0.0, 0.0, 2e-3))).collect();
    let faces = body.faces().iter().copied().chain(body.faces().iter().map(|f| f.map(|v| v + first))).collect();
    let poses = body.poses().iter().map(|p| Pose { positions: worn(&p.positions), ..p.clone() }).collect();
    let dressed = Sequence::new("dressed", faces, worn(body.reference()), poses).expect("a sequence");
    let result = by_default(&dressed);
    let twice: Vec<u32> = person.labels.iter().chain(&person.labels).copied().collect();
    let agreement = agreement(&dressed, &result.labels, &twice);
    println!("{} parts for {} bones in two layers, agreement {agreement:.3}", result.parts.len(), person.parts.len());
    assert!(result.parts.len() <= person.parts.len() + 2 && agreement >= 0.9);
}

/// The faces of boxes between the corners 0 to 7 whose numbers have x, y and z as bits.
fn box_faces(boxes: usize) -> Vec<[u32; 3]> {
    let sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]];
    let of_box =
        |k: u32| sides.iter().flat_map(move |&[a, b, c, d]| [[a, b, c], [a, c, d]].map(|f| f.map(|v| 8 * k + v)));
    (0..boxes as u32).flat_map(of_box).collect()
}

/// Corner 0 to 7 of a box of side 1 about the origin.
fn box_corner(corner: usize) -> DVec3 {
    DVec3::new((corner & 1) as f64, (corner >> 1 & 1) as f64, (corner >> 2) as f64) - 0.5
}

/// Boxes in a square field of `rows` times `rows`, in ten poses; `motion` maps box and pose to its motion about its middle.
fn field_of_boxes(rows: usize, motion: impl Fn(usize, f64) -> DAffine3) -> Sequence {
    let boxes = rows * rows;
    let middle = |k: usize| 2.0 * DVec3::new((k % rows) as f64, (k / rows) as f64, 0.0);
    let at = |motion: &dyn Fn(usize) -> DAffine3| {
        let place = |v: usize| middle(v / 8) + motion(v / 8).transform_point3(box_corner(v % 8));
        (0..8 * boxes).map(place).collect::<Vec<_>>()
    };
    let pose = |t: u32| {
        let time = f64::from(t);
        Pose { name: t.to_string(), time, positions: at(&|k| motion(k, time)) }
    };
    let reference = at(&|_| DAffine3::IDENTITY);
    Sequence::new("boxes", box_faces(boxes), reference, (1..=10).map(pose).collect()).expect("boxes")
}

/// However many they are, and whatever each does.
#[test]
fn boxes_that_move_on_their_own_are_a_part_each() {
    // Numbers that look random, of the box alone.
    let of_box = |k: usize, i: usize| ((k + 1) as f64 * [2.0_f64, 3.0, 5.0][i].sqrt()).fract() - 0.5;
    let way = |k: usize| DVec3::new(of_box(k, 0), of_box(k, 1), of_box(k, 2));
    let shift = |k: usize, t: f64| DAffine3::from_translation(t.sin() * way(k));
    let turn = |k: usize, t: f64| DAffine3::from_axis_angle(way(k).normalize(), 0.3 * t);
    let grow = |k: usize, t: f64| DAffine3::from_scale(DVec3::splat(1.0 + 0.3 * (t + k as f64).sin()));
    let still = |_: usize, _: f64| DAffine3::IDENTITY;
    let check = |name: &str, rows: usize, motion: &dyn Fn(usize, f64) -> DAffine3, parts: usize| {
        let result = by_default(&field_of_boxes(rows, motion));
        println!(
            "{name}: {} parts of {} boxes, residual {:.1e}",
            result.parts.len(),
            rows * rows,
            result.rigid_residual
        );
        assert_eq!(result.parts.len(), parts, "{name}");
        assert!(result.rigid_residual < 1e-6, "{name}");
    };
    check("shift", 3, &shift, 9);
    check("turn", 3, &turn, 9);
    check("grow", 3, &grow, 9);
    check("one grows", 3, &|k, t| if k == 4 { grow(k, t) } else { still(k, t) }, 2);
    check("each in its way", 3, &|k, t| [grow(k, t), turn(k, t), shift(k, t)][k % 3], 9);
    check("a hundred shift", 10, &shift, 100);
    check("hundreds burst", 17, &|k, t| shift(k, t) * turn(k, t), 289);
    check("all do the same", 10, &|_, t| shift(0, t), 1);
}

/// A figure that grows has the parts that it has at its size, and one part if it only grows.
#[test]
fn growth_makes_no_parts() {
    let size = |t: usize| 1.0 + 0.1 * t as f64;
    let grown = |sequence: &Sequence, still: bool| {
        let rest = sequence.reference();
        let pose = |(t, pose): (usize, &Pose)| {
            let positions = if still { rest } else { &pose.positions };
            Pose { positions: positions.iter().map(|&p| size(t + 1) * p).collect(), ..pose.clone() }
        };
        let poses = sequence.poses().iter().enumerate().map(pose).collect();
        Sequence::new("grown", sequence.faces().to_vec(), rest.to_vec(), poses).expect("a sequence")
    };
    for name in ["person", "robot", "snake"] {
        let creature = creature(name, 4_000, true);
        let sequence = &creature.sequence;
        let only_grown = by_default(&grown(sequence, true));
        assert_eq!(only_grown.parts.len(), 1, "{name}");
        assert!(only_grown.rigid_residual < 1e-6, "{name}");
        let (steady, result) = (by_default(sequence), by_default(&grown(sequence, false)));
        let agreement = agreement(sequence, &result.labels, &creature.labels);
        println!("{name}: {} parts, grown {} parts, agreement {agreement:.3}", steady.parts.len(), result.parts.len());
        assert!(result.parts.len().abs_diff(steady.parts.len()) <= 1 && agreement >= 0.95, "{name}");
    }
}

/// Noise lengthens every edge, and that is no growth.
#[test]
fn noise_is_no_growth() {
    let person = creature("person", 8_000, false).sequence;
    let noise = |v: usize, i: usize, t: u32| (((v * 3 + i + 1) as f64 * f64::from(t + 2).sqrt()).sin() * 1e4).fract();
    let rigid = rigidly_moved(&person);
    let poses = rigid.poses().iter().zip(0..).map(|(pose, t)| {
        let shaken = |(v, &p): (usize, &DVec3)| {
            p + 0.01 * person.diagonal() * DVec3::from_array([0, 1, 2].map(|i| noise(v, i, t)))
        };
        Pose { positions: pose.positions.iter().enumerate().map(shaken).collect(), ..pose.clone() }
    });
    let shaken = Sequence::new("shaken", person.faces().to_vec(), person.reference().to_vec(), poses.collect());
    let result = by_default(&shaken.expect("a sequence"));
    println!("{} parts, residual {:.4}", result.parts.len(), result.rigid_residual);
    assert!(result.parts.len() == 1 && result.rigid_residual < 0.01);
}

/// An arm of five rigid links that is nothing but small plates around it.
#[test]
fn plates_belong_to_the_limb_they_sit_on() {
    for plates in [60, 150, 400] {
        let link_of = |plate: usize| 5 * plate / plates;
        let place = |plate: usize, corner: usize| {
            // Numbers that look random: the fractional parts of multiples of square roots.
            let along = 2.0 * link_of(plate) as f64 + 2.0 * (plate as f64 * 2.0_f64.sqrt()).fract();
            let turn = DMat3::from_rotation_x(TAU * (plate as f64 * 3.0_f64.sqrt()).fract());
            DVec3::new(along, 0.0, 0.0)
                + turn * (DVec3::new(0.0, 0.5, 0.0) + box_corner(corner) * DVec3::new(0.3, 0.1, 0.3))
        };
        let reference: Vec<DVec3> = (0..8 * plates).map(|v| place(v / 8, v % 8)).collect();
        let pose = |k: usize| {
            let bend = |link: usize| {
                let turn = 0.2 * k as f64 * if link < 3 { 1.0 } else { -1.0 };
                let turn =
                    if link % 2 == 1 { DAffine3::from_rotation_z(turn) } else { DAffine3::from_rotation_y(turn) };
                let joint = DVec3::new(2.0 * link as f64, 0.0, 0.0);
                DAffine3::from_translation(joint) * turn * DAffine3::from_translation(-joint)
            };
            let motion = |link: usize| (1..=link).fold(DAffine3::IDENTITY, |all, link| all * bend(link));
            let positions = reference.iter().enumerate().map(|(v, &p)| motion(link_of(v / 8)).transform_point3(p));
            Pose { name: format!("{k}"), time: k as f64, positions: positions.collect() }
        };
        let arm =
            Sequence::new("arm", box_faces(plates), reference.clone(), (1..=5).map(pose).collect()).expect("an arm");
        let result = by_default(&arm);
        println!("{plates} plates: {} parts, residual {:.1e}", result.parts.len(), result.rigid_residual);
        assert_eq!(result.parts.len(), 5, "{plates} plates");
        assert!(result.rigid_residual < 1e-6);
    }
}

/// What stands still around a character, however large, is a part of its own and changes nothing else.
#[test]
fn a_floor_leaves_the_parts_as_they_are() {
    let dog = creature("dog", 3000, false).sequence;
    let alone = by_default(&dog);
    for half in [3.0, 100.0] {
        let scene = floor::on_a_floor(&dog, half);
        let result = by_default(&scene);
        let (labels, below) = result.labels.split_at(dog.faces().len());
        assert!(below.iter().all(|&l| l == below[0]) && !labels.contains(&below[0]), "the floor is one part");
        let agreement = agreement(&dog, labels, &alone.labels);
        println!("floor of {half}: {} parts, {agreement:.4}", result.parts.len());
        assert!(agreement > 0.95, "{agreement}");
        let units = scene.diagonal() / dog.diagonal();
        assert!(result.rigid_residual * units < 1.1 * alone.rigid_residual, "stated in the diagonal of all");
    }
}

#[test]
fn two_bodies_that_move_apart_are_two_parts() {
    let person = creature("person", 2_000, false).sequence;
    let rigid = rigidly_moved(&person);
    let still = Sequence::new("still", person.faces().to_vec(), person.reference().to_vec(), {
        rigid.poses().iter().map(|p| Pose { positions: person.reference().to_vec(), ..p.clone() }).collect()
    });
    let result = by_default(&side_by_side(&still.expect("a sequence"), &rigid));
    assert_eq!(result.parts.len(), 2);
    assert!(result.rigid_residual < 1e-5);
}

#[test]
fn the_paper_by_the_letter_covers_the_mesh_with_parts_in_one_piece() {
    let horse = creature("horse", 4_000, false);
    let result = segment(&horse.sequence, &Parameters::paper(), &mut Silent).expect("a segmentation");
    assert!(result.parts.len() > 3, "{} parts", result.parts.len());
    assert!((result.parts.iter().map(|p| p.area).sum::<f64>() - 1.0).abs() < 1e-9);
    assert!(result.steps.rounds.len() > 1, "clustering takes rounds");
    assert_parts_in_one_piece(&horse.sequence, &result.labels);
}

#[test]
fn landmarks_agree_with_all_pairs() {
    let horse = creature("horse", 2_500, false).sequence;
    for method in [Method::Tree, Method::Paper] {
        let quick = Parameters { method, ..Parameters::default() };
        let exact = Parameters { exact: true, ..quick.clone() };
        let [quick, exact] = [quick, exact].map(|p| segment(&horse, &p, &mut Silent).expect("a segmentation"));
        let agreement = agreement(&horse, &quick.labels, &exact.labels);
        println!("{method:?}: {} and {} parts, agreement {agreement:.3}", quick.parts.len(), exact.parts.len());
        assert!(agreement >= 0.97, "{method:?}: {agreement}");
    }
}

#[test]
fn the_same_input_gives_the_same_bytes() {
    let horse = creature("horse", 6_000, false).sequence;
    for parameters in [Parameters::default(), Parameters::paper()] {
        let [mut a, mut b] = [(), ()].map(|()| segment(&horse, &parameters, &mut Silent).expect("a segmentation"));
        a.seconds.clear();
        b.seconds.clear();
        assert!(a == b);
    }
}

#[test]
fn any_number_of_parts_can_be_asked_for() {
    let horse = creature("horse", 6_000, false).sequence;
    let segmenter = Segmenter::new(&horse, &Parameters::default(), &mut Silent).expect("a segmentation");
    let mut before = f64::INFINITY;
    for wanted in [1, 2, 5, 9, 16, 30] {
        let result = segmenter.segmentation(Some(wanted));
        assert_eq!(result.parts.len(), wanted);
        assert!(result.rigid_residual < before, "more parts explain more");
        before = result.rigid_residual;
        assert_parts_in_one_piece(&horse, &result.labels);
    }
}

#[test]
fn progress_rises_and_stopping_stops() {
    let horse = creature("horse", 3_000, false).sequence;
    let mut heard = Vec::new();
    segment(&horse, &Parameters::default(), &mut |_: &'static str, done: f64| {
        heard.push(done);
        true
    })
    .expect("a segmentation");
    assert!(heard.windows(2).all(|w| w[0] <= w[1]) && heard.len() > 10);
    let mut calls = 0;
    let stopped = segment(&horse, &Parameters::default(), &mut |_: &'static str, _: f64| {
        calls += 1;
        calls < 8
    });
    assert_eq!(stopped.err(), Some(SegmentationError::Cancelled));
}

#[test]
fn parameters_out_of_range_are_refused_by_name() {
    let horse = creature("snake", 1_000, false).sequence;
    let wrong = [
        Parameters { delta: f64::NAN, ..Parameters::default() },
        Parameters { alpha: 1.5, ..Parameters::default() },
        Parameters { epsilon: Some(-1.0), ..Parameters::default() },
        Parameters { parts: Some(0), ..Parameters::default() },
    ];
    for parameters in wrong {
        assert!(matches!(segment(&horse, &parameters, &mut Silent), Err(SegmentationError::Parameter { .. })));
    }
}

#[test]
fn no_faces_is_an_error_in_words() {
    let empty = Sequence::new("empty", Vec::new(), vec![DVec3::ZERO], Vec::new()).expect("a sequence");
    assert_eq!(segment(&empty, &Parameters::default(), &mut Silent).err(), Some(SegmentationError::NoFaces));
}

#[test]
fn thousands_of_pieces_are_clustered_by_the_letter() {
    // Loose triangles, every other one turning: a table of faces × partitions would have 36 million entries.
    let corner = |t: f64, i: u32| {
        let turn = DMat3::from_rotation_z(t * f64::from(i / 3 % 2));
        DVec3::splat(f64::from(i / 3)) + turn * [DVec3::X, DVec3::Y, DVec3::Z][i as usize % 3]
    };
    let at = |t: f64| (0..18_000).map(|i| corner(t, i)).collect::<Vec<_>>();
    let faces = (0..6_000).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
    let pose = Pose { name: String::new(), time: 0.0, positions: at(0.5) };
    let sequence = Sequence::new("loose", faces, at(0.0), vec![pose]).expect("a sequence");
    let result = segment(&sequence, &Parameters::paper(), &mut Silent).expect("a segmentation");
    assert_eq!(result.parts.len(), 6_000);
    assert_sane(&sequence, &result);
}

fn assert_sane(sequence: &Sequence, result: &Segmentation) {
    assert_eq!(result.labels.len(), sequence.faces().len());
    assert!(result.labels.iter().all(|&l| (l as usize) < result.parts.len()));
    assert!(result.rigid_residual.is_finite() && result.rigid_residual >= 0.0);
    for part in &result.parts {
        assert!(part.faces > 0 && part.area.is_finite() && part.residual.is_finite());
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    /// Triangle soups with shared and doubled faces, edges with many faces, flat faces, and poses that tear and collapse.
    #[test]
    fn no_soup_is_too_bad(
        faces in prop::collection::vec(prop::array::uniform3(0..14u32), 1..60),
        points in prop::collection::vec(prop::array::uniform3(-2..3i8), 14 * 4),
        poses in 0..4usize, method in prop_oneof![Just(Method::Tree), Just(Method::Paper)], exact in any::<bool>(),
        huge in prop_oneof![Just(1.0), Just(1e-300), Just(1e-200), Just(1e150), Just(1e300)],
        grown in prop_oneof![Just(1.0), Just(1e-30), Just(1e30), Just(1e-300)],
    ) {
        let at = |t: usize, size: f64| -> Vec<DVec3> {
            points[14 * t..14 * (t + 1)].iter().map(|p| DVec3::from_array(p.map(|x| f64::from(x) * size))).collect()
        };
        let moved = if huge > 1e200 { 1.0 } else { huge * grown };
        let pose = |t: usize| Pose { name: t.to_string(), time: 0.0, positions: at(t, moved) };
        let sequence =
            Sequence::new("soup", faces, at(0, huge), (1..=poses).map(pose).collect()).expect("a sequence");
        for smoothing in [Smoothing::Deformable, Smoothing::Printed] {
            let parameters = Parameters { method, exact, smoothing, ..Parameters::default() };
            let result = segment(&sequence, &parameters, &mut Silent).expect("a segmentation");
            assert_sane(&sequence, &result);
        }
    }
}

#[test]
fn public_sequences_reach_their_bars() {
    let Some(data) = npz::data("segmentation of public sequences") else { return };
    let check = |name: &str, most_parts: usize, residual: f64, agrees: f64| {
        let sequence = npz::sequence(&data.join(name));
        let result = by_default(&sequence);
        let weights = data.join(name.replace(".npz", "_weights.npz"));
        let agreement = if weights.exists() {
            agreement(&sequence, &result.labels, &npz::true_parts(&weights, sequence.faces()))
        } else {
            1.0
        };
        println!(
            "{name}: {} parts, residual {:.4}, agreement {agreement:.3}",
            result.parts.len(),
            result.rigid_residual
        );
        assert!(result.parts.len() <= most_parts && result.rigid_residual <= residual && agreement >= agrees, "{name}");
        assert!(result.rigid_residual <= 1.1 * result.residual_before_smoothing, "{name}: smoothing");
        assert_parts_in_one_piece(&sequence, &result.labels);
    };
    check("seq/cylinder-gt.npz", 5, 0.0300, 0.95);
    check("seq/wolf-gt.npz", 25, 0.0041, 0.70);
    check("sumner/horse.npz", 17, 0.0075, 0.0);
    check("seq/horse-collapse_18.npz", 24, 0.0150, 0.0);
}
