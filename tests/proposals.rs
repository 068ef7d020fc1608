//! Proposed correspondences against true ones. `cargo test --test proposals -- --nocapture` prints the tables.
#![cfg(not(target_arch = "wasm32"))]

#[path = "common/npz.rs"]
mod npz;

use glam::DVec3;
use sinew::clock;
use sinew::sequence::Sequence;
use sinew::transfer::propose::Proposer;
use sinew::zoo::{self, Creature, Recipe};
use std::path::Path;

/// Two meshes and true pairs: source vertex, place on the target.
struct Case {
    name: String,
    source: Sequence,
    target: Sequence,
    pairs: Vec<(u32, DVec3)>,
}

fn creature(name: &str) -> Creature {
    zoo::make(&Recipe { name: name.into(), faces: 12_000, poses: 1, exact: false, ..Recipe::default() })
        .expect("a creature of that name")
}

fn zoo_case(a: &str, b: &str) -> Case {
    let (a, b) = (creature(a), creature(b));
    let name = format!("zoo {} > {}", a.sequence.name(), b.sequence.name());
    let pairs = zoo::correspondences(&a, &b, 60);
    let pairs = pairs.into_iter().map(|(s, t)| (s, b.sequence.reference()[t as usize])).collect();
    Case { name, source: a.sequence, target: b.sequence, pairs }
}

fn zoo_cases() -> Vec<Case> {
    let pairs = [("person", "person-arms-out"), ("person-arms-out", "person"), ("horse", "camel"), ("camel", "horse")];
    pairs.iter().map(|(a, b)| zoo_case(a, b)).collect()
}

/// Bodies of one topology tell the truth about the same bodies with their own.
fn body_cases(data: &Path) -> Vec<Case> {
    let read = |name: String| npz::sequence(&data.join("anny").join(name));
    let cases = [("man_lean", "woman"), ("man_lean", "heavy_man"), ("woman", "heavy_man"), ("heavy_man", "woman")];
    let case = |(a, b): &(&str, &str)| {
        let truth = read(format!("low_shared_{b}.npz"));
        Case {
            name: format!("bodies {a} > {b}"),
            source: read(format!("low_shared_{a}.npz")),
            target: read(format!("low_own_{b}.npz")),
            pairs: (0..).zip(truth.reference().iter().copied()).collect(),
        }
    };
    cases.iter().map(case).collect()
}

fn numbers(line: &str) -> Vec<u32> {
    line.split(|c: char| !c.is_ascii_digit()).filter_map(|word| word.parse().ok()).collect()
}

/// Animals with pairs marked by hand.
fn animal_cases(data: &Path) -> Vec<Case> {
    let mut cases = Vec::new();
    for (a, b, file) in [("horse", "camel", "horse_camel.cons"), ("cat", "lion", "marker-cat-lion.txt")] {
        let read = |name: &str| npz::sequence(&data.join("sumner").join(format!("{name}.npz")));
        let text = std::fs::read_to_string(data.join("sumner").join(file)).expect("a list of pairs");
        let pairs: Vec<Vec<u32>> = text.lines().map(numbers).filter(|n| n.len() == 2).collect();
        let (s, t) = (read(a), read(b));
        let there = pairs.iter().map(|p| (p[0], t.reference()[p[1] as usize])).collect();
        let back = pairs.iter().map(|p| (p[1], s.reference()[p[0] as usize])).collect();
        cases.push(Case { name: format!("{b} > {a}"), source: t.clone(), target: s.clone(), pairs: back });
        cases.push(Case { name: format!("{a} > {b}"), source: s, target: t, pairs: there });
    }
    cases
}

/// A small generator of numbers that look random (Knuth's constants).
struct Dice(u64);

impl Dice {
    fn below(&mut self, n: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        ((self.0 >> 33) as usize) % n.max(1)
    }

    fn some(&mut self, n: usize, count: usize) -> Vec<usize> {
        let mut all: Vec<usize> = (0..n).collect();
        for i in 0..count.min(n) {
            let j = i + self.below(n - i);
            all.swap(i, j);
        }
        all.truncate(count);
        all
    }
}

