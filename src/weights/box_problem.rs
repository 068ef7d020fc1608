//! Least wᵀ Q w within bounds: one handle's weights on one piece of the mesh.
//!
//! Primal-dual active sets (M. Hintermüller, K. Ito, K. Kunisch. *The primal-dual active set strategy as a semismooth
//! Newton method*. SIAM J. Optimization 13(3), 2002): solve with a guess of which weights are at a bound, correct the
//! guess where a weight leaves the range or a bound pulls the wrong way, until nothing changes. The guess changes in many
//! places at once, so a few rounds suffice; but it can run in circles. Then a monotone method takes over: from weights
//! within bounds towards the optimum of the free ones as far as bounds allow, which never raises the energy.

use super::quadratic::Quadratic;
use crate::linalg::cholesky::{Cholesky, Ordering};

/// Rounds of guessing.
const ROUNDS: usize = 60;

/// Rounds of the monotone method.
const MONOTONE_ROUNDS: usize = 400;

/// How far a weight may leave the range and still count as within.
const BOUND: f64 = 1e-11;

/// Which force counts as none, in shares of the largest.
const FORCE: f64 = 1e-11;

/// Which force counts as rounding, in shares of the diagonal of Q.
const ROUNDING: f64 = 4e-15;

/// What holds a weight.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// Nothing.
    Free,
    /// The lower bound 0.
    Low,
    /// The upper bound 1.
    High,
    /// A handle, or another piece.
    Fixed,
}

/// One handle's weights, before rows are divided by their sums.
#[derive(Clone, Debug)]
pub struct Column {
    /// The weights, one for each welded vertex.
    pub weights: Vec<f64>,
    /// What holds them.
    pub states: Vec<State>,
    /// wᵀ Q w.
    pub energy: f64,
    /// See [`super::Weights::kkt_residual`].
    pub residual: f64,
}

/// Solves for one handle: weights are fixed where `start` says so, and elsewhere its states are the first guess.
pub fn solve(quadratic: &Quadratic, members: &[u32], mut start: Column) -> Column {
    if !start.weights.iter().any(|&w| w > 0.0) {
        return rest(start);
    }
    let mut problem = Problem { quadratic, members, place: vec![u32::MAX; start.weights.len()], gradient: Vec::new() };
    for _ in 0..ROUNDS {
        if !problem.solve_free(&mut start) {
            break;
        }
        if !problem.correct(&mut start) {
            return problem.finish(start);
        }
    }
    problem.descend(&mut start);
    problem.finish(start)
}

/// Nothing to do: all weights are zero.
fn rest(mut column: Column) -> Column {
    column.weights.iter_mut().for_each(|w| *w = 0.0);
    column.states.iter_mut().filter(|s| **s != State::Fixed).for_each(|s| *s = State::Low);
    Column { energy: 0.0, residual: 0.0, ..column }
}

struct Problem<'a> {
    quadratic: &'a Quadratic,
    members: &'a [u32],
    place: Vec<u32>,
    gradient: Vec<f64>,
}

