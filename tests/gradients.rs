//! Transfer by gradients: identity, published results, true answers, and input as it is.
#![cfg(not(target_arch = "wasm32"))]

#[path = "common/npz.rs"]
mod npz;

use glam::{DMat3, DVec3};
use nalgebra::DMatrix;
use sinew::mesh::DualGraph;
use sinew::mesh::ball::unit_ball;
use sinew::observer::Silent;
use sinew::sequence::{Pose, Sequence};
use sinew::transfer::gradients::solver::{Solver, bridging};
use sinew::transfer::gradients::{Moved, Mover};
use sinew::transfer::surface::WeldedSurface;
use sinew::transfer::{Method, Pair, Parameters, TransferError};
use sinew::zoo::{self, Creature, Recipe};

fn creature(name: &str, faces: usize) -> Creature {
    zoo::make(&Recipe { name: name.into(), faces, poses: 8, exact: false, ..Recipe::default() })
        .expect("a creature of that name")
}

fn pairs(a: &Creature, b: &Creature, count: usize) -> Vec<Pair> {
    zoo::correspondences(a, b, count).into_iter().map(|(source, target)| Pair { source, target }).collect()
}

/// By one of the two methods, from a target that stands still.
fn moved(method: Method, source: &Sequence, target: &Sequence, pairs: &[Pair]) -> Moved {
    let parameters = Parameters { method, ..Parameters::default() };
    let mover = Mover::new(source, &target.reference_alone(), &parameters, &mut Silent).expect("a mover");
    let moved = mover.transfer(pairs, &mut Silent).expect("a transfer");
    println!("  {:?} {:.4?} {:.3?} {} parts", mover.seconds(), moved.seconds, moved.bent.quality, moved.parts);
    moved
}

