//! Dense elimination of the leading columns of a symmetric matrix, in tiles of two vectors by four columns.

use super::symmetric::Symmetric;
use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

/// Rows and columns are counted in fours; what is over is zero.
pub const TILE: usize = 4;

/// Columns that are eliminated before they are subtracted from others of their slab.
const BLOCK: usize = 2 * TILE;

/// Columns that are eliminated before they are subtracted from everything else: so many that they stay near the processor
/// meanwhile.
const SLAB: usize = 64;

/// The next multiple of [`TILE`].
pub fn padded(count: usize) -> usize {
    count.next_multiple_of(TILE)
}

/// Solves with the columns of a front from `first` on: [`TILE`] of them, or what is left of the pivots.
macro_rules! solve_block {
    ($front:ident, $solve:ident, $simd:ident, $x:ident, $first:ident) => {
        match $front.pivots - $first {
            1 => $solve($simd, $front.block::<1>($first), $x, $first),
            2 => $solve($simd, $front.block::<2>($first), $x, $first),
            3 => $solve($simd, $front.block::<3>($first), $x, $first),
            _ => $solve($simd, $front.block::<TILE>($first), $x, $first),
        }
    };
}

/// A dense symmetric matrix of which some columns are to be eliminated.
#[derive(Debug, Default)]
pub struct Front {
    /// Columns to be eliminated.
    pub pivots: usize,
    /// Rows beneath them.
    pub below: usize,
    /// The lower triangle of the pivots' columns, column by column: pivots, padded, and the rows beneath, padded.
    pub panel: Vec<f64>,
    /// The lower triangle of the rest in fours of columns, each four from its first column's diagonal on; see
    /// [`Front::rest_column`].
    pub rest: Vec<f64>,
}

impl Front {
    /// Makes this zeros of another size.
    pub fn reset(&mut self, pivots: usize, below: usize) {
        (self.pivots, self.below) = (pivots, below);
        let rows = self.rows();
        for (values, count) in
            [(&mut self.panel, rows * pivots), (&mut self.rest, rest_from(padded(below), padded(below)))]
        {
            values.clear();
            values.resize(count, 0.0);
        }
    }

    /// The rows of the panel, padding included.
    pub fn rows(&self) -> usize {
        padded(self.pivots) + padded(self.below)
    }

    /// Where a column of the rest lies in it, from the first row that it has on, and which row that is.
    #[inline]
    pub fn rest_column(&self, column: usize) -> (Range<usize>, usize) {
        let (side, first) = (padded(self.below), column - column % TILE);
        let rows = side - first;
        let start = rest_from(side, first) + column % TILE * rows;
        (start..start + rows, first)
    }

    /// Puts a matrix's entries, from the diagonal on, in the pivots' columns, `columns` being the numbers of these. `places` is
    /// the row of each unknown here, or more than there are rows.
    pub fn set(&mut self, matrix: &Symmetric, columns: impl Iterator<Item = u32>, places: &[u32]) {
        let rows = self.rows();
        for (column, v) in self.panel.chunks_exact_mut(rows).zip(columns) {
            for (u, value) in matrix.row_from_diagonal(v as usize) {
                if let Some(entry) = column.get_mut(places[u] as usize) {
                    *entry = value;
                }
            }
        }
    }

    /// Adds what another front left to be eliminated. `places` is where each of the rows beneath its pivots is here,
    /// ascending, or more than there are rows.
    pub fn add(&mut self, other: &Self, places: &[usize]) {
        let (top, rows) = (padded(self.pivots), self.rows());
        for (j, &to) in places.iter().enumerate() {
            let (left, first) = other.rest_column(j);
            let left = &other.rest[left][j - first..];
            let (column, from) = match to {
                to if to < self.pivots => (&mut self.panel[to * rows..(to + 1) * rows], 0),
                to if to < rows => {
                    let (column, first) = self.rest_column(to - top);
                    (&mut self.rest[column], top + first)
                }
                // It is not among the unknowns here.
                _ => continue,
            };
            for (place, value) in places[j..].iter().zip(left) {
                if let Some(entry) = column.get_mut(place.wrapping_sub(from)) {
                    *entry += value;
                }
            }
        }
    }

