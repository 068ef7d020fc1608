//! Minimum cut of a small undirected graph with two terminals, by Dinic's maximum flow.
//!
//! E. A. Dinic. Algorithm for solution of a problem of maximum flow in networks with power estimation. Soviet
//! Mathematics Doklady 11, 1970.

use std::collections::VecDeque;

/// A graph of `n` inner nodes between a source and a sink.
pub struct MinCut {
    heads: Vec<Vec<u32>>,
    to: Vec<u32>,
    capacity: Vec<f64>,
    source: usize,
    sink: usize,
}

impl MinCut {
    /// `n` inner nodes `0..n` without edges.
    pub fn new(n: usize) -> Self {
        Self { heads: vec![Vec::new(); n + 2], to: Vec::new(), capacity: Vec::new(), source: n, sink: n + 1 }
    }

    /// An undirected edge: cutting it, either way round, costs `capacity`.
    pub fn edge(&mut self, a: usize, b: usize, capacity: f64) {
        self.arcs(a, b, capacity, capacity);
    }

    /// What it costs to leave node `a` on the sink's side, and on the source's side (both not negative).
    pub fn prefer(&mut self, a: usize, cost_on_sink_side: f64, cost_on_source_side: f64) {
        self.arcs(self.source, a, cost_on_sink_side, 0.0);
        self.arcs(a, self.sink, cost_on_source_side, 0.0);
    }

    fn arcs(&mut self, a: usize, b: usize, there: f64, back: f64) {
        for (from, to, capacity) in [(a, b, there), (b, a, back)] {
            self.heads[from].push(self.to.len() as u32);
            self.to.push(to as u32);
            self.capacity.push(capacity.max(0.0));
        }
    }

    /// For each inner node, whether it is on the source's side of the minimum cut (of several, the one nearest to the
    /// source), and the value of the cut.
    pub fn solve(mut self) -> (Vec<bool>, f64) {
        let smallest = 1e-12 * self.capacity.iter().copied().filter(|c| c.is_finite()).fold(0.0, f64::max);
        let mut flow = 0.0;
        loop {
            let level = self.levels(smallest);
            if level[self.sink] == u32::MAX {
                let side = level[..self.source].iter().map(|&l| l != u32::MAX).collect();
                return (side, flow);
            }
            let mut next = vec![0usize; self.heads.len()];
            while let Some(pushed) = self.augment(&level, &mut next, smallest) {
                flow += pushed;
            }
        }
    }

    fn levels(&self, smallest: f64) -> Vec<u32> {
        let mut level = vec![u32::MAX; self.heads.len()];
        level[self.source] = 0;
        let mut queue = VecDeque::from([self.source]);
        while let Some(a) = queue.pop_front() {
            for &arc in &self.heads[a] {
                let b = self.to[arc as usize] as usize;
                if level[b] == u32::MAX && self.capacity[arc as usize] > smallest {
                    level[b] = level[a] + 1;
                    queue.push_back(b);
                }
            }
        }
        level
    }

    /// One augmenting path along falling levels, without recursion (paths can be long).
    fn augment(&mut self, level: &[u32], next: &mut [usize], smallest: f64) -> Option<f64> {
        let mut path: Vec<u32> = Vec::new();
        let mut a = self.source;
        while a != self.sink {
            match self.heads[a].get(next[a]) {
                Some(&arc) => {
                    let b = self.to[arc as usize] as usize;
                    if self.capacity[arc as usize] > smallest && level[b] == level[a] + 1 {
                        path.push(arc);
                        a = b;
                    } else {
                        next[a] += 1;
                    }
                }
                None => {
                    // A dead end: step back and do not come here again.
                    let arc = path.pop()?;
                    a = self.to[arc as usize ^ 1] as usize;
                    next[a] += 1;
                }
            }
        }
        let pushed = path.iter().map(|&arc| self.capacity[arc as usize]).fold(f64::INFINITY, f64::min);
        if !pushed.is_finite() {
            // Source and sink are joined by edges that cannot be cut: no finite cut, any is as good.
            path.iter().for_each(|&arc| self.capacity[arc as usize] = 0.0);
            return Some(0.0);
        }
        for &arc in &path {
            self.capacity[arc as usize] -= pushed;
            self.capacity[arc as usize ^ 1] += pushed;
        }
        Some(pushed)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn no_cut_of_a_small_graph_is_cheaper(
            edges in prop::collection::vec((0..7usize, 0..7usize, 0.0..4.0f64), 0..15),
            terms in prop::collection::vec((0.0..4.0f64, 0.0..4.0f64), 7),
        ) {
            let cost = |side: &dyn Fn(usize) -> bool| {
                let cut: f64 = edges.iter().filter(|&&(a, b, _)| side(a) != side(b)).map(|e| e.2).sum();
                cut + (0..7).map(|i| if side(i) { terms[i].1 } else { terms[i].0 }).sum::<f64>()
            };
            let mut graph = MinCut::new(7);
            edges.iter().for_each(|&(a, b, c)| graph.edge(a, b, c));
            terms.iter().enumerate().for_each(|(i, &(sink, source))| graph.prefer(i, sink, source));
            let (side, value) = graph.solve();
            prop_assert!((cost(&|i| side[i]) - value).abs() < 1e-9);
            let best = (0..128u32).map(|bits| cost(&|i| bits >> i & 1 == 1)).fold(f64::INFINITY, f64::min);
            prop_assert!((value - best).abs() < 1e-9);
        }
    }
}
