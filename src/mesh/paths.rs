//! Shortest paths over a graph whose links have lengths.

/// A graph whose links have lengths: the neighbours of all nodes, one node after the other.
#[derive(Clone, Debug, Default)]
pub struct Graph {
    /// #nodes + 1: where each node's links start.
    start: Vec<u32>,
    /// (neighbour, length)
    links: Vec<(u32, f64)>,
    /// The mean length of a link; zero without any.
    typical: f64,
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
        let typical = both.iter().map(|link| link.2).sum::<f64>() / both.len().max(1) as f64;
        Self { start, links: both.into_iter().map(|(_, b, d)| (b, d)).collect(), typical }
    }

    /// How many nodes.
    pub fn len(&self) -> usize {
        self.start.len().saturating_sub(1)
    }

    /// Whether there is no node.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The neighbours of a node and how far they are.
    pub fn links(&self, node: u32) -> &[(u32, f64)] {
        &self.links[self.start[node as usize] as usize..self.start[node as usize + 1] as usize]
    }
}

/// Distances of all nodes from sources that are added one after the other, and which source is nearest.
///
/// Nodes wait in buckets of similar distances, not in order: one that leaves its bucket too early leaves it again (delta
/// stepping: U. Meyer and P. Sanders, *Δ-stepping: a parallelizable shortest path algorithm*, Journal of Algorithms 49(1),
/// 2003, pp. 114–152). The distances are those of Dijkstra's algorithm to the last bit.
#[derive(Clone, Debug)]
pub struct Paths {
    /// #nodes distances; infinite where no source is in reach.
    pub distance: Vec<f64>,
    /// #nodes labels of the nearest source; `u32::MAX` where none is in reach.
    pub label: Vec<u32>,
    buckets: Buckets,
}

impl Paths {
    /// No source yet.
    pub fn new(graph: &Graph) -> Self {
        let nodes = graph.len();
        Self { distance: vec![f64::INFINITY; nodes], label: vec![u32::MAX; nodes], buckets: Buckets::new(graph) }
    }

    /// From one source, whose label is 0.
    pub fn from(graph: &Graph, source: u32) -> Self {
        let mut paths = Self::new(graph);
        paths.add(graph, source, 0);
        paths
    }

    /// Adds a source; only what becomes nearer is visited. `graph` is the one that `self` was made for.
    pub fn add(&mut self, graph: &Graph, source: u32, label: u32) {
        self.distance[source as usize] = 0.0;
        self.label[source as usize] = label;
        self.buckets.start(source);
        while let Some((d, node)) = self.buckets.pop() {
            if d > self.distance[node as usize] {
                continue;
            }
            for &(next, length) in graph.links(node) {
                let further = d + length;
                if further < self.distance[next as usize] {
                    self.distance[next as usize] = further;
                    self.label[next as usize] = label;
                    self.buckets.push(further, next);
                }
            }
        }
    }
}

/// Buckets in use at a time.
const BUCKETS: usize = 64;

/// Nodes that wait, by how far they are: those of one bucket in any order, and before all of the next.
#[derive(Clone, Debug)]
struct Buckets {
    /// Distances of one bucket.
    width: f64,
    /// Where the first begins.
    base: f64,
    /// The one that is being emptied.
    current: usize,
    /// (distance, node); the last holds all that is farther.
    waiting: Vec<Vec<(f64, u32)>>,
}

impl Buckets {
    fn new(graph: &Graph) -> Self {
        Self { width: graph.typical, base: 0.0, current: 0, waiting: vec![Vec::new(); BUCKETS] }
    }

    /// With one node at no distance, all buckets being empty.
    fn start(&mut self, node: u32) {
        (self.base, self.current) = (0.0, 0);
        self.push(0.0, node);
    }

    /// No nearer than what was taken last.
    fn push(&mut self, distance: f64, node: u32) {
        // Where widths are zero, what is not farther than the base is no number: the first bucket.
        let bucket = ((distance - self.base) / self.width) as usize;
        self.waiting[bucket.min(BUCKETS - 1)].push((distance, node));
    }

    fn pop(&mut self) -> Option<(f64, u32)> {
        loop {
            if self.current == BUCKETS - 1 {
                let far = std::mem::take(&mut self.waiting[BUCKETS - 1]);
                self.base = far.iter().map(|far| far.0).min_by(f64::total_cmp)?;
                self.current = 0;
                far.into_iter().for_each(|(distance, node)| self.push(distance, node));
            }
            match self.waiting[self.current].pop() {
                Some(nearest) => return Some(nearest),
                None => self.current += 1,
            }
        }
    }
}
