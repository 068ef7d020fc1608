//! Members of a crew who share no memory, as the workers of a browser: all come to the same answer as one alone.
#![cfg(not(target_arch = "wasm32"))]

use sinew::crew::{Crew, Shared, Threads, at_once};
use sinew::keypoints::{KeyPoints, Parameters, fit_all_by, select_by};
use sinew::observer::Silent;
use sinew::sequence::Sequence;
use sinew::zoo::{self, Recipe};
use std::cell::Cell;
use std::collections::BTreeMap;
use std::sync::{Condvar, Mutex};
use std::time::Duration;

/// Members that take longer than this for an item are broken.
const PATIENCE: Duration = Duration::from_secs(60);

/// The bytes of a result, and whether it is enough.
type HandedIn = (Vec<u8>, bool);

/// What members have handed in, by meeting and item.
#[derive(Default)]
struct Table {
    handed_in: Mutex<BTreeMap<(usize, usize), HandedIn>>,
    changed: Condvar,
}

/// One of some members, who know each other's results by their bytes alone.
struct Member<'a> {
    rank: usize,
    size: usize,
    meeting: Cell<usize>,
    table: &'a Table,
}

impl Crew for Member<'_> {
    async fn until<T: Shared>(
        &self,
        count: usize,
        work: &(dyn Fn(usize) -> T + Sync),
        enough: &(dyn Fn(&T) -> bool + Sync),
    ) -> Vec<T> {
        let meeting = self.meeting.replace(self.meeting.get() + 1);
        for item in (self.rank..count).step_by(self.size) {
            let result = work(item);
            let bytes = postcard::to_allocvec(&result).expect("bytes");
            let last = enough(&result);
            self.table.handed_in.lock().expect("a lock").insert((meeting, item), (bytes, last));
            self.table.changed.notify_all();
            if last {
                break;
            }
        }
        let mut results = Vec::new();
        let mut handed_in = self.table.handed_in.lock().expect("a lock");
        while results.len() < count {
            let Some((bytes, last)) = handed_in.get(&(meeting, results.len())) else {
                let (next, late) = self.table.changed.wait_timeout(handed_in, PATIENCE).expect("a lock");
                assert!(!late.timed_out(), "a member does not hand in what it should");
                handed_in = next;
                continue;
            };
            results.push(postcard::from_bytes(bytes).expect("a result"));
            if *last {
                break;
            }
        }
        results
    }
}

/// What `size` members come to, each running `work` as a whole.
fn together<T: Send>(size: usize, work: impl Fn(&Member) -> T + Sync) -> Vec<T> {
    let table = Table::default();
    std::thread::scope(|scope| {
        let member = |rank| {
            let (table, work) = (&table, &work);
            scope.spawn(move || work(&Member { rank, size, meeting: Cell::new(0), table }))
        };
        let members: Vec<_> = (0..size).map(member).collect();
        members.into_iter().map(|member| member.join().expect("no panic")).collect()
    })
}

fn camel() -> Sequence {
    let recipe = Recipe { name: "camel".into(), faces: 1_600, poses: 6, exact: false, ..Recipe::default() };
    zoo::make(&recipe).expect("a creature of that name").sequence
}

fn assert_same(one: &KeyPoints, other: &KeyPoints) {
    assert_eq!(one.key_points, other.key_points);
    assert_eq!(one.groups, other.groups);
    assert_eq!(one.replacements.len(), other.replacements.len());
    // Factors, which are not sent, differ in their last digits when they are made anew.
    let near = |a: &[f64], b: &[f64]| a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-12);
    assert!(near(&one.errors, &other.errors), "{:?}, {:?}", one.errors, other.errors);
    assert!(near(&one.weights.values, &other.weights.values));
}

#[test]
fn members_choose_the_same_points_as_one_alone() {
    let camel = camel();
    let parameters = Parameters { points: Some(7), ..Parameters::default() };
    let chosen = |crew: &Member| at_once(select_by(crew, &camel, &parameters, &mut Silent)).expect("key points");
    let alone = at_once(select_by(&Threads, &camel, &parameters, &mut Silent)).expect("key points");
    for size in [1, 3] {
        let all = together(size, chosen);
        all.iter().for_each(|found| assert_same(found, &alone));
        all.iter().for_each(|found| assert_eq!(found.errors, all[0].errors, "members differ"));
    }
}

#[test]
fn members_find_the_same_weights_as_one_alone() {
    let camel = camel();
    let (points, parameters) = ([3, 150, 400, 600], Parameters::default());
    let alone = at_once(fit_all_by(&Threads, &camel, &points, &parameters)).expect("weights");
    for found in together(2, |crew| at_once(fit_all_by(crew, &camel, &points, &parameters)).expect("weights")) {
        assert_eq!(found.weights.values, alone.weights.values);
        assert_eq!(found.weights.kkt_residual, alone.weights.kkt_residual);
        assert_eq!(found.error, alone.error);
    }
}
