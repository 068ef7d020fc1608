//! Cholesky factors of principal submatrices: of a symmetric matrix restricted to a set of its unknowns, again and again
//! as the set changes.
//!
//! Multifrontal (I. Duff, J. Reid. *The multifrontal solution of indefinite sparse symmetric linear equations*. ACM
//! Transactions on Mathematical Software 9(3), 1983): each node of an elimination tree is a dense matrix of which some
//! columns are eliminated, and what is left is added to the nodes above. The [`Tree`] is that of the whole matrix and is
//! found once; nodes leave out what is not in the set. What is left below a node is kept, so that after a change of the
//! set only the nodes from the change up to the root are done again.

use super::cholesky::NotPositiveDefinite;
use super::front::{Front, padded};
use super::symmetric::Symmetric;
use super::tree::NONE;
pub use super::tree::{Merging, Tree};
use pulp::{Arch, Simd, WithSimd};
use std::sync::Arc;

/// The factor of a matrix restricted to a set of unknowns.
#[derive(Clone, Debug, Default)]
pub struct Principal {
    /// The set, ascending.
    set: Vec<u32>,
    /// What has been in it and is no longer, but may still be among the rows of a part.
    left: Vec<u32>,
    /// #nodes: what was eliminated; nothing where no column is in the set.
    parts: Vec<Option<Arc<Part>>>,
    /// #nodes: whether anything was eliminated there or below.
    alive: Vec<bool>,
}

/// A node's share of the factor.
#[derive(Debug, Default)]
struct Part {
    /// The node's columns in the set, ascending.
    columns: Vec<u32>,
    /// The rows beneath them that were in the set, ascending.
    rows: Vec<u32>,
    front: Front,
}

/// Room for what a factor computes; serves any number of factors of one matrix.
#[derive(Debug)]
pub struct Room {
    /// #unknowns: whether each is in the set.
    inside: Vec<bool>,
    /// #unknowns: its place in the front at hand, or [`NONE`].
    place: Vec<u32>,
    /// #nodes: whether each is to be done again.
    stale: Vec<bool>,
    /// #unknowns: zeros but while something is solved.
    x: Vec<f64>,
    /// Nodes below the one at hand, and where one's rows are in it.
    below: Vec<u32>,
    places: Vec<usize>,
    /// Parts that are no longer needed here.
    spare: Vec<Arc<Part>>,
}

impl Room {
    /// Room for a matrix with a tree.
    pub fn new(matrix: &Symmetric, tree: &Tree) -> Self {
        let n = matrix.size();
        Self {
            inside: vec![false; n],
            place: vec![NONE; n],
            stale: vec![false; tree.size()],
            x: vec![0.0; n],
            below: Vec::new(),
            places: Vec::new(),
            spare: Vec::new(),
        }
    }

    /// A part that no other factor has: this one, or a spare one, or a new one.
    fn own(&mut self, part: Option<Arc<Part>>) -> Arc<Part> {
        let mut own = part.filter(is_own);
        while own.is_none()
            && let Some(spare) = self.spare.pop()
        {
            own = Some(spare).filter(is_own);
        }
        own.unwrap_or_default()
    }
}

impl Principal {
    /// The number of stored entries.
    pub fn entries(&self) -> usize {
        let entries = |part: &Arc<Part>| part.front.panel.len() + part.front.rest.len();
        self.parts.iter().flatten().map(entries).sum()
    }

    /// Makes this the factor on another set, ascending. After an error it is worth nothing.
    pub fn change(
        &mut self,
        matrix: &Symmetric,
        tree: &Tree,
        set: &[u32],
        room: &mut Room,
    ) -> Result<(), NotPositiveDefinite> {
        self.parts.resize(tree.size(), None);
        self.alive.resize(tree.size(), false);
        let mut stale = Vec::new();
        let mut touch = |node: u32| {
            let mut next = Some(node);
            while let Some(node) = next.filter(|node| !std::mem::replace(&mut room.stale[*node as usize], true)) {
                stale.push(node);
                next = tree.parent(node);
            }
        };
        let gone = without(&self.set, set);
        gone.iter().for_each(|&v| touch(tree.node(v)));
        for &new in &without(set, &self.set) {
            touch(tree.node(new));
            // Below, its row was left out.
            tree.holders(new).iter().filter(|s| self.parts[**s as usize].is_some()).for_each(|&s| touch(s));
        }
        stale.sort_unstable();
        stale.iter().for_each(|&node| room.stale[node as usize] = false);
        self.set.clear();
        self.set.extend_from_slice(set);
        set.iter().for_each(|&v| room.inside[v as usize] = true);
        self.left.extend(gone);
        self.left.retain(|&v| !room.inside[v as usize]);
        let done = stale.iter().all(|&node| self.eliminate(matrix, tree, node, room));
        set.iter().for_each(|&v| room.inside[v as usize] = false);
        if done { Ok(()) } else { Err(NotPositiveDefinite) }
    }

