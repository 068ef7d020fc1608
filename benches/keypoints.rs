//! How long the choice of key points takes, and a pose's fit: natively, on all cores, against the paper's letter in the
//! same run. The letter takes minutes and so runs once.
//!
//! `cargo bench --bench keypoints -- starts dog octopus FILE.npz …` tells instead how much ten starts differ on creatures
//! and sequences of your choice; `cargo bench --bench keypoints -- crew` how well the choice divides among workers that
//! have a core each.

#[path = "../tests/common/npz.rs"]
mod npz;

use criterion::Criterion;
use sinew::clock;
use sinew::crew::{Crew, Shared, at_once};
use sinew::keypoints::{KeyPoints, Parameters, fit_all, select, select_by, thinned};
use sinew::mesh::ball::unit_ball;
use sinew::mesh::laplacian::Laplacian;
use sinew::observer::Silent;
use sinew::sequence::Sequence;
use sinew::skinning::{Fitter, Rows, SkinnedMesh};
use sinew::zoo::{self, Recipe};
use std::cell::RefCell;
use std::path::Path;

/// Vertices, poses and points of the comparison.
const VERTICES: usize = 2_500;
const POINTS: usize = 12;

/// Ten poses of a made creature of about so many faces.
fn made(name: &str, faces: usize) -> Sequence {
    let recipe = Recipe { name: name.into(), faces, poses: 10, exact: false, ..Recipe::default() };
    zoo::make(&recipe).expect("a creature of that name").sequence
}

/// A sequence from an archive, or a made creature.
fn named(name: &str) -> Sequence {
    let path = Path::new(name);
    let is_archive = path.extension().is_some_and(|end| end == "npz");
    thinned(&if is_archive { npz::sequence(path) } else { made(name, 2 * VERTICES) }, VERTICES)
}

/// Ten poses of a horse, where the data is at hand, else of a made one.
fn horse() -> Sequence {
    let whole = match npz::data("the public horse; a made one is measured instead") {
        Some(data) => npz::sequence(&data.join("sumner/horse.npz")),
        None => made("horse", 16_843),
    };
    thinned(&whole, VERTICES)
}

fn run(sequence: &Sequence, parameters: &Parameters) -> (f64, KeyPoints) {
    let start = clock::seconds();
    let result = select(sequence, parameters, &mut Silent).expect("key points");
    (clock::seconds() - start, result)
}

fn last(result: &KeyPoints) -> f64 {
    result.errors.last().copied().unwrap_or(f64::NAN)
}

fn by_criterion(criterion: &mut Criterion, horse: &Sequence, parameters: &Parameters) {
    let points = run(horse, parameters).1.key_points;
    let mut group = criterion.benchmark_group("key points");
    group.sample_size(10);
    group.bench_function("12 of 100 candidates", |b| b.iter(|| run(horse, parameters)));
    group.bench_function("given by hand", |b| b.iter(|| fit_all(horse, &points, parameters)));
    group.finish();
}

/// One pose of a prepared mesh of 15 handles.
fn a_pose(criterion: &mut Criterion, horse: &Sequence, parameters: &Parameters) {
    let points = run(horse, &Parameters { points: Some(15), ..parameters.clone() }).1.key_points;
    let fitted = fit_all(horse, &points, parameters).expect("a fit");
    let laplacian = Laplacian::new(horse.faces(), horse.reference());
    let rows = Rows::new(&fitted.weights.values, points.len());
    let mesh = SkinnedMesh {
        reference: horse.reference(),
        edges: &laplacian.edges,
        stiffness: &laplacian.cotangents,
        mass: &vec![1.0; horse.reference().len()],
        handles: &points,
        weights: &rows,
        groups: &fitted.groups,
        ball: unit_ball(horse.faces(), horse.reference()),
    };
    criterion.bench_function("prepare a rig of 15 handles", |b| b.iter(|| Fitter::new(&mesh, &parameters.fit())));
    let fitter = Fitter::new(&mesh, &parameters.fit());
    let poses = horse.poses();
    let mut turn = 0;
    criterion.bench_function("fit a pose with 15 handles", |b| {
        b.iter(|| {
            turn = (turn + 1) % poses.len();
            fitter.fit(&poses[turn].positions)
        });
    });
}