/// `count` of the pairs that lie far apart on the source.
fn far_apart(case: &Case, among: &[usize], count: usize) -> Vec<usize> {
    let at = |i: usize| case.source.reference()[case.pairs[i].0 as usize];
    let middle = among.iter().map(|&i| at(i)).sum::<DVec3>() / among.len() as f64;
    let mut distance: Vec<f64> = among.iter().map(|&i| at(i).distance(middle)).collect();
    let mut chosen = Vec::new();
    while chosen.len() < count.min(among.len()) {
        let next = (0..among.len()).max_by(|&a, &b| distance[a].total_cmp(&distance[b])).expect("a pair");
        let first = chosen.is_empty();
        chosen.push(among[next]);
        for (d, &i) in distance.iter_mut().zip(among) {
            let to = at(i).distance(at(among[next]));
            *d = if first { to } else { d.min(to) };
        }
    }
    chosen
}

/// Errors in % of the diagonal, of the points that were not given.
#[derive(Default)]
struct Errors {
    median: Vec<f64>,
    worst: Vec<f64>,
    seconds: f64,
    /// Points found on the wrong side.
    swapped: usize,
    /// (confidence, error)
    trust: Vec<(f64, f64)>,
}

fn nearest(points: &[DVec3], to: DVec3) -> u32 {
    let d = |i: &u32| points[*i as usize].distance_squared(to);
    (0..points.len() as u32).min_by(|a, b| d(a).total_cmp(&d(b))).expect("a point")
}

enum Draw {
    Spread,
    Random(u64),
    Advised,
}