    /// Does a node again; false where that cannot be.
    fn eliminate(&mut self, matrix: &Symmetric, tree: &Tree, node: u32, room: &mut Room) -> bool {
        let mut shared = room.own(self.parts[node as usize].take());
        let Some(part) = Arc::get_mut(&mut shared) else { return false };
        let Part { columns, rows, front } = part;
        columns.clear();
        columns.extend(tree.columns(node).filter(|v| room.inside[*v as usize]));
        let below = tree.children(node).iter().any(|&child| self.alive[child as usize]);
        self.alive[node as usize] = below || !columns.is_empty();
        if columns.is_empty() {
            room.spare.push(shared);
            return true;
        }
        rows.clear();
        rows.extend(tree.rows(node).iter().filter(|v| room.inside[**v as usize]));
        front.reset(columns.len(), rows.len());
        let top = padded(columns.len()) as u32;
        let places = (0..).zip(&*columns).chain((top..).zip(&*rows));
        places.for_each(|(place, &v)| room.place[v as usize] = place);
        front.set(matrix, columns.iter().copied(), &room.place);
        if below {
            self.find_below(tree, node, &mut room.below);
            let parts = room.below.iter().filter_map(|&child| self.parts[child as usize].as_deref());
            parts.for_each(|part| part.add_to(front, &room.place, &mut room.places));
        }
        columns.iter().chain(&*rows).for_each(|&v| room.place[v as usize] = NONE);
        let done = front.eliminate();
        self.parts[node as usize] = Some(shared);
        done
    }

    /// The nodes below a node that eliminated something and have none such in between.
    fn find_below(&self, tree: &Tree, node: u32, below: &mut Vec<u32>) {
        let children = |node: u32| tree.children(node).iter().filter(|child| self.alive[**child as usize]);
        below.clear();
        below.extend(children(node));
        let mut at = 0;
        while let Some(&child) = below.get(at) {
            if self.parts[child as usize].is_some() {
                at += 1;
            } else {
                below.swap_remove(at);
                below.extend(children(child));
            }
        }
    }

    /// Leaves its memory to the next factors that are computed with this room.
    pub fn empty(self, room: &mut Room) {
        room.spare.extend(self.parts.into_iter().flatten());
    }

    /// Replaces right-hand sides by solutions at the unknowns of the set, `x` being one number for each of them.
    pub fn solve(&self, x: &mut [f64], room: &mut Room) {
        Arch::new().dispatch(Solution { factor: self, x, room });
    }
}

/// A solution, with the widest vectors that the machine has.
struct Solution<'a> {
    factor: &'a Principal,
    x: &'a mut [f64],
    room: &'a mut Room,
}

impl WithSimd for Solution<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { factor, x, room } = self;
        let all = &mut room.x;
        let mut of_node = Vec::new();
        factor.set.iter().zip(&*x).for_each(|(&v, &value)| all[v as usize] = value);
        for part in factor.parts.iter().flatten() {
            part.gather(all, &mut of_node);
            part.front.forward(simd, &mut of_node);
            let (above, below) = part.split(&of_node);
            scatter(&part.columns, above, all);
            scatter(&part.rows, below, all);
        }
        factor.left.iter().for_each(|&v| all[v as usize] = 0.0);
        for part in factor.parts.iter().flatten().rev() {
            part.gather(all, &mut of_node);
            part.front.backward(simd, &mut of_node);
            scatter(&part.columns, part.split(&of_node).0, all);
        }
        for (&v, value) in factor.set.iter().zip(x) {
            *value = std::mem::take(&mut all[v as usize]);
        }
    }
}

/// Puts values where unknowns are.
#[inline(always)]
fn scatter(unknowns: &[u32], values: &[f64], all: &mut [f64]) {
    unknowns.iter().zip(values).for_each(|(&v, &value)| all[v as usize] = value);
}

impl Part {
    /// The values of its unknowns, one for each row of its front.
    #[inline(always)]
    fn gather(&self, all: &[f64], values: &mut Vec<f64>) {
        let top = padded(self.columns.len());
        values.clear();
        values.extend(self.columns.iter().map(|&v| all[v as usize]));
        values.resize(top, 0.0);
        values.extend(self.rows.iter().map(|&v| all[v as usize]));
        values.resize(self.front.rows(), 0.0);
    }

