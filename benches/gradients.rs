//! How long transfer by gradients takes: natively, on one core, a horse's poses on a camel of 43,814 faces.

#[path = "../tests/common/npz.rs"]
mod npz;

use criterion::Criterion;
use sinew::clock;
use sinew::observer::Silent;
use sinew::sequence::Sequence;
use sinew::transfer::gradients::Mover;
use sinew::transfer::{Method, Pair, Parameters};
use sinew::zoo::{self, Creature, Recipe};

/// The public horse and camel and their pairs, where they are at hand, else made ones of the same size.
fn scene() -> (Sequence, Sequence, Vec<Pair>) {
    if let Some(data) = npz::data("the public horse and camel; made ones are measured instead") {
        let [horse, camel] = ["horse", "camel"].map(|name| npz::sequence(&data.join(format!("sumner/{name}.npz"))));
        let text = std::fs::read_to_string(data.join("sumner/horse_camel.cons")).expect("pairs");
        let pair = |line: &str| {
            let (source, target) = line.split_once(',')?;
            Some(Pair { source: source.trim().parse().ok()?, target: target.trim().parse().ok()? })
        };
        let pairs = text.lines().filter_map(pair).collect();
        return (horse, camel.reference_alone(), pairs);
    }
    let make = |name: &str, faces: usize| -> Creature {
        let recipe = Recipe { name: name.into(), faces, poses: 10, exact: false, ..Recipe::default() };
        zoo::make(&recipe).expect("a creature of that name")
    };
    let (horse, camel) = (make("horse", 16_843), make("camel", 43_814));
    let pairs = zoo::correspondences(&horse, &camel, 107).into_iter();
    let pairs = pairs.map(|(source, target)| Pair { source, target }).collect();
    (horse.sequence, camel.sequence.reference_alone(), pairs)
}

fn main() {
    let (source, target, pairs) = scene();
    for method in [Method::Gradients, Method::Posed] {
        let parameters = Parameters { method, ..Parameters::default() };
        let start = clock::seconds();
        let mover = Mover::new(&source, &target, &parameters, &mut Silent).expect("a mover");
        let moved = mover.transfer(&pairs, &mut Silent).expect("a transfer");
        println!("{method:?}: {:.2} s, {:.3?}", clock::seconds() - start, moved.bent.quality);
        for (step, seconds) in mover.seconds().iter().chain(&moved.seconds) {
            println!("  {step:<20} {seconds:.3} s");
        }
    }
    let mut criterion = Criterion::default().configure_from_args();
    let mut group = criterion.benchmark_group("gradients");
    group.sample_size(10);
    let parameters = Parameters { method: Method::Gradients, ..Parameters::default() };
    let mover = Mover::new(&source, &target, &parameters, &mut Silent).expect("a mover");
    group.bench_function("correspondence and ten poses", |b| b.iter(|| mover.transfer(&pairs, &mut Silent)));
    group.finish();
    criterion.final_summary();
}
