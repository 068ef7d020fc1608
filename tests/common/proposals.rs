//! Pairs of meshes with true correspondences, and how far proposals are from them.

use super::npz;
use glam::DVec3;
use sinew::clock;
use sinew::sequence::Sequence;
use sinew::transfer::propose::Proposer;
use sinew::zoo::{self, Creature, Recipe};
use std::path::Path;

/// Two meshes and true pairs: source vertex, place on the target.
pub struct Case {
    pub name: String,
    pub source: Sequence,
    pub target: Sequence,
    pub pairs: Vec<(u32, DVec3)>,
}

pub fn creature(name: &str) -> Creature {
    zoo::make(&Recipe { name: name.into(), faces: 12_000, poses: 1, exact: false, ..Recipe::default() })
        .expect("a creature of that name")
}

pub fn zoo_case(a: &str, b: &str) -> Case {
    between(creature(a), creature(b))
}

/// Two creatures.
pub fn between(a: Creature, b: Creature) -> Case {
    let name = format!("zoo {} > {}", a.sequence.name(), b.sequence.name());
    let pairs = zoo::correspondences(&a, &b, 60);
    let pairs = pairs.into_iter().map(|(s, t)| (s, b.sequence.reference()[t as usize])).collect();
    Case { name, source: a.sequence, target: b.sequence, pairs }
}

/// Bodies of one topology tell the truth about the same bodies with their own.
pub fn body_cases(data: &Path, cases: &[(&str, &str)]) -> Vec<Case> {
    let read = |name: String| npz::sequence(&data.join("anny").join(name));
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

/// Animals with pairs marked by hand, kept in a file.
pub fn animal_case(data: &Path, a: &str, b: &str, file: &str) -> Case {
    let read = |name: &str| npz::sequence(&data.join("sumner").join(format!("{name}.npz")));
    let text = std::fs::read_to_string(data.join("sumner").join(file)).expect("a list of pairs");
    let pairs: Vec<Vec<u32>> = text.lines().map(numbers).filter(|n| n.len() == 2).collect();
    let (source, target) = (read(a), read(b));
    let pairs = pairs.iter().map(|p| (p[0], target.reference()[p[1] as usize])).collect();
    Case { name: format!("{a} > {b}"), source, target, pairs }
}

impl Case {
    /// Proposals from the target to the source.
    #[allow(dead_code)]
    pub fn reversed(&self) -> Self {
        let name = self.name.split(" > ").collect::<Vec<_>>();
        let name = format!("{} > {}", name[name.len() - 1], name[0]);
        let back =
            |&(s, at): &(u32, DVec3)| (nearest(self.target.reference(), at), self.source.reference()[s as usize]);
        let pairs = self.pairs.iter().map(back).collect();
        Self { name, source: self.target.clone(), target: self.source.clone(), pairs }
    }
}

/// Prepares a case.
pub fn proposer(case: &Case) -> Proposer {
    let (s, t) = (&case.source, &case.target);
    Proposer::new(s.faces(), s.reference(), t.faces(), t.reference()).expect("two meshes")
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
pub fn far_apart(case: &Case, among: &[usize], count: usize) -> Vec<usize> {
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

/// Errors in % of the diagonal, of the points that were not given: one entry a draw.
#[derive(Default)]
pub struct Errors {
    pub median: Vec<f64>,
    pub worst: Vec<f64>,
    pub seconds: f64,
    /// Points found on the wrong side.
    pub swapped: usize,
    /// (confidence, error)
    pub trust: Vec<(f64, f64)>,
}

fn nearest(points: &[DVec3], to: DVec3) -> u32 {
    let d = |i: &u32| points[*i as usize].distance_squared(to);
    (0..points.len() as u32).min_by(|a, b| d(a).total_cmp(&d(b))).expect("a point")
}

/// Which of the points are given.
pub enum Draw {
    /// The farthest apart.
    Spread,
    /// Any.
    Random(u64),
    /// Always the one that proposals ask for next.
    Advised,
}

/// Proposes for 20 far-apart points of which `given` are known, and measures.
pub fn measure(case: &Case, proposer: &Proposer, given: usize, seed: u64, draw: &Draw, errors: &mut Errors) {
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
            errors.trust.push((proposal.confidence, error));
            let (own, found) = (at.x - middle, target[proposal.target as usize].x - middle);
            errors.swapped +=
                usize::from(own * found < 0.0 && own.abs().min(found.abs()) > 0.03 * case.target.diagonal());
        }
    }
    off.sort_by(f64::total_cmp);
    errors.median.push(off[off.len() / 2]);
    errors.worst.push(off[off.len() - 1]);
}

pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len().max(1) as f64
}

pub fn most(values: &[f64]) -> f64 {
    values.iter().copied().fold(0.0, f64::max)
}
