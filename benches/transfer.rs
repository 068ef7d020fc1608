//! How long a transfer takes, natively on one core: preparing, placing points, following one that is dragged, and a new
//! pose; near-rigid bones against the paper's letter.

use criterion::{BatchSize, Criterion};
use glam::DVec3;
use sinew::observer::Silent;
use sinew::sequence::Sequence;
use sinew::transfer::{Method, Pair, Parameters, Prepared};
use sinew::zoo::{self, Creature, Recipe};

/// Pairs that are given.
const PAIRS: usize = 14;

fn creature(name: &str, vertices: usize) -> Creature {
    let recipe = Recipe { name: name.into(), faces: 2 * vertices, poses: 12, exact: false, ..Recipe::default() };
    zoo::make(&recipe).expect("a creature of that name")
}

fn still(sequence: &Sequence) -> Sequence {
    Sequence::new(sequence.name(), sequence.faces().to_vec(), sequence.reference().to_vec(), Vec::new())
        .expect("a mesh")
}

fn prepared(horse: &Creature, camel: &Creature, method: Method) -> (Prepared, Vec<Pair>) {
    let parameters = Parameters { method, ..Parameters::default() };
    let prepared = Prepared::new(&horse.sequence, &still(&camel.sequence), &parameters, &mut Silent);
    let pairs = zoo::correspondences(horse, camel, PAIRS).into_iter().map(|(source, target)| Pair { source, target });
    (prepared.expect("two meshes"), pairs.collect())
}

/// A point that wanders over its neighbours.
fn dragged(pairs: &[Pair], target: &Sequence, step: usize) -> Vec<Pair> {
    let mut pairs = pairs.to_vec();
    let own = pairs[5].target;
    let around: Vec<u32> = target.faces().iter().filter(|face| face.contains(&own)).flatten().copied().collect();
    pairs[5].target = around[step % around.len()];
    pairs
}

fn main() {
    let mut criterion = Criterion::default().configure_from_args();
    for vertices in [5_000, 20_000] {
        let (horse, camel) = (creature("horse", vertices), creature("camel", vertices));
        let mut group = criterion.benchmark_group(format!("{vertices} vertices"));
        group.sample_size(10);
        for method in [Method::Bones, Method::Direct] {
            let name = format!("{method:?}").to_lowercase();
            group.bench_function(format!("prepare, {name}"), |b| {
                b.iter(|| prepared(&horse, &camel, method).0.seconds()[0])
            });
            let (mut ready, pairs) = prepared(&horse, &camel, method);
            group.bench_function(format!("all poses, {name}"), |b| {
                b.iter(|| ready.transfer(&pairs, &mut Silent).expect("a transfer"));
            });
            let mut step = 0;
            group.bench_function(format!("follow a dragged point, {name}"), |b| {
                b.iter_batched(
                    || {
                        step += 1;
                        dragged(&pairs, &camel.sequence, step)
                    },
                    |pairs| ready.follow(&pairs, &mut Silent).expect("a transfer"),
                    BatchSize::PerIteration,
                );
            });
            let skin = ready.transfer(&pairs, &mut Silent).expect("a transfer").skin;
            let (poses, reference) = (horse.sequence.poses(), camel.sequence.reference());
            group.bench_function(format!("a new pose, {name}"), |b| {
                b.iter(|| -> Vec<DVec3> {
                    step += 1;
                    let maps = ready.maps(&poses[step % poses.len()].positions).expect("maps");
                    skin.posed(reference, &maps)
                });
            });
        }
        group.finish();
    }
    criterion.final_summary();
}
