//! The energy wᵀ Q w with Q = L M⁻¹ L: the integral of the squared Laplacian.

use crate::linalg::cholesky::Lower;
use crate::mesh::laplacian::Laplacian;

/// A vertex with less area than this share of the mean is taken to have as much: the inverse enters Q.
const LEAST_MASS: f64 = 1e-7;

/// A symmetric sparse matrix, both triangles, by rows.
#[derive(Debug)]
pub struct Symmetric {
    starts: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl Symmetric {
    /// The entries of a row: column numbers, rising, and values.
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> {
        let range = self.starts[row] as usize..self.starts[row + 1] as usize;
        self.columns[range.clone()].iter().map(|&c| c as usize).zip(self.values[range].iter().copied())
    }

    /// The number of rows.
    pub fn size(&self) -> usize {
        self.starts.len() - 1
    }

    /// The product of a row with a vector.
    pub fn times(&self, row: usize, vector: &[f64]) -> f64 {
        self.row(row).map(|(column, value)| value * vector[column]).sum()
    }

    /// The entry of a row on the diagonal.
    pub fn diagonal(&self, row: usize) -> f64 {
        self.row(row).find(|&(column, _)| column == row).map_or(0.0, |(_, value)| value)
    }

    /// The lower triangle of the rows and columns listed in `members`; `place` is each one's place in that list, and
    /// `u32::MAX` for those not in it.
    pub fn lower(&self, members: &[u32], place: &[u32]) -> Lower {
        let mut lower = Lower { starts: vec![0], rows: Vec::new(), values: Vec::new() };
        for (column, &v) in members.iter().enumerate() {
            for (u, value) in self.row(v as usize) {
                if place[u] != u32::MAX && place[u] as usize >= column {
                    lower.rows.push(place[u]);
                    lower.values.push(value);
                }
            }
            lower.starts.push(lower.rows.len() as u32);
        }
        lower
    }
}

/// The matrices of the energy.
#[derive(Debug)]
pub struct Quadratic {
    /// L, rows summing to zero, negative semidefinite's opposite: positive on the diagonal.
    pub laplacian: Symmetric,
    /// The diagonal of M⁻¹.
    pub inverse_mass: Vec<f64>,
    /// Q = L M⁻¹ L.
    pub matrix: Symmetric,
}

impl Quadratic {
    /// The energy of a mesh with `laplacian`.
    pub fn new(laplacian: &Laplacian) -> Self {
        let n = laplacian.mass.len();
        let covered = laplacian.mass.iter().filter(|&&m| m > 0.0).count().max(1);
        let least = LEAST_MASS * laplacian.mass.iter().sum::<f64>() / covered as f64;
        let invert = |&mass: &f64| if least > 0.0 { 1.0 / mass.max(least) } else { 0.0 };
        let inverse_mass: Vec<f64> = laplacian.mass.iter().map(invert).collect();
        let laplacian = stiffness(laplacian, n);
        let matrix = square(&laplacian, &inverse_mass);
        Self { laplacian, inverse_mass, matrix }
    }

    /// Q w, from L twice, which loses fewer digits than from Q.
    pub fn gradient(&self, w: &[f64]) -> Vec<f64> {
        let n = w.len();
        let inner: Vec<f64> = (0..n).map(|v| self.inverse_mass[v] * self.laplacian.times(v, w)).collect();
        (0..n).map(|v| self.laplacian.times(v, &inner)).collect()
    }

    /// wᵀ Q w.
    pub fn energy(&self, w: &[f64]) -> f64 {
        (0..w.len()).map(|v| self.inverse_mass[v] * self.laplacian.times(v, w).powi(2)).sum()
    }
}

/// L by rows.
fn stiffness(laplacian: &Laplacian, n: usize) -> Symmetric {
    let mut entries = Vec::with_capacity(2 * laplacian.edges.len() + n);
    let mut diagonal = vec![0.0; n];
    for (&[a, b], &c) in laplacian.edges.iter().zip(&laplacian.cotangents) {
        entries.extend([(a, b, -c), (b, a, -c)]);
        diagonal[a as usize] += c;
        diagonal[b as usize] += c;
    }
    entries.extend(diagonal.iter().enumerate().map(|(v, &d)| (v as u32, v as u32, d)));
    entries.sort_unstable_by_key(|&(row, column, _)| (row, column));
    let mut matrix = Symmetric { starts: vec![0; n + 1], columns: Vec::new(), values: Vec::new() };
    for (row, column, value) in entries {
        matrix.starts[row as usize + 1] += 1;
        matrix.columns.push(column);
        matrix.values.push(value);
    }
    (0..n).for_each(|row| matrix.starts[row + 1] += matrix.starts[row]);
    matrix
}

/// L M⁻¹ L, by rows.
fn square(laplacian: &Symmetric, inverse_mass: &[f64]) -> Symmetric {
    let n = laplacian.size();
    let mut matrix = Symmetric { starts: vec![0], columns: Vec::new(), values: Vec::new() };
    let mut sum = vec![0.0; n];
    let mut seen = vec![u32::MAX; n];
    let mut touched = Vec::new();
    for row in 0..n {
        touched.clear();
        for (middle, a) in laplacian.row(row) {
            let a = a * inverse_mass[middle];
            for (column, b) in laplacian.row(middle) {
                if seen[column] != row as u32 {
                    seen[column] = row as u32;
                    sum[column] = 0.0;
                    touched.push(column as u32);
                }
                sum[column] += a * b;
            }
        }
        touched.sort_unstable();
        matrix.columns.extend(&touched);
        matrix.values.extend(touched.iter().map(|&c| sum[c as usize]));
        matrix.starts.push(matrix.columns.len() as u32);
    }
    matrix
}
