//! How far proposals lie from true correspondences, and how long they take: a table by pairs of meshes, for 20 points of
//! which none, three or five are given in several draws. `SINEW_ONLY` limits it to pairs whose names contain that.

#[path = "../tests/common/npz.rs"]
mod npz;
#[path = "../tests/common/proposals.rs"]
mod proposals;

use proposals::{Case, Draw, Errors, animal_case, body_cases, mean, measure, most, proposer, zoo_case};
use sinew::clock;

fn cases() -> Vec<Case> {
    let creatures =
        [("person", "person-arms-out"), ("horse", "camel"), ("cat", "elephant"), ("cat", "camel"), ("cat", "giraffe")];
    let mut cases: Vec<Case> = creatures.iter().map(|(a, b)| zoo_case(a, b)).collect();
    if let Some(data) = npz::data("proposals on bodies and animals") {
        let bodies = [("man_lean", "woman"), ("man_lean", "heavy_man"), ("woman", "heavy_man"), ("heavy_man", "woman")];
        cases.extend(body_cases(&data, &bodies));
        for (a, b, file) in [("horse", "camel", "horse_camel.cons"), ("cat", "lion", "marker-cat-lion.txt")] {
            cases.push(animal_case(&data, a, b, file));
        }
    }
    let reversed: Vec<Case> =
        cases.iter().filter(|case| !case.name.starts_with("bodies")).map(Case::reversed).collect();
    cases.extend(reversed);
    cases
}

fn row(case: &Case, trust: &mut Vec<(f64, f64)>) {
    let start = clock::seconds();
    let proposer = proposer(case);
    print!("{:30} {:.2} s", case.name, clock::seconds() - start);
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
        print!(" | {given}: {:5.2} ≤{:5.2} worst {:5.1} ≤{:5.1}", mean(m), most(m), mean(w), most(w));
        print!(" swapped {}", all.swapped);
        slowest = slowest.max(all.seconds);
        trust.extend(all.trust);
    }
    println!(" | {:.0} ms", 1000.0 * slowest);
}

/// What confidence is worth, by tenths.
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

fn main() {
    let only = std::env::var("SINEW_ONLY").unwrap_or_default();
    println!(
        "pair, seconds to prepare | points given: mean of medians ≤ largest, of worst ≤ largest, in % of the diagonal | slowest"
    );
    let mut trust = Vec::new();
    cases().iter().filter(|case| case.name.contains(&only)).for_each(|case| row(case, &mut trust));
    calibration(trust);
}
