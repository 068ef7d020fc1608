//! Least wᵀ Q w within bounds: one handle's weights on one piece of the mesh.
//!
//! Primal-dual active sets (M. Hintermüller, K. Ito, K. Kunisch. *The primal-dual active set strategy as a semismooth
//! Newton method*. SIAM J. Optimization 13(3), 2002): solve with a guess of which weights are at a bound, correct the
//! guess where a weight leaves the range or a bound pulls the wrong way, until nothing changes. The guess changes in many
//! places at once, so a few rounds suffice; but it can run in circles. When the number of corrections has not fallen for
//! some rounds, a monotone method takes over (`descent`).

use super::factor::Solver;
use super::quadratic::Quadratic;
use super::{descent, fronts};
use crate::linalg::principal::Principal;
use serde::{Deserialize, Serialize};

/// Rounds of guessing, at most, and without fewer corrections than ever before.
const ROUNDS: usize = 250;
const PATIENCE: usize = 40;

/// Rounds of making forces on free weights vanish further.
const REFINEMENTS: usize = 3;

/// How far a weight may leave the range and still count as within.
const BOUND: f64 = 1e-14;

/// Which force counts as none, in shares of the largest: a guess with no more than that against its bounds is right.
const FORCE: f64 = 9e-7;

/// The same on meshes of at most so many vertices, where rounding allows it and rounds cost nothing.
const SMALL: usize = 300;
const FORCE_IF_SMALL: f64 = 1e-11;

/// The same where a first guess is all that is wanted.
const FORCE_OF_ESTIMATE: f64 = 1e-3;

/// While a guess is wrong, bounds are given up from this share of the force that counts as none: what is near the limit
/// would be wrong in the next round.
const GIVEN_UP: f64 = 0.4;

/// No more than this share of it may come from putting a free weight that has left the range back.
const PUT_BACK: f64 = 0.1;

/// Which force counts as rounding, in shares of the diagonal of Q.
const ROUNDING: f64 = 4e-15;

/// Factors with more entries are not kept.
const KEPT_ENTRIES: usize = 500_000;

/// What holds a weight.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
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

impl State {
    /// The bound at which a weight is held, if it is.
    pub fn bound(self) -> Option<f64> {
        match self {
            Self::Low => Some(0.0),
            Self::High => Some(1.0),
            Self::Free | Self::Fixed => None,
        }
    }
}

/// One handle's weights, before rows are divided by their sums.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Column {
    /// The weights, one for each welded vertex.
    pub weights: Vec<f64>,
    /// What holds them.
    pub states: Vec<State>,
    /// wᵀ Q w.
    pub energy: f64,
    /// See [`super::Weights::kkt_residual`].
    pub residual: f64,
    /// The last factor, unless it is too large to keep or nothing is likely to be updated; it is not sent.
    #[serde(skip)]
    pub factor: Option<Principal>,
}

/// Solves for one handle: weights are fixed where `start` says so, and elsewhere its states are the first guess.
///
/// `members` are the vertices of the piece, ascending; there is a weight at least that is fixed and not zero.
pub fn solve(quadratic: &Quadratic, members: &[u32], mut start: Column) -> Column {
    let mut problem = Problem::new(quadratic, members, start.factor.take());
    if !problem.guess(&mut start) {
        descent::descend(&mut problem, &mut start);
    }
    problem.finish(start)
}

/// The same, but no more than what some rounds of guessing give.
pub fn estimate(quadratic: &Quadratic, members: &[u32], mut start: Column) -> Column {
    let mut problem = Problem::new(quadratic, members, start.factor.take());
    problem.no_force = FORCE_OF_ESTIMATE;
    problem.guess(&mut start);
    start
}

