//! Symmetric sparse matrices.

use super::cholesky::Upper;
use std::ops::Range;

/// A symmetric sparse matrix, both triangles, by rows.
#[derive(Debug)]
pub struct Symmetric {
    starts: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<f64>,
    /// Where in each row the entries from the diagonal on begin.
    diagonals: Vec<u32>,
}

impl Symmetric {
    /// From `starts`, n + 1 places in `columns` and `values` where each row starts, and their length; column numbers rise
    /// within a row.
    pub fn new(starts: Vec<u32>, columns: Vec<u32>, values: Vec<f64>) -> Self {
        let left = |(row, range): (usize, &[u32])| {
            let own = &columns[range[0] as usize..range[1] as usize];
            range[0] + own.partition_point(|&column| (column as usize) < row) as u32
        };
        let diagonals = starts.windows(2).enumerate().map(left).collect();
        Self { starts, columns, values, diagonals }
    }

    /// From one triangle, with the unknowns in another order: `places` is where each goes.
    pub fn permuted(upper: &Upper, places: &[u32]) -> Self {
        let n = places.len();
        let mut starts = vec![0; n + 1];
        let entries = || {
            let column = |c: usize| upper.starts[c] as usize..upper.starts[c + 1] as usize;
            (0..n).flat_map(move |c| column(c).map(move |at| (places[c], places[upper.rows[at] as usize], at)))
        };
        let mirrored =
            |(a, b, at): (u32, u32, usize)| [(a, b, at), (b, a, at)].into_iter().take(1 + usize::from(a != b));
        entries().flat_map(mirrored).for_each(|(row, _, _)| starts[row as usize + 1] += 1);
        (0..n).for_each(|row| starts[row + 1] += starts[row]);
        let count = starts[n] as usize;
        let place = |next: &mut [u32], row: u32| {
            next[row as usize] += 1;
            next[row as usize] as usize - 1
        };
        // Put into rows twice: what is taken row by row the second time comes to each of them in order.
        let (mut next, mut loose) = (starts.clone(), vec![(0, 0); count]);
        for (row, column, at) in entries().flat_map(mirrored) {
            loose[place(&mut next, row)] = (column, at);
        }
        let (mut next, mut columns, mut values) = (starts.clone(), vec![0; count], vec![0.0; count]);
        for row in 0..n as u32 {
            for &(column, at) in &loose[starts[row as usize] as usize..starts[row as usize + 1] as usize] {
                let to = place(&mut next, column);
                (columns[to], values[to]) = (row, upper.values[at]);
            }
        }
        Self::new(starts, columns, values)
    }

    /// The entries of a row: column numbers, rising, and values.
    #[inline]
    pub fn row(&self, row: usize) -> impl Iterator<Item = (usize, f64)> {
        self.entries(self.starts[row]..self.starts[row + 1])
    }

    /// The entries of a row from the diagonal on.
    #[inline]
    pub fn row_from_diagonal(&self, row: usize) -> impl Iterator<Item = (usize, f64)> {
        self.entries(self.diagonals[row]..self.starts[row + 1])
    }

    #[inline]
    fn entries(&self, range: Range<u32>) -> impl Iterator<Item = (usize, f64)> {
        let range = range.start as usize..range.end as usize;
        self.columns[range.clone()].iter().map(|&c| c as usize).zip(self.values[range].iter().copied())
    }

    /// The number of rows.
    pub fn size(&self) -> usize {
        self.starts.len() - 1
    }

    /// The product of a row with a vector.
    #[inline]
    pub fn times(&self, row: usize, vector: &[f64]) -> f64 {
        self.row(row).map(|(column, value)| value * vector[column]).sum()
    }

    /// The entry of a row on the diagonal.
    pub fn diagonal(&self, row: usize) -> f64 {
        self.row(row).find(|&(column, _)| column == row).map_or(0.0, |(_, value)| value)
    }

    /// The upper triangle of the rows and columns listed in `members`, ascending; `place` is each one's place in that list, and
    /// `u32::MAX` for those not in it.
    pub fn upper(&self, members: &[u32], place: &[u32]) -> Upper {
        let mut upper = Upper { starts: vec![0], rows: Vec::new(), values: Vec::new() };
        for (column, &v) in members.iter().enumerate() {
            for (u, value) in self.row(v as usize) {
                if place[u] as usize <= column {
                    upper.rows.push(place[u]);
                    upper.values.push(value);
                }
            }
            upper.starts.push(upper.rows.len() as u32);
        }
        upper
    }
}
