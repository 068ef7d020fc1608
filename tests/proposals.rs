//! Proposed correspondences against true ones.
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
    zoo::make(&Recipe { name: name.into(), faces: 12_000, poses: 1, exact: false }).expect("a creature of that name")
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
    let mut off = Vec::new();
    for ((proposal, at), known) in proposals.points.iter().zip(&truth).zip(&known) {
        if known.is_none() {
            let error = 100.0 * target[proposal.target as usize].distance(*at) / case.target.diagonal();
            off.push(error);
            if error > 4.0 && std::env::var("EACH").is_ok() {
                let s = case.source.reference()[points[trust_index(&proposals.points, proposal)] as usize];
                println!(
                    "  {error:.1} at {s:.2} true {at:.2} proposed {:.2}, confidence {:.2}",
                    target[proposal.target as usize], proposal.confidence
                );
            }
            errors.trust.push((proposal.confidence, error));
        }
    }
    if std::env::var("EACH").is_ok() {
        println!("{}", off.iter().map(|e| format!("{e:.1}")).collect::<Vec<_>>().join(" "));
    }
    off.sort_by(f64::total_cmp);
    errors.median.push(off[off.len() / 2]);
    errors.worst.push(off[off.len() - 1]);
}

fn trust_index(all: &[sinew::transfer::propose::Proposal], one: &sinew::transfer::propose::Proposal) -> usize {
    all.iter().position(|p| std::ptr::eq(p, one)).unwrap_or(0)
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

fn most(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}

fn table(cases: &[Case]) -> Vec<(f64, f64)> {
    let mut trust = Vec::new();
    let only = std::env::var("ONLY").unwrap_or_default();
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
            slowest = slowest.max(all.seconds);
            trust.extend(all.trust);
        }
        println!("{line} | {:.0} ms", 1000.0 * slowest);
    }
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

#[test]
fn table_of_all() {
    let mut cases = zoo_cases();
    if let Some(data) = npz::data("bodies and animals") {
        cases.extend(body_cases(&data));
        cases.extend(animal_cases(&data));
    }
    calibration(table(&cases));
}