impl Problem<'_> {
    /// Puts bound weights on their bounds and solves for the free ones; false where that cannot be done.
    fn solve_free(&mut self, column: &mut Column) -> bool {
        for &v in self.members {
            match column.states[v as usize] {
                State::Free | State::Low => column.weights[v as usize] = 0.0,
                State::High => column.weights[v as usize] = 1.0,
                State::Fixed => {}
            }
        }
        let is_free = |v: &&u32| column.states[**v as usize] == State::Free;
        let free: Vec<u32> = self.members.iter().filter(is_free).copied().collect();
        let Some(step) = self.newton(&free, &column.weights) else { return false };
        free.iter().zip(&step).for_each(|(&v, &x)| column.weights[v as usize] = x);
        self.gradient = self.quadratic.gradient(&column.weights);
        true
    }

    /// The change of the free weights that makes their forces vanish.
    fn newton(&mut self, free: &[u32], weights: &[f64]) -> Option<Vec<f64>> {
        free.iter().enumerate().for_each(|(i, &v)| self.place[v as usize] = i as u32);
        let lower = self.quadratic.matrix.lower(free, &self.place);
        free.iter().for_each(|&v| self.place[v as usize] = u32::MAX);
        let factor = Cholesky::of(&lower, Ordering::MinimumDegree).ok()?;
        let forces = self.quadratic.gradient(weights);
        let mut step: Vec<f64> = free.iter().map(|&v| -forces[v as usize]).collect();
        factor.solve(&mut step);
        step.iter().all(|x| x.is_finite()).then_some(step)
    }

    /// Frees what is held the wrong way and holds what has left the range; false if there is nothing to correct.
    fn correct(&self, column: &mut Column) -> bool {
        let scale = self.largest_force();
        let mut changed = false;
        for &v in self.members {
            let v = v as usize;
            let (w, force) = (column.weights[v], self.gradient[v]);
            let tolerance = self.tolerance(v, scale);
            let next = match column.states[v] {
                State::Free if w < -BOUND => State::Low,
                State::Free if w > 1.0 + BOUND => State::High,
                State::Low if force < -tolerance => State::Free,
                State::High if force > tolerance => State::Free,
                same => same,
            };
            changed |= next != column.states[v];
            column.states[v] = next;
        }
        changed
    }

    fn tolerance(&self, v: usize, scale: f64) -> f64 {
        FORCE * scale + ROUNDING * self.quadratic.matrix.diagonal(v)
    }

    fn largest_force(&self) -> f64 {
        self.members.iter().map(|&v| self.gradient[v as usize].abs()).fold(0.0, f64::max)
    }

    /// The monotone method.
    fn descend(&mut self, column: &mut Column) {
        clamp(column);
        let mut best = self.quadratic.energy(&column.weights);
        for _ in 0..MONOTONE_ROUNDS {
            self.gradient = self.quadratic.gradient(&column.weights);
            self.release(column);
            let before = column.weights.clone();
            if !self.to_the_bounds(column) {
                return;
            }
            let energy = self.quadratic.energy(&column.weights);
            if energy >= best {
                if energy > best {
                    column.weights = before;
                }
                return;
            }
            best = energy;
        }
    }

    /// What is on a bound is held there if its force pulls outwards, else free.
    fn release(&self, column: &mut Column) {
        let scale = self.largest_force();
        for &v in self.members {
            let v = v as usize;
            let (w, force, tolerance) = (column.weights[v], self.gradient[v], self.tolerance(v, scale));
            column.states[v] = match column.states[v] {
                State::Fixed => State::Fixed,
                _ if w <= 0.0 && force >= -tolerance => State::Low,
                _ if w >= 1.0 && force <= tolerance => State::High,
                _ => State::Free,
            };
        }
    }

    /// Goes to the optimum of the free weights; what meets a bound on the way is held there, and the rest goes on.
    fn to_the_bounds(&mut self, column: &mut Column) -> bool {
        loop {
            let is_free = |v: &&u32| column.states[**v as usize] == State::Free;
            let free: Vec<u32> = self.members.iter().filter(is_free).copied().collect();
            let Some(step) = self.newton(&free, &column.weights) else { return false };
            let room = |w: f64, d: f64| match w + d {
                to if to < 0.0 => w / -d,
                to if to > 1.0 => (1.0 - w) / d,
                _ => f64::INFINITY,
            };
            let weights = &mut column.weights;
            let limit = free.iter().zip(&step).map(|(&v, &d)| room(weights[v as usize], d)).fold(1.0, f64::min);
            let mut blocked = false;
            for (&v, &d) in free.iter().zip(&step) {
                let v = v as usize;
                if limit < 1.0 && room(weights[v], d) <= limit {
                    column.states[v] = if d > 0.0 { State::High } else { State::Low };
                    weights[v] = if d > 0.0 { 1.0 } else { 0.0 };
                    blocked = true;
                } else {
                    weights[v] = (weights[v] + limit * d).clamp(0.0, 1.0);
                }
            }
            if !blocked {
                return true;
            }
        }
    }

    /// Weights within bounds, their energy and residual.
    fn finish(&mut self, mut column: Column) -> Column {
        clamp(&mut column);
        self.gradient = self.quadratic.gradient(&column.weights);
        let scale = self.largest_force();
        let wrong = |&v: &u32| {
            let (w, force) = (column.weights[v as usize], self.gradient[v as usize]);
            match column.states[v as usize] {
                State::Fixed => 0.0,
                _ if w <= 0.0 => (-force).max(0.0),
                _ if w >= 1.0 => force.max(0.0),
                _ => force.abs(),
            }
        };
        let largest = self.members.iter().map(wrong).fold(0.0, f64::max);
        let residual = if scale > 0.0 { largest / scale } else { 0.0 };
        Column { energy: self.quadratic.energy(&column.weights), residual, ..column }
    }
}

fn clamp(column: &mut Column) {
    for (w, state) in column.weights.iter_mut().zip(&column.states) {
        *w = match state {
            State::Low => 0.0,
            State::High => 1.0,
            State::Fixed => *w,
            State::Free if w.is_finite() => w.clamp(0.0, 1.0),
            State::Free => 0.0,
        };
    }
}