/// For each pose the mean distance from the truth, the mean difference removed, over `size`.
fn apart(found: &[Vec<DVec3>], truth: &[Pose], size: f64) -> Vec<f64> {
    assert_eq!(found.len(), truth.len());
    let mean = |found: &[DVec3], truth: &[DVec3]| {
        let off: Vec<DVec3> = found.iter().zip(truth).map(|(a, b)| (*a - *b) / size).collect();
        let middle = off.iter().sum::<DVec3>() / off.len() as f64;
        off.iter().map(|d| (*d - middle).length()).sum::<f64>() / off.len() as f64
    };
    found.iter().zip(truth).map(|(a, b)| mean(a, &b.positions)).collect()
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

fn same(vertices: impl IntoIterator<Item = u32>) -> Vec<Pair> {
    vertices.into_iter().map(|v| Pair { source: v, target: v }).collect()
}

fn markers(path: &std::path::Path) -> Vec<Pair> {
    let text = std::fs::read_to_string(path).expect("a list of pairs");
    let numbers = |line: &str| -> Vec<u32> {
        line.split(|c: char| !c.is_ascii_digit()).filter_map(|word| word.parse().ok()).collect()
    };
    text.lines().map(numbers).filter(|n| n.len() == 2).map(|n| Pair { source: n[0], target: n[1] }).collect()
}

#[test]
fn published_results_are_met() {
    let Some(data) = npz::data("Sumner's own results") else { return };
    let data = data.join("sumner");
    for (source, target, pairs) in [("horse", "camel", "horse_camel.cons"), ("cat", "lion", "marker-cat-lion.txt")] {
        let [source, target] = [source, target].map(|name| npz::sequence(&data.join(format!("{name}.npz"))));
        let found = moved(Method::Gradients, &source, &target, &markers(&data.join(pairs)));
        let off = apart(&found.poses, target.poses(), target.diagonal());
        println!("{} to {}: {:.5} {off:.4?}", source.name(), target.name(), mean(&off));
        assert!(mean(&off) <= 0.015);
    }
}

#[test]
fn with_every_true_correspondence_bodies_move_as_they_truly_do() {
    let Some(data) = npz::data("bodies whose true motion is known") else { return };
    let body = |name: &str| npz::sequence(&data.join(format!("anny/low_shared_{name}.npz")));
    let man = body("man_lean");
    for (name, bound) in [("woman", 0.0095), ("heavy_man", 0.0115)] {
        let target = body(name);
        let (_, radius) = unit_ball(target.faces(), target.reference());
        let found = moved(Method::Gradients, &man, &target, &same(0..man.reference().len() as u32));
        let off = mean(&apart(&found.poses, target.poses(), radius));
        println!("{name}: {off:.5}");
        assert!(off <= bound);
    }
}

#[test]
fn a_mesh_moves_like_itself() {
    let person = creature("person", 4_000).sequence;
    for method in [Method::Gradients, Method::Posed] {
        let found = moved(method, &person, &person, &same((0..12).map(|i| 150 * i)));
        let off = apart(&found.poses, person.poses(), person.diagonal());
        println!("{method:?} {off:?}");
        assert!(off.iter().all(|&off| off <= 1e-6));
    }
}

#[test]
fn arms_out_move_like_arms_down() {
    let (down, out) = (creature("person", 6_000), creature("person-arms-out", 6_000));
    let (_, radius) = unit_ball(out.sequence.faces(), out.sequence.reference());
    for count in [14, 30] {
        let pairs = pairs(&down, &out, count);
        // The same mesh in the same motion: only the reference differs.
        let truth = down.sequence.poses();
        let by = |method| {
            let found = moved(method, &down.sequence, &out.sequence, &pairs).poses;
            (mean(&apart(&found, truth, radius)), creases(out.sequence.faces(), &found[3], &truth[3].positions))
        };
        let ((plain, _), (posed, crease)) = (by(Method::Gradients), by(Method::Posed));
        println!("{count} pairs: gradients {plain:.4}, posed {posed:.4}: {:.3}; creases {crease:.1}°", posed / plain);
        assert!(posed < 0.2 * plain);
        assert!(crease < 15.0);
    }
}

/// By how many degrees more than in truth the faces at an edge are bent against each other, at all but one in a hundred
/// edges at most.
fn creases(faces: &[[u32; 3]], found: &[DVec3], truth: &[DVec3]) -> f64 {
    let bend = |points: &[DVec3], faces: [[u32; 3]; 2]| {
        let [a, b] = faces.map(|f| {
            let [a, b, c] = f.map(|v| points[v as usize]);
            (b - a).cross(c - a).normalize_or_zero()
        });
        a.dot(b).clamp(-1.0, 1.0).acos().to_degrees()
    };
    let graph = DualGraph::new(faces);
    let both = |edge: &sinew::mesh::DualEdge| edge.faces.map(|f| faces[f as usize]);
    let mut more: Vec<f64> = graph.edges().iter().map(|e| bend(found, both(e)) - bend(truth, both(e))).collect();
    more.sort_by(f64::total_cmp);
    more[more.len() * 99 / 100]
}

/// A target of two tetrahedra that do not touch, one with a face split into a flat one, and an edge with three faces.
fn odd_target() -> WeldedSurface {
    let tetrahedron = |at: DVec3| [at, at + 0.4 * DVec3::X, at + 0.5 * DVec3::Y, at + 0.3 * DVec3::Z];
    let mut positions = tetrahedron(DVec3::splat(-0.5)).to_vec();
    positions.extend(tetrahedron(DVec3::splat(0.2)));
    // A flat face between two corners of the first and the middle of their edge; a fin on an edge of the second.
    positions.push(0.5 * (positions[0] + positions[1]));
    positions.push(DVec3::new(0.9, 0.1, 0.2));
    let one = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]];
    let mut faces = one.to_vec();
    faces.extend(one.map(|f| f.map(|v| v + 4)));
    faces.extend([[0, 8, 1], [4, 5, 9]]);
    WeldedSurface::new(&Sequence::new("odd", faces, positions, Vec::new()).expect("a mesh"))
}

/// Maps that differ from face to face.
fn some_maps(count: usize, seed: f64) -> Vec<DMat3> {
    let entry = |f: usize, k: usize| 0.4 * (seed + 1.7 * f as f64 + 0.9 * k as f64).sin();
    (0..count).map(|f| DMat3::IDENTITY + DMat3::from_cols_array(&std::array::from_fn(|k| entry(f, k)))).collect()
}

