//! Transfer against ground truth, and on input as it is.
#![cfg(not(target_arch = "wasm32"))]

#[path = "common/floor.rs"]
mod floor;
#[path = "common/npz.rs"]
mod npz;

use glam::{DAffine3, DMat3, DVec3};
use sinew::linalg::polar::frobenius;
use sinew::linalg::rigid_fit::Moments;
use sinew::mesh::ball::unit_ball;
use sinew::observer::Silent;
use sinew::sequence::{Pose, Sequence};
use sinew::transfer::correspondence::Fitting;
use sinew::transfer::gradients::Mover;
use sinew::transfer::rig::Rig;
use sinew::transfer::surface::WeldedSurface;
use sinew::transfer::{Method, Pair, Parameters, Prepared, Transfer, TransferError, transfer};
use sinew::zoo::{self, Creature, Recipe};
use std::collections::BTreeMap;

fn creature(name: &str, faces: usize) -> Creature {
    zoo::make(&Recipe { name: name.into(), faces, poses: 12, exact: false, ..Recipe::default() })
        .expect("a creature of that name")
}

fn by_default(source: &Sequence, target: &Sequence, pairs: &[Pair]) -> Transfer {
    transfer(source, target, pairs, &Parameters::default(), &mut Silent).expect("a transfer")
}

fn pairs(a: &Creature, b: &Creature, count: usize) -> Vec<Pair> {
    zoo::correspondences(a, b, count).into_iter().map(|(source, target)| Pair { source, target }).collect()
}

/// The first #V positions only, as one would open a target.
fn still(sequence: &Sequence) -> Sequence {
    Sequence::new(sequence.name(), sequence.faces().to_vec(), sequence.reference().to_vec(), Vec::new())
        .expect("a mesh")
}

/// Mean distance from the truth over vertices and poses, the mean difference of each pose removed, in radii.
fn error(target: &Sequence, found: &[Vec<DVec3>], truth: &[Pose]) -> f64 {
    assert_eq!(found.len(), truth.len());
    let (_, radius) = unit_ball(target.faces(), target.reference());
    let mean = |found: &[DVec3], truth: &[DVec3]| {
        let off: Vec<DVec3> = found.iter().zip(truth).map(|(a, b)| (*a - *b) / radius).collect();
        let middle = off.iter().sum::<DVec3>() / off.len() as f64;
        off.iter().map(|d| (*d - middle).length()).sum::<f64>() / off.len() as f64
    };
    found.iter().zip(truth).map(|(a, b)| mean(a, &b.positions)).sum::<f64>() / truth.len() as f64
}

fn turned(sequence: &Sequence, map: impl Fn(DVec3) -> DVec3) -> Sequence {
    let all = |points: &[DVec3]| points.iter().map(|&p| map(p)).collect::<Vec<_>>();
    let poses = sequence.poses().iter();
    let poses = poses.map(|pose| Pose { positions: all(&pose.positions), ..pose.clone() }).collect();
    Sequence::new(sequence.name(), sequence.faces().to_vec(), all(sequence.reference()), poses).expect("a sequence")
}

/// Far-apart vertices of a mesh, by straight distance.
fn far_apart(points: &[DVec3], count: usize) -> Vec<u32> {
    let mut chosen = vec![0];
    let mut distance: Vec<f64> = points.iter().map(|p| p.distance(points[0])).collect();
    while chosen.len() < count {
        let next = (0..points.len()).max_by(|&a, &b| distance[a].total_cmp(&distance[b])).expect("a vertex");
        chosen.push(next as u32);
        distance.iter_mut().zip(points).for_each(|(d, p)| *d = d.min(p.distance(points[next])));
    }
    chosen
}

