//! The energy wᵀ Q w with Q = L M⁻¹ L: the integral of the squared Laplacian.

use crate::linalg::principal::{Merging, Tree};
use crate::linalg::symmetric::Symmetric;
use crate::mesh::laplacian::Laplacian;

/// A vertex with less area than this share of the mean is taken to have as much: the inverse enters Q.
const LEAST_MASS: f64 = 1e-7;

/// The matrices of the energy.
#[derive(Debug)]
pub struct Quadratic {
    /// L, rows summing to zero, negative semidefinite's opposite: positive on the diagonal.
    pub laplacian: Symmetric,
    /// The diagonal of M⁻¹.
    pub inverse_mass: Vec<f64>,
    /// Q = L M⁻¹ L.
    pub matrix: Symmetric,
    /// The diagonal of Q.
    pub diagonal: Vec<f64>,
    /// How Q and its parts are factored.
    pub tree: Tree,
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
        let diagonal = (0..n).map(|v| matrix.diagonal(v)).collect();
        let tree = Tree::new(&matrix, Merging::Much);
        Self { laplacian, inverse_mass, matrix, diagonal, tree }
    }

    /// Q w on a piece with the vertices `members`, into `gradient`; from L twice, which loses fewer digits than from Q.
    /// `inner` is room for M⁻¹ L w. All are as long as the mesh has vertices.
    pub fn gradient(&self, members: &[u32], w: &[f64], inner: &mut [f64], gradient: &mut [f64]) {
        for &v in members {
            inner[v as usize] = self.inverse_mass[v as usize] * self.laplacian.times(v as usize, w);
        }
        for &v in members {
            gradient[v as usize] = self.laplacian.times(v as usize, inner);
        }
    }

    /// (Q w) at one vertex.
    pub fn force(&self, v: usize, w: &[f64]) -> f64 {
        let inner = |u: usize| self.inverse_mass[u] * self.laplacian.times(u, w);
        self.laplacian.row(v).map(|(u, value)| value * inner(u)).sum()
    }

    /// wᵀ Q w over a piece with the vertices `members`.
    pub fn energy(&self, members: &[u32], w: &[f64]) -> f64 {
        let at = |&v: &u32| self.inverse_mass[v as usize] * self.laplacian.times(v as usize, w).powi(2);
        members.iter().map(at).sum()
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
    let mut starts = vec![0; n + 1];
    entries.iter().for_each(|entry| starts[entry.0 as usize + 1] += 1);
    (0..n).for_each(|row| starts[row + 1] += starts[row]);
    let (columns, values) = entries.into_iter().map(|(_, column, value)| (column, value)).unzip();
    Symmetric::new(starts, columns, values)
}

/// L M⁻¹ L, by rows.
fn square(laplacian: &Symmetric, inverse_mass: &[f64]) -> Symmetric {
    let n = laplacian.size();
    let (mut starts, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
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
        columns.extend(&touched);
        values.extend(touched.iter().map(|&c| sum[c as usize]));
        starts.push(columns.len() as u32);
    }
    Symmetric::new(starts, columns, values)
}