/// Proposes for 20 far-apart points of which `given` are known, and measures.
fn measure(case: &Case, proposer: &Proposer, given: usize, seed: u64, draw: &Draw, errors: &mut Errors) {
    let mut dice = Dice(seed);
    let among: Vec<usize> = if seed == 0 {
        (0..case.pairs.len()).collect()
    } else {
        dice.some(case.pairs.len(), (case.pairs.len() / 2).max(20))
    };
    let chosen = far_apart(case, &among, 20);
    let points: Vec<u32> = chosen.iter().map(|&i| case.pairs[i].0).collect();
    let truth: Vec<DVec3> = chosen.iter().map(|&i| case.pairs[i].1).collect();
    let target = case.target.reference();
    let mut known = vec![None; points.len()];
    match draw {
        Draw::Spread => (0..given).for_each(|i| known[i] = Some(nearest(target, truth[i]))),
        Draw::Random(seed) => {
            let picks = Dice(seed * 77 + 5).some(points.len(), given);
            picks.into_iter().for_each(|i| known[i] = Some(nearest(target, truth[i])));
        }
        Draw::Advised => {
            for _ in 0..given {
                let next = proposer.propose(&points, &known).expect("proposals").next.expect("a point");
                known[next] = Some(nearest(target, truth[next]));
            }
        }
    }
    let start = clock::seconds();
    let proposals = proposer.propose(&points, &known).expect("proposals");
    errors.seconds = errors.seconds.max(clock::seconds() - start);
    // All these figures are symmetric from left to right, which is x.
    let (low, high) = target.iter().fold((f64::MAX, f64::MIN), |(l, h), p| (l.min(p.x), h.max(p.x)));
    let middle = 0.5 * (low + high);
    let mut off = Vec::new();
    for ((proposal, at), known) in proposals.points.iter().zip(&truth).zip(&known) {
        if known.is_none() {
            let error = 100.0 * target[proposal.target as usize].distance(*at) / case.target.diagonal();
            off.push(error);
            let (own, found) = (at.x - middle, target[proposal.target as usize].x - middle);
            errors.swapped +=
                usize::from(own * found < 0.0 && own.abs().min(found.abs()) > 0.03 * case.target.diagonal());
        }
    }
    off.sort_by(f64::total_cmp);
    errors.median.push(off[off.len() / 2]);
    errors.worst.push(off[off.len() - 1]);
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

fn most(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

/// What a row of the table must not exceed, in % of the diagonal: (given, mean median, mean worst).
type Bounds<'a> = &'a [(usize, f64, f64)];

/// Prints a row for each case and checks it; `SINEW_ONLY` limits it to cases whose name contains that.
fn table(cases: &[Case], bounds: &dyn Fn(&str) -> Bounds<'static>) -> Vec<(f64, f64)> {
    let mut trust = Vec::new();
    let only = std::env::var("SINEW_ONLY").unwrap_or_default();
    let (mut missed, mut swapped) = (Vec::new(), 0);
    for case in cases.iter().filter(|c| c.name.contains(&only)) {
        let start = clock::seconds();
        let proposer =
            Proposer::new(case.source.faces(), case.source.reference(), case.target.faces(), case.target.reference())
                .expect("two meshes");
        let preparing = clock::seconds() - start;
        let mut line = format!("{:30} {preparing:.2} s", case.name);
        let mut slowest: f64 = 0.0;
        for given in [0, 3, 5] {
            let mut all = Errors::default();
            for seed in 0..3 {
                let draws: &[Draw] = if given == 0 {
                    &[Draw::Spread]
                } else {
                    &[Draw::Spread, Draw::Random(seed + 1), Draw::Random(seed + 11), Draw::Advised]
                };
                draws.iter().for_each(|draw| measure(case, &proposer, given, seed, draw, &mut all));
            }
            let (m, w) = (&all.median, &all.worst);
            line += &format!(" | {given}: {:5.2} ≤{:5.2} worst {:5.1} ≤{:5.1}", mean(m), most(m), mean(w), most(w));
            line += &format!(" swapped {}", all.swapped);
            if given >= 3 {
                swapped += all.swapped;
            }
            for &(_, median, worst) in bounds(&case.name).iter().filter(|b| b.0 == given) {
                if mean(m) > median || mean(w) > worst {
                    missed.push(format!("{}: {given} given, {:.2} and {:.1}", case.name, mean(m), mean(w)));
                }
            }
            slowest = slowest.max(all.seconds);
            trust.extend(all.trust);
        }
        println!("{line} | {:.0} ms", 1000.0 * slowest);
    }
    assert!(missed.is_empty(), "{missed:?}");
    println!("swapped with three or more given: {swapped}");
    trust
}

fn calibration(mut trust: Vec<(f64, f64)>) {
    trust.sort_by(|a, b| a.0.total_cmp(&b.0));
    for tenth in trust.chunks(trust.len().div_ceil(10).max(1)) {
        let mut errors: Vec<f64> = tenth.iter().map(|t| t.1).collect();
        errors.sort_by(f64::total_cmp);
        println!(
            "confidence {:.2} to {:.2}: median error {:.1} %, nine tenths below {:.1} %, within 4 %: {:.2}",
            tenth[0].0,
            tenth[tenth.len() - 1].0,
            errors[errors.len() / 2],
            errors[errors.len() * 9 / 10],
            errors.iter().filter(|e| **e <= 4.0).count() as f64 / errors.len() as f64
        );
    }
}

/// Mean over draws of the given points.
fn bounds(name: &str) -> Bounds<'static> {
    match name {
        n if n.starts_with("zoo person") => &[(3, 3.0, 8.0)],
        n if n.starts_with("zoo") => &[(3, 4.0, 10.0)],
        n if n.starts_with("bodies") => &[(0, 1.75, 6.0)],
        "horse > camel" => &[(0, 6.0, 15.0), (5, 3.0, 9.5)],
        n if n.contains("lion") => &[(0, 3.0, 8.0), (5, 3.0, 8.0)],
        _ => &[],
    }
}

#[test]
fn creatures_of_one_build() {
    calibration(table(&zoo_cases(), &bounds));
}

#[test]
fn bodies_and_animals() {
    let Some(data) = npz::data("proposals on bodies and animals") else { return };
    let mut cases = body_cases(&data);
    cases.extend(animal_cases(&data));
    calibration(table(&cases, &bounds));
}

#[test]
fn a_target_with_another_axis_up_is_found_out() {
    let mut case = zoo_case("horse", "camel");
    let turn = |p: DVec3| DVec3::new(p.x, -p.z, p.y);
    let turned = case.target.reference().iter().map(|&p| turn(p)).collect();
    case.target = Sequence::new("turned", case.target.faces().to_vec(), turned, Vec::new()).expect("a mesh");
    case.pairs.iter_mut().for_each(|pair| pair.1 = turn(pair.1));
    let proposer = proposer(&case);
    let mut errors = Errors::default();
    measure(&case, &proposer, 0, 0, &Draw::Spread, &mut errors);
    println!("turned: median {:.2}, worst {:.1}", errors.median[0], errors.worst[0]);
    assert!(errors.median[0] <= 4.0, "{}", errors.median[0]);
}

fn proposer(case: &Case) -> Proposer {
    let (s, t) = (&case.source, &case.target);
    Proposer::new(s.faces(), s.reference(), t.faces(), t.reference()).expect("two meshes")
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
    let horse = creature("horse").sequence;
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