#[test]
fn the_solution_is_that_of_a_dense_solve() {
    let target = odd_target();
    let weights: Vec<f64> = (0..target.faces.len()).map(|f| 1.0 + 0.3 * f as f64).collect();
    let maps = some_maps(target.faces.len(), 0.3);
    let found = Solver::new(&target, &weights, &[]).expect("a factor").solve(1, &|_| maps.clone(), &[]);
    // The paper's own system: every face with a fourth vertex, rows for the nine entries of T − S, here by columns of x.
    let (n, m) = (target.len(), target.faces.len());
    let sound: Vec<usize> = (0..m).filter(|&f| area(&target, f) > 1e-9).collect();
    assert_eq!(sound.len(), m - 1);
    let mut rows: Vec<(Vec<f64>, DVec3)> = Vec::new();
    for (k, &f) in sound.iter().enumerate() {
        let [a, b, c] = target.faces[f].map(|v| target.positions[v as usize]);
        let normal = (b - a).cross(c - a);
        let inverse = DMat3::from_cols(b - a, c - a, normal / normal.length().sqrt()).inverse();
        let corners = target.faces[f];
        for column in 0..3 {
            let mut row = vec![0.0; n + sound.len()];
            let share = [inverse.row(0)[column], inverse.row(1)[column], inverse.row(2)[column]];
            row[corners[1] as usize] += share[0];
            row[corners[2] as usize] += share[1];
            row[n + k] += share[2];
            row[corners[0] as usize] -= share.iter().sum::<f64>();
            let root = weights[f].sqrt();
            rows.push((row.iter().map(|x| root * x).collect(), root * maps[f].col(column)));
        }
    }
    // The flat face's edges, and the tie between the pieces.
    let flat = (0..m).find(|&f| area(&target, f) <= 1e-9).expect("a flat face");
    let mut tie = |parts: &[(u32, f64)], wanted: DVec3, weight: f64| {
        let mut row = vec![0.0; n + sound.len()];
        parts.iter().for_each(|&(v, c)| row[v as usize] += weight.sqrt() * c);
        rows.push((row, weight.sqrt() * wanted));
    };
    for (i, j) in [(0, 1), (1, 2), (2, 0)] {
        let [a, b] = [target.faces[flat][i], target.faces[flat][j]];
        let edge = target.positions[a as usize] - target.positions[b as usize];
        tie(&[(a, 1.0), (b, -1.0)], maps[flat] * edge, weights[flat] / edge.length_squared());
    }
    for [f, g] in bridging(&target, &DualGraph::new(&target.faces)) {
        let corners = [f, g].map(|f| target.faces[f as usize]);
        let points = corners.map(|c| c.map(|v| target.positions[v as usize]));
        let middle = |p: [DVec3; 3]| (p[0] + p[1] + p[2]) / 3.0;
        let way = middle(points[0]) - middle(points[1]);
        let size = way.length_squared().max(points[0][0].distance_squared(points[0][1]));
        let parts: Vec<(u32, f64)> =
            corners[0].iter().map(|&v| (v, 1.0 / 3.0)).chain(corners[1].iter().map(|&v| (v, -1.0 / 3.0))).collect();
        tie(&parts, 0.5 * ((maps[f as usize] + maps[g as usize]) * way), weights[f as usize] / size);
    }
    // The first vertex where it was found, and its weight of no matter.
    tie(&[(0, 1.0)], found[0][0], 1.0);
    let size = n + sound.len();
    let matrix = DMatrix::from_fn(rows.len(), size, |i, j| rows[i].0[j]);
    let side = DMatrix::from_fn(rows.len(), 3, |i, k| rows[i].1[k]);
    let normal = matrix.transpose() * &matrix;
    let solution = normal.lu().solve(&(matrix.transpose() * side)).expect("a solution");
    for (v, p) in found[0].iter().enumerate() {
        let dense = DVec3::new(solution[(v, 0)], solution[(v, 1)], solution[(v, 2)]);
        assert!(dense.distance(*p) < 1e-9, "{v}: {dense} and {p}");
    }
}

