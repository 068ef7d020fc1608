//! Newton steps on changing sets of free weights with few factorisations.
//!
//! A factor of Q restricted to some set serves every set that differs from it in a few members: each member more or less
//! borders the system with a row and a column, eliminated first (the Schur complement of the border, as in P. Gill, W.
//! Murray, M. Saunders, M. Wright. *A Schur-complement method for sparse quadratic programming*, 1987).

use super::quadratic::Quadratic;
use crate::linalg::cholesky::{Cholesky, Ordering};
use std::sync::Arc;

/// Not in a set.
const NONE: u32 = u32::MAX;

/// Borders are kept up to this many, and up to a share of the set: beyond, a new factor is cheaper.
const MOST_BORDERS: usize = 24;
const BORDERS_PER_MEMBER: usize = 16;

/// A factor of Q on a set of vertices, and the borders computed with it so far.
#[derive(Clone, Debug)]
pub struct Factor {
    base: Arc<Base>,
    borders: Vec<Arc<Border>>,
}

#[derive(Debug)]
struct Base {
    /// The set, ascending.
    members: Vec<u32>,
    cholesky: Cholesky,
}

/// A vertex by which a set may differ from the base's.
#[derive(Debug)]
struct Border {
    vertex: u32,
    /// Its column: unit for a member of the base, its column of Q else. (place in the base, value).
    column: Vec<(u32, f64)>,
    /// The column after solving with the base.
    solved: Vec<f64>,
}

impl Factor {
    /// Factors Q on `free`, ascending; `None` where that is not positive definite within rounding.
    fn new(quadratic: &Quadratic, free: &[u32], place: &mut [u32]) -> Option<Self> {
        mark(free, place);
        let upper = quadratic.matrix.upper(free, place);
        unmark(free, place);
        let cholesky = Cholesky::of(&upper, Ordering::AsGiven).ok()?;
        Some(Self { base: Arc::new(Base { members: free.to_vec(), cholesky }), borders: Vec::new() })
    }

    /// The number of stored entries.
    pub fn entries(&self) -> usize {
        self.base.cholesky.entries() + self.borders.len() * self.base.members.len()
    }

    /// The vertices by which a set differs from the base's: those it lacks, and those it has more.
    fn difference(&self, free: &[u32]) -> (Vec<u32>, Vec<u32>) {
        (without(&self.base.members, free), without(free, &self.base.members))
    }
}

/// What solves on sets of free vertices: the last factor, and room for marks.
pub struct Solver<'a> {
    quadratic: &'a Quadratic,
    /// The factor in use, if any.
    pub factor: Option<Factor>,
    place: Vec<u32>,
    /// How many factors were computed.
    pub factored: usize,
}

impl<'a> Solver<'a> {
    /// A solver that starts from a factor at hand.
    pub fn new(quadratic: &'a Quadratic, factor: Option<Factor>) -> Self {
        Self { quadratic, factor, place: vec![NONE; quadratic.inverse_mass.len()], factored: 0 }
    }

    /// The solution d of Q d = −`forces` on the vertices in `free` (ascending), d being zero elsewhere; one number for each
    /// of `free`. `None` where Q is not positive definite there within rounding.
    pub fn step(&mut self, free: &[u32], forces: &[f64]) -> Option<Vec<f64>> {
        if free.is_empty() {
            return Some(Vec::new());
        }
        if let Some(step) = self.bordered(free, forces) {
            return Some(step);
        }
        self.factored += 1;
        self.factor = None;
        let factor = Factor::new(self.quadratic, free, &mut self.place)?;
        let mut step: Vec<f64> = free.iter().map(|&v| -forces[v as usize]).collect();
        factor.base.cholesky.solve(&mut step);
        self.factor = Some(factor);
        step.iter().all(|x| x.is_finite()).then_some(step)
    }

    fn bordered(&mut self, free: &[u32], forces: &[f64]) -> Option<Vec<f64>> {
        let mut factor = self.factor.take()?;
        let step = self.bordered_by(&mut factor, free, forces);
        self.factor = Some(factor);
        step
    }

