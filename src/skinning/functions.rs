//! Φ: the functions that the handles' maps are coefficients of.

use super::rows::Rows;
use glam::DVec3;

/// Coefficients of a handle's four functions: a row for each axis.
pub type Axes = [[f64; 4]; 3];

/// The rows of Φ, #V × 4h: `w_k [p − c_k, 1]` for each handle k, at `c_k`, that the vertex at p listens to.
pub struct Functions {
    start: Vec<u32>,
    handle: Vec<u32>,
    value: Vec<[f64; 4]>,
}

impl Functions {
    /// From #V × #H weights, #V points and #H places.
    pub fn new(weights: &Rows, points: &[DVec3], at: &[DVec3]) -> Self {
        let mut functions = Self { start: vec![0], handle: Vec::new(), value: Vec::new() };
        for (v, &p) in points.iter().enumerate() {
            for (k, w) in weights.entries(v) {
                let local = w * (p - at[k as usize]);
                functions.handle.push(k);
                functions.value.push([local.x, local.y, local.z, w]);
            }
            functions.start.push(functions.handle.len() as u32);
        }
        functions
    }

    /// The row of a vertex: handles, ascending, and what stands in their four columns.
    #[inline]
    pub fn row(&self, v: usize) -> impl Iterator<Item = (usize, &[f64; 4])> {
        let range = self.start[v] as usize..self.start[v + 1] as usize;
        self.handle[range.clone()].iter().map(|&k| k as usize).zip(&self.value[range])
    }

    /// Adds `φᵀ d`, φ being the row of a vertex, to #H coefficients.
    #[inline]
    pub fn spread(&self, v: usize, d: DVec3, sum: &mut [Axes]) {
        for (k, f) in self.row(v) {
            (0..3).for_each(|axis| (0..4).for_each(|i| sum[k][axis][i] += d[axis] * f[i]));
        }
    }

    /// `φ X`, φ being the row of a vertex and X #H coefficients.
    #[inline]
    pub fn at(&self, v: usize, x: &[Axes]) -> DVec3 {
        let mut sum = Axes::default();
        for (k, f) in self.row(v) {
            (0..3).for_each(|axis| (0..4).for_each(|i| sum[axis][i] += x[k][axis][i] * f[i]));
        }
        DVec3::from_array(sum.map(|row| row.iter().sum()))
    }
}

/// Coefficients as a matrix of 4h rows.
pub fn as_rows(axes: &[Axes]) -> Vec<[f64; 3]> {
    axes.iter().flat_map(|axes| (0..4).map(|i| axes.map(|row| row[i]))).collect()
}

/// A matrix of 4h rows as coefficients.
pub fn as_axes(rows: &[[f64; 3]]) -> Vec<Axes> {
    rows.chunks_exact(4).map(|four| [0, 1, 2].map(|axis| [0, 1, 2, 3].map(|i| four[i][axis]))).collect()
}
