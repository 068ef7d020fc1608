//! Which columns of a factor are computed together, and which need which: found once for a matrix and all its parts.
//!
//! J. Liu. *The role of elimination trees in sparse factorization*. SIAM J. Matrix Analysis and Applications 11(1), 1990;
//! nodes are merged as in C. Ashcraft, R. Grimes. *The influence of relaxed supernode partitions on the multifrontal
//! method*. ACM Transactions on Mathematical Software 15(4), 1989.

use crate::linalg::symmetric::Symmetric;
use std::ops::Range;

/// No node, no column.
pub const NONE: u32 = u32::MAX;

/// How readily nodes become one, at the price of zeros among their entries.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Merging {
    /// For factors that are kept: three quarters of the entries, in about the same time.
    Little,
    /// For parts that are factored again and again, and are small.
    Much,
}

impl Merging {
    /// Up to so many columns are one node if no more than such a share of its entries are zeros.
    fn limits(self) -> &'static [(usize, f64)] {
        match self {
            Self::Little => &[(4, 1.0), (8, 0.5), (16, 0.3), (64, 0.15), (usize::MAX, 0.05)],
            Self::Much => &[(16, 1.0), (32, 0.7), (64, 0.4), (usize::MAX, 0.12)],
        }
    }
}

/// The tree of a symmetric matrix whose unknowns are eliminated in the order of their numbers. Nodes are runs of columns;
/// children come before their parents.
#[derive(Debug)]
pub struct Tree {
    /// #nodes + 1: where each node's columns begin.
    starts: Vec<u32>,
    /// #columns: the node that each is in.
    node: Vec<u32>,
    /// #nodes: parents, or [`NONE`].
    parent: Vec<u32>,
    rows: Lists,
    children: Lists,
    holders: Lists,
}

impl Tree {
    /// The tree of a matrix with a full diagonal.
    pub fn new(matrix: &Symmetric, merging: Merging) -> Self {
        let above = parents(matrix);
        let counts = counts(matrix, &above);
        let starts = nodes(&above, &counts, merging.limits());
        let n = matrix.size();
        let count = starts.len() - 1;
        let mut node = vec![0; n];
        for (s, range) in starts.windows(2).enumerate() {
            node[range[0] as usize..range[1] as usize].fill(s as u32);
        }
        let of_last = |s: usize| above[starts[s + 1] as usize - 1];
        let parent_of = |s: usize| if of_last(s) == NONE { NONE } else { node[of_last(s) as usize] };
        let parent: Vec<u32> = (0..count).map(parent_of).collect();
        let children = Lists::inverse((0..count).map(|s| (parent[s], s as u32)), count);
        let rows = rows(matrix, &starts, &children);
        let held = (0..count).flat_map(|s| rows.of(s).iter().map(move |&row| (row, s as u32)));
        let holders = Lists::inverse(held, n);
        Self { starts, node, parent, rows, children, holders }
    }

    /// The number of nodes.
    pub fn size(&self) -> usize {
        self.parent.len()
    }

    /// The node of a column.
    pub fn node(&self, column: u32) -> u32 {
        self.node[column as usize]
    }

    /// The node above a node, if there is one.
    pub fn parent(&self, node: u32) -> Option<u32> {
        Some(self.parent[node as usize]).filter(|parent| *parent != NONE)
    }

    /// The columns of a node.
    pub fn columns(&self, node: u32) -> Range<u32> {
        self.starts[node as usize]..self.starts[node as usize + 1]
    }

    /// The rows beneath a node's columns in which the factor may have entries, ascending.
    pub fn rows(&self, node: u32) -> &[u32] {
        self.rows.of(node as usize)
    }

    /// The nodes right below a node.
    pub fn children(&self, node: u32) -> &[u32] {
        self.children.of(node as usize)
    }

    /// The nodes that have a row beneath their columns.
    pub fn holders(&self, row: u32) -> &[u32] {
        self.holders.of(row as usize)
    }
}

/// Lists one after the other.
#[derive(Debug)]
struct Lists {
    starts: Vec<usize>,
    items: Vec<u32>,
}

impl Lists {
    fn of(&self, list: usize) -> &[u32] {
        &self.items[self.starts[list]..self.starts[list + 1]]
    }

