//! Distances between all nodes of a graph, of which only those that are asked for are worked out: points that look for
//! their places try about half of a surface's samples.

use crate::mesh::paths::{Graph, Paths};
use std::sync::OnceLock;

/// How far it is to what cannot be reached.
const BEYOND: f32 = 2.0;

/// #nodes × #nodes distances, row by row.
#[derive(Clone, Debug)]
pub struct Distances {
    graph: Graph,
    /// What a length of one in the graph is.
    unit: f32,
    rows: Vec<OnceLock<Vec<f32>>>,
}

impl Distances {
    /// Along the links of a graph.
    pub fn new(graph: Graph) -> Self {
        let rows = vec![OnceLock::new(); graph.len()];
        Self { graph, unit: 1.0, rows }
    }

    /// What they run along, in lengths of its own.
    pub fn graph(&self) -> &Graph {
        &self.graph
    }

    /// Makes all distances longer or shorter.
    pub fn scale(&mut self, by: f32) {
        self.unit *= by;
        self.rows.iter_mut().filter_map(OnceLock::get_mut).flatten().for_each(|d| *d *= by);
    }

    /// Distances of all nodes from one of them.
    pub fn row(&self, node: u32) -> &[f32] {
        self.rows[node as usize].get_or_init(|| {
            let far = |&d: &f64| self.unit * if d.is_finite() { d as f32 } else { BEYOND };
            Paths::from(&self.graph, node).distance.iter().map(far).collect()
        })
    }
}
