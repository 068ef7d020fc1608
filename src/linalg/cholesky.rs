//! Sparse Cholesky factorisation behind one small type; the work is done by the crate `faer`.

use faer::dyn_stack::{MemBuffer, MemStack};
use faer::linalg::cholesky::llt::factor::LltRegularization;
use faer::sparse::linalg::cholesky::{
    CholeskySymbolicParams, LltRef, SymbolicCholesky, SymmetricOrdering, factorize_symbolic_cholesky,
};
use faer::sparse::linalg::{SupernodalThreshold, amd};
use faer::sparse::{SparseColMatRef, SymbolicSparseColMatRef};
use faer::{Conj, MatMut, Par, Side};

/// The matrix has no Cholesky factor: it is not positive definite within rounding, or has entries that are no numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the system of equations has no unique solution")]
pub struct NotPositiveDefinite;

/// From which share of the usual number of operations per entry columns are taken together in dense blocks: what has two
/// edges' reach on a surface gains by that early.
const BLOCKS: SupernodalThreshold = SupernodalThreshold(0.25);

/// How the unknowns are numbered while they are eliminated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Ordering {
    /// By approximate minimum degree, for little fill.
    MinimumDegree,
    /// As they are given: the caller has put them in a good order.
    AsGiven,
}

/// The upper triangle of a symmetric n × n matrix, by columns.
#[derive(Clone, Debug, Default)]
pub struct Upper {
    /// n + 1 places in `rows` and `values` where each column starts, and their length.
    pub starts: Vec<u32>,
    /// Row numbers, rising within a column, none below the diagonal.
    pub rows: Vec<u32>,
    /// The entries.
    pub values: Vec<f64>,
}

/// An order in which to eliminate the unknowns of a symmetric matrix for little fill, by approximate minimum degree: for
/// each place, the number of the unknown that is put there. Of the matrix, `starts` and `rows` are as in [`Upper`].
pub fn minimum_degree(starts: &[u32], rows: &[u32]) -> Option<Vec<u32>> {
    let n = starts.len().checked_sub(1)?;
    let structure = SymbolicSparseColMatRef::new_checked(n, n, starts, None, rows);
    let (mut order, mut places) = (vec![0; n], vec![0; n]);
    let mut buffer = MemBuffer::try_new(amd::order_scratch::<u32>(n, rows.len())).ok()?;
    let stack = MemStack::new(&mut buffer);
    amd::order(&mut order, &mut places, structure, amd::Control::default(), stack).ok()?;
    Some(order)
}

/// The factor L of a symmetric positive definite matrix A = L Lᵀ.
#[derive(Debug)]
pub struct Cholesky {
    symbolic: SymbolicCholesky<u32>,
    values: Vec<f64>,
}

impl Cholesky {
    /// Factors an n × n matrix given by entries (row, column, value) of its lower triangle, in any order; equal places
    /// are summed. Entries above the diagonal are left out, so that a full symmetric list serves as well.
    pub fn new(n: usize, entries: &[(u32, u32, f64)]) -> Result<Self, NotPositiveDefinite> {
        Self::of(&Upper::new(n, entries)?, Ordering::MinimumDegree)
    }

    /// Factors a matrix given by columns.
    pub fn of(matrix: &Upper, ordering: Ordering) -> Result<Self, NotPositiveDefinite> {
        let n = matrix.starts.len().saturating_sub(1);
        if !matrix.values.iter().all(|v| v.is_finite()) {
            return Err(NotPositiveDefinite);
        }
        let structure = SymbolicSparseColMatRef::new_checked(n, n, &matrix.starts, None, &matrix.rows);
        let ordering = match ordering {
            Ordering::MinimumDegree => SymmetricOrdering::Amd,
            Ordering::AsGiven => SymmetricOrdering::Identity,
        };
        let parameters =
            CholeskySymbolicParams { supernodal_flop_ratio_threshold: BLOCKS, ..CholeskySymbolicParams::default() };
        let symbolic = factorize_symbolic_cholesky(structure, Side::Upper, ordering, parameters);
        let symbolic = symbolic.map_err(|_| NotPositiveDefinite)?;
        let values = vec![0.0; symbolic.len_val()];
        let mut factor = Self { symbolic, values };
        factor.again(matrix)?;
        Ok(factor)
    }