    /// For each of `count` lists the items that go with it, in the order of `pairs` (list or [`NONE`], item).
    fn inverse(pairs: impl Iterator<Item = (u32, u32)> + Clone, count: usize) -> Self {
        let mut starts = vec![0; count + 1];
        let listed = pairs.filter(|pair| pair.0 != NONE);
        listed.clone().for_each(|(list, _)| starts[list as usize + 1] += 1);
        (0..count).for_each(|list| starts[list + 1] += starts[list]);
        let mut next = starts.clone();
        let mut items = vec![0; starts[count]];
        for (list, item) in listed {
            items[next[list as usize]] = item;
            next[list as usize] += 1;
        }
        Self { starts, items }
    }
}

/// For each column the first row beneath its diagonal in the factor: its parent.
fn parents(matrix: &Symmetric) -> Vec<u32> {
    let n = matrix.size();
    let (mut parent, mut ancestor) = (vec![NONE; n], vec![NONE; n]);
    for row in 0..n {
        for (column, _) in matrix.row(row).take_while(|entry| entry.0 < row) {
            let mut at = column;
            loop {
                let up = std::mem::replace(&mut ancestor[at], row as u32);
                match up {
                    NONE => {
                        parent[at] = row as u32;
                        break;
                    }
                    up if up as usize == row => break,
                    up => at = up as usize,
                }
            }
        }
    }
    parent
}

/// For each column the number of entries beneath its diagonal in the factor.
fn counts(matrix: &Symmetric, parent: &[u32]) -> Vec<u32> {
    let n = matrix.size();
    let (mut counts, mut seen) = (vec![0; n], vec![NONE; n]);
    for row in 0..n {
        seen[row] = row as u32;
        for (column, _) in matrix.row(row).take_while(|entry| entry.0 < row) {
            let mut at = column;
            while seen[at] != row as u32 {
                seen[at] = row as u32;
                counts[at] += 1;
                at = parent[at] as usize;
            }
        }
    }
    counts
}

/// A run of columns while nodes are merged.
struct Run {
    first: u32,
    /// Rows beneath.
    below: usize,
    /// Entries that are zeros, merging being what it is.
    zeros: f64,
}

/// Where nodes begin, and the number of columns.
fn nodes(parent: &[u32], counts: &[u32], limits: &[(usize, f64)]) -> Vec<u32> {
    let n = parent.len();
    let mut runs: Vec<Run> = Vec::new();
    let mut first = 0;
    while first < n {
        let mut end = first + 1;
        while end < n && parent[end - 1] as usize == end && counts[end - 1] == counts[end] + 1 {
            end += 1;
        }
        let mut run = Run { first: first as u32, below: counts[end - 1] as usize, zeros: 0.0 };
        while let Some(last) = runs.last() {
            let under = parent[run.first as usize - 1];
            let both = if (under as usize) < end { merged(last, &run, end, limits) } else { None };
            let Some(both) = both else { break };
            runs.pop();
            run = both;
        }
        runs.push(run);
        first = end;
    }
    runs.iter().map(|run| run.first).chain([n as u32]).collect()
}

/// A run and the one before it as one, if the limits allow it.
fn merged(before: &Run, run: &Run, end: usize, limits: &[(usize, f64)]) -> Option<Run> {
    let (own, theirs) = (end - run.first as usize, (run.first - before.first) as usize);
    let zeros = before.zeros + run.zeros + (theirs * (own + run.below - before.below)) as f64;
    let columns = own + theirs;
    let share = zeros / (columns * (columns + 1) / 2 + columns * run.below) as f64;
    let allowed = limits.iter().find(|(most, _)| columns <= *most).map_or(0.0, |allowed| allowed.1);
    (share <= allowed).then_some(Run { first: before.first, below: run.below, zeros })
}

/// The rows beneath each node: those of its columns and of its children.
fn rows(matrix: &Symmetric, starts: &[u32], children: &Lists) -> Lists {
    let mut rows = Lists { starts: vec![0], items: Vec::new() };
    let mut seen = vec![NONE; matrix.size()];
    for (s, range) in starts.windows(2).enumerate() {
        let from = rows.items.len();
        let mut add = |row: u32, items: &mut Vec<u32>| {
            if row >= range[1] && std::mem::replace(&mut seen[row as usize], s as u32) != s as u32 {
                items.push(row);
            }
        };
        for column in range[0]..range[1] {
            matrix.row(column as usize).for_each(|(row, _)| add(row as u32, &mut rows.items));
        }
        for &child in children.of(s) {
            for i in rows.starts[child as usize]..rows.starts[child as usize + 1] {
                add(rows.items[i], &mut rows.items);
            }
        }
        rows.items[from..].sort_unstable();
        rows.starts.push(rows.items.len());
    }
    rows
}
