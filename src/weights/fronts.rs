//! Following the edges of the set of free weights.
//!
//! Far from the handle the edge of that set moves by a ring of vertices a round, while the other weights hardly change any
//! more. So rounds are played in the neighbourhood of what was corrected last, everything else being held, until nothing
//! there is left to correct; then the whole is solved again.

use super::box_problem::{Column, Problem, State};
use crate::linalg::principal::Principal;

/// Rounds in neighbourhoods between two on the whole.
const ROUNDS: usize = 6;

/// And none any more when so small a share of the first corrections is left: what they do to the whole matters more then.
const LEFT: f64 = 0.1;

/// A neighbourhood is everything within so many edges of what was corrected: wide enough for a front to move on by itself,
/// which halves the rounds on the whole.
const REACH: usize = 4;

/// Q ties what is within so many edges of each other.
const TIED: usize = 2;

/// Corrects states near `corrected` vertices further.
pub fn follow(problem: &mut Problem, column: &mut Column, mut corrected: Vec<u32>) {
    let mut factor = Principal::default();
    let few = LEFT * corrected.len() as f64;
    for _ in 0..ROUNDS {
        to_bounds(problem, column, &corrected);
        let (felt, within) = around(problem, &corrected);
        let is_free = |v: &&u32| column.states[**v as usize] == State::Free;
        let mut free: Vec<u32> = felt[..within].iter().filter(is_free).copied().collect();
        free.sort_unstable();
        let Some(step) = problem.solver.step_of(&mut factor, &free, &problem.forces) else { break };
        free.iter().zip(&step).for_each(|(&v, &d)| problem.shift(column, v, d));
        corrected = problem.correct(column, &felt);
        if corrected.len() as f64 <= few {
            break;
        }
    }
    to_bounds(problem, column, &corrected);
    problem.solver.give_back(factor);
}

/// Puts weights that are held where they are held.
fn to_bounds(problem: &mut Problem, column: &mut Column, vertices: &[u32]) {
    for &v in vertices {
        if let Some(bound) = column.states[v as usize].bound() {
            problem.shift(column, v, bound - column.weights[v as usize]);
            // To the bit.
            column.weights[v as usize] = bound;
        }
    }
}

/// Everything within [`REACH`] of a set, and then what else is [`TIED`] to that; and how many the former are.
fn around(problem: &mut Problem, vertices: &[u32]) -> (Vec<u32>, usize) {
    // One place more than there are vertices: each that is met is put there, and counted if it is new, without a branch.
    let mut set = vertices.to_vec();
    set.resize(problem.marks.len() + 1, 0);
    set[..vertices.len()].iter().for_each(|&v| problem.marks[v as usize] = true);
    // Where the outermost ring begins, and the end of every ring.
    let (mut from, mut count, mut ends) = (0, vertices.len(), Vec::new());
    for _ in 0..REACH + TIED {
        let end = count;
        for i in from..end {
            for (u, _) in problem.quadratic.laplacian.row(set[i] as usize) {
                set[count] = u as u32;
                count += usize::from(!std::mem::replace(&mut problem.marks[u], true));
            }
        }
        from = end;
        ends.push(count);
    }
    set.truncate(count);
    set.iter().for_each(|&v| problem.marks[v as usize] = false);
    (set, ends[REACH - 1])
}