    /// Replaces the panel by the factor's columns and the rest by what is left to be eliminated; false where a pivot is
    /// not positive.
    pub fn eliminate(&mut self) -> bool {
        Arch::new().dispatch(Elimination(self))
    }

    /// Solves L y = x for the pivots, `x` being one number for each row of the panel, and takes from the rows beneath what
    /// the pivots contribute there.
    #[inline(always)]
    pub fn forward<S: Simd>(&self, simd: S, x: &mut [f64]) {
        for first in (0..self.pivots).step_by(TILE) {
            solve_block!(self, forward, simd, x, first);
        }
    }

    /// Solves Lᵀ x = y for the pivots, with the solution in the rows beneath them.
    #[inline(always)]
    pub fn backward<S: Simd>(&self, simd: S, x: &mut [f64]) {
        for first in (0..self.pivots).step_by(TILE).rev() {
            solve_block!(self, backward, simd, x, first);
        }
    }

    /// [`Front::forward`] for some vectors of right-hand sides: `x` is V vectors for each row.
    #[inline(always)]
    pub fn forward_together<S: Simd, const V: usize>(&self, simd: S, x: &mut [[S::f64s; V]]) {
        for first in (0..self.pivots).step_by(TILE) {
            solve_block!(self, forward_together, simd, x, first);
        }
    }

    /// [`Front::backward`] for some vectors of right-hand sides.
    #[inline(always)]
    pub fn backward_together<S: Simd, const V: usize>(&self, simd: S, x: &mut [[S::f64s; V]]) {
        for first in (0..self.pivots).step_by(TILE).rev() {
            solve_block!(self, backward_together, simd, x, first);
        }
    }

    /// Some columns of the panel.
    #[inline(always)]
    fn block<const N: usize>(&self, first: usize) -> [&[f64]; N] {
        let rows = self.rows();
        let mut columns = [&self.panel[..0]; N];
        for (column, values) in columns.iter_mut().zip(self.panel[first * rows..].chunks_exact(rows)) {
            *column = values;
        }
        columns
    }
}

/// Solves for the pivots of some columns, the first being that of row `first`.
#[inline(always)]
fn forward<S: Simd, const N: usize>(simd: S, columns: [&[f64]; N], x: &mut [f64], first: usize) {
    let (block, below) = x[first..].split_at_mut(N);
    for j in 0..N {
        block[j] /= columns[j][first + j];
        for i in j + 1..N {
            block[i] -= columns[j][first + i] * block[j];
        }
    }
    let factors: [S::f64s; N] = std::array::from_fn(|j| simd.splat_f64s(-block[j]));
    let (vectors, rest) = S::as_mut_simd_f64s(below);
    let beneath = columns.map(|column| S::as_simd_f64s(&column[first + N..]));
    for (i, x) in vectors.iter_mut().enumerate() {
        for j in 0..N {
            *x = simd.mul_add_e_f64s(beneath[j].0[i], factors[j], *x);
        }
    }
    for (i, x) in rest.iter_mut().enumerate() {
        for j in 0..N {
            *x -= beneath[j].1[i] * block[j];
        }
    }
}

/// The same with the transposed columns.
#[inline(always)]
fn backward<S: Simd, const N: usize>(simd: S, columns: [&[f64]; N], x: &mut [f64], first: usize) {
    let (block, below) = x[first..].split_at_mut(N);
    let (vectors, rest) = S::as_simd_f64s(below);
    let beneath = columns.map(|column| S::as_simd_f64s(&column[first + N..]));
    let mut parts = [simd.splat_f64s(0.0); N];
    for (i, x) in vectors.iter().enumerate() {
        for j in 0..N {
            parts[j] = simd.mul_add_e_f64s(beneath[j].0[i], *x, parts[j]);
        }
    }
    let mut sums = parts.map(|part| simd.reduce_sum_f64s(part));
    for j in (0..N).rev() {
        for (i, x) in rest.iter().enumerate() {
            sums[j] += beneath[j].1[i] * x;
        }
        for i in j + 1..N {
            sums[j] += columns[j][first + i] * block[i];
        }
        block[j] = (block[j] - sums[j]) / columns[j][first + j];
    }
}