/// A problem with room for what its rounds compute.
pub struct Problem<'a> {
    pub(super) quadratic: &'a Quadratic,
    pub(super) members: &'a [u32],
    pub(super) solver: Solver<'a>,
    /// Q w.
    pub(super) forces: Vec<f64>,
    inner: Vec<f64>,
    /// The largest of the forces, when they were last measured.
    pub(super) largest: f64,
    /// Marks of vertices.
    pub(super) marks: Vec<bool>,
    /// How many free weights each force depends on, while guessing.
    ties: Vec<u32>,
    /// Which force counts as none, in shares of the largest.
    no_force: f64,
}

impl<'a> Problem<'a> {
    fn new(quadratic: &'a Quadratic, members: &'a [u32], factor: Option<Principal>) -> Self {
        let n = quadratic.inverse_mass.len();
        let solver = Solver::new(quadratic, factor);
        Self {
            quadratic,
            members,
            solver,
            forces: vec![0.0; n],
            inner: vec![0.0; n],
            largest: 0.0,
            marks: vec![false; n],
            ties: vec![0; n],
            no_force: if members.len() <= SMALL { FORCE_IF_SMALL } else { FORCE },
        }
    }

    /// Guesses until a guess is right; false if that does not come about.
    fn guess(&mut self, column: &mut Column) -> bool {
        let (mut least, mut since) = (usize::MAX, 0);
        self.to_bounds(column);
        self.measure(&column.weights);
        self.free(column).iter().for_each(|&v| self.tie(v, true));
        for _ in 0..ROUNDS {
            if !self.free_step(column) {
                return false;
            }
            if self.is_right(column) {
                self.refine(column);
                if self.is_right(column) {
                    return true;
                }
            }
            let corrected = self.correct(column, self.members);
            match corrected.len() {
                // Nothing that could be corrected.
                0 => return true,
                corrections if corrections < least => (least, since) = (corrections, 0),
                _ if since < PATIENCE => since += 1,
                _ => return false,
            }
            fronts::follow(self, column, corrected);
        }
        false
    }

    fn to_bounds(&self, column: &mut Column) {
        for &v in self.members {
            if let Some(bound) = column.states[v as usize].bound() {
                column.weights[v as usize] = bound;
            }
        }
    }

    /// Computes the forces.
    pub(super) fn measure(&mut self, weights: &[f64]) {
        self.quadratic.gradient(self.members, weights, &mut self.inner, &mut self.forces);
        self.largest = self.largest_force();
    }

    /// The free vertices, ascending.
    pub(super) fn free(&self, column: &Column) -> Vec<u32> {
        self.members.iter().filter(|v| column.states[**v as usize] == State::Free).copied().collect()
    }

    /// Counts a weight among those that forces depend on, or no longer.
    fn tie(&mut self, v: u32, free: bool) {
        for (u, _) in self.quadratic.matrix.row(v as usize) {
            let ties = &mut self.ties[u];
            *ties = if free { *ties + 1 } else { ties.saturating_sub(1) };
        }
    }

    /// One Newton step of the free weights: no force is left on them. Those that depend on them follow.
    fn free_step(&mut self, column: &mut Column) -> bool {
        if !self.newton(column) {
            return false;
        }
        for &v in self.members {
            let force = &mut self.forces[v as usize];
            match column.states[v as usize] {
                State::Free => *force = 0.0,
                _ if self.ties[v as usize] > 0 => *force = self.quadratic.matrix.times(v as usize, &column.weights),
                _ => {}
            }
        }
        self.largest = self.largest_force();
        true
    }

    /// The step alone; forces are those before it.
    fn newton(&mut self, column: &mut Column) -> bool {
        let free = self.free(column);
        let Some(step) = self.solver.step(&free, &self.forces) else { return false };
        free.iter().zip(&step).for_each(|(&v, &d)| column.weights[v as usize] += d);
        true
    }

    /// Moves a weight, and the forces around it with it.
    pub(super) fn shift(&mut self, column: &mut Column, v: u32, by: f64) {
        column.weights[v as usize] += by;
        self.quadratic.matrix.row(v as usize).for_each(|(u, value)| self.forces[u] += value * by);
    }

