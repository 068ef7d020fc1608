//! Proposed correspondences against true ones; `cargo bench --bench proposals` prints them for more draws and pairs.
#![cfg(not(target_arch = "wasm32"))]

#[path = "common/npz.rs"]
mod npz;
#[path = "common/proposals.rs"]
mod proposals;

use glam::DVec3;
use proposals::{
    Case, Draw, Errors, animal_case, between, body_cases, creature, mean, measure, most, proposer, zoo_case,
};
use sinew::sequence::Sequence;
use sinew::transfer::propose::Proposer;
use sinew::zoo::{self, Creature, Recipe};

/// Checks the mean over draws, in % of the diagonal, against `(given, median, worst)`, and that no side is swapped from
/// three given points on.
fn check(case: &Case, bounds: &[(usize, f64, f64)]) {
    let proposer = proposer(case);
    for &(given, median, worst) in bounds {
        let mut errors = Errors::default();
        for seed in 0..2 {
            measure(case, &proposer, given, seed, &Draw::Spread, &mut errors);
            if given > 0 {
                measure(case, &proposer, given, seed, &Draw::Random(seed + 1), &mut errors);
            }
        }
        let found = (mean(&errors.median), mean(&errors.worst));
        println!(
            "{:30} {given} given: median {:.2}, worst {:.1} (single draws {:.1}), {} swapped, {:.0} ms",
            case.name,
            found.0,
            found.1,
            most(&errors.worst),
            errors.swapped,
            1000.0 * errors.seconds
        );
        assert!(found.0 <= median && found.1 <= worst, "{}, {given} given: {found:?}", case.name);
        assert!(given < 3 || errors.swapped == 0, "{}, {given} given: {} swapped", case.name, errors.swapped);
    }
}

/// Checks that with five points given, always the one that was asked for, none of the others is farther off than `worst`.
fn check_advised(case: &Case, worst: f64) {
    let proposer = proposer(case);
    let mut errors = Errors::default();
    (0..3).for_each(|seed| measure(case, &proposer, 5, seed, &Draw::Advised, &mut errors));
    println!(
        "{:30} 5 given as asked for: median {:.2}, worst {:.1} (single draws {:.1})",
        case.name,
        mean(&errors.median),
        mean(&errors.worst),
        most(&errors.worst)
    );
    assert!(most(&errors.worst) <= worst, "{}, as asked for: {:?}", case.name, errors.worst);
}

#[test]
fn creatures_of_one_build() {
    check(&zoo_case("person", "person-arms-out"), &[(3, 3.0, 8.0)]);
    check(&zoo_case("horse", "camel"), &[(3, 4.0, 10.0)]);
}

#[test]
fn creatures_of_other_proportions() {
    let usual = Recipe { faces: 12_000, poses: 1, exact: false, ..Recipe::default() };
    for other in [
        Recipe { name: "person".into(), head: 1.4, legs: 1.5, arms: 0.7, ..usual.clone() },
        Recipe { name: "horse".into(), head: 1.5, neck: 1.6, legs: 1.6, ..usual.clone() },
        Recipe { name: "dog".into(), build: 1.4, head: 0.7, legs: 1.7, tail: 0.6, ..usual.clone() },
        Recipe { name: "bird".into(), build: 0.7, neck: 1.4, legs: 1.7, ..usual.clone() },
    ] {
        let other = zoo::make(&other).expect("a creature of that name");
        let own = creature(other.sequence.name());
        check(&between(own, other), &[(0, 4.0, 10.0), (3, 4.0, 10.0)]);
    }
}

/// The surface of a person as games have it: head, shirt, trousers, hands and feet, each a piece with an open rim, one a
/// little wider than the other. Vertices keep their order within a piece; returned with the first copy of each vertex.
fn in_pieces(creature: &Creature) -> (Sequence, Vec<u32>) {
    let garment = |part: &str| match part {
        "head" => 0,
        "pelvis" => 2,
        _ if part.ends_with("hand") => 3 + usize::from(part.starts_with("left")),
        _ if part.ends_with("foot") => 5 + usize::from(part.starts_with("left")),
        _ if part.ends_with("thigh") || part.ends_with("shank") => 2,
        _ => 1,
    };
    let (faces, points) = (creature.sequence.faces(), creature.sequence.reference());
    let mut normals = vec![DVec3::ZERO; points.len()];
    for face in faces {
        let [a, b, c] = face.map(|v| points[v as usize]);
        face.iter().for_each(|&v| normals[v as usize] += (b - a).cross(c - a));
    }
    let wider = 0.004 * creature.sequence.diagonal();
    let (mut first, mut cut_faces, mut cut_points) = (vec![u32::MAX; points.len()], Vec::new(), Vec::new());
    for piece in 0..7 {
        let mut number = vec![u32::MAX; points.len()];
        let here = (0..faces.len()).filter(|&f| garment(&creature.parts[creature.labels[f] as usize]) == piece);
        for f in here {
            cut_faces.push(faces[f].map(|v| {
                let v = v as usize;
                if number[v] == u32::MAX {
                    number[v] = cut_points.len() as u32;
                    cut_points.push(points[v] + wider * f64::from(piece as u8 % 3) * normals[v].normalize_or_zero());
                    first[v] = first[v].min(number[v]);
                }
                number[v]
            }));
        }
    }
    (Sequence::new(creature.sequence.name(), cut_faces, cut_points, Vec::new()).expect("a mesh"), first)
}