/// [`forward`] for some vectors of right-hand sides.
#[inline(always)]
fn forward_together<S: Simd, const N: usize, const V: usize>(
    simd: S,
    columns: [&[f64]; N],
    x: &mut [[S::f64s; V]],
    first: usize,
) {
    let (block, below) = x[first..].split_at_mut(N);
    for j in 0..N {
        block[j] = times(simd, block[j], 1.0 / columns[j][first + j]);
        for i in j + 1..N {
            block[i] = plus(simd, block[j], -columns[j][first + i], block[i]);
        }
    }
    let taken: [_; N] = std::array::from_fn(|j| block[j].map(|x| simd.neg_f64s(x)));
    let beneath = columns.map(|column| &column[first + N..][..below.len()]);
    for (i, x) in below.iter_mut().enumerate() {
        for j in 0..N {
            *x = plus(simd, taken[j], beneath[j][i], *x);
        }
    }
}

/// [`backward`] for some vectors of right-hand sides.
#[inline(always)]
fn backward_together<S: Simd, const N: usize, const V: usize>(
    simd: S,
    columns: [&[f64]; N],
    x: &mut [[S::f64s; V]],
    first: usize,
) {
    let (block, below) = x[first..].split_at_mut(N);
    let beneath = columns.map(|column| &column[first + N..][..below.len()]);
    let mut taken = [[simd.splat_f64s(0.0); V]; N];
    for (i, x) in below.iter().enumerate() {
        for j in 0..N {
            taken[j] = plus(simd, *x, -beneath[j][i], taken[j]);
        }
    }
    for j in (0..N).rev() {
        for i in j + 1..N {
            taken[j] = plus(simd, block[i], -columns[j][first + i], taken[j]);
        }
        let left = plus(simd, taken[j], 1.0, block[j]);
        block[j] = times(simd, left, 1.0 / columns[j][first + j]);
    }
}

/// x a.
#[inline(always)]
fn times<S: Simd, const V: usize>(simd: S, x: [S::f64s; V], a: f64) -> [S::f64s; V] {
    x.map(|x| simd.mul_f64s(x, simd.splat_f64s(a)))
}

/// x a + y.
#[inline(always)]
fn plus<S: Simd, const V: usize>(simd: S, x: [S::f64s; V], a: f64, y: [S::f64s; V]) -> [S::f64s; V] {
    let a = simd.splat_f64s(a);
    std::array::from_fn(|k| simd.mul_add_e_f64s(x[k], a, y[k]))
}

/// Where a four of columns begins in the rest, which has `side` rows.
fn rest_from(side: usize, column: usize) -> usize {
    side * column - column * column.saturating_sub(TILE) / 2
}

/// The elimination, with the widest vectors that the machine has.
struct Elimination<'a>(&'a mut Front);

impl WithSimd for Elimination<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        let Front { pivots, below, .. } = *self.0;
        let rows = self.0.rows();
        let Front { panel, rest, .. } = self.0;
        let (top, side) = (padded(pivots), padded(below));
        for start in (0..pivots).step_by(SLAB) {
            let end = pivots.min(start + SLAB);
            let (done, later) = panel.split_at_mut(end * rows);
            let slab = &mut done[start * rows..];
            if !eliminate_slab(simd, slab, rows, start) {
                return false;
            }
            let source = Source { values: slab, rows };
            for (columns, first) in later.chunks_mut(TILE * rows).zip((end..).step_by(TILE)) {
                subtract(simd, source, first, Target { columns, rows, first });
            }
            let mut rest = &mut rest[..];
            for first in (0..side).step_by(TILE) {
                let (columns, later) = rest.split_at_mut(TILE * (side - first));
                subtract(simd, source, top + first, Target { columns, rows: side - first, first: 0 });
                rest = later;
            }
        }
        true
    }
}