    /// Such values: those of its columns and those of its rows, each padded.
    #[inline(always)]
    fn split<'a>(&self, values: &'a [f64]) -> (&'a [f64], &'a [f64]) {
        values.split_at(padded(self.columns.len()))
    }

    /// Adds what is left to a node above; `place` is where each row is there, `places` room.
    fn add_to(&self, front: &mut Front, place: &[u32], places: &mut Vec<usize>) {
        places.clear();
        places.extend(self.rows.iter().map(|&v| place[v as usize] as usize));
        front.add(&self.front, places);
    }
}

fn is_own(part: &Arc<Part>) -> bool {
    Arc::strong_count(part) == 1
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

#[cfg(test)]
mod tests {
    use super::*;

    /// A stiff sheet of `side` × `side` points, each tied to all within two steps, held weakly.
    fn sheet(side: usize) -> Symmetric {
        let n = side * side;
        let (mut starts, mut columns, mut values) = (vec![0], Vec::new(), Vec::new());
        for v in 0..n {
            let (x, y) = (v % side, v / side);
            let near = (0..n).filter(|u| (u % side).abs_diff(x) <= 2 && (u / side).abs_diff(y) <= 2);
            for u in near {
                columns.push(u as u32);
                values.push(if u == v { 25.0 + v as f64 * 0.01 } else { ((u * v) as f64).sin() });
            }
            starts.push(columns.len() as u32);
        }
        Symmetric::new(starts, columns, values)
    }

    /// The largest entry of A x − b on a set, where x is zero elsewhere.
    fn miss(matrix: &Symmetric, set: &[u32], x: &[f64], right: &[f64]) -> f64 {
        let mut all = vec![0.0; matrix.size()];
        set.iter().zip(x).for_each(|(&v, &value)| all[v as usize] = value);
        let off = set.iter().zip(right).map(|(&v, b)| (matrix.times(v as usize, &all) - b).abs());
        off.fold(0.0, f64::max)
    }

    #[test]
    fn solutions_solve_while_the_set_changes() {
        let matrix = sheet(20);
        let tree = Tree::new(&matrix, Merging::Much);
        let mut room = Room::new(&matrix, &tree);
        let mut factor = Principal::default();
        let member = |v: u32, round: u32| match round {
            0 => true,
            1 => v % 7 != 3 && v < 300,
            2 => v % 7 != 3 && (10..310).contains(&v),
            3 => v == 5,
            4 => false,
            _ => (v * v + round) % 5 > 1,
        };
        for round in 0..8 {
            let set: Vec<u32> = (0..400).filter(|&v| member(v, round)).collect();
            let right: Vec<f64> = set.iter().map(|&v| f64::from(v).cos()).collect();
            factor.change(&matrix, &tree, &set, &mut room).expect("a positive definite matrix");
            let mut x = right.clone();
            factor.solve(&mut x, &mut room);
            let miss = miss(&matrix, &set, &x, &right);
            assert!(miss < 1e-12, "round {round}: {miss}");
        }
    }

    #[test]
    fn a_changed_factor_is_the_same_as_a_new_one() {
        let matrix = sheet(15);
        let tree = Tree::new(&matrix, Merging::Much);
        let mut room = Room::new(&matrix, &tree);
        let first: Vec<u32> = (0..150).collect();
        let second: Vec<u32> = (0..225).filter(|v| v % 11 != 0).collect();
        let (mut changed, mut new) = (Principal::default(), Principal::default());
        for set in [&first, &second] {
            changed.change(&matrix, &tree, set, &mut room).expect("a factor");
        }
        new.change(&matrix, &tree, &second, &mut room).expect("a factor");
        let mut x = vec![1.0; second.len()];
        let mut y = x.clone();
        changed.solve(&mut x, &mut room);
        new.solve(&mut y, &mut room);
        assert!(x.iter().zip(&y).all(|(a, b)| (a - b).abs() < 1e-13));
    }

    #[test]
    fn what_is_not_positive_definite_is_refused() {
        let matrix = Symmetric::new(vec![0, 2, 4], vec![0, 1, 0, 1], vec![1.0, 2.0, 2.0, 1.0]);
        let tree = Tree::new(&matrix, Merging::Much);
        let mut room = Room::new(&matrix, &tree);
        let mut factor = Principal::default();
        assert!(factor.change(&matrix, &tree, &[0, 1], &mut room).is_err());
        let mut factor = Principal::default();
        assert!(factor.change(&matrix, &tree, &[1], &mut room).is_ok());
    }
}
