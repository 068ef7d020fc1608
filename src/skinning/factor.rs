//! Cholesky factor of a small dense symmetric matrix.
//!
//! Gene H. Golub, Charles F. Van Loan. Matrix Computations, 4th edition, §4.2.

/// Pivots below this share of the largest diagonal entry count as 0: their unknowns stay 0.
const FLAT: f64 = 1e-14;

/// `L Lᵀ = A`, row-major, for a positive semi-definite A. Directions in which A is 0 are answered with 0.
pub struct Factor {
    n: usize,
    lower: Vec<f64>,
}

impl Factor {
    /// Factors the n × n matrix whose lower triangle is in the row-major `a`.
    pub fn new(mut a: Vec<f64>, n: usize) -> Self {
        let flat = FLAT * (0..n).map(|i| a[i * n + i]).fold(0.0, f64::max);
        for j in 0..n {
            let (above, row) = a.split_at_mut(j * n);
            let row = &mut row[..=j];
            for k in 0..j {
                let other = &above[k * n..=k * n + k];
                let pivot = other[k];
                let sum: f64 = row[..k].iter().zip(other).map(|(x, y)| x * y).sum();
                row[k] = if pivot > 0.0 { (row[k] - sum) / pivot } else { 0.0 };
            }
            let left = row[j] - row[..j].iter().map(|x| x * x).sum::<f64>();
            row[j] = if left > flat { left.sqrt() } else { 0.0 };
        }
        Self { n, lower: a }
    }

    /// Solves `A x = b` for N right-hand sides at once, in place.
    pub fn solve<const N: usize>(&self, b: &mut [[f64; N]]) {
        let n = self.n;
        for i in 0..n {
            let row = &self.lower[i * n..=i * n + i];
            let mut x = b[i];
            for (l, y) in row[..i].iter().zip(b.iter()) {
                (0..N).for_each(|c| x[c] -= l * y[c]);
            }
            b[i] = x.map(|x| if row[i] > 0.0 { x / row[i] } else { 0.0 });
        }
        for i in (0..n).rev() {
            let row = &self.lower[i * n..=i * n + i];
            let x = b[i].map(|x| if row[i] > 0.0 { x / row[i] } else { 0.0 });
            b[i] = x;
            for (l, y) in row[..i].iter().zip(b.iter_mut()) {
                (0..N).for_each(|c| y[c] -= l * x[c]);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn solves_what_it_factored(m in prop::collection::vec(-1.0..1.0f64, 49), x in prop::collection::vec(-1.0..1.0f64, 21)) {
            let n = 7;
            let entry = |i: usize, j: usize| (0..n).map(|k| m[i * n + k] * m[j * n + k]).sum::<f64>() + f64::from(i == j);
            let a: Vec<f64> = (0..n * n).map(|e| entry(e / n, e % n)).collect();
            let wanted: Vec<[f64; 3]> = x.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
            let times = |i: usize, c: usize| (0..n).map(|j| a[i * n + j] * wanted[j][c]).sum::<f64>();
            let mut b: Vec<[f64; 3]> = (0..n).map(|i| [times(i, 0), times(i, 1), times(i, 2)]).collect();
            Factor::new(a.clone(), n).solve(&mut b);
            for (found, wanted) in b.iter().flatten().zip(wanted.iter().flatten()) {
                prop_assert!((found - wanted).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn directions_of_no_weight_are_answered_with_0() {
        let mut b = [[2.0; 3], [5.0; 3]];
        Factor::new(vec![4.0, 0.0, 0.0, 0.0], 2).solve(&mut b);
        assert_eq!(b, [[0.5; 3], [0.0; 3]]);
    }
}
