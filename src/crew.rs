//! Costly work shared out among the members of a crew.
//!
//! Natively the members are threads, and share all they have. In a browser they are workers that share no memory, so there
//! every member runs the whole computation, from the same input; what is costly in it is divided. Where [`Crew::until`] is
//! called, the members meet: each does some of the items, and each gets the results of all. So a computation that is
//! shared out must come to the same meetings, in the same order, whoever runs it: it may depend on nothing but its input.

use serde::Serialize;
use serde::de::DeserializeOwned;
use std::num::NonZero;
use std::pin::pin;
use std::sync::OnceLock;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::task::{Context, Poll, Waker};

/// What can be sent from one member to another.
pub trait Shared: Send + Serialize + DeserializeOwned + 'static {}

impl<T: Send + Serialize + DeserializeOwned + 'static> Shared for T {}

/// Those who share out work.
pub trait Crew {
    /// The results of `work` on 0, 1, … up to the first that is `enough`, that one included, or up to `count`, whoever does
    /// what. Of the items behind it, some may be done in vain.
    fn until<T: Shared>(
        &self,
        count: usize,
        work: &(dyn Fn(usize) -> T + Sync),
        enough: &(dyn Fn(&T) -> bool + Sync),
    ) -> impl Future<Output = Vec<T>>;

    /// The results of `work` on 0, 1, … up to `count`.
    fn each<T: Shared>(&self, count: usize, work: &(dyn Fn(usize) -> T + Sync)) -> impl Future<Output = Vec<T>> {
        self.until(count, work, &|_| false)
    }
}

/// The threads of one process: one for each core, in a browser one.
pub struct Threads;

impl Crew for Threads {
    async fn until<T: Shared>(
        &self,
        count: usize,
        work: &(dyn Fn(usize) -> T + Sync),
        enough: &(dyn Fn(&T) -> bool + Sync),
    ) -> Vec<T> {
        let threads = threads().min(count);
        let (next, end) = (AtomicUsize::new(0), AtomicUsize::new(count));
        let some = || {
            let mut done = Vec::new();
            loop {
                let item = next.fetch_add(1, Ordering::Relaxed);
                if item >= end.load(Ordering::Relaxed) {
                    return done;
                }
                let result = work(item);
                if enough(&result) {
                    end.fetch_min(item + 1, Ordering::Relaxed);
                }
                done.push((item, result));
            }
        };
        let all: Vec<(usize, T)> = if threads <= 1 {
            some()
        } else {
            std::thread::scope(|scope| {
                let others: Vec<_> = (1..threads).map(|_| scope.spawn(some)).collect();
                let mut all = some();
                for other in others {
                    match other.join() {
                        Ok(done) => all.extend(done),
                        Err(panic) => std::panic::resume_unwind(panic),
                    }
                }
                all
            })
        };
        let mut results: Vec<Option<T>> = (0..count).map(|_| None).collect();
        all.into_iter().for_each(|(item, result)| results[item] = Some(result));
        results.into_iter().take(end.into_inner()).flatten().collect()
    }
}

/// Runs what need not wait for anybody, as everything that [`Threads`] share out.
pub fn at_once<T>(work: impl Future<Output = T>) -> T {
    let mut work = pin!(work);
    loop {
        if let Poll::Ready(result) = work.as_mut().poll(&mut Context::from_waker(Waker::noop())) {
            return result;
        }
        std::thread::yield_now();
    }
}

/// How many threads are worth it; asked once, for the system reads files to know.
fn threads() -> usize {
    static THREADS: OnceLock<usize> = OnceLock::new();
    let cores = || std::thread::available_parallelism().map_or(1, NonZero::get);
    if cfg!(target_arch = "wasm32") { 1 } else { *THREADS.get_or_init(cores) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn results_are_in_order() {
        assert_eq!(at_once(Threads.each(100, &|i| i * i)), (0..100).map(|i| i * i).collect::<Vec<_>>());
        assert!(at_once(Threads.each(0, &|i| i)).is_empty());
    }

    #[test]
    fn the_first_that_is_enough_is_the_last() {
        for enough in [0, 1, 7, 99] {
            let found = at_once(Threads.until(100, &|i| i, &|&i| i == enough || i == enough + 3));
            assert_eq!(found, (0..=enough).collect::<Vec<_>>());
        }
    }
}
