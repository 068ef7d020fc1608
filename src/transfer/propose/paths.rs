//! Shortest paths over a weighted graph of points (Dijkstra 1959).

use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// A graph whose links have lengths: the neighbours of all nodes, one node after the other.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    /// #nodes + 1: where each node's links start.
    start: Vec<u32>,
    /// (neighbour, length)
    links: Vec<(u32, f64)>,
}

impl Graph {
    /// From undirected links `(a, b, length)` between nodes below `nodes`; of parallel links the shortest counts. Links
    /// from a node to itself and lengths that are negative or not finite are left out.
    pub fn new(nodes: usize, links: &[(u32, u32, f64)]) -> Self {
        let fine = |&&(a, b, d): &&(u32, u32, f64)| a != b && d >= 0.0 && d.is_finite();
        let both = links.iter().filter(fine).flat_map(|&(a, b, d)| [(a, b, d), (b, a, d)]);
        let mut both: Vec<(u32, u32, f64)> =
            both.filter(|l| (l.0 as usize) < nodes && (l.1 as usize) < nodes).collect();
        both.sort_by(|x, y| (x.0, x.1).cmp(&(y.0, y.1)).then(x.2.total_cmp(&y.2)));
        both.dedup_by_key(|l| (l.0, l.1));
        let mut start = vec![0; nodes + 1];
        both.iter().for_each(|l| start[l.0 as usize + 1] += 1);
        for node in 0..nodes {
            start[node + 1] += start[node];
        }
        Self { start, links: both.into_iter().map(|(_, b, d)| (b, d)).collect() }
    }

    /// How many nodes.
    pub fn len(&self) -> usize {
        self.start.len().saturating_sub(1)
    }

    /// The neighbours of a node and how far they are.
    pub fn links(&self, node: u32) -> &[(u32, f64)] {
        &self.links[self.start[node as usize] as usize..self.start[node as usize + 1] as usize]
    }
}

/// Distances of all nodes from sources that are added one after the other, and which source is nearest.
#[derive(Clone, Debug)]
pub struct Paths {
    /// #nodes distances; infinite where no source is in reach.
    pub distance: Vec<f64>,
    /// #nodes labels of the nearest source; `u32::MAX` where none is in reach.
    pub label: Vec<u32>,
    heap: BinaryHeap<Reverse<(u64, u32)>>,
}

impl Paths {
    /// No source yet.
    pub fn new(nodes: usize) -> Self {
        Self { distance: vec![f64::INFINITY; nodes], label: vec![u32::MAX; nodes], heap: BinaryHeap::new() }
    }

    /// Forgets all sources.
    pub fn clear(&mut self) {
        self.distance.fill(f64::INFINITY);
        self.label.fill(u32::MAX);
    }

    /// Adds a source; only what becomes nearer is visited.
    pub fn add(&mut self, graph: &Graph, source: u32, label: u32) {
        self.distance[source as usize] = 0.0;
        self.label[source as usize] = label;
        self.heap.push(Reverse((0, source)));
        // Distances are not negative, so their bits are ordered like their values.
        while let Some(Reverse((bits, node))) = self.heap.pop() {
            let d = f64::from_bits(bits);
            if d > self.distance[node as usize] {
                continue;
            }
            for &(next, length) in graph.links(node) {
                let further = d + length;
                if further < self.distance[next as usize] {
                    self.distance[next as usize] = further;
                    self.label[next as usize] = label;
                    self.heap.push(Reverse((further.to_bits(), next)));
                }
            }
        }
    }
}
