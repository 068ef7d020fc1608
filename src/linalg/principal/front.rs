//! Dense elimination of the leading columns of a symmetric matrix, in tiles of two vectors by four columns.

use pulp::{Arch, Simd, WithSimd};
use std::ops::Range;

/// Rows and columns are counted in fours; what is over is zero.
pub const TILE: usize = 4;

/// Columns that are eliminated before they are subtracted from the rest.
const BLOCK: usize = 2 * TILE;

/// The next multiple of [`TILE`].
pub fn padded(count: usize) -> usize {
    count.next_multiple_of(TILE)
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
    pub fn rest_column(&self, column: usize) -> (Range<usize>, usize) {
        let (side, first) = (padded(self.below), column - column % TILE);
        let rows = side - first;
        let start = rest_from(side, first) + column % TILE * rows;
        (start..start + rows, first)
    }

    /// Replaces the panel by the factor's columns and the rest by what is left to be eliminated; false where a pivot is
    /// not positive.
    pub fn eliminate(&mut self) -> bool {
        Arch::new().dispatch(Elimination(self))
    }

    /// Solves L y = x for the pivots, and takes from `below` what they contribute there.
    #[inline(always)]
    pub fn forward(&self, pivots: &mut [f64], below: &mut [f64]) {
        let top = padded(self.pivots);
        for (j, column) in self.panel.chunks_exact(self.rows()).enumerate() {
            let y = pivots[j] / column[j];
            pivots[j] = y;
            for (x, l) in pivots[j + 1..].iter_mut().zip(&column[j + 1..]) {
                *x -= l * y;
            }
            for (x, l) in below.iter_mut().zip(&column[top..]) {
                *x -= l * y;
            }
        }
    }

    /// Solves Lᵀ x = y for the pivots, with the solution in the rows `below`.
    #[inline(always)]
    pub fn backward(&self, pivots: &mut [f64], below: &[f64]) {
        let top = padded(self.pivots);
        for (j, column) in self.panel.chunks_exact(self.rows()).enumerate().rev() {
            let sum = dot(&column[top..], below) + dot(&column[j + 1..], &pivots[j + 1..]);
            pivots[j] = (pivots[j] - sum) / column[j];
        }
    }
}

/// Where a four of columns begins in the rest, which has `side` rows.
fn rest_from(side: usize, column: usize) -> usize {
    side * column - column * column.saturating_sub(TILE) / 2
}

/// The sum of products of two vectors, as far as the shorter goes; eight sums side by side.
#[inline(always)]
fn dot(a: &[f64], b: &[f64]) -> f64 {
    const SIDE: usize = 8;
    let count = a.len().min(b.len());
    let (a, b) = (&a[..count], &b[..count]);
    let mut sums = [0.0; SIDE];
    for (x, y) in a.chunks_exact(SIDE).zip(b.chunks_exact(SIDE)) {
        for i in 0..SIDE {
            sums[i] += x[i] * y[i];
        }
    }
    let mut sum = (sums[0] + sums[4]) + (sums[1] + sums[5]) + (sums[2] + sums[6]) + (sums[3] + sums[7]);
    for (x, y) in a.iter().zip(b).skip(count - count % SIDE) {
        sum += x * y;
    }
    sum
}

/// The elimination, with the widest vectors that the machine has.
struct Elimination<'a>(&'a mut Front);

impl WithSimd for Elimination<'_> {
    type Output = bool;

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) -> bool {
        let front = self.0;
        let (rows, pivots) = (front.rows(), front.pivots);
        for first in (0..pivots).step_by(BLOCK) {
            let end = pivots.min(first + BLOCK);
            let (done, later) = front.panel.split_at_mut(end * rows);
            let block = &mut done[first * rows..];
            if !eliminate_block(block, rows, first) {
                return false;
            }
            for (columns, first) in later.chunks_mut(TILE * rows).zip((end..).step_by(TILE)) {
                subtract(simd, Source { values: block, rows }, [first, first], Target { columns, rows, first });
            }
        }
        let (top, side) = (padded(pivots), padded(front.below));
        let source = Source { values: &front.panel, rows };
        let mut rest = &mut front.rest[..];
        for first in (0..side).step_by(TILE) {
            let (columns, later) = rest.split_at_mut(TILE * (side - first));
            subtract(simd, source, [top + first, top + first], Target { columns, rows: side - first, first: 0 });
            rest = later;
        }
        true
    }
}

/// Eliminates a block of columns whose first pivot is in row `first`.
#[inline(always)]
fn eliminate_block(block: &mut [f64], rows: usize, first: usize) -> bool {
    for j in 0..block.len() / rows {
        let (done, later) = block.split_at_mut((j + 1) * rows);
        let column = &mut done[j * rows..];
        let row = first + j;
        let pivot = column[row];
        if pivot.is_nan() || pivot <= 0.0 || pivot.is_infinite() {
            return false;
        }
        let scale = 1.0 / pivot.sqrt();
        for x in &mut column[row..] {
            *x *= scale;
        }
        for (k, other) in later.chunks_exact_mut(rows).enumerate() {
            let row = row + 1 + k;
            let share = column[row];
            for (x, l) in other[row..].iter_mut().zip(&column[row..]) {
                *x -= l * share;
            }
        }
    }
    true
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

/// Subtracts, from `target`, the product of the source's rows from `from[0]` on with its four rows from `from[1]` on.
#[inline(always)]
fn subtract<S: Simd>(simd: S, source: Source, from: [usize; 2], target: Target) {
    let Target { columns, rows, first } = target;
    let (mut row, count) = (0, rows - first);
    while row + 2 * S::F64_LANES <= count {
        let sums = products::<S, 2>(simd, source, [from[0] + row, from[1]]);
        for (to, sums) in columns.chunks_exact_mut(rows).zip(&sums) {
            take::<S>(simd, &mut to[first + row..], sums);
        }
        row += 2 * S::F64_LANES;
    }
    while row + S::F64_LANES <= count {
        let sums = products::<S, 1>(simd, source, [from[0] + row, from[1]]);
        for (to, sums) in columns.chunks_exact_mut(rows).zip(&sums) {
            take::<S>(simd, &mut to[first + row..], sums);
        }
        row += S::F64_LANES;
    }
    for row in row..count {
        for (j, to) in columns.chunks_exact_mut(rows).enumerate() {
            let products =
                source.values.chunks_exact(source.rows).map(|values| values[from[0] + row] * values[from[1] + j]);
            to[first + row] -= products.sum::<f64>();
        }
    }
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
