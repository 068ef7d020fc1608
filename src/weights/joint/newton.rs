//! Guesses which weights are zero, solves, and corrects the guess (primal-dual active sets, as in `box_problem`).
//!
//! In every row one positive weight, the pivot, is one less the others; so the sums hold by themselves, and what remains
//! is a sparse positive definite system in the others.

use super::{Columns, Piece};
use crate::linalg::cholesky::{Cholesky, Ordering, Upper};

/// Rounds of guessing, at most, and without fewer corrections than ever before.
const ROUNDS: usize = 60;
const PATIENCE: usize = 10;

/// Rounds of making forces equal further, once the guess is right.
const REFINEMENTS: usize = 3;

/// How far a weight may leave the range and still count as within.
const BOUND: f64 = 1e-14;

/// Which force counts as none: in shares of the largest, and of the diagonal of Q.
const FORCE: f64 = 1e-10;
const ROUNDING: f64 = 4e-15;

/// Larger systems are not solved; the splitting method has to do.
const MOST_UNKNOWNS: usize = 60_000;

/// No row: a handle's, or one of another piece.
const NONE: u32 = u32::MAX;

/// The unknowns of a guess.
struct Unknowns {
    /// For each vertex of the mesh, the place of its row's first unknown, or `NONE`.
    first: Vec<u32>,
    /// For each vertex of the mesh, its pivot.
    pivot: Vec<u32>,
    /// (vertex, handle), row by row.
    list: Vec<(u32, u32)>,
}

impl Unknowns {
    /// The unknowns of a row: places and handles.
    fn of(&self, v: usize) -> impl Iterator<Item = (u32, u32)> {
        let first = self.first[v];
        let row = self.list.get(first as usize..).unwrap_or(&[]);
        let same = row.iter().take_while(move |(u, _)| *u as usize == v);
        same.enumerate().map(move |(i, &(_, k))| (first + i as u32, k))
    }
}