    fn bordered_by(&mut self, factor: &mut Factor, free: &[u32], forces: &[f64]) -> Option<Vec<f64>> {
        let (less, more) = factor.difference(free);
        let members = factor.base.members.len();
        let count = less.len() + more.len();
        if count > MOST_BORDERS.min(8 + members / BORDERS_PER_MEMBER) {
            return None;
        }
        mark(&factor.base.members, &mut self.place);
        self.add_borders(factor, less.iter().chain(&more));
        let find = |v: &u32| factor.borders.iter().find(|border| border.vertex == *v).cloned();
        let borders: Vec<Arc<Border>> = less.iter().chain(&more).filter_map(find).collect();
        let mut inner: Vec<f64> = factor.base.members.iter().map(|&v| -forces[v as usize]).collect();
        factor.base.cholesky.solve(&mut inner);
        let outer = self.eliminate(&borders, less.len(), &more, &inner, forces);
        unmark(&factor.base.members, &mut self.place);
        let outer = outer?;
        for (border, y) in borders.iter().zip(&outer) {
            inner.iter_mut().zip(&border.solved).for_each(|(x, s)| *x -= y * s);
        }
        let step = gather(free, &factor.base.members, &inner, &more, &outer[less.len()..]);
        step.iter().all(|x| x.is_finite()).then_some(step)
    }

    /// Computes the borders that are missing, all in one solve.
    fn add_borders<'v>(&self, factor: &mut Factor, vertices: impl Iterator<Item = &'v u32>) {
        let missing: Vec<u32> =
            vertices.copied().filter(|&v| factor.borders.iter().all(|border| border.vertex != v)).collect();
        let members = factor.base.members.len();
        let mut solved = vec![0.0; members * missing.len()];
        let column = |&v: &u32| match self.place[v as usize] {
            NONE => self.places(v).collect(),
            place => vec![(place, 1.0)],
        };
        let columns: Vec<Vec<(u32, f64)>> = missing.iter().map(column).collect();
        for (dense, column) in solved.chunks_exact_mut(members).zip(&columns) {
            column.iter().for_each(|&(place, value)| dense[place as usize] = value);
        }
        factor.base.cholesky.solve(&mut solved);
        for ((&vertex, column), solved) in missing.iter().zip(columns).zip(solved.chunks_exact(members)) {
            factor.borders.push(Arc::new(Border { vertex, column, solved: solved.to_vec() }));
        }
    }

    /// A column of Q on the base's places.
    fn places(&self, v: u32) -> impl Iterator<Item = (u32, f64)> {
        let row = self.quadratic.matrix.row(v as usize);
        row.map(|(u, value)| (self.place[u], value)).filter(|&(place, _)| place != NONE)
    }

    /// The unknowns of the borders: forces that hold the `less` first borders, and the steps of the `more` others.
    fn eliminate(
        &self,
        borders: &[Arc<Border>],
        less: usize,
        more: &[u32],
        inner: &[f64],
        forces: &[f64],
    ) -> Option<Vec<f64>> {
        let dot =
            |border: &Border, x: &[f64]| border.column.iter().map(|&(p, value)| value * x[p as usize]).sum::<f64>();
        let count = borders.len();
        let mut matrix = vec![0.0; count * count];
        for (i, a) in borders.iter().enumerate() {
            for (j, b) in borders.iter().enumerate() {
                matrix[i * count + j] = -dot(a, &b.solved);
            }
        }
        for (i, &u) in more.iter().enumerate() {
            for (v, value) in self.quadratic.matrix.row(u as usize) {
                if let Ok(j) = more.binary_search(&(v as u32)) {
                    matrix[(less + i) * count + less + j] += value;
                }
            }
        }
        let mut right: Vec<f64> = borders.iter().map(|border| -dot(border, inner)).collect();
        right[less..].iter_mut().zip(more).for_each(|(x, &v)| *x -= forces[v as usize]);
        solve_dense(&mut matrix, &mut right).then_some(right)
    }
}