#[test]
fn a_mesh_moves_like_itself() {
    for (name, faces) in [("person", 4_000), ("person", 1_000), ("horse", 1_000)] {
        let source = creature(name, faces).sequence;
        let pairs: Vec<Pair> =
            far_apart(source.reference(), 8).into_iter().map(|v| Pair { source: v, target: v }).collect();
        let result = by_default(&source, &still(&source), &pairs);
        let found = error(&source, &result.poses(source.reference()), source.poses());
        println!(
            "{name} of {faces} faces itself {found:.4}, skin of the source {:.4}, {} bones",
            result.source_error, result.bones
        );
        assert!(found < 0.004, "{name}, {faces} faces: {found}");
        assert!(result.warnings.is_empty());
    }
}

/// A body without the faces between its bones, as a robot is, hangs together as it does with them.
#[test]
fn a_body_in_pieces_moves_as_one() {
    for (name, most) in [("person", 0.009), ("horse", 0.005)] {
        let whole = creature(name, 4_000);
        let main = |v: u32| whole.weights[v as usize].iter().max_by(|a, b| a.1.total_cmp(&b.1)).map(|share| share.0);
        let within = |face: &[u32; 3]| face.iter().all(|&v| main(v) == main(face[0]));
        let faces = whole.sequence.faces().iter().copied().filter(within).collect();
        let target =
            Sequence::new("in pieces", faces, whole.sequence.reference().to_vec(), Vec::new()).expect("a mesh");
        let count = WeldedSurface::new(&target).pieces().len();
        let pairs: Vec<Pair> =
            far_apart(target.reference(), 8).into_iter().map(|v| Pair { source: v, target: v }).collect();
        let result = by_default(&whole.sequence, &target, &pairs);
        let found = error(&target, &result.poses(target.reference()), whole.sequence.poses());
        println!("{name} in {count} pieces {found:.4}");
        assert!(count > 10 && found < most, "{name}, {count} pieces: {found}");
    }
}

/// Rotations of a creature's bones in a pose, from the vertices that follow hardly another bone, by the bones' names.
fn rotations(creature: &Creature, pose: &[DVec3]) -> BTreeMap<String, DMat3> {
    let mut moments = vec![(Moments::default(), 0); creature.parts.len()];
    for (v, weights) in creature.weights.iter().enumerate() {
        if let Some(&(bone, _)) = weights.iter().find(|w| w.1 > 0.98) {
            moments[bone as usize].0.add(1.0, creature.sequence.reference()[v], pose[v]);
            moments[bone as usize].1 += 1;
        }
    }
    let named = creature.parts.iter().cloned().zip(moments).filter(|(_, m)| m.1 >= 30);
    named.map(|(name, m)| (name, m.0.motion().rotation)).collect()
}

/// The angle between two rotations, in degrees.
fn angle(a: &DMat3, b: &DMat3) -> f64 {
    let r = a.transpose() * *b;
    (0.5 * (r.x_axis.x + r.y_axis.y + r.z_axis.z - 1.0)).clamp(-1.0, 1.0).acos().to_degrees()
}

