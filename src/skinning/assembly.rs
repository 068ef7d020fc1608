//! The sums over vertices and edges that a fit needs: A, and K and P of every group.

use super::fitter::SkinnedMesh;
use super::functions::{Axes, Functions, as_rows};
use crate::linalg::outer::outer;
use glam::{DMat3, DVec3};

/// What a group of edges says about its rotation.
#[derive(Clone)]
pub struct Group {
    /// `K_g`, 4h × 3.
    pub k: Vec<[f64; 3]>,
    /// `P_g`.
    pub p: DMat3,
}

/// `A` and the groups.
pub struct Assembly {
    /// (4h)² row-major, of which the lower triangle counts.
    pub a: Vec<f64>,
    /// In the order of their numbers.
    pub groups: Vec<Group>,
}

/// The neighbours of each vertex and the edges' weights, those that count.
struct Links {
    start: Vec<u32>,
    link: Vec<(u32, f64)>,
}

impl Links {
    fn new(mesh: &SkinnedMesh, lambda: f64) -> Self {
        let weighted = mesh.edges.iter().zip(mesh.stiffness).map(|(&edge, &stiffness)| (edge, lambda * stiffness));
        let counted = weighted.filter(|&(_, weight)| weight > 0.0 && weight.is_finite());
        let mut start = vec![0; mesh.reference.len() + 1];
        counted.clone().flat_map(|(edge, _)| edge).for_each(|v| start[v as usize + 1] += 1);
        (1..start.len()).for_each(|v| start[v] += start[v - 1]);
        let mut next = start.clone();
        let mut link = vec![(0, 0.0); start.last().map_or(0, |&end| end as usize)];
        for ([a, b], weight) in counted {
            for (from, to) in [(a, b), (b, a)] {
                let place = &mut next[from as usize];
                link[*place as usize] = (to, weight);
                *place += 1;
            }
        }
        Self { start, link }
    }

    fn of(&self, v: usize) -> &[(u32, f64)] {
        &self.link[self.start[v] as usize..self.start[v + 1] as usize]
    }
}

/// A row of `(M + λ L) Φ`: few handles' columns are not 0.
struct Row {
    value: Vec<[f64; 4]>,
    touched: Vec<usize>,
    is_touched: Vec<bool>,
}

impl Row {
    fn new(handles: usize) -> Self {
        Self { value: vec![[0.0; 4]; handles], touched: Vec::new(), is_touched: vec![false; handles] }
    }

    fn add<'a>(&mut self, weight: f64, row: impl Iterator<Item = (usize, &'a [f64; 4])>) {
        for (k, f) in row {
            if !self.is_touched[k] {
                self.is_touched[k] = true;
                self.touched.push(k);
            }
            add_scaled(&mut self.value[k], weight, f);
        }
    }

    fn clear(&mut self) {
        for k in self.touched.drain(..) {
            self.value[k] = [0.0; 4];
            self.is_touched[k] = false;
        }
    }
}

impl Assembly {
    /// Sums up. `points` (#V) and `mass` (#V) are those of the mesh in the unit sphere, `hold` (#H) weighs the crosses.
    pub fn new(
        mesh: &SkinnedMesh,
        functions: &Functions,
        points: &[DVec3],
        mass: &[f64],
        hold: &[f64],
        lambda: f64,
    ) -> Self {
        let links = Links::new(mesh, lambda);
        let a = square(functions, &links, mass, hold.len());
        let groups = groups(mesh, functions, &links, points, hold.len());
        let mut assembly = Self { a, groups };
        assembly.add_crosses(mesh, hold);
        assembly
    }

    /// The handles' crosses.
    fn add_crosses(&mut self, mesh: &SkinnedMesh, hold: &[f64]) {
        let n = 4 * hold.len();
        for (k, (&v, &hold)) in mesh.handles.iter().zip(hold).enumerate() {
            let group = &mut self.groups[mesh.groups[v as usize] as usize];
            group.p += DMat3::from_diagonal(DVec3::splat(hold));
            for axis in 0..3 {
                group.k[4 * k + axis][axis] += hold;
            }
            (4 * k..4 * k + 4).for_each(|i| self.a[i * n + i] += hold);
        }
    }
}

/// The lower triangle of `Φᵀ (M + λ L) Φ`, a vertex' row of Φ times its row of `(M + λ L) Φ` after the other.
fn square(functions: &Functions, links: &Links, mass: &[f64], handles: usize) -> Vec<f64> {
    let mut blocks = vec![[[0.0; 4]; 4]; handles * handles];
    let mut row = Row::new(handles);
    for (v, &m) in mass.iter().enumerate() {
        let around = links.of(v);
        row.add(m.max(0.0) + around.iter().map(|link| link.1).sum::<f64>(), functions.row(v));
        around.iter().for_each(|&(u, weight)| row.add(-weight, functions.row(u as usize)));
        for (k, f) in functions.row(v) {
            for &l in row.touched.iter().filter(|&&l| l <= k) {
                let block = &mut blocks[k * handles + l];
                (0..4).for_each(|i| add_scaled(&mut block[i], f[i], &row.value[l]));
            }
        }
        row.clear();
    }
    let n = 4 * handles;
    let entry = |e: usize| blocks[e / n / 4 * handles + e % n / 4][e / n % 4][e % 4];
    (0..n * n).map(entry).collect()
}

/// K and P of every group; an edge counts half in the group of each of its ends.
fn groups(mesh: &SkinnedMesh, functions: &Functions, links: &Links, points: &[DVec3], handles: usize) -> Vec<Group> {
    let count = mesh.groups.iter().max().map_or(1, |&g| g as usize + 1);
    let mut k = vec![vec![Axes::default(); handles]; count];
    let mut p = vec![DMat3::ZERO; count];
    // What a vertex' edges add up to in the groups of its neighbours: mostly in its own alone.
    let mut shares: Vec<(u32, DVec3)> = Vec::new();
    for (v, (&group, &here)) in mesh.groups.iter().zip(points).enumerate() {
        let mut own = DVec3::ZERO;
        for &(u, weight) in links.of(v) {
            let edge = here - points[u as usize];
            let half = 0.5 * weight * edge;
            p[group as usize] += outer(edge, half);
            own += half;
            add_share(&mut shares, mesh.groups[u as usize], half);
        }
        add_share(&mut shares, group, own);
        shares.drain(..).for_each(|(group, share)| functions.spread(v, share, &mut k[group as usize]));
    }
    k.iter().zip(p).map(|(k, p)| Group { k: as_rows(k), p }).collect()
}

fn add_share(shares: &mut Vec<(u32, DVec3)>, group: u32, share: DVec3) {
    match shares.iter_mut().find(|(known, _)| *known == group) {
        Some((_, sum)) => *sum += share,
        None => shares.push((group, share)),
    }
}

fn add_scaled(sum: &mut [f64; 4], factor: f64, x: &[f64; 4]) {
    (0..4).for_each(|i| sum[i] += factor * x[i]);
}
