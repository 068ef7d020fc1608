//! A numbering of the vertices for which Q, and Q restricted to any of them, has a sparse factor.
//!
//! Approximate minimum degree on all of Q: an order that is good for the whole is good enough for its parts, so weights
//! that are nonzero on a part of the mesh need no numbering of their own. Should there be no room for that, nested
//! dissection by position: A. George. *Nested dissection of a regular finite element mesh*. SIAM J. Numerical Analysis
//! 10(2), 1973. The vertices are halved across the longest side of their box; those of one half that Q ties to the other
//! half are numbered last.

use super::rings::Rings;
use crate::linalg::cholesky::minimum_degree;
use glam::DVec3;

/// Sets of so many vertices are not halved.
const SMALL: usize = 24;

/// Vertices in the order in which they are to be numbered.
///
/// `rings` are the neighbours of every vertex, `positions` #V points.
pub fn order(rings: &Rings, positions: &[DVec3]) -> Vec<u32> {
    let (starts, rows) = pattern(rings, positions.len());
    minimum_degree(&starts, &rows).unwrap_or_else(|| dissect(rings, positions))
}

/// The upper triangle of Q's pattern: for every vertex, those up to it within two edges. Where each one's list starts, and
/// the lists, ascending.
fn pattern(rings: &Rings, vertices: usize) -> (Vec<u32>, Vec<u32>) {
    let (mut starts, mut rows) = (vec![0], Vec::new());
    let mut near = Vec::new();
    for v in 0..vertices as u32 {
        near.clear();
        near.push(v);
        for &u in rings.of(v) {
            near.push(u);
            near.extend_from_slice(rings.of(u));
        }
        near.retain(|&u| u <= v);
        near.sort_unstable();
        near.dedup();
        rows.extend_from_slice(&near);
        starts.push(rows.len() as u32);
    }
    (starts, rows)
}

fn dissect(rings: &Rings, positions: &[DVec3]) -> Vec<u32> {
    let mut dissection = Dissection {
        positions,
        rings,
        side: vec![0; positions.len()],
        seen: vec![0; positions.len()],
        round: 0,
        order: Vec::with_capacity(positions.len()),
    };
    dissection.dissect((0..positions.len() as u32).collect());
    dissection.order
}

struct Dissection<'a> {
    positions: &'a [DVec3],
    rings: &'a Rings,
    /// Marks of the sets at hand.
    side: Vec<u32>,
    seen: Vec<u32>,
    round: u32,
    order: Vec<u32>,
}

impl Dissection<'_> {
    fn dissect(&mut self, mut set: Vec<u32>) {
        if set.len() <= SMALL {
            set.sort_unstable();
            self.order.extend(set);
            return;
        }
        let axis = self.longest_axis(&set);
        let middle = set.len() / 2;
        set.select_nth_unstable_by(middle, |&a, &b| {
            let (x, y) = (self.positions[a as usize][axis], self.positions[b as usize][axis]);
            x.total_cmp(&y).then(a.cmp(&b))
        });
        let far = set.split_off(middle);
        let separator = self.separator(&set, &far);
        set.retain(|v| separator.binary_search(v).is_err());
        self.dissect(set);
        self.dissect(far);
        self.order.extend(separator);
    }

    fn longest_axis(&self, set: &[u32]) -> usize {
        let points = || set.iter().map(|&v| self.positions[v as usize]);
        let size = points().fold(DVec3::NEG_INFINITY, DVec3::max) - points().fold(DVec3::INFINITY, DVec3::min);
        (0..3).fold(0, |longest, axis| if size[axis] > size[longest] { axis } else { longest })
    }

    /// The vertices of `near` within two edges of `far`, in ascending order.
    fn separator(&mut self, near: &[u32], far: &[u32]) -> Vec<u32> {
        self.round += 1;
        near.iter().for_each(|&v| self.side[v as usize] = self.round);
        let mut separator = Vec::new();
        for &v in far {
            let around = std::iter::once(v).chain(self.rings.of(v).iter().copied());
            for between in around {
                if std::mem::replace(&mut self.seen[between as usize], self.round) == self.round {
                    continue;
                }
                let reached = std::iter::once(between).chain(self.rings.of(between).iter().copied());
                for u in reached {
                    if self.side[u as usize] == self.round {
                        self.side[u as usize] = 0;
                        separator.push(u);
                    }
                }
            }
        }
        separator.sort_unstable();
        separator
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_vertex_gets_one_number() {
        let positions: Vec<DVec3> = (0..400).map(|i| DVec3::new(f64::from(i % 20), f64::from(i / 20), 0.0)).collect();
        let faces: Vec<[u32; 3]> = (0..379).filter(|i| i % 20 != 19).map(|i| [i, i + 1, i + 20]).collect();
        for (faces, positions) in [(&faces[..], &positions[..]), (&[], &[DVec3::ZERO; 100]), (&[], &[])] {
            let rings = Rings::new(faces, positions.len());
            for mut order in [order(&rings, positions), dissect(&rings, positions)] {
                order.sort_unstable();
                assert_eq!(order, (0..positions.len() as u32).collect::<Vec<_>>());
            }
        }
    }
}