fn starts(name: &str, sequence: &Sequence, parameters: &Parameters) {
    let error = |seed| last(&run(sequence, &Parameters { seed, ..parameters.clone() }).1);
    let errors: Vec<f64> = (0..10).map(error).collect();
    let (low, high) = errors.iter().fold((f64::INFINITY, 0.0_f64), |(l, h), &e| (l.min(e), h.max(e)));
    println!("{name}, ten starts: errors {errors:.5?}, the worst {:.1} % above the best", 100.0 * (high / low - 1.0));
}

/// One who does everything alone and notes the seconds of every item of every meeting.
#[derive(Default)]
struct Alone(RefCell<Vec<Vec<f64>>>);

impl Crew for Alone {
    async fn until<T: Shared>(
        &self,
        count: usize,
        work: &(dyn Fn(usize) -> T + Sync),
        enough: &(dyn Fn(&T) -> bool + Sync),
    ) -> Vec<T> {
        let (mut results, mut seconds) = (Vec::new(), Vec::new());
        for item in 0..count {
            let start = clock::seconds();
            results.push(work(item));
            seconds.push(clock::seconds() - start);
            if results.last().is_some_and(enough) {
                break;
            }
        }
        self.0.borrow_mut().push(seconds);
        results
    }
}

/// How long a choice would take members who take items in turn, wait for each other, and have a core each.
fn divided(name: &str, sequence: &Sequence, parameters: &Parameters) {
    let alone = Alone::default();
    let start = clock::seconds();
    at_once(select_by(&alone, sequence, parameters, &mut Silent)).expect("key points");
    let whole = clock::seconds() - start;
    let meetings = alone.0.into_inner();
    let shared: f64 = meetings.iter().flatten().sum();
    print!("{name}: {whole:.2} s alone, of which {:.0} % can be divided; on the longest path", 100.0 * shared / whole);
    for members in [2, 4, 8] {
        let of = |items: &Vec<f64>, member: usize| -> f64 { items.iter().skip(member).step_by(members).sum() };
        let longest = |items: &Vec<f64>| (0..members).map(|member| of(items, member)).fold(0.0, f64::max);
        let path = whole - shared + meetings.iter().map(longest).sum::<f64>();
        print!(" {path:.2} s of {members} members,");
    }
    println!(" what they say to each other not counted");
}

fn against_the_letter(horse: &Sequence, parameters: &Parameters) {
    let (quick_seconds, quick) = run(horse, parameters);
    let (literal_seconds, literal) = run(horse, &Parameters { literal: true, ..parameters.clone() });
    println!(
        "{} vertices, {} poses, {POINTS} points: {quick_seconds:.2} s with error {:.5}, by the letter {literal_seconds:.0} s \
         with error {:.5}: {:.0} times as fast, error {:+.1} %",
        horse.sizes().vertices,
        horse.sizes().poses,
        last(&quick),
        last(&literal),
        literal_seconds / quick_seconds,
        100.0 * (last(&quick) / last(&literal) - 1.0)
    );
    for (step, seconds) in quick.seconds {
        println!("  {step:<20} {seconds:.3} s");
    }
}

fn main() {
    let parameters = Parameters { points: Some(POINTS), ..Parameters::default() };
    let arguments: Vec<String> = std::env::args().skip(1).filter(|argument| !argument.starts_with('-')).collect();
    if let Some(("starts", names)) = arguments.split_first().map(|(first, names)| (first.as_str(), names)) {
        names.iter().for_each(|name| starts(name, &named(name), &parameters));
        return;
    }
    let horse = horse();
    if arguments.first().is_some_and(|first| first == "crew") {
        return divided("horse", &horse, &parameters);
    }
    let mut criterion = Criterion::default().configure_from_args();
    by_criterion(&mut criterion, &horse, &parameters);
    a_pose(&mut criterion, &horse, &parameters);
    criterion.final_summary();
    starts("horse", &horse, &parameters);
    against_the_letter(&horse, &parameters);
}
