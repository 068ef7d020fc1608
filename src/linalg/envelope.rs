//! Cholesky in an envelope: for matrices whose rows begin near the diagonal, as those of a banded order do.
//!
//! Alan George, Joseph W. H. Liu. *Computer Solution of Large Sparse Positive Definite Systems*. Prentice-Hall, 1981,
//! chapter 4. Rows are kept in fours that begin at one column, so that a factor consists of products of 4 × 4 blocks.

/// A symmetric positive definite matrix by its lower triangle, or its factor.
#[derive(Default)]
pub struct Envelope {
    /// For each four rows: the column at which they begin, a multiple of four.
    begin: Vec<usize>,
    /// For each four rows: where their columns begin in `columns`, and the end.
    at: Vec<usize>,
    /// What stands in one column of four rows.
    columns: Vec<[f64; 4]>,
    /// How many fours are factored.
    factored: usize,
}

/// Four columns of four rows.
type Block = [[f64; 4]; 4];

/// A pivot below this share of the diagonal counts as none.
const NO_PIVOT: f64 = 1e-13;

impl Envelope {
    /// Makes room for a matrix whose rows begin at the given columns, which are on the diagonal or left of it. The `same`
    /// first rows are those of the matrix that was factored last, and stay factored: entries are to be set from the row
    /// on that is returned, and are 0 until then.
    pub fn reset(&mut self, first: &[usize], same: usize) -> usize {
        self.factored = (same / 4).min(self.factored);
        self.begin.truncate(self.factored);
        self.at.truncate(self.factored + 1);
        if self.at.is_empty() {
            self.at.push(0);
        }
        for (row, &first) in first.iter().enumerate().skip(4 * self.factored) {
            let first = first / 4 * 4;
            if row % 4 == 0 {
                self.begin.push(first);
            }
            let begin = &mut self.begin[row / 4];
            *begin = first.min(*begin);
        }
        let mut end = self.at.last().copied().unwrap_or(0);
        self.columns.truncate(end);
        for (four, begin) in self.begin.iter().enumerate().skip(self.factored) {
            end += 4 * four + 4 - begin;
            self.at.push(end);
        }
        self.columns.resize(end, [0.0; 4]);
        // Rows that only make up the last four.
        (first.len()..4 * self.begin.len()).for_each(|row| self.set(row, row, 1.0));
        4 * self.factored
    }

    /// Sets an entry of the lower triangle within the envelope.
    pub fn set(&mut self, row: usize, column: usize, value: f64) {
        let four = row / 4;
        self.columns[self.at[four] + column - self.begin[four]][row % 4] = value;
    }

    /// Puts the factor in the matrix' place, its diagonal inverted; what has no pivot becomes 0, and so do solutions there.
    pub fn factor(&mut self) {
        for (four, &begin) in self.begin.iter().enumerate().skip(self.factored) {
            let (above, own) = self.columns.split_at_mut(self.at[four]);
            let own = &mut own[..4 * four + 4 - begin];
            for before in begin / 4..four {
                let from = begin.max(self.begin[before]);
                let other = &above[self.at[before] + from - self.begin[before]..self.at[before + 1]];
                let Some((left, diagonal)) = other.split_last_chunk() else { continue };
                let (done, rest) = own[from - begin..].split_at_mut(left.len());
                let Some((columns, _)) = rest.split_first_chunk_mut() else { continue };
                divide(columns, &product(done, left), diagonal);
            }
            let Some((done, diagonal)) = own.split_last_chunk_mut() else { continue };
            factor_diagonal(diagonal, &product(done, done));
        }
        self.factored = self.begin.len();
    }

    /// Solves with the factor, in place.
    pub fn solve(&self, x: &mut Vec<f64>) {
        let rows = x.len();
        x.resize(4 * self.begin.len(), 0.0);
        for (four, &begin) in self.begin.iter().enumerate() {
            let (left, diagonal) = self.four(four);
            let (known, own) = x[begin..4 * four + 4].split_at_mut(left.len());
            let mut sum = [0.0; 4];
            for (l, x) in left.iter().zip(known) {
                (0..4).for_each(|r| sum[r] += l[r] * *x);
            }
            for s in 0..4 {
                own[s] = (own[s] - sum[s]) * diagonal[s][s];
                (s + 1..4).for_each(|r| sum[r] += diagonal[s][r] * own[s]);
            }
        }
        for (four, &begin) in self.begin.iter().enumerate().rev() {
            let (left, diagonal) = self.four(four);
            let (rest, own) = x[begin..4 * four + 4].split_at_mut(left.len());
            for s in (0..4).rev() {
                let known: f64 = (s + 1..4).map(|r| diagonal[s][r] * own[r]).sum();
                own[s] = (own[s] - known) * diagonal[s][s];
            }
            for (l, x) in left.iter().zip(rest) {
                *x -= (0..4).map(|r| l[r] * own[r]).sum::<f64>();
            }
        }
        x.truncate(rows);
    }

