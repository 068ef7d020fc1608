//! The monotone method: from weights within bounds towards the optimum of the free ones, as far as bounds allow.
//!
//! What meets a bound is held there and the rest goes on; then everything that a bound pulls the wrong way is freed, and
//! so on (an active-set method, J. Nocedal, S. Wright. *Numerical optimization*, 2006, §16.5). The energy never rises.

use super::box_problem::{Column, Problem, State};

/// Rounds, at most.
const ROUNDS: usize = 400;

/// Lowers the energy of weights until it falls no further.
pub fn descend(problem: &mut Problem, column: &mut Column) {
    for &v in problem.members {
        let w = &mut column.weights[v as usize];
        if column.states[v as usize] != State::Fixed {
            *w = if w.is_finite() { w.clamp(0.0, 1.0) } else { 0.0 };
        }
    }
    let mut least = problem.quadratic.energy(problem.members, &column.weights);
    for _ in 0..ROUNDS {
        problem.measure(&column.weights);
        release(problem, column);
        let before = column.weights.clone();
        let done = !to_the_bounds(problem, column);
        let energy = problem.quadratic.energy(problem.members, &column.weights);
        if energy.is_nan() || energy > least {
            column.weights = before;
        }
        if done || energy.is_nan() || energy >= least {
            return;
        }
        least = energy;
    }
}

/// What is on a bound is held there if its force pulls outwards, else free.
fn release(problem: &Problem, column: &mut Column) {
    let scale = problem.largest_force();
    for &v in problem.members {
        let tolerance = problem.tolerance(v, scale);
        let v = v as usize;
        let (w, force) = (column.weights[v], problem.forces[v]);
        column.states[v] = match column.states[v] {
            State::Fixed => State::Fixed,
            _ if w <= 0.0 && force >= -tolerance => State::Low,
            _ if w >= 1.0 && force <= tolerance => State::High,
            _ => State::Free,
        };
    }
}

/// Goes to the optimum of the free weights, holding what meets a bound on the way; false where there is no way.
fn to_the_bounds(problem: &mut Problem, column: &mut Column) -> bool {
    let room = |w: f64, d: f64| match w + d {
        to if to < 0.0 => w / -d,
        to if to > 1.0 => (1.0 - w) / d,
        _ => f64::INFINITY,
    };
    loop {
        problem.measure(&column.weights);
        let free = problem.free(column);
        let Some(step) = problem.solver.step(&free, &problem.forces) else { return false };
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