fn area(surface: &WeldedSurface, face: usize) -> f64 {
    let [a, b, c] = surface.faces[face].map(|v| surface.positions[v as usize]);
    0.5 * (b - a).cross(c - a).length()
}

#[test]
fn pinned_vertices_go_where_they_are_told() {
    let target = odd_target();
    let weights = vec![1.0; target.faces.len()];
    let maps: Vec<Vec<DMat3>> = [0.3, 2.0].map(|seed| some_maps(target.faces.len(), seed)).to_vec();
    let pins = [3, 6, 9];
    let goals = vec![vec![DVec3::X, DVec3::Y, DVec3::Z], vec![DVec3::ZERO, DVec3::ONE, DVec3::NEG_X]];
    let solver = Solver::new(&target, &weights, &pins).expect("a factor");
    let of_pose = |pose: usize| maps[pose].clone();
    let found = solver.solve(maps.len(), &of_pose, &goals);
    for (pose, goals) in found.iter().zip(&goals) {
        for (&pin, goal) in pins.iter().zip(goals) {
            assert!(pose[pin as usize].distance(*goal) < 1e-9);
        }
    }
    // Told to go where they go anyway, they change nothing.
    let free = Solver::new(&target, &weights, &[]).expect("a factor").solve(maps.len(), &of_pose, &[]);
    let there: Vec<Vec<DVec3>> = free.iter().map(|pose| pins.map(|pin| pose[pin as usize]).to_vec()).collect();
    for (a, b) in solver.solve(maps.len(), &of_pose, &there).iter().flatten().zip(free.iter().flatten()) {
        assert!(a.distance(*b) < 1e-9);
    }
}

#[test]
fn a_foot_that_stands_keeps_standing() {
    let (horse, camel) = (creature("horse", 3_000), creature("camel", 3_000));
    let pairs = pairs(&horse, &camel, 14);
    let lowest = (0..camel.sequence.reference().len() as u32)
        .min_by(|&a, &b| camel.sequence.reference()[a as usize].y.total_cmp(&camel.sequence.reference()[b as usize].y));
    let foot = lowest.expect("a vertex");
    let parameters = Parameters { method: Method::Gradients, pinned: vec![foot], ..Parameters::default() };
    let mover = Mover::new(&horse.sequence, &camel.sequence, &parameters, &mut Silent).expect("a mover");
    let poses = mover.transfer(&pairs, &mut Silent).expect("a transfer").poses;
    // A source that does not move moves nothing, wherever it is pinned.
    let start = &camel.sequence.reference()[foot as usize];
    let still: Vec<Pose> =
        vec![Pose { name: String::new(), time: 0.0, positions: horse.sequence.reference().to_vec() }];
    let source = horse.sequence.reference_alone();
    let source =
        Sequence::new("still", source.faces().to_vec(), source.reference().to_vec(), still).expect("a sequence");
    let stands = Mover::new(&source, &camel.sequence, &parameters, &mut Silent).expect("a mover");
    let stands = stands.transfer(&pairs, &mut Silent).expect("a transfer").poses;
    assert!(stands[0].iter().zip(camel.sequence.reference()).all(|(a, b)| a.distance(*b) < 1e-6));
    let reach = poses.iter().map(|pose| pose[foot as usize].distance(*start)).fold(0.0, f64::max);
    assert!(reach > 0.05 && reach < 1.5, "{reach}");
}