impl Piece<'_> {
    /// Corrects the guess that lies in `weights` until it is right; false if that does not come about. The best shares on
    /// the way go to `best`.
    pub(super) fn correct(&mut self, weights: &mut Columns, best: &mut (Columns, f64)) -> bool {
        let mut free: Vec<Vec<bool>> = weights.iter().map(|c| c.iter().map(|&w| w > 0.0).collect()).collect();
        let (mut least, mut since) = (usize::MAX, 0);
        for _ in 0..ROUNDS {
            if !self.step(weights, &free) {
                return false;
            }
            let corrections = self.corrections(weights, &mut free);
            if corrections == 0 {
                self.refine(weights, &free, best);
                return true;
            }
            let mut shares = weights.clone();
            self.to_shares(&mut shares);
            self.keep(&shares, best);
            if corrections < least {
                (least, since) = (corrections, 0);
            } else if since < PATIENCE {
                since += 1;
            } else {
                break;
            }
        }
        self.to_shares(weights);
        false
    }

    /// The best weights of a guess, and the forces there; false where there are none within rounding.
    fn step(&mut self, weights: &mut Columns, free: &[Vec<bool>]) -> bool {
        let unknowns = self.unknowns(weights, free);
        if unknowns.list.len() > MOST_UNKNOWNS {
            return false;
        }
        self.settle(weights, free, &unknowns);
        self.measure(weights);
        if unknowns.list.is_empty() {
            return true;
        }
        let Ok(factor) = Cholesky::of(&self.reduced(&unknowns), Ordering::AsGiven) else { return false };
        let force = |k: u32, v: u32| self.forces[k as usize][v as usize];
        let pull = |&(v, k): &(u32, u32)| force(unknowns.pivot[v as usize], v) - force(k, v);
        let mut step: Vec<f64> = unknowns.list.iter().map(pull).collect();
        factor.solve(&mut step);
        if !step.iter().all(|d| d.is_finite()) {
            return false;
        }
        for (&(v, k), d) in unknowns.list.iter().zip(&step) {
            weights[k as usize][v as usize] += d;
        }
        self.settle(weights, free, &unknowns);
        self.measure(weights);
        true
    }

    /// Numbers the unknowns; the largest weight of a row is its pivot.
    fn unknowns(&self, weights: &Columns, free: &[Vec<bool>]) -> Unknowns {
        let n = self.quadratic.inverse_mass.len();
        let mut unknowns = Unknowns { first: vec![NONE; n], pivot: vec![0; n], list: Vec::new() };
        for &vertex in &self.open {
            let v = vertex as usize;
            let larger = |a: usize, b: usize| if weights[b][v] > weights[a][v] { b } else { a };
            let pivot = (0..weights.len()).filter(|&k| free[k][v]).reduce(larger).unwrap_or(0);
            unknowns.first[v] = unknowns.list.len() as u32;
            unknowns.pivot[v] = pivot as u32;
            let others = (0..weights.len()).filter(|&k| free[k][v] && k != pivot);
            unknowns.list.extend(others.map(|k| (vertex, k as u32)));
        }
        unknowns
    }

    /// Zeros where the guess has them, and pivots that make the sums one.
    fn settle(&self, weights: &mut Columns, free: &[Vec<bool>], unknowns: &Unknowns) {
        for &v in &self.open {
            let v = v as usize;
            let pivot = unknowns.pivot[v] as usize;
            let mut sum = 0.0;
            for k in (0..weights.len()).filter(|&k| k != pivot) {
                if !free[k][v] {
                    weights[k][v] = 0.0;
                }
                sum += weights[k][v];
            }
            weights[pivot][v] = 1.0 - sum;
        }
    }

    /// The upper triangle of the system.
    fn reduced(&self, unknowns: &Unknowns) -> Upper {
        let mut upper = Upper { starts: vec![0], rows: Vec::new(), values: Vec::new() };
        for (column, &(v, k)) in unknowns.list.iter().enumerate() {
            let pivot = unknowns.pivot[v as usize];
            for (u, q) in self.quadratic.matrix.row(v as usize).filter(|&(u, _)| unknowns.first[u] != NONE) {
                let other = unknowns.pivot[u];
                for (row, l) in unknowns.of(u).take_while(|&(row, _)| row as usize <= column) {
                    let times =
                        i32::from(k == l) - i32::from(k == other) - i32::from(l == pivot) + i32::from(pivot == other);
                    if times != 0 {
                        upper.rows.push(row);
                        upper.values.push(q * f64::from(times));
                    }
                }
            }
            upper.starts.push(upper.rows.len() as u32);
        }
        upper
    }

    /// Holds what is negative at zero and frees what a row would gain from; the number of corrections.
    fn corrections(&self, weights: &Columns, free: &mut [Vec<bool>]) -> usize {
        let scale = self.largest_force();
        let mut count = 0;
        for &v in &self.open {
            let v = v as usize;
            let tolerance = FORCE * scale + ROUNDING * self.quadratic.diagonal[v];
            let level = (0..weights.len()).filter(|&k| free[k][v]).map(|k| self.forces[k][v]);
            let level = level.fold(f64::INFINITY, f64::min);
            for k in 0..weights.len() {
                let next = match free[k][v] {
                    true => weights[k][v] >= -BOUND,
                    false => self.forces[k][v] < level - tolerance,
                };
                count += usize::from(next != free[k][v]);
                free[k][v] = next;
            }
        }
        count
    }

    /// Steps again while that helps, with the right guess.
    fn refine(&mut self, weights: &mut Columns, free: &[Vec<bool>], best: &mut (Columns, f64)) {
        for _ in 0..=REFINEMENTS {
            let before = best.1;
            let mut shares = weights.clone();
            self.to_shares(&mut shares);
            self.keep(&shares, best);
            if best.1 > 0.5 * before || best.1 <= FORCE || !self.step(weights, free) {
                return;
            }
        }
    }
}
