//! What comes out.

use crate::warning::Warning;

/// The weights of a set of handles on a mesh.
#[derive(Clone, Debug)]
pub struct Weights {
    /// #H vertices, in the order they were given.
    pub handles: Vec<u32>,
    /// #V rows × #H, row by row: shares between 0 and 1 that sum to 1 in each row.
    pub values: Vec<f64>,
    /// How far the solutions are from optimal, the largest over the handles: of the raw weights, before rows were divided
    /// by their sums. Forces that an optimum would not have (along a free weight, or drawing a weight off its bound into
    /// the range), over the largest force of that handle; and, as they are, weights out of bounds.
    pub kkt_residual: f64,
    /// #H energies wᵀ Q w of the raw weights, with lengths in radii of the mesh ([`crate::mesh::ball`]).
    pub energies: Vec<f64>,
    /// What a person should know.
    pub warnings: Vec<Warning>,
    /// #H columns of raw weights on the mesh's own (welded) vertices: where [`super::Biharmonic::update`] starts.
    pub(super) raw: Vec<super::box_problem::Column>,
}

impl Weights {
    /// The number of handles.
    pub fn count(&self) -> usize {
        self.handles.len()
    }

    /// The number of vertices.
    pub fn vertices(&self) -> usize {
        self.values.len().checked_div(self.count()).unwrap_or(0)
    }

    /// The shares of the handles at a vertex, #H; empty where there is no such vertex.
    pub fn row(&self, vertex: usize) -> &[f64] {
        let count = self.count();
        self.values.get(vertex * count..(vertex + 1) * count).unwrap_or(&[])
    }

    /// The share of one handle at all vertices, #V.
    pub fn column(&self, handle: usize) -> Vec<f64> {
        (0..self.vertices()).map(|v| self.row(v).get(handle).copied().unwrap_or(0.0)).collect()
    }
}
