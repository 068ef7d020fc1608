//! A splitting method for a guess: weights without bounds and shares that follow each other.
//!
//! Alternating directions with over-relaxation and balanced residuals (S. Boyd, N. Parikh, E. Chu, B. Peleato, J.
//! Eckstein. *Distributed optimization and statistical learning via the alternating direction method of multipliers*.
//! Foundations and Trends in Machine Learning 3(1), 2011, §3.4, §4.2). One factor of Q + ρ diag Q serves all handles.

use super::{Columns, Piece};
use crate::linalg::cholesky::{Cholesky, Ordering, Upper};

/// Rounds a call, and how many of them pass between looks at the balance.
const ROUNDS: usize = 300;
const LOOK: usize = 30;

const RELAXATION: f64 = 1.6;

/// The first penalty, in shares of the diagonal of Q.
const PENALTY: f64 = 1e-2;
/// The penalty is changed if it is out of balance by more than this.
const BALANCE: f64 = 3.0;

impl Piece<'_> {
    /// Moves shares towards the optimum.
    pub(super) fn split(&mut self, shares: &mut Columns) {
        let (m, count) = (self.open.len(), shares.len());
        if m == 0 {
            return;
        }
        let pull = self.pull_of_handles(shares);
        // Local copies, open vertices only, handle by handle.
        let mut z: Vec<f64> = shares.iter().flat_map(|c| self.open.iter().map(|&v| c[v as usize])).collect();
        let mut dual = vec![0.0; z.len()];
        let diagonal: Vec<f64> = self.open.iter().map(|&v| self.quadratic.diagonal[v as usize]).collect();
        let mut penalty = PENALTY;
        let Some(mut factor) = self.penalised(penalty) else { return };
        for round in 0..ROUNDS {
            let at = |i: usize| penalty * diagonal[i % m] * (z[i] - dual[i]) + pull[i];
            let mut x: Vec<f64> = (0..z.len()).map(at).collect();
            factor.solve(&mut x);
            if !x.iter().all(|x| x.is_finite()) {
                return;
            }
            let before = z.clone();
            let relaxed: Vec<f64> = x.iter().zip(&z).map(|(x, z)| RELAXATION * x + (1.0 - RELAXATION) * z).collect();
            for i in 0..m {
                let mut row: Vec<f64> = (0..count).map(|k| relaxed[k * m + i] + dual[k * m + i]).collect();
                to_simplex(&mut row);
                row.iter().enumerate().for_each(|(k, &share)| z[k * m + i] = share);
            }
            dual.iter_mut().zip(relaxed.iter().zip(&z)).for_each(|(u, (x, z))| *u += x - z);
            if round % LOOK == LOOK - 1 {
                let size = |a: &[f64], b: &[f64]| {
                    let at = |(i, (a, b)): (usize, (&f64, &f64))| diagonal[i % m] * (a - b).powi(2);
                    a.iter().zip(b).enumerate().map(at).sum::<f64>().sqrt()
                };
                let ratio = size(&x, &z) / (size(&z, &before) * penalty.sqrt()).max(f64::MIN_POSITIVE);
                if ratio.is_finite() && !(1.0 / BALANCE..BALANCE).contains(&ratio) {
                    let change = ratio.sqrt().clamp(0.2, 5.0);
                    let Some(other) = self.penalised(penalty * change) else { break };
                    (penalty, factor) = (penalty * change, other);
                    dual.iter_mut().for_each(|u| *u /= change);
                }
            }
        }
        for (column, local) in shares.iter_mut().zip(z.chunks_exact(m)) {
            self.open.iter().zip(local).for_each(|(&v, &share)| column[v as usize] = share);
        }
    }

    /// −Q times the handles' fixed rows, at the open vertices, handle by handle.
    fn pull_of_handles(&mut self, shares: &Columns) -> Vec<f64> {
        let mut only = shares.clone();
        only.iter_mut().for_each(|column| self.open.iter().for_each(|&v| column[v as usize] = 0.0));
        self.measure(&only);
        self.forces.iter().flat_map(|forces| self.open.iter().map(|&v| -forces[v as usize])).collect()
    }

    /// A factor of Q + `penalty` diag Q on the open vertices.
    fn penalised(&self, penalty: f64) -> Option<Cholesky> {
        let mut place = vec![u32::MAX; self.quadratic.inverse_mass.len()];
        self.open.iter().enumerate().for_each(|(i, &v)| place[v as usize] = i as u32);
        let mut upper: Upper = self.quadratic.matrix.upper(&self.open, &place);
        for column in 0..self.open.len() {
            // Rows rise: the last of a column is the diagonal.
            let last = upper.starts[column + 1] as usize - 1;
            upper.values[last] *= 1.0 + penalty;
        }
        Cholesky::of(&upper, Ordering::AsGiven).ok()
    }
}

/// The nearest point whose coordinates are shares: not negative, summing to one. (J. Duchi, S. Shalev-Shwartz, Y. Singer,
/// T. Chandra. *Efficient projections onto the ℓ1-ball for learning in high dimensions*. ICML 2008.)
fn to_simplex(row: &mut [f64]) {
    let mut sorted = row.to_vec();
    sorted.sort_unstable_by(|a, b| b.total_cmp(a));
    let (mut sum, mut shift) = (0.0, 0.0);
    for (i, &x) in sorted.iter().enumerate() {
        sum += x;
        let excess = (sum - 1.0) / (i + 1) as f64;
        if x <= excess {
            break;
        }
        shift = excess;
    }
    row.iter_mut().for_each(|x| *x = (*x - shift).max(0.0));
}

#[cfg(test)]
mod tests {
    use super::to_simplex;

    #[test]
    fn the_nearest_shares() {
        for (row, expected) in [
            ([0.2, 0.3, 0.5], [0.2, 0.3, 0.5]),
            ([2.0, 0.0, -1.0], [1.0, 0.0, 0.0]),
            ([0.5, 0.5, -3.0], [0.5, 0.5, 0.0]),
            ([0.0, 0.0, 0.0], [1.0 / 3.0; 3]),
            ([0.9, 0.5, 0.1], [0.7, 0.3, 0.0]),
        ] {
            let mut shares = row;
            to_simplex(&mut shares);
            assert!(shares.iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-15), "{row:?}: {shares:?}");
        }
    }
}