#[test]
fn pieces_holes_and_fins_hold_together() {
    let person = creature("person", 2_000).sequence;
    // A target in four pieces: cut at two heights, with a hole and a fin, and a piece of dust that follows.
    let cut = |f: &[u32; 3]| {
        let y = f.iter().map(|&v| person.reference()[v as usize].y).sum::<f64>() / 3.0;
        u32::from(y > 0.8) + u32::from(y > 1.4)
    };
    let n = person.reference().len() as u32;
    let mut faces: Vec<[u32; 3]> = person.faces().iter().map(|f| f.map(|v| v + n * cut(f))).collect();
    faces.remove(40);
    let all = |points: &[DVec3]| -> Vec<DVec3> {
        let mut three: Vec<DVec3> =
            (0..3).flat_map(|k| points.iter().map(move |p| *p + 1e-3 * f64::from(k) * DVec3::X)).collect();
        three.extend([points[5] + 0.05 * DVec3::Z, points[5] + 0.06 * DVec3::Z, points[5] + 0.05 * DVec3::ONE]);
        three
    };
    faces.extend([[3 * n, 3 * n + 1, 3 * n + 2], [faces[7][0], faces[7][1], 3 * n]]);
    let target = Sequence::new("cut", faces, all(person.reference()), Vec::new()).expect("a mesh");
    let owner = |v: u32| target.faces().iter().flatten().find(|&&u| u % n == v && u < 3 * n).copied();
    let pairs: Vec<Pair> = (0..14).filter_map(|i| Some(Pair { source: 60 * i, target: owner(60 * i)? })).collect();
    for method in [Method::Gradients, Method::Posed] {
        let found = moved(method, &person, &target, &pairs);
        for (pose, truth) in found.poses.iter().zip(person.poses()) {
            assert!(pose.iter().all(|p| p.is_finite()));
            let truth = all(&truth.positions);
            let used: Vec<usize> =
                target.faces().iter().flatten().map(|&v| v as usize).filter(|&v| v < 3 * n as usize).collect();
            let off: Vec<DVec3> = used.iter().map(|&v| pose[v] - truth[v]).collect();
            let mean = off.iter().sum::<DVec3>() / off.len() as f64;
            let worst = off.iter().map(|d| (*d - mean).length()).sum::<f64>() / off.len() as f64;
            assert!(worst < 0.05, "{method:?}: {worst}");
        }
    }
}

#[test]
fn what_cannot_be_used_is_said_in_words() {
    let person = creature("person", 1_000).sequence;
    let parameters = Parameters { method: Method::Gradients, ..Parameters::default() };
    let mover = Mover::new(&person, &person, &parameters, &mut Silent).expect("a mover");
    let pair = |source, target| Pair { source, target };
    assert_eq!(mover.transfer(&[], &mut Silent).expect_err("an error"), TransferError::NoPairs);
    let error = mover.transfer(&[pair(0, 0), pair(1, 99_999)], &mut Silent).expect_err("an error");
    assert!(error.to_string().starts_with("pair 1 names vertex 99999 of the target"), "{error}");
    let error = mover.transfer(&[pair(0, 0), pair(0, 5)], &mut Silent).expect_err("an error");
    assert_eq!(error, TransferError::SamePlace { first: 0, second: 1, side: "source" });
    let one = mover.transfer(&[pair(3, 3)], &mut Silent).expect("a transfer");
    assert!(one.warnings.iter().any(|w| w.code == "few-pairs"));
    assert!(one.poses.iter().flatten().all(|p| p.is_finite()));
    let mut calls = 0;
    let stop = mover.transfer(&[pair(0, 0)], &mut |_: &'static str, _: f64| {
        calls += 1;
        calls < 3
    });
    assert_eq!(stop.expect_err("an error"), TransferError::Cancelled);
    let points = Sequence::new("points", Vec::new(), vec![DVec3::ZERO; 4], Vec::new()).expect("points");
    let error = Mover::new(&person, &points, &parameters, &mut Silent).err();
    assert_eq!(error, Some(TransferError::NoFaces { side: "target" }));
    let flat = Sequence::new("flat", vec![[0, 1, 2]], vec![DVec3::ZERO, DVec3::X, 2.0 * DVec3::X], Vec::new());
    let flat = flat.expect("a mesh");
    let error = Mover::new(&flat, &person, &parameters, &mut Silent).err();
    assert_eq!(error, Some(TransferError::Degenerate { side: "source" }));
    let onto = Mover::new(&person, &flat, &parameters, &mut Silent).expect("a mover");
    let poses = onto.transfer(&[pair(0, 0), pair(9, 1)], &mut Silent).expect("a transfer").poses;
    assert!(poses.iter().flatten().all(|p| p.is_finite()));
}