/// Where a shirt hangs on the trousers is found all around, not where it happens to come nearest.
#[test]
fn a_body_in_pieces_is_not_turned_round() {
    let usual = Recipe { name: "person".into(), faces: 12_000, poses: 1, exact: false, ..Recipe::default() };
    let own = zoo::make(&usual).expect("a person");
    for other in [
        Recipe { head: 0.88, legs: 1.33, arms: 0.88, build: 1.24, ..usual.clone() },
        Recipe { head: 1.06, legs: 1.12, arms: 1.06, build: 1.06, ..usual.clone() },
        Recipe { head: 1.24, legs: 0.91, arms: 1.24, build: 0.88, ..usual.clone() },
    ] {
        let other = zoo::make(&other).expect("a person");
        let pairs = zoo::correspondences(&own, &other, 60);
        let ((source, first), (target, _)) = (in_pieces(&own), in_pieces(&other));
        let place = |t: u32| other.sequence.reference()[t as usize];
        let pairs = pairs.into_iter().map(|(s, t)| (first[s as usize], place(t))).collect();
        check(&Case { name: "person in pieces".into(), source, target, pairs }, &[(0, 3.0, 6.0)]);
    }
}

#[test]
fn points_of_a_coarse_mesh_get_places_of_their_own() {
    let recipe = Recipe { name: "person".into(), faces: 12_000, poses: 1, ..Recipe::default() };
    let (own, coarse) = (zoo::make(&recipe), zoo::make(&Recipe { faces: 300, legs: 0.6, ..recipe.clone() }));
    let case = between(own.expect("a person"), coarse.expect("a person"));
    let points: Vec<u32> = case.pairs.iter().map(|pair| pair.0).collect();
    let known: Vec<Option<u32>> = (0..points.len()).map(|i| (i == 7).then_some(5)).collect();
    let proposals = proposer(&case).propose(&points, &known).expect("proposals");
    let mut targets: Vec<u32> = proposals.points.iter().map(|p| p.target).collect();
    assert_eq!(targets[7], 5);
    targets.sort_unstable();
    targets.dedup();
    assert_eq!(targets.len(), points.len());
}

#[test]
fn a_trunk_is_not_taken_for_a_tail() {
    check(&zoo_case("cat", "elephant"), &[(0, 4.0, 15.0), (3, 4.0, 10.0)]);
    check(&zoo_case("elephant", "cat"), &[(0, 4.0, 15.0), (3, 4.0, 10.0)]);
}

/// A giraffe's neck reaches where, laid over it as they stand, a cat's forelegs are.
#[test]
fn legs_are_not_taken_for_a_long_neck() {
    check(&zoo_case("cat", "giraffe"), &[(0, 4.0, 12.0), (3, 4.0, 12.0)]);
    check(&zoo_case("giraffe", "cat"), &[(0, 4.0, 12.0), (3, 4.0, 12.0)]);
}

/// Its tail is as long as a camel's neck.
#[test]
fn a_cat_is_not_taken_for_a_camel_walking_backwards() {
    check(&zoo_case("camel", "cat"), &[(0, 4.0, 12.0)]);
    check(&zoo_case("cat", "camel"), &[(0, 4.0, 12.0)]);
}

#[test]
fn bodies_and_animals() {
    let Some(data) = npz::data("proposals on bodies and animals") else { return };
    for case in body_cases(&data, &[("man_lean", "woman"), ("man_lean", "heavy_man")]) {
        check(&case, &[(0, 1.5, 4.0)]);
    }
    let animals = animal_case(&data, "horse", "camel", "horse_camel.cons");
    check(&animals, &[(0, 6.0, 15.0), (5, 3.0, 11.0)]);
    check_advised(&animals, 9.0);
}

