//! Sparse Cholesky factors, multifrontal: I. Duff, J. Reid. *The multifrontal solution of indefinite sparse symmetric
//! linear equations*. ACM Transactions on Mathematical Software 9(3), 1983.

use super::front::{Front, padded};
use super::symmetric::Symmetric;
use super::tree::{Merging, Tree};
use pulp::{Arch, Simd, WithSimd};

/// The matrix has no Cholesky factor: it is not positive definite within rounding, or has entries that are no numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
#[error("the system of equations has no unique solution")]
pub struct NotPositiveDefinite;

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
/// each place, the number of the unknown that is put there. Of the matrix, `starts` and `rows` are as in [`Upper`], with all
/// of the diagonal.
pub fn minimum_degree(starts: &[u32], rows: &[u32]) -> Option<Vec<u32>> {
    let n = starts.len().checked_sub(1)?;
    let (order, _, _) = amd::order(u32::try_from(n).ok()?, starts, rows, &amd::Control::default()).ok()?;
    Some(order)
}

/// The factor L of a symmetric positive definite matrix A = L Lᵀ.
#[derive(Debug)]
pub struct Cholesky {
    /// For each unknown, when it is eliminated.
    places: Vec<u32>,
    tree: Tree,
    /// #nodes of the tree: what was eliminated there.
    fronts: Vec<Front>,
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
        if !matrix.has_diagonal() {
            return Err(NotPositiveDefinite);
        }
        let mut places: Vec<u32> = (0..n as u32).collect();
        if ordering == Ordering::MinimumDegree {
            let order = minimum_degree(&matrix.starts, &matrix.rows).ok_or(NotPositiveDefinite)?;
            order.iter().zip(0..).for_each(|(&unknown, place)| places[unknown as usize] = place);
        }
        let permuted = Symmetric::permuted(matrix, &places);
        let tree = Tree::new(&permuted, Merging::Little);
        let fronts = (0..tree.size()).map(|_| Front::default()).collect();
        let mut factor = Self { places, tree, fronts };
        factor.eliminate(&permuted)?;
        Ok(factor)
    }

    /// Factors another matrix with entries in the same places, in the order of elimination that was found for the first.
    /// After an error the factor is worth nothing.
    pub fn again(&mut self, matrix: &Upper) -> Result<(), NotPositiveDefinite> {
        if matrix.starts.len() != self.size() + 1 {
            return Err(NotPositiveDefinite);
        }
        self.eliminate(&Symmetric::permuted(matrix, &self.places))
    }

    /// Eliminates the unknowns of a matrix that is in order already.
    fn eliminate(&mut self, matrix: &Symmetric) -> Result<(), NotPositiveDefinite> {
        let tree = &self.tree;
        // Of each unknown, its row in the front at hand. What is in a front is in the one above as well, so that none of
        // those left from earlier fronts is asked for.
        let mut row = vec![0; matrix.size()];
        // What a node leaves lies in memory that one below had before.
        let (mut of_child, mut spare): (Vec<usize>, Vec<Vec<f64>>) = (Vec::new(), Vec::new());
        for node in 0..tree.size() {
            let (below, here) = self.fronts.split_at_mut(node);
            let (front, node) = (&mut here[0], node as u32);
            let (columns, rows) = (tree.columns(node), tree.rows(node));
            front.rest = spare.pop().unwrap_or_default();
            front.reset(columns.len(), rows.len());
            let places = (0..).zip(columns.clone()).chain((padded(columns.len()) as u32..).zip(rows.iter().copied()));
            places.for_each(|(place, v)| row[v as usize] = place);
            front.set(matrix, columns, &row);
            for &child in tree.children(node) {
                of_child.clear();
                of_child.extend(tree.rows(child).iter().map(|&v| row[v as usize] as usize));
                let child = &mut below[child as usize];
                front.add(child, &of_child);
                spare.push(std::mem::take(&mut child.rest));
            }
            if !front.eliminate() {
                return Err(NotPositiveDefinite);
            }
        }
        Ok(())
    }

    /// The number of unknowns.
    pub fn size(&self) -> usize {
        self.places.len()
    }

    /// The number of stored entries of the factor.
    #[cfg(test)]
    fn entries(&self) -> usize {
        self.fronts.iter().map(|front| front.panel.len()).sum()
    }

    /// Replaces right-hand sides by solutions: `columns` is n × k, column by column.
    pub fn solve(&self, columns: &mut [f64]) {
        if self.size() > 0 {
            Arch::new().dispatch(Solution { factor: self, columns });
        }
    }
}

/// Solutions, with the widest vectors that the machine has.
struct Solution<'a> {
    factor: &'a Cholesky,
    columns: &'a mut [f64],
}