/// Eliminates at most [`SLAB`] columns whose first pivot is in row `start`.
#[inline(always)]
fn eliminate_slab<S: Simd>(simd: S, slab: &mut [f64], rows: usize, start: usize) -> bool {
    let pivots = slab.len() / rows;
    for first in (0..pivots).step_by(BLOCK) {
        let end = pivots.min(first + BLOCK);
        let (done, later) = slab.split_at_mut(end * rows);
        let block = &mut done[first * rows..];
        if !eliminate_block(simd, block, rows, start + first) {
            return false;
        }
        let source = Source { values: block, rows };
        for (columns, first) in later.chunks_mut(TILE * rows).zip((start + end..).step_by(TILE)) {
            subtract(simd, source, first, Target { columns, rows, first });
        }
    }
    true
}

/// Eliminates a block of at most [`BLOCK`] columns whose first pivot is in row `first`.
#[inline(always)]
fn eliminate_block<S: Simd>(simd: S, block: &mut [f64], rows: usize, first: usize) -> bool {
    match block.len() / rows {
        1 => eliminate_columns::<S, 1>(simd, block, rows, first),
        2 => eliminate_columns::<S, 2>(simd, block, rows, first),
        3 => eliminate_columns::<S, 3>(simd, block, rows, first),
        4 => eliminate_columns::<S, 4>(simd, block, rows, first),
        5 => eliminate_columns::<S, 5>(simd, block, rows, first),
        6 => eliminate_columns::<S, 6>(simd, block, rows, first),
        7 => eliminate_columns::<S, 7>(simd, block, rows, first),
        _ => eliminate_columns::<S, BLOCK>(simd, block, rows, first),
    }
}

/// Factors the pivots' own rows, and divides those beneath by that factor, some rows side by side.
#[inline(always)]
fn eliminate_columns<S: Simd, const N: usize>(simd: S, block: &mut [f64], rows: usize, first: usize) -> bool {
    let mut chunks = block.chunks_exact_mut(rows);
    let columns: [&mut [f64]; N] = std::array::from_fn(|_| chunks.next().unwrap_or_default());
    let Some(factor) = triangle::<N>(std::array::from_fn(|j| std::array::from_fn(|i| columns[j][first + i]))) else {
        return false;
    };
    let mut parts = columns.map(|column| column[first..].split_at_mut(N));
    parts.iter_mut().zip(&factor).for_each(|((own, _), values)| own.copy_from_slice(values));
    let mut beneath = parts.map(|(_, beneath)| S::as_mut_simd_f64s(beneath));
    for i in 0..beneath[0].0.len() {
        let values = divided(simd, std::array::from_fn(|j| beneath[j].0[i]), &factor);
        (0..N).for_each(|j| beneath[j].0[i] = values[j]);
    }
    if !beneath[0].1.is_empty() {
        let values = divided(simd, std::array::from_fn(|j| simd.partial_load_f64s(beneath[j].1)), &factor);
        (0..N).for_each(|j| simd.partial_store_f64s(beneath[j].1, values[j]));
    }
    true
}

/// Some rows of columns beneath their pivots, divided by the pivots' factor.
#[inline(always)]
fn divided<S: Simd, const N: usize>(simd: S, mut values: [S::f64s; N], factor: &[[f64; N]; N]) -> [S::f64s; N] {
    for j in 0..N {
        values[j] = simd.mul_f64s(values[j], simd.splat_f64s(1.0 / factor[j][j]));
        for k in j + 1..N {
            values[k] = simd.mul_add_e_f64s(values[j], simd.splat_f64s(-factor[j][k]), values[k]);
        }
    }
    values
}

