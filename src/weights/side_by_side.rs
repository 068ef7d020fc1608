//! Handles side by side: each has a problem of its own, so each core may take the next.

use std::sync::atomic::{AtomicUsize, Ordering};

/// The results of `work` on 0, 1, … up to `count`, in that order: the same whatever the number of cores. One after the
/// other in a browser, whose worker has one thread.
pub fn each<T: Send>(count: usize, work: impl Fn(usize) -> T + Sync) -> Vec<T> {
    let cores = if cfg!(target_arch = "wasm32") { 1 } else { cores().min(count) };
    if cores <= 1 {
        return (0..count).map(work).collect();
    }
    let next = AtomicUsize::new(0);
    let some = || {
        let mut done = Vec::new();
        loop {
            let item = next.fetch_add(1, Ordering::Relaxed);
            if item >= count {
                return done;
            }
            done.push((item, work(item)));
        }
    };
    let mut all: Vec<(usize, T)> = std::thread::scope(|scope| {
        let others: Vec<_> = (1..cores).map(|_| scope.spawn(some)).collect();
        let mut all = some();
        for other in others {
            match other.join() {
                Ok(done) => all.extend(done),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        }
        all
    });
    all.sort_by_key(|(item, _)| *item);
    all.into_iter().map(|(_, result)| result).collect()
}

fn cores() -> usize {
    std::thread::available_parallelism().map_or(1, std::num::NonZero::get)
}

#[cfg(test)]
mod tests {
    use super::each;

    #[test]
    fn results_are_in_order() {
        assert_eq!(each(100, |i| i * i), (0..100).map(|i| i * i).collect::<Vec<_>>());
        assert!(each(0, |i| i).is_empty());
    }
}
