//! What comes out.

use crate::warning::Warning;

/// The weights of a set of handles on a mesh.
#[derive(Clone, Debug)]
pub struct Weights {
    /// #H vertices, in the order they were given.
    pub handles: Vec<u32>,
    /// #V rows × #H, row by row: shares between 0 and 1 that sum to 1 in each row.
    pub values: Vec<f64>,
    /// #V sums of the raw weights, by which rows were divided: 1 in the joint form, 0 on pieces without a handle.
    pub sums: Vec<f64>,
    /// How far the solutions are from optimal: the largest force that an optimum would not have, over the largest force
    /// there is. Forces are Q w, of the weights after they were clamped to their range: bounds, rows of handles and, in
    /// the joint form, sums hold exactly and do not enter; so what is measured is stationarity with the right signs.
    ///
    /// Separate form: for each handle, of its raw weights (before rows are divided by their sums), the largest of |(Q w)ᵥ|
    /// where 0 < wᵥ < 1, of −(Q w)ᵥ where wᵥ = 0 and of (Q w)ᵥ where wᵥ = 1, handles left out, over the largest |(Q w)ᵥ|
    /// with handles; then the largest over the handles. Joint form: for each vertex but the handles, by how much the
    /// largest force on a positive weight exceeds the least force on any; the largest over the vertices of a piece, over
    /// the largest |(Q wⱼ)ᵥ| there; then the largest over the pieces.
    ///
    /// What is aimed at: 1e-6. More remains where triangles are so thin that forces are lost in the rounding of the weights.
    pub kkt_residual: f64,
    /// #H energies wᵀ Q w of the raw weights, with lengths in radii of the mesh ([`crate::mesh::ball`]).
    pub energies: Vec<f64>,
    /// What a person should know.
    pub warnings: Vec<Warning>,
    /// #H columns of raw weights of the separate form on the mesh's own (welded) vertices: where [`super::Biharmonic::update`] starts.
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

    /// The raw weights of one handle at all vertices, before rows were divided by their sums, #V; 0 on pieces without a
    /// handle.
    pub fn raw_column(&self, handle: usize) -> Vec<f64> {
        self.column(handle).iter().zip(&self.sums).map(|(share, sum)| share * sum).collect()
    }

    /// The share of one handle at all vertices, #V.
    pub fn column(&self, handle: usize) -> Vec<f64> {
        (0..self.vertices()).map(|v| self.row(v).get(handle).copied().unwrap_or(0.0)).collect()
    }
}