/// The Cholesky factor of a small matrix by columns, lower triangles both; none where a pivot is not positive.
#[inline(always)]
fn triangle<const N: usize>(mut columns: [[f64; N]; N]) -> Option<[[f64; N]; N]> {
    for j in 0..N {
        let pivot = columns[j][j];
        if pivot.is_nan() || pivot <= 0.0 || pivot.is_infinite() {
            return None;
        }
        let scale = 1.0 / pivot.sqrt();
        columns[j][j..].iter_mut().for_each(|x| *x *= scale);
        for k in j + 1..N {
            for i in k..N {
                columns[k][i] -= columns[j][i] * columns[j][k];
            }
        }
    }
    Some(columns)
}

/// Columns of the factor.
#[derive(Clone, Copy)]
struct Source<'a> {
    values: &'a [f64],
    rows: usize,
}

/// Up to four columns from which something is subtracted, from row `first` on.
struct Target<'a> {
    columns: &'a mut [f64],
    rows: usize,
    first: usize,
}

/// Subtracts, from `target`, the product of the source's rows from `from` on with the first four of them.
#[inline(always)]
fn subtract<S: Simd>(simd: S, source: Source, from: usize, target: Target) {
    let Target { columns, rows, first } = target;
    let (mut row, count) = (0, rows - first);
    while row + 2 * S::F64_LANES <= count {
        let sums = products::<S, 2>(simd, source, [from + row, from]);
        for (to, sums) in columns.chunks_exact_mut(rows).zip(&sums) {
            take::<S>(simd, &mut to[first + row..], sums);
        }
        row += 2 * S::F64_LANES;
    }
    while row + S::F64_LANES <= count {
        let sums = products::<S, 1>(simd, source, [from + row, from]);
        for (to, sums) in columns.chunks_exact_mut(rows).zip(&sums) {
            take::<S>(simd, &mut to[first + row..], sums);
        }
        row += S::F64_LANES;
    }
    if row < count {
        let sums = rest_products(simd, source, from + row..from + count, from);
        for (to, sum) in columns.chunks_exact_mut(rows).zip(sums) {
            let to = &mut to[first + row..];
            simd.partial_store_f64s(to, simd.sub_f64s(simd.partial_load_f64s(to), sum));
        }
    }
}

/// The same as [`products`] for fewer rows than there are in a vector.
#[inline(always)]
fn rest_products<S: Simd>(simd: S, source: Source, rows: Range<usize>, from: usize) -> [S::f64s; TILE] {
    let mut sums = [simd.splat_f64s(0.0); TILE];
    for values in source.values.chunks_exact(source.rows) {
        let a = simd.partial_load_f64s(&values[rows.clone()]);
        let b = &values[from..from + TILE];
        for j in 0..TILE {
            sums[j] = simd.mul_add_e_f64s(a, simd.splat_f64s(b[j]), sums[j]);
        }
    }
    sums
}

/// Subtracts vectors from the beginning of a column.
#[inline(always)]
fn take<S: Simd>(simd: S, column: &mut [f64], sums: &[S::f64s]) {
    let (vectors, _) = S::as_mut_simd_f64s(column);
    for (x, sum) in vectors.iter_mut().zip(sums) {
        *x = simd.sub_f64s(*x, *sum);
    }
}

/// Σ over the columns of `source`: V vectors of its entries from row `from[0]` on by each of four from `from[1]` on.
#[inline(always)]
fn products<S: Simd, const V: usize>(simd: S, source: Source, from: [usize; 2]) -> [[S::f64s; V]; TILE] {
    let mut sums = [[simd.splat_f64s(0.0); V]; TILE];
    for values in source.values.chunks_exact(source.rows) {
        let (a, _) = S::as_simd_f64s(&values[from[0]..from[0] + V * S::F64_LANES]);
        let b = &values[from[1]..from[1] + TILE];
        for j in 0..TILE {
            let b = simd.splat_f64s(b[j]);
            for i in 0..V {
                sums[j][i] = simd.mul_add_e_f64s(a[i], b, sums[j][i]);
            }
        }
    }
    sums
}