/// The median error when the target is turned and nothing is given.
fn turned(mut case: Case, turn: fn(DVec3) -> DVec3) -> f64 {
    let places = case.target.reference().iter().map(|&p| turn(p)).collect();
    case.target = Sequence::new("turned", case.target.faces().to_vec(), places, Vec::new()).expect("a mesh");
    case.pairs.iter_mut().for_each(|pair| pair.1 = turn(pair.1));
    let mut errors = Errors::default();
    measure(&case, &proposer(&case), 0, 0, &Draw::Spread, &mut errors);
    println!("{}, turned: median {:.2}, worst {:.1}", case.name, errors.median[0], errors.worst[0]);
    errors.median[0]
}

#[test]
fn a_target_with_another_axis_up_is_found_out() {
    let median = turned(zoo_case("horse", "camel"), |p| DVec3::new(p.x, -p.z, p.y));
    assert!(median <= 4.0, "{median}");
}

#[test]
fn a_target_that_faces_back_is_found_out() {
    for (source, target) in [("horse", "camel"), ("giraffe", "dog"), ("person", "person-arms-out")] {
        let median = turned(zoo_case(source, target), |p| DVec3::new(-p.x, p.y, -p.z));
        assert!(median <= 4.0, "{median}");
    }
}

#[test]
fn known_points_are_echoed_and_the_answer_is_always_the_same() {
    let case = zoo_case("person", "person-arms-out");
    let proposer = proposer(&case);
    let points: Vec<u32> = case.pairs.iter().take(8).map(|p| p.0).collect();
    let mut known = vec![None; 8];
    known[3] = Some(17);
    let first = proposer.propose(&points, &known).expect("proposals");
    assert_eq!((first.points[3].target, first.points[3].confidence), (17, 1.0));
    assert_eq!(first, proposer.propose(&points, &known).expect("proposals"));
    assert!(first.next.is_some_and(|next| next != 3 && next < 8));
    let all = vec![Some(1); 8];
    assert_eq!(proposer.propose(&points, &all).expect("proposals").next, None);
}

/// Meshes that are hardly meshes.
fn odd_meshes() -> Vec<(Vec<[u32; 3]>, Vec<DVec3>)> {
    let triangle = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let fan: Vec<DVec3> =
        (0..8).map(|i| DVec3::new(f64::from(i).cos(), f64::from(i).sin(), 0.3 * f64::from(i))).collect();
    let apart: Vec<DVec3> =
        (0..30).map(|i| DVec3::new(f64::from(i / 3) * 5.0, f64::from(i % 3), f64::from(i % 2))).collect();
    vec![
        (vec![[0, 1, 2]], triangle.clone()),
        (vec![], triangle.clone()),
        (vec![], vec![DVec3::ONE]),
        (vec![[0, 1, 2]], vec![DVec3::ONE; 3]),
        (vec![[0, 0, 1], [0, 1, 9]], triangle.clone()),
        (vec![[0, 1, 2]], vec![DVec3::ZERO, DVec3::X, DVec3::NAN]),
        (vec![[0, 1, 2]], triangle.iter().map(|p| *p * 1e200).collect()),
        (vec![[0, 1, 2]], triangle.iter().map(|p| *p * 1e-200).collect()),
        ((2..8).map(|i| [0, 1, i]).collect(), fan),
        ((0..10).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect(), apart),
    ]
}

#[test]
fn odd_meshes_get_an_answer() {
    let small = Recipe { name: "horse".into(), faces: 2_000, poses: 1, exact: false, ..Recipe::default() };
    let horse = zoo::make(&small).expect("a horse").sequence;
    let mut meshes = odd_meshes();
    meshes.push((horse.faces().to_vec(), horse.reference().to_vec()));
    for (i, (sf, sp)) in meshes.iter().enumerate() {
        for (j, (tf, tp)) in meshes.iter().enumerate() {
            let proposer = Proposer::new(sf, sp, tf, tp).expect("meshes with vertices");
            let points: Vec<u32> = (0..sp.len().min(5) as u32).chain([0, 0]).collect();
            for given in [0, 1, points.len()] {
                let known: Vec<_> = (0..points.len()).map(|k| (k < given).then_some(0)).collect();
                let proposals = proposer.propose(&points, &known).expect("proposals");
                for p in &proposals.points {
                    assert!((p.target as usize) < tp.len(), "{i} {j}");
                    assert!((0.0..=1.0).contains(&p.confidence), "{i} {j}: {}", p.confidence);
                }
            }
        }
    }
    assert!(Proposer::new(&[], &[], &[], &[DVec3::ONE]).is_err());
    let proposer = Proposer::new(&[], &[DVec3::ONE], &[], &[DVec3::ONE]).expect("a point each");
    assert!(proposer.propose(&[1], &[None]).is_err());
    assert!(proposer.propose(&[0], &[Some(1)]).is_err());
    assert!(proposer.propose(&[0], &[]).is_err());
    assert_eq!(proposer.propose(&[], &[]).expect("nothing").next, None);
}
