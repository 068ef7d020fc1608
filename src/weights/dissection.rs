//! A numbering of the vertices for which Q, and Q restricted to any of them, has a sparse factor.
//!
//! Nested dissection by position: A. George. *Nested dissection of a regular finite element mesh*. SIAM J. Numerical
//! Analysis 10(2), 1973. The vertices are halved across the longest side of their box; those of one half that Q ties to
//! the other half are numbered last. What separates the whole separates every part, so weights that are nonzero on a part
//! of the mesh need no numbering of their own.

use super::rings::Rings;
use glam::DVec3;

/// Sets of so many vertices are not halved.
const SMALL: usize = 24;

/// Vertices in the order in which they are to be numbered.
///
/// `rings` are the neighbours of every vertex, `positions` #V points.
pub fn order(rings: &Rings, positions: &[DVec3]) -> Vec<u32> {
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
            let mut order = order(&Rings::new(faces, positions.len()), positions);
            order.sort_unstable();
            assert_eq!(order, (0..positions.len() as u32).collect::<Vec<_>>());
        }
    }
}