    /// Four rows: what is left of the diagonal block, and the block.
    fn four(&self, four: usize) -> (&[[f64; 4]], &[[f64; 4]]) {
        let columns = &self.columns[self.at[four]..self.at[four + 1]];
        columns.split_at(columns.len() - 4)
    }
}

/// Σ aᵀ b over columns: `[s][r]` belongs to row r of `a` and row s of `b`.
fn product(a: &[[f64; 4]], b: &[[f64; 4]]) -> Block {
    let mut sum = [[0.0; 4]; 4];
    for (a, b) in a.iter().zip(b) {
        for s in 0..4 {
            for r in 0..4 {
                sum[s][r] += a[r] * b[s];
            }
        }
    }
    sum
}

/// The next four columns of four rows: less `sum`, and divided by the block of the factor on the diagonal.
fn divide(columns: &mut Block, sum: &Block, diagonal: &Block) {
    for s in 0..4 {
        let mut column = columns[s];
        (0..4).for_each(|r| column[r] -= sum[s][r]);
        for t in 0..s {
            (0..4).for_each(|r| column[r] -= columns[t][r] * diagonal[t][s]);
        }
        columns[s] = column.map(|x| x * diagonal[s][s]);
    }
}

/// The block of the factor on the diagonal.
fn factor_diagonal(block: &mut Block, sum: &Block) {
    for s in 0..4 {
        let whole = block[s][s];
        for r in s..4 {
            let known: f64 = (0..s).map(|t| block[t][r] * block[t][s]).sum();
            block[s][r] -= sum[s][r] + known;
        }
        let pivot = block[s][s];
        let inverse = if pivot > NO_PIVOT * whole { 1.0 / pivot.sqrt() } else { 0.0 };
        (s + 1..4).for_each(|r| block[s][r] *= inverse);
        block[s][s] = inverse;
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// A matrix of rows that begin at the given columns, by its entries.
    type Entries = Vec<Vec<f64>>;

    fn matrix(rows: usize) -> impl Strategy<Value = (Vec<usize>, Entries)> {
        let first: Vec<_> = (0..rows).map(|row| row.saturating_sub(9)..=row).collect();
        (first, prop::collection::vec(prop::collection::vec(-1.0..1.0f64, rows), rows))
    }

    fn filled(envelope: &mut Envelope, first: &[usize], entries: &Entries, same: usize) {
        for row in envelope.reset(first, same)..first.len() {
            (first[row]..row).for_each(|column| envelope.set(row, column, entries[row][column]));
            envelope.set(row, row, 20.0);
        }
        envelope.factor();
    }

    fn is_solved(envelope: &Envelope, first: &[usize], entries: &Entries) -> bool {
        let n = first.len();
        let wanted: Vec<f64> = (0..n).map(|i| 1.0 + i as f64).collect();
        let mut b: Vec<f64> = wanted.iter().map(|x| 20.0 * x).collect();
        for row in 0..n {
            for column in first[row]..row {
                b[row] += entries[row][column] * wanted[column];
                b[column] += entries[row][column] * wanted[row];
            }
        }
        envelope.solve(&mut b);
        b.len() == n && b.iter().zip(&wanted).all(|(found, wanted)| (found - wanted).abs() < 1e-9)
    }

    proptest! {
        #[test]
        fn solves_what_it_factored((first, entries) in (1..30usize).prop_flat_map(matrix)) {
            let mut envelope = Envelope::default();
            filled(&mut envelope, &first, &entries, 0);
            prop_assert!(is_solved(&envelope, &first, &entries));
        }

        #[test]
        fn rows_that_stay_need_no_second_factor(
            ((first, entries), (other_first, other)) in (matrix(23), matrix(30)),
            same in 0..=23usize,
        ) {
            let mut envelope = Envelope::default();
            filled(&mut envelope, &first, &entries, 0);
            let first = [&first[..same], &other_first[same..]].concat();
            let entries = [&entries[..same], &other[same..]].concat();
            filled(&mut envelope, &first, &entries, same);
            prop_assert!(is_solved(&envelope, &first, &entries));
        }
    }

    #[test]
    fn rows_without_a_pivot_are_answered_with_0() {
        let mut envelope = Envelope::default();
        envelope.reset(&[0, 0], 0);
        envelope.set(0, 0, 4.0);
        envelope.factor();
        let mut x = vec![2.0, 5.0];
        envelope.solve(&mut x);
        assert_eq!(x, [0.5, 0.0]);
        Envelope::default().solve(&mut Vec::new());
    }
}
