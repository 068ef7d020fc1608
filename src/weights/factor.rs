//! Newton steps on changing sets of free weights.

use super::quadratic::Quadratic;
use crate::linalg::principal::{Principal, Room};

/// What solves on sets of free vertices: the last factor, which is changed to the next set.
pub struct Solver<'a> {
    quadratic: &'a Quadratic,
    /// The factor in use, if any.
    pub factor: Option<Principal>,
    room: Room,
}

impl<'a> Solver<'a> {
    /// A solver that starts from a factor at hand.
    pub fn new(quadratic: &'a Quadratic, factor: Option<Principal>) -> Self {
        Self { quadratic, factor, room: Room::new(&quadratic.matrix, &quadratic.tree) }
    }

    /// The solution d of Q d = −`forces` on the vertices in `free` (ascending), d being zero elsewhere; one number for each
    /// of `free`. `None` where Q is not positive definite there within rounding.
    pub fn step(&mut self, free: &[u32], forces: &[f64]) -> Option<Vec<f64>> {
        let mut factor = self.factor.take().unwrap_or_default();
        let step = self.step_of(&mut factor, free, forces);
        self.factor = step.is_some().then_some(factor);
        step
    }

    /// The same with another factor, which is changed to this set.
    pub fn step_of(&mut self, factor: &mut Principal, free: &[u32], forces: &[f64]) -> Option<Vec<f64>> {
        factor.change(&self.quadratic.matrix, &self.quadratic.tree, free, &mut self.room).ok()?;
        let mut step: Vec<f64> = free.iter().map(|&v| -forces[v as usize]).collect();
        factor.solve(&mut step, &mut self.room);
        step.iter().all(|x| x.is_finite()).then_some(step)
    }

    /// A factor that is no longer needed: its memory serves the next ones.
    pub fn give_back(&mut self, factor: Principal) {
        factor.empty(&mut self.room);
    }
}