    /// Whether bounds hold, within rounding, what they should.
    fn is_right(&self, column: &Column) -> bool {
        self.members.iter().all(|&v| {
            let (w, force) = (column.weights[v as usize], self.forces[v as usize]);
            let (outside, none) = ((-w).max(w - 1.0), self.tolerance(v, self.largest));
            match column.states[v as usize] {
                State::Free => outside <= BOUND || outside * self.quadratic.diagonal[v as usize] <= PUT_BACK * none,
                State::Low => force >= -none,
                State::High => force <= none,
                State::Fixed => true,
            }
        })
    }

    /// Among `vertices`, frees what is held the wrong way and holds what has left the range; those corrected.
    pub(super) fn correct(&mut self, column: &mut Column, vertices: &[u32]) -> Vec<u32> {
        let mut corrected = Vec::new();
        for &v in vertices {
            let (state, w, force) = (column.states[v as usize], column.weights[v as usize], self.forces[v as usize]);
            let none = GIVEN_UP * self.tolerance(v, self.largest);
            let next = match state {
                State::Free if w < -BOUND => State::Low,
                State::Free if w > 1.0 + BOUND => State::High,
                State::Low if force < -none => State::Free,
                State::High if force > none => State::Free,
                same => same,
            };
            if next != state {
                column.states[v as usize] = next;
                self.tie(v, next == State::Free);
                corrected.push(v);
            }
        }
        corrected
    }

    /// The force at a vertex that counts as none.
    pub(super) fn tolerance(&self, v: u32, largest: f64) -> f64 {
        self.no_force * largest + ROUNDING * self.quadratic.diagonal[v as usize]
    }

    pub(super) fn largest_force(&self) -> f64 {
        self.members.iter().map(|&v| self.forces[v as usize].abs()).fold(0.0, f64::max)
    }

    /// Measures the forces exactly, and steps again while that makes those on free weights smaller.
    fn refine(&mut self, column: &mut Column) {
        self.measure(&column.weights);
        for _ in 0..REFINEMENTS {
            let before = self.largest_free_force(column);
            if before <= 0.1 * self.no_force * self.largest {
                return;
            }
            let weights = column.weights.clone();
            let stepped = self.newton(column);
            self.measure(&column.weights);
            if !stepped || self.largest_free_force(column) > 0.5 * before {
                column.weights = weights;
                return self.measure(&column.weights);
            }
        }
    }

    fn largest_free_force(&self, column: &Column) -> f64 {
        let free = self.members.iter().filter(|v| column.states[**v as usize] == State::Free);
        free.map(|&v| self.forces[v as usize].abs()).fold(0.0, f64::max)
    }

    /// Weights within bounds, their energy and residual.
    fn finish(mut self, mut column: Column) -> Column {
        for &v in self.members {
            let w = &mut column.weights[v as usize];
            *w = match column.states[v as usize] {
                State::Low => 0.0,
                State::High => 1.0,
                State::Fixed => *w,
                State::Free if w.is_finite() => w.clamp(0.0, 1.0),
                State::Free => 0.0,
            };
        }
        self.measure(&column.weights);
        let scale = self.largest_force();
        let wrong = |&v: &u32| {
            let (w, force) = (column.weights[v as usize], self.forces[v as usize]);
            match column.states[v as usize] {
                State::Fixed => 0.0,
                _ if w <= 0.0 => (-force).max(0.0),
                _ if w >= 1.0 => force.max(0.0),
                _ => force.abs(),
            }
        };
        let largest = self.members.iter().map(wrong).fold(0.0, f64::max);
        let residual = if scale > 0.0 { largest / scale } else { 0.0 };
        let factor = self.solver.factor.filter(|factor| factor.entries() <= KEPT_ENTRIES);
        Column { energy: self.quadratic.energy(self.members, &column.weights), residual, factor, ..column }
    }
}