impl WithSimd for Solution<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        // Right-hand sides most often come in threes.
        if S::F64_LANES < 4 { self.together::<S, 2>(simd) } else { self.together::<S, 1>(simd) }
    }
}

impl Solution<'_> {
    /// Solves for V vectors of right-hand sides at a time.
    #[inline(always)]
    fn together<S: Simd, const V: usize>(self, simd: S) {
        let Self { factor: Cholesky { places, tree, fronts }, columns } = self;
        let (n, width, zero) = (places.len(), V * S::F64_LANES, [simd.splat_f64s(0.0); V]);
        let (mut values, mut here) = (vec![0.0; n * width], Vec::new());
        for columns in columns.chunks_mut(n * width) {
            for (k, column) in columns.chunks_exact(n).enumerate() {
                places.iter().zip(column).for_each(|(&place, &x)| values[place as usize * width + k] = x);
            }
            let (all, _) = S::as_mut_simd_f64s(&mut values).0.as_chunks_mut::<V>();
            for (node, front) in (0..).zip(fronts) {
                gather(tree, node, all, zero, &mut here);
                front.forward_together(simd, &mut here);
                scatter(tree, node, &here, all);
            }
            for (node, front) in (0..fronts.len() as u32).zip(fronts).rev() {
                gather(tree, node, all, zero, &mut here);
                front.backward_together(simd, &mut here);
                scatter(tree, node, &here, all);
            }
            for (k, column) in columns.chunks_exact_mut(n).enumerate() {
                places.iter().zip(column).for_each(|(&place, x)| *x = values[place as usize * width + k]);
            }
        }
    }
}

/// What stands at a node's unknowns, one for each row of its front.
#[inline(always)]
fn gather<T: Copy>(tree: &Tree, node: u32, all: &[T], zero: T, here: &mut Vec<T>) {
    let (columns, rows) = (tree.columns(node), tree.rows(node));
    let top = padded(columns.len());
    here.clear();
    here.extend_from_slice(&all[columns.start as usize..columns.end as usize]);
    here.resize(top, zero);
    here.extend(rows.iter().map(|&v| all[v as usize]));
    here.resize(top + padded(rows.len()), zero);
}

/// Puts it back.
#[inline(always)]
fn scatter<T: Copy>(tree: &Tree, node: u32, here: &[T], all: &mut [T]) {
    let columns = tree.columns(node);
    let (own, beneath) = here.split_at(padded(columns.len()));
    all[columns.start as usize..columns.end as usize].copy_from_slice(&own[..columns.len()]);
    tree.rows(node).iter().zip(beneath).for_each(|(&v, &x)| all[v as usize] = x);
}

impl Upper {
    /// Whether every column has an entry on the diagonal.
    fn has_diagonal(&self) -> bool {
        let last = |range: &[u32]| self.rows[range[0] as usize..range[1] as usize].last();
        self.starts.windows(2).zip(0..).all(|(range, column)| last(range) == Some(&column))
    }

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
    fn other_values_in_the_same_places_and_another_order_give_what_a_new_factor_gives() {
        let (n, entries) = (23 * 23, grid(23));
        let stiffer: Vec<_> =
            entries.iter().map(|&(i, j, x)| (i, j, if i == j { x + f64::from(i % 5) } else { x })).collect();
        let [first, second] = [entries, stiffer].map(|entries| Upper::new(n, &entries).expect("a matrix"));
        let mut again = Cholesky::of(&first, Ordering::MinimumDegree).expect("a factor");
        again.again(&second).expect("another factor");
        let given = Cholesky::of(&second, Ordering::AsGiven).expect("a factor");
        // More right-hand sides than there are numbers in a vector, and some left over.
        let mut x: Vec<f64> = (0..19 * n).map(|i| (i as f64).cos()).collect();
        let mut y = x.clone();
        again.solve(&mut x);
        given.solve(&mut y);
        let worst = x.iter().zip(&y).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
        assert!(worst < 1e-11, "{worst}");
        assert!(again.entries() < given.entries(), "minimum degree saves entries");
        assert!(again.again(&Upper::new(2, &[]).expect("a matrix")).is_err(), "of another size");
    }

    #[test]
    fn refuses_what_is_not_positive_definite() {
        assert!(Cholesky::new(2, &[(0, 0, 1.0), (1, 0, 2.0), (1, 1, 1.0)]).is_err());
        assert!(Cholesky::new(2, &[(0, 0, 1.0)]).is_err());
        assert!(Cholesky::new(1, &[(0, 0, f64::NAN)]).is_err());
        assert!(Cholesky::new(2, &[(0, 0, 1.0), (1, 0, f64::INFINITY), (1, 1, 1.0)]).is_err());
        assert!(Cholesky::new(0, &[]).is_ok());
    }
}