    /// Factors another matrix with entries in the same places, in the order of elimination that was found for the first.
    /// After an error the factor is worth nothing.
    pub fn again(&mut self, matrix: &Upper) -> Result<(), NotPositiveDefinite> {
        let n = self.size();
        if matrix.starts.len() != n + 1 || !matrix.values.iter().all(|v| v.is_finite()) {
            return Err(NotPositiveDefinite);
        }
        let structure = SymbolicSparseColMatRef::new_checked(n, n, &matrix.starts, None, &matrix.rows);
        let scratch = self.symbolic.factorize_numeric_llt_scratch::<f64>(Par::Seq, Default::default());
        let mut buffer = MemBuffer::try_new(scratch).map_err(|_| NotPositiveDefinite)?;
        let entries = SparseColMatRef::new(structure, &matrix.values);
        let done = self.symbolic.factorize_numeric_llt(
            &mut self.values,
            entries,
            Side::Upper,
            LltRegularization::default(),
            Par::Seq,
            MemStack::new(&mut buffer),
            Default::default(),
        );
        let done = done.is_ok();
        if done && self.values.iter().all(|v| v.is_finite()) { Ok(()) } else { Err(NotPositiveDefinite) }
    }

    /// The number of unknowns.
    pub fn size(&self) -> usize {
        self.symbolic.nrows()
    }

    /// The number of stored entries of the factor.
    pub fn entries(&self) -> usize {
        self.values.len()
    }

    /// Replaces right-hand sides by solutions: `columns` is n × k, column by column.
    pub fn solve(&self, columns: &mut [f64]) {
        let n = self.size();
        let count = columns.len().checked_div(n).unwrap_or(0);
        if count == 0 {
            return;
        }
        let columns = MatMut::from_column_major_slice_mut(&mut columns[..n * count], n, count);
        let scratch = self.symbolic.solve_in_place_scratch::<f64>(count, Par::Seq);
        let mut buffer = MemBuffer::new(scratch);
        let factor = LltRef::new(&self.symbolic, &self.values);
        factor.solve_in_place_with_conj(Conj::No, columns, Par::Seq, MemStack::new(&mut buffer));
    }
}

impl Upper {
    /// The transpose of a lower triangle given by entries (row, column, value): those of one place are summed, those above
    /// the diagonal and outside the matrix left out.
    pub fn new(n: usize, entries: &[(u32, u32, f64)]) -> Result<Self, NotPositiveDefinite> {
        let inside = |&&(row, column, _): &&(u32, u32, f64)| column <= row && (row as usize) < n;
        let mut sorted: Vec<(u32, u32, f64)> = entries.iter().filter(inside).copied().collect();
        sorted.sort_by_key(|&(row, column, _)| (row, column));
        if u32::try_from(sorted.len()).is_err() {
            return Err(NotPositiveDefinite);
        }
        let mut upper = Self { starts: vec![0; n + 1], rows: Vec::new(), values: Vec::new() };
        for same in sorted.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
            upper.starts[same[0].0 as usize + 1] += 1;
            upper.rows.push(same[0].1);
            upper.values.push(same.iter().map(|entry| entry.2).sum());
        }
        for column in 0..n {
            upper.starts[column + 1] += upper.starts[column];
        }
        Ok(upper)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A grid of springs, held weakly.
    fn grid(side: u32) -> Vec<(u32, u32, f64)> {
        let mut entries = Vec::new();
        for v in 0..side * side {
            entries.push((v, v, 0.01));
            for (inside, next) in [(v % side + 1 < side, v + 1), (v / side + 1 < side, v + side)] {
                if inside {
                    entries.extend([(v, v, 1.0), (next, next, 1.0), (next, v, -1.0), (v, next, -1.0)]);
                }
            }
        }
        entries
    }

    #[test]
    fn solutions_solve() {
        for side in [1, 2, 7, 40] {
            let n = (side * side) as usize;
            let entries = grid(side);
            let right: Vec<f64> = (0..3 * n).map(|i| (i as f64).sin()).collect();
            let mut x = right.clone();
            Cholesky::new(n, &entries).expect("a positive definite matrix").solve(&mut x);
            let mut product = vec![0.0; 3 * n];
            for k in 0..3 {
                for &(row, column, value) in &entries {
                    product[k * n + row as usize] += value * x[k * n + column as usize];
                }
            }
            let worst = product.iter().zip(&right).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
            assert!(worst < 1e-10, "{side}: {worst}");
        }
    }

    #[test]
    fn refuses_what_is_not_positive_definite() {
        assert!(Cholesky::new(2, &[(0, 0, 1.0), (1, 0, 2.0), (1, 1, 1.0)]).is_err());
        assert!(Cholesky::new(2, &[(0, 0, 1.0)]).is_err());
        assert!(Cholesky::new(1, &[(0, 0, f64::NAN)]).is_err());
        assert!(Cholesky::new(0, &[]).is_ok());
    }
}
