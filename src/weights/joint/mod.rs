//! Partition of unity as a constraint: all handles of a piece in one problem (Eq. 1 as printed).
//!
//! Least Σ ½ wⱼᵀ Q wⱼ where every vertex's row is a point of the simplex. From the separate weights, guesses of which
//! weights are zero are corrected until they are right (`newton`); where that runs in circles, a splitting method that
//! always converges, but slowly, brings a better guess (`splitting`). A handle has nothing to say on pieces that it is
//! not on, as in the separate form.

mod newton;
mod splitting;

use super::box_problem::{Column, State};
use super::levels::Level;
use super::quadratic::Quadratic;

/// Turns of guessing and splitting, at most.
const TURNS: usize = 4;

/// With more weights than this, the splitting method goes first: its rounds are the cheaper ones.
const MOST_DIRECT: usize = 6_000;

/// Weights with a smaller residual are good.
const GOOD: f64 = 1e-9;
/// After the first turn, so much will do.
const ENOUGH: f64 = 1e-6;

/// The joint weights: one column for each handle, from the separate ones. `places` are the handles' vertices.
pub fn solve(level: &Level, places: &[u32], separate: &[Column]) -> Vec<Column> {
    let mut columns: Vec<Column> = separate.iter().map(|c| Column { factor: None, ..c.clone() }).collect();
    let piece = |j: usize| level.surface.piece[places[j] as usize];
    for first in 0..places.len() {
        if (0..first).any(|j| piece(j) == piece(first)) {
            continue;
        }
        let here: Vec<usize> = (first..places.len()).filter(|&j| piece(j) == piece(first)).collect();
        let start = here.iter().map(|&j| separate[j].weights.clone()).collect();
        let own: Vec<u32> = here.iter().map(|&j| places[j]).collect();
        let mut piece = Piece::new(&level.quadratic, level.members_around(own[0]), &own);
        let (rows, residual) = piece.solve(start);
        for (weights, &j) in rows.into_iter().zip(&here) {
            let energy = level.quadratic.energy(piece.members, &weights);
            let state = |v: usize| match columns[j].states[v] {
                State::Fixed => State::Fixed,
                _ if weights[v] <= 0.0 => State::Low,
                _ if weights[v] >= 1.0 => State::High,
                _ => State::Free,
            };
            let states = (0..weights.len()).map(state).collect();
            columns[j] = Column { weights, states, energy, residual, factor: None };
        }
    }
    columns
}

/// Columns of weights, or forces, of the handles on a piece, each as long as the mesh has vertices.
type Columns = Vec<Vec<f64>>;

/// The problem on one piece.
struct Piece<'a> {
    quadratic: &'a Quadratic,
    /// The vertices of the piece, ascending.
    members: &'a [u32],
    /// Those of them that are no handles.
    open: Vec<u32>,
    /// Q w for each handle.
    forces: Columns,
    inner: Vec<f64>,
}

impl<'a> Piece<'a> {
    fn new(quadratic: &'a Quadratic, members: &'a [u32], handles: &[u32]) -> Self {
        let n = quadratic.inverse_mass.len();
        let open = members.iter().copied().filter(|v| !handles.contains(v)).collect();
        Self { quadratic, members, open, forces: vec![vec![0.0; n]; handles.len()], inner: vec![0.0; n] }
    }

    /// The best weights that are found, and their residual.
    fn solve(&mut self, mut weights: Columns) -> (Columns, f64) {
        self.to_shares(&mut weights);
        let mut best = (weights.clone(), self.residual(&weights));
        for turn in 0..TURNS {
            if turn > 0 || self.open.len() * weights.len() > MOST_DIRECT {
                self.split(&mut weights);
                self.to_shares(&mut weights);
                self.keep(&weights, &mut best);
            }
            let settled = self.correct(&mut weights, &mut best);
            if settled || best.1 <= if turn == 0 { GOOD } else { ENOUGH } {
                break;
            }
        }
        best
    }

    fn keep(&mut self, weights: &Columns, best: &mut (Columns, f64)) {
        let residual = self.residual(weights);
        if residual < best.1 {
            *best = (weights.clone(), residual);
        }
    }

    fn row(&self, weights: &Columns, v: u32) -> Vec<f64> {
        weights.iter().map(|column| column[v as usize]).collect()
    }

    /// Makes every row one of shares that sum to one.
    fn to_shares(&self, weights: &mut Columns) {
        for &v in &self.open {
            let mut row: Vec<f64> =
                self.row(weights, v).into_iter().map(|x| if x.is_finite() { x.max(0.0) } else { 0.0 }).collect();
            let sum: f64 = row.iter().sum();
            let even = 1.0 / row.len() as f64;
            row.iter_mut().for_each(|x| *x = if sum > 0.0 { *x / sum } else { even });
            weights.iter_mut().zip(row).for_each(|(column, x)| column[v as usize] = x);
        }
    }

    /// Computes the forces.
    fn measure(&mut self, weights: &Columns) {
        for (column, forces) in weights.iter().zip(&mut self.forces) {
            self.quadratic.gradient(self.members, column, &mut self.inner, forces);
        }
    }

    /// The largest of the forces, handles included.
    fn largest_force(&self) -> f64 {
        let of = |forces: &Vec<f64>| self.members.iter().map(|&v| forces[v as usize].abs()).fold(0.0, f64::max);
        self.forces.iter().map(of).fold(0.0, f64::max)
    }

    /// How far shares are from optimal. At an optimum the forces on a vertex's positive weights are equal, and those on
    /// its zero weights are not smaller: the largest excess of the former over the least of all, in shares of the largest
    /// force.
    fn residual(&mut self, weights: &Columns) -> f64 {
        self.measure(weights);
        let scale = self.largest_force();
        let excess = |&v: &u32| {
            let v = v as usize;
            let (mut high, mut low) = (f64::NEG_INFINITY, f64::INFINITY);
            for (column, forces) in weights.iter().zip(&self.forces) {
                low = low.min(forces[v]);
                high = if column[v] > 0.0 { high.max(forces[v]) } else { high };
            }
            high - low
        };
        let largest = self.open.iter().map(excess).fold(0.0, f64::max);
        if scale > 0.0 { largest / scale } else { 0.0 }
    }
}