/// How far each bone of the target turns from what the source's does, ascending, and how far these turn on the mean; in
/// degrees. The target's own gait is another one: what is known is how each of its bones must turn.
fn bones_off(source: &Creature, target: &Creature, found: &[Vec<DVec3>]) -> (Vec<f64>, f64) {
    let (mut off, mut moved) = (Vec::new(), Vec::new());
    for (pose, found) in source.sequence.poses().iter().zip(found) {
        let truth = rotations(source, &pose.positions);
        for (name, rotation) in rotations(target, found) {
            let Some(truth) = truth.get(&name) else { continue };
            off.push(angle(truth, &rotation));
            moved.push(angle(truth, &DMat3::IDENTITY));
        }
    }
    off.sort_by(f64::total_cmp);
    (off, mean(&moved))
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

#[test]
fn a_camel_walks_like_a_horse() {
    let (horse, camel) = (creature("horse", 8_000), creature("camel", 6_000));
    let result = by_default(&horse.sequence, &still(&camel.sequence), &pairs(&horse, &camel, 14));
    let (off, turning) = bones_off(&horse, &camel, &result.poses(camel.sequence.reference()));
    let found = mean(&off);
    println!(
        "bones off by {found:.2}° of {turning:.2}°, median {:.2}°, worst {:.1}°",
        off[off.len() / 2],
        off[off.len() - 1]
    );
    assert!(found < 0.25 * turning, "{found} of {turning}");
}

/// Four pairs leave much open between figures of other proportions, or with limbs held another way: guides close it.
#[test]
fn few_pairs_are_enough_for_other_proportions() {
    for (a, b, share) in [("cat", "giraffe", 0.3), ("horse", "dog", 0.15), ("person", "person-arms-out", 0.1)] {
        let (source, target) = (creature(a, 8_000), creature(b, 6_000));
        let result = by_default(&source.sequence, &still(&target.sequence), &pairs(&source, &target, 4));
        let (off, turning) = bones_off(&source, &target, &result.poses(target.sequence.reference()));
        let found = mean(&off);
        println!("{a} > {b}, four pairs: bones off by {found:.2}° of {turning:.2}°");
        assert!(found < share * turning, "{a} > {b}: {found} of {turning}");
    }
}

/// A tail that the source has not follows what it grows from, though the source's legs are what lies nearest to it.
#[test]
fn a_tail_without_a_twin_is_held_by_the_pelvis() {
    let (source, target) = (creature("person", 8_000), creature("dinosaur", 6_000));
    let pairs = zoo::landmark_pairs(&source, &target).into_iter();
    let pairs: Vec<Pair> = pairs.map(|(_, source, target)| Pair { source, target }).collect();
    for pairs in [&pairs[..], &pairs[3..]] {
        let result = by_default(&source.sequence, &still(&target.sequence), pairs);
        let poses = result.poses(target.sequence.reference());
        let off = poses.iter().flat_map(|pose| {
            let rotations = rotations(&target, pose);
            let tail = rotations.iter().filter(|bone| bone.0.starts_with("tail"));
            tail.map(|bone| angle(bone.1, &rotations["pelvis"])).collect::<Vec<_>>()
        });
        let found = mean(&off.collect::<Vec<_>>());
        println!("person > dinosaur, {} pairs: the tail turns {found:.1}° against the pelvis", pairs.len());
        assert!(found < 10.0, "{found}");
    }
}

/// The same where faces carry the motion, and the source is bent into the target.
#[test]
fn few_pairs_are_enough_by_gradients() {
    for (a, b, share) in [("cat", "giraffe", 0.2), ("horse", "dog", 0.15), ("dog", "elephant", 0.1)] {
        let (source, target) = (creature(a, 8_000), creature(b, 6_000));
        let parameters = Parameters { method: Method::Gradients, ..Parameters::default() };
        let mover = Mover::new(&source.sequence, &still(&target.sequence), &parameters, &mut Silent).expect("a mover");
        let result = mover.transfer(&pairs(&source, &target, 4), &mut Silent).expect("a transfer");
        let (off, turning) = bones_off(&source, &target, &result.poses);
        let found = mean(&off);
        println!("{a} > {b}, four pairs, by gradients: bones off by {found:.2}° of {turning:.2}°");
        assert!(found < share * turning, "{a} > {b}: {found} of {turning}");
    }
}

#[test]
fn size_place_and_up_axis_do_not_matter() {
    let person = creature("person", 3_000).sequence;
    let z_up = |p: DVec3| 37.0 * DVec3::new(p.x, -p.z, p.y) + DVec3::new(500.0, 20.0, -3.0);
    let target = turned(&person, z_up);
    let pairs: Vec<Pair> =
        far_apart(person.reference(), 6).into_iter().map(|v| Pair { source: v, target: v }).collect();
    let result = by_default(&person, &still(&target), &pairs);
    let found = error(&target, &result.poses(target.reference()), target.poses());
    assert!(found < 0.008, "{found}");
    let expected = DMat3::from_cols(DVec3::X, DVec3::Z, DVec3::NEG_Y);
    assert_eq!(result.alignment.turn, expected);
    // The result lies in the target's own frame: also where it stands.
    let middle = |points: &[DVec3]| points.iter().sum::<DVec3>() / points.len() as f64;
    for (found, truth) in result.poses(target.reference()).iter().zip(target.poses()) {
        assert!(middle(found).distance(middle(&truth.positions)) < 0.02 * 37.0);
    }
}

#[test]
fn one_pair_is_enough_to_move() {
    let (horse, camel) = (creature("horse", 3_000), creature("camel", 3_000));
    for count in 1..4 {
        let result = by_default(&horse.sequence, &still(&camel.sequence), &pairs(&horse, &camel, count));
        assert!(result.warnings.iter().any(|w| w.code == "few-pairs"));
        let (_, radius) = unit_ball(camel.sequence.faces(), camel.sequence.reference());
        let poses = result.poses(camel.sequence.reference());
        for (p, q) in poses.iter().flat_map(|pose| pose.iter().zip(camel.sequence.reference())) {
            assert!(p.is_finite() && p.distance(*q) < 2.0 * radius);
        }
    }
}

#[test]
fn shares_sum_to_one_and_forms_of_the_skin_agree() {
    let (horse, camel) = (creature("horse", 3_000), creature("camel", 3_000));
    let skin = by_default(&horse.sequence, &still(&camel.sequence), &pairs(&horse, &camel, 10)).skin;
    let most = skin.most_influences();
    assert!(most <= 8);
    let (indices, shares) = skin.influences(most);
    let dense = skin.dense();
    let matrices = skin.matrices();
    assert_eq!(matrices.len(), 12 * 12 * skin.handles.len());
    for (v, row) in skin.rows.iter().enumerate() {
        assert!((row.iter().map(|entry| entry.1).sum::<f64>() - 1.0).abs() < 1e-12);
        for k in 0..most {
            let handle = usize::from(indices[v * most + k]);
            let share = f64::from(shares[v * most + k]);
            assert!(share == 0.0 || (share - dense[v * skin.handles.len() + handle]).abs() < 1e-6);
        }
    }
    assert_eq!(skin.pose(camel.sequence.reference(), 999), camel.sequence.reference());
}

#[test]
fn following_a_dragged_point_stays_close_to_a_fresh_start() {
    let (horse, camel) = (creature("horse", 6_000), creature("camel", 6_000));
    let all = pairs(&horse, &camel, 12);
    let mut moved = all.clone();
    moved[5].target = camel.sequence.faces()[0][0];
    if moved.iter().enumerate().any(|(i, p)| i != 5 && p.target == moved[5].target) {
        moved[5].target = all[5].target;
    }
    let target = still(&camel.sequence);
    let mut prepared = Prepared::new(&horse.sequence, &target, &Parameters::default(), &mut Silent).expect("prepared");
    prepared.transfer(&moved, &mut Silent).expect("a transfer");
    let followed = prepared.follow(&all, &mut Silent).expect("a transfer");
    let fresh = prepared.transfer(&all, &mut Silent).expect("a transfer");
    let as_poses = |transfer: &Transfer| -> Vec<Pose> {
        let poses = transfer.poses(target.reference()).into_iter();
        poses.map(|positions| Pose { name: String::new(), time: 0.0, positions }).collect()
    };
    let apart = error(&target, &followed.poses(target.reference()), &as_poses(&fresh));
    println!("{apart:.4} after {:?}", followed.seconds);
    assert!(apart < 0.02, "{apart}");
}

#[test]
fn another_pose_follows_without_a_new_start() {
    let (horse, camel) = (creature("horse", 3_000), creature("camel", 3_000));
    let pairs = pairs(&horse, &camel, 10);
    let (few, rest) = horse.sequence.poses().split_at(8);
    let source = horse.sequence.faces().to_vec();
    let source = Sequence::new("few", source, horse.sequence.reference().to_vec(), few.to_vec()).expect("a sequence");
    let target = still(&camel.sequence);
    for method in [Method::Bones, Method::Direct, Method::Relative] {
        let parameters = Parameters { method, ..Parameters::default() };
        let mut prepared = Prepared::new(&source, &target, &parameters, &mut Silent).expect("prepared");
        assert_eq!(prepared.maps(&few[0].positions), None);
        let result = prepared.transfer(&pairs, &mut Silent).expect("a transfer");
        for (pose, maps) in few.iter().zip(&result.skin.maps) {
            assert_eq!(prepared.maps(&pose.positions).as_ref(), Some(maps));
        }
        // The gait goes on: the next pose lies as far from the last as that from the one before.
        let maps = prepared.maps(&rest[0].positions).expect("maps");
        let next = result.skin.posed(target.reference(), &maps);
        let poses = result.poses(target.reference());
        let apart = |a: &[DVec3], b: &[DVec3]| a.iter().zip(b).map(|(a, b)| a.distance(*b)).sum::<f64>();
        assert!(apart(&next, &poses[7]) < 3.0 * apart(&poses[7], &poses[6]), "{method:?}");
        assert_eq!(prepared.maps(&rest[0].positions[1..]), None);
        assert_eq!(prepared.maps(&vec![DVec3::NAN; horse.sequence.reference().len()]), None);
    }
}

#[test]
fn which_way_faces_are_wound_does_not_matter() {
    let (horse, camel) = (creature("horse", 2000), creature("camel", 2000));
    let pairs = pairs(&horse, &camel, 14);
    let inside_out = |sequence: &Sequence| {
        let faces = sequence.faces().iter().map(|&[a, b, c]| [a, c, b]).collect();
        Sequence::new(sequence.name(), faces, sequence.reference().to_vec(), sequence.poses().to_vec()).expect("a mesh")
    };
    let (source, target) = (&horse.sequence, still(&camel.sequence));
    let expected = by_default(source, &target, &pairs).poses(target.reference());
    for (source, target) in [(inside_out(source), target.clone()), (source.clone(), inside_out(&target))] {
        let found = by_default(&source, &target, &pairs).poses(target.reference());
        let far =
            expected.iter().flatten().zip(found.iter().flatten()).map(|(a, b)| a.distance(*b)).fold(0.0, f64::max);
        assert!(far < 1e-3 * target.diagonal(), "{far}");
    }
}

/// A bone of one vertex, or of vertices on a line, does not say how it turns; rounding must not say it instead.
#[test]
fn a_floor_under_the_source_changes_nothing() {
    let (horse, camel) = (creature("horse", 2_000), creature("camel", 2_000));
    let (scene, target) = (floor::on_a_floor(&horse.sequence, 30.0), still(&camel.sequence));
    let pairs = pairs(&horse, &camel, 10);
    let [alone, standing] = [&horse.sequence, &scene].map(|source| by_default(source, &target, &pairs));
    assert_eq!(alone.poses(target.reference()), standing.poses(target.reference()));
}

/// A button on the target is a piece of its own: all of it follows one row, that of what lies beneath it.
#[test]
fn a_small_loose_piece_keeps_its_shape() {
    let (horse, camel) = (creature("horse", 2_000), creature("camel", 2_000));
    let (mut faces, mut points) = (camel.sequence.faces().to_vec(), camel.sequence.reference().to_vec());
    let first = points.len() as u32;
    let (beneath, size) = (points[faces[700][0] as usize], 0.01 * camel.sequence.diagonal());
    points.extend([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| beneath + size * (p + DVec3::ONE)));
    faces.extend([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|face| face.map(|v: u32| v + first)));
    let target = Sequence::new("with a button", faces, points, Vec::new()).expect("a mesh");
    let skin = by_default(&horse.sequence, &target, &pairs(&horse, &camel, 12)).skin;
    let rows = &skin.rows[first as usize..];
    assert!(rows.iter().all(|row| row == &rows[0] && !row.is_empty()));
}

/// Where arms hang on one and are spread on the other, a person is told; not where only proportions differ.
#[test]
fn different_postures_are_noticed() {
    let person = creature("person", 4_000);
    for (name, differ) in [("person-arms-out", true), ("person-broad", false)] {
        let target = creature(name, 4_000);
        let found = by_default(&person.sequence, &still(&target.sequence), &pairs(&person, &target, 14));
        assert_eq!(
            found.warnings.iter().any(|w| w.code == "different-postures"),
            differ,
            "{name}: {:?}",
            found.warnings
        );
    }
}

/// A skirt has no pair and no twin on the waving source, whose hands hang beside it: it stays on the hips.
#[test]
fn clothes_follow_the_body_beneath() {
    let recipe = Recipe { name: "person".into(), faces: 4_000, poses: 12, motion: "wave".into(), ..Recipe::default() };
    let person = zoo::make(&recipe).expect("a person");
    let (mut faces, mut points) = (person.sequence.faces().to_vec(), person.sequence.reference().to_vec());
    let (first, around, rows) = (points.len() as u32, 24, 10);
    for row in 0..rows {
        let down = f64::from(row) / f64::from(rows - 1);
        points.extend((0..around).map(|i| {
            let (sine, cosine) = (f64::from(i) / f64::from(around) * std::f64::consts::TAU).sin_cos();
            DVec3::new((0.17 + 0.09 * down) * cosine, 1.02 - 0.42 * down, (0.14 + 0.10 * down) * sine)
        }));
    }
    for (row, i) in (1..rows).flat_map(|row| (0..around).map(move |i| (row, i))) {
        let at = |row: u32, i: u32| first + row * around + i % around;
        faces.push([at(row, i), at(row - 1, i), at(row, i + 1)]);
        faces.push([at(row, i + 1), at(row - 1, i), at(row - 1, i + 1)]);
    }
    let target = Sequence::new("in a skirt", faces, points, Vec::new()).expect("a mesh");
    let pairs: Vec<Pair> =
        far_apart(person.sequence.reference(), 12).into_iter().map(|v| Pair { source: v, target: v }).collect();
    let poses = by_default(&person.sequence, &target, &pairs).poses(target.reference());
    let moved = |pose: &[DVec3], rest: &[DVec3], from: usize, to: usize| -> f64 {
        (from..to).map(|v| pose[v].distance(rest[v])).fold(0.0, f64::max)
    };
    let skirt =
        poses.iter().map(|pose| moved(pose, target.reference(), first as usize, pose.len())).fold(0.0, f64::max);
    let body = person
        .sequence
        .poses()
        .iter()
        .map(|pose| moved(&pose.positions, person.sequence.reference(), 0, first as usize))
        .fold(0.0, f64::max);
    println!("a skirt moves by {skirt:.3}, a waving hand by {body:.3}");
    assert!(skirt < 0.1 * body, "{skirt} of {body}");
}

/// A figure that grows while it walks makes the other one grow as well, and walk as it would.
#[test]
fn growth_is_carried_over() {
    let (horse, camel) = (creature("horse", 2_000), creature("camel", 2_000));
    let (target, pairs) = (still(&camel.sequence), pairs(&horse, &camel, 12));
    let size = |pose: usize| [0.5, 1.0, 1.3, 2.0][pose % 4];
    let poses = horse
        .sequence
        .poses()
        .iter()
        .enumerate()
        .map(|(i, pose)| Pose { positions: pose.positions.iter().map(|&p| size(i) * p).collect(), ..pose.clone() });
    let (faces, reference) = (horse.sequence.faces().to_vec(), horse.sequence.reference().to_vec());
    let growing = Sequence::new("growing", faces, reference, poses.collect()).expect("a sequence");
    let [steady, grown] = [&horse.sequence, &growing].map(|source| by_default(source, &target, &pairs));
    let truth = steady.poses(target.reference()).into_iter().enumerate();
    let truth = truth.map(|(i, pose)| pose.into_iter().map(|p| size(i) * p).collect());
    let truth: Vec<Pose> = truth.map(|positions| Pose { name: String::new(), time: 0.0, positions }).collect();
    let off = error(&target, &grown.poses(target.reference()), &truth);
    println!("growing: off by {off:.1e}");
    assert!(off < 1e-3, "{off}");
}

#[test]
fn bones_of_few_vertices_do_not_spin() {
    for (name, faces) in [("dog", 600), ("person", 900), ("octopus", 900)] {
        let source = creature(name, faces).sequence;
        let mut poses = source.poses().to_vec();
        let nearly =
            |(i, p): (usize, &DVec3)| *p + 1e-7 * source.diagonal() * DVec3::splat(((i * 7919) % 13) as f64 - 6.0);
        poses.push(Pose { positions: poses[0].positions.iter().enumerate().map(nearly).collect(), ..poses[0].clone() });
        let surface = WeldedSurface::new(&source);
        let places: Vec<Vec<DVec3>> = poses.iter().map(|pose| surface.unit(&pose.positions)).collect();
        let rig = Rig::new(&surface, &places, 64);
        let apart = |(a, b): (&DAffine3, &DAffine3)| frobenius(a.matrix3 - b.matrix3);
        let most = rig.maps[0].iter().zip(&rig.maps[poses.len() - 1]).map(apart).fold(0.0, f64::max);
        println!("{name}: {} bones, {most:.1e} apart", rig.bones);
        assert!(most < 0.05, "{name}: {most}");
    }
}

#[test]
fn seams_stay_closed_and_loose_vertices_stay_finite() {
    let person = creature("person", 2_000).sequence;
    // Every face with vertices of its own, and a vertex far away that no face uses.
    let split = |points: &[DVec3]| -> Vec<DVec3> {
        let mut all: Vec<DVec3> = person.faces().iter().flatten().map(|&v| points[v as usize]).collect();
        all.push(DVec3::splat(1e4));
        all
    };
    let faces: Vec<[u32; 3]> = (0..person.faces().len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
    let target = Sequence::new("split", faces, split(person.reference()), Vec::new()).expect("a mesh");
    let corner = |v: u32| person.faces().iter().flatten().position(|&u| u == v).expect("a corner") as u32;
    let pairs: Vec<Pair> =
        far_apart(person.reference(), 6).into_iter().map(|v| Pair { source: v, target: corner(v) }).collect();
    let result = by_default(&person, &target, &pairs);
    for pose in result.poses(target.reference()) {
        assert!(pose.iter().all(|p| p.is_finite()));
        let mut at = vec![None; person.reference().len()];
        for (&v, p) in person.faces().iter().flatten().zip(&pose) {
            assert_eq!(*at[v as usize].get_or_insert(*p), *p);
        }
    }
}

#[test]
fn what_cannot_be_used_is_said_in_words() {
    let person = creature("person", 1_000).sequence;
    let run = |pairs: &[Pair]| transfer(&person, &still(&person), pairs, &Parameters::default(), &mut Silent);
    let pair = |source, target| Pair { source, target };
    assert_eq!(run(&[]).expect_err("an error"), TransferError::NoPairs);
    let error = run(&[pair(0, 0), pair(1, 99_999)]).expect_err("an error");
    assert!(error.to_string().starts_with("pair 1 names vertex 99999 of the target"), "{error}");
    let error = run(&[pair(0, 0), pair(0, 5)]).expect_err("an error");
    assert_eq!(error, TransferError::SamePlace { first: 0, second: 1, side: "source" });
    let error = run(&[pair(0, 5), pair(1, 5)]).expect_err("an error");
    assert_eq!(error, TransferError::SamePlace { first: 0, second: 1, side: "target" });
    let repeated = run(&[pair(0, 0), pair(9, 9), pair(90, 90), pair(200, 200), pair(9, 9)]).expect("a transfer");
    assert!(repeated.warnings.iter().any(|w| w.code == "repeated-pair"));
    let points = Sequence::new("points", Vec::new(), vec![DVec3::ZERO; 4], Vec::new()).expect("points");
    let error = transfer(&person, &points, &[pair(0, 0)], &Parameters::default(), &mut Silent);
    assert_eq!(error.expect_err("an error"), TransferError::NoFaces { side: "target" });
    let stop =
        transfer(&person, &still(&person), &[pair(0, 0)], &Parameters::default(), &mut |_: &'static str, _: f64| false);
    assert_eq!(stop.expect_err("an error"), TransferError::Cancelled);
    let fitting = |closeness: f64| Fitting { closeness: vec![0.0, closeness], ..Fitting::default() };
    for (name, wrong) in [
        ("bones", Parameters { bones: 0, ..Parameters::default() }),
        ("doubt", Parameters { doubt: f64::NAN, method: Method::Gradients, ..Parameters::default() }),
        ("closeness", Parameters { fitting: fitting(-1.0), method: Method::Posed, ..Parameters::default() }),
    ] {
        let error = transfer(&person, &still(&person), &[pair(0, 0)], &wrong, &mut Silent).expect_err("an error");
        assert!(matches!(error, TransferError::Parameter { name: said, .. } if said == name), "{error}");
    }
}

#[test]
fn bodies_of_one_topology_move_as_they_truly_do() {
    let Some(data) = npz::data("bodies whose true motion is known") else { return };
    let body = |name: &str| npz::sequence(&data.join(format!("anny/low_shared_{name}.npz")));
    let man = body("man_lean");
    for (name, few, many) in [("woman", 0.0125, 0.0105), ("heavy_man", 0.0130, 0.0125)] {
        let target = body(name);
        for (count, bound) in [(6, few), (14, many)] {
            let points = far_apart(man.reference(), count);
            let pairs: Vec<Pair> = points.into_iter().map(|v| Pair { source: v, target: v }).collect();
            let result = by_default(&man, &still(&target), &pairs);
            let found = error(&target, &result.poses(target.reference()), target.poses());
            println!("{name}, {count} pairs: {found:.4}");
            assert!(found < bound, "{name}, {count} pairs: {found}");
        }
    }
}

#[test]
fn bodies_of_their_own_topology_move_as_they_truly_do() {
    let Some(data) = npz::data("bodies of their own topology whose true motion is known") else { return };
    let body = |name: &str| npz::sequence(&data.join(format!("anny/low_{name}.npz")));
    let man = body("shared_man_lean");
    for (name, bound) in [("woman", 0.0105), ("heavy_man", 0.0125)] {
        let (shared, target) = (body(&format!("shared_{name}")), body(&format!("own_{name}")));
        let twin = |v: u32| {
            let at = shared.reference()[v as usize];
            let far = |u: &u32| target.reference()[*u as usize].distance(at);
            (0..target.reference().len() as u32).min_by(|a, b| far(a).total_cmp(&far(b))).expect("a vertex")
        };
        let points = far_apart(man.reference(), 14).into_iter();
        let pairs: Vec<Pair> = points.map(|v| Pair { source: v, target: twin(v) }).collect();
        let result = by_default(&man, &still(&target), &pairs);
        let found = error(&target, &result.poses(target.reference()), target.poses());
        println!("{name}, own topology: {found:.4}");
        assert!(found < bound, "{name}: {found}");
    }
}