fn mark(set: &[u32], place: &mut [u32]) {
    set.iter().enumerate().for_each(|(i, &v)| place[v as usize] = i as u32);
}

fn unmark(set: &[u32], place: &mut [u32]) {
    set.iter().for_each(|&v| place[v as usize] = NONE);
}

/// What is in one ascending list and not in another.
fn without(a: &[u32], b: &[u32]) -> Vec<u32> {
    let mut rest = b.iter().peekable();
    let mut only = Vec::new();
    for &v in a {
        while rest.next_if(|&&u| u < v).is_some() {}
        if rest.peek() != Some(&&v) {
            only.push(v);
        }
    }
    only
}

/// The values of `free` from those of the base's members and of the vertices beyond them; all lists ascend.
fn gather(free: &[u32], members: &[u32], inner: &[f64], more: &[u32], outer: &[f64]) -> Vec<f64> {
    let mut inside = members.iter().zip(inner).peekable();
    let mut outside = more.iter().zip(outer).peekable();
    let value = |&v: &u32| {
        while inside.next_if(|(u, _)| **u < v).is_some() {}
        match outside.next_if(|(u, _)| **u == v) {
            Some((_, &x)) => x,
            None => inside.peek().map_or(0.0, |&(_, &x)| x),
        }
    };
    free.iter().map(value).collect()
}

/// Gaussian elimination with row pivots; false for a singular matrix. `matrix` is row by row.
fn solve_dense(matrix: &mut [f64], right: &mut [f64]) -> bool {
    let n = right.len();
    for k in 0..n {
        let pivot =
            (k..n).fold(k, |best, i| if matrix[i * n + k].abs() > matrix[best * n + k].abs() { i } else { best });
        let size = matrix[pivot * n + k].abs();
        if size == 0.0 || size.is_nan() {
            return false;
        }
        if pivot != k {
            (0..n).for_each(|j| matrix.swap(k * n + j, pivot * n + j));
            right.swap(k, pivot);
        }
        for i in k + 1..n {
            let share = matrix[i * n + k] / matrix[k * n + k];
            if share != 0.0 {
                let (above, below) = matrix.split_at_mut(i * n);
                below[k..n].iter_mut().zip(&above[k * n + k..k * n + n]).for_each(|(x, y)| *x -= share * y);
                right[i] -= share * right[k];
            }
        }
    }
    for k in (0..n).rev() {
        let sum: f64 = (k + 1..n).map(|j| matrix[k * n + j] * right[j]).sum();
        right[k] = (right[k] - sum) / matrix[k * n + k];
    }
    true
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::laplacian::Laplacian;
    use glam::DVec3;

    #[test]
    fn borders_give_what_a_new_factor_gives() {
        let at = |i: u32| DVec3::new(f64::from(i % 12), f64::from(i / 12), (f64::from(i) * 0.7).sin());
        let positions: Vec<DVec3> = (0..144).map(at).collect();
        let cells = (0..131).filter(|i| i % 12 != 11);
        let faces: Vec<[u32; 3]> = cells.flat_map(|i| [[i, i + 1, i + 13], [i, i + 13, i + 12]]).collect();
        let quadratic = Quadratic::new(&Laplacian::new(&faces, &positions));
        let forces: Vec<f64> = (0..144).map(|i| f64::from(i).cos()).collect();
        let first: Vec<u32> = (20..100).collect();
        let second: Vec<u32> = (18..97).filter(|v| *v != 50 && *v != 61).collect();
        let mut solver = Solver::new(&quadratic, None);
        solver.step(&first, &forces).expect("a step");
        let bordered = solver.step(&second, &forces).expect("a step");
        assert_eq!(solver.factored, 1);
        let direct = Solver::new(&quadratic, None).step(&second, &forces).expect("a step");
        let largest = direct.iter().map(|x| x.abs()).fold(0.0, f64::max);
        assert!(bordered.iter().zip(&direct).all(|(a, b)| (a - b).abs() < 1e-9 * largest));
    }
}
