//! How long segmentation takes: natively, on one core, by size and against its literal self.
//!
//! The ratio to the all-pairs variant is measured once, in the same run: that variant takes a minute.

#[path = "../tests/common/agreement.rs"]
mod agreement;
#[path = "../tests/common/npz.rs"]
mod npz;

use criterion::{BenchmarkId, Criterion};
use sinew::clock;
use sinew::observer::Silent;
use sinew::segmentation::{Method, Parameters, Segmentation, Segmenter, segment};
use sinew::sequence::Sequence;
use sinew::zoo::{self, Recipe};

fn creature(name: &str, faces: usize) -> Sequence {
    let recipe = Recipe { name: name.into(), faces, poses: 24, exact: false, ..Recipe::default() };
    zoo::make(&recipe).expect("a creature of that name").sequence
}

/// Ten poses of a horse of 16,843 faces where the data is at hand, else as much of a made one.
fn horse() -> Sequence {
    match npz::data("the public horse; a made one is measured instead") {
        Some(data) => npz::sequence(&data.join("sumner/horse.npz")),
        None => creature("horse", 16_843),
    }
}

fn run(sequence: &Sequence, parameters: &Parameters) -> (f64, Segmentation) {
    let start = clock::seconds();
    let result = segment(sequence, parameters, &mut Silent).expect("a segmentation");
    (clock::seconds() - start, result)
}

fn by_criterion(criterion: &mut Criterion, horse: &Sequence) {
    let mut group = criterion.benchmark_group("segment");
    group.sample_size(10);
    let default = Parameters::default();
    group.bench_function("horse", |b| b.iter(|| run(horse, &default)));
    group.bench_function("horse, by the letter", |b| b.iter(|| run(horse, &Parameters::paper())));
    let segmenter = Segmenter::new(horse, &default, &mut Silent).expect("a segmentation");
    group.bench_function("horse, another number of parts", |b| b.iter(|| segmenter.segmentation(Some(12))));
    group.finish();

    let mut group = criterion.benchmark_group("make a creature");
    group.sample_size(10);
    for faces in [12_000, 200_000] {
        group.bench_with_input(BenchmarkId::from_parameter(faces), &faces, |b, &n| b.iter(|| creature("horse", n)));
    }
    group.finish();
}

/// Median of three runs by number of faces, the growth between them, and the memory at the end.
fn by_size() {
    let median = |faces: usize| {
        let sequence = creature("horse", faces);
        let mut seconds = [0; 3].map(|_| run(&sequence, &Parameters::default()).0);
        seconds.sort_by(f64::total_cmp);
        println!("{faces:>8} faces × 24 poses: {:.2} s", seconds[1]);
        seconds[1]
    };
    let (small, large) = (median(20_000), median(200_000));
    println!("         growth from 20,000 to 200,000 faces: {:.1} times", large / small);
    if let Some(peak) = peak_megabytes() {
        println!("         peak memory of this process so far: {peak:.0} MB");
    }
}

/// The largest resident size of this process, where the system tells.
fn peak_megabytes() -> Option<f64> {
    let status = std::fs::read_to_string("/proc/self/status").ok()?;
    let line = status.lines().find(|l| l.starts_with("VmHWM:"))?;
    Some(line.split_whitespace().nth(1)?.parse::<f64>().ok()? / 1024.0)
}

fn against_all_pairs(horse: &Sequence) {
    for method in [Method::Paper, Method::Tree] {
        let parameters = Parameters { method, ..Parameters::default() };
        let (quick_seconds, quick) = run(horse, &parameters);
        let (exact_seconds, exact) = run(horse, &Parameters { exact: true, ..parameters });
        println!(
            "{method:?}: {quick_seconds:.2} s, from all pairs {exact_seconds:.1} s, {:.0} times as long; \
             the two agree on {:.1} % of the area",
            exact_seconds / quick_seconds,
            100.0 * agreement::agreement(horse, &quick.labels, &exact.labels)
        );
    }
}

fn main() {
    by_size();
    let horse = horse();
    let mut criterion = Criterion::default().configure_from_args();
    by_criterion(&mut criterion, &horse);
    criterion.final_summary();
    against_all_pairs(&horse);
}
