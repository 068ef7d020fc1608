//! The merge tree (beyond the paper): from many small parts, again and again the two neighbours are joined whose union
//! moves most nearly as one rigid body. The whole tree is there at once, so that any number of parts is a cut through it.

use super::Merge;
use super::motion::{self, PartMoments};
use std::cmp::Reverse;
use std::collections::{BTreeSet, BinaryHeap};

/// A pair of parts that could be joined, cheapest first; the versions tell whether the price still holds.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Offer {
    cost: Reverse<u64>,
    parts: Reverse<(u32, u32)>,
    versions: (u32, u32),
}

/// Joins parts until no two that touch are left. `neighbours` are pairs of parts that touch; costs are the growth of the
/// summed squared residual.
pub fn build(mut moments: Vec<PartMoments>, neighbours: &[(u32, u32)]) -> Vec<Merge> {
    let parts = moments.len();
    let mut touching = vec![BTreeSet::new(); parts];
    for &(a, b) in neighbours {
        touching[a as usize].insert(b);
        touching[b as usize].insert(a);
    }
    let mut own: Vec<f64> = moments.iter().map(motion::residual).collect();
    let mut version = vec![0u32; parts];
    let mut heap = BinaryHeap::new();
    let offer = |moments: &[PartMoments], own: &[f64], version: &[u32], a: u32, b: u32| {
        let (a, b) = (a.min(b), a.max(b));
        let union = motion::union_residual(&moments[a as usize], &moments[b as usize]);
        // Never negative but for rounding; the bits of non-negative numbers are ordered like their values.
        let cost = (union - own[a as usize] - own[b as usize]).max(0.0);
        Offer {
            cost: Reverse(cost.to_bits()),
            parts: Reverse((a, b)),
            versions: (version[a as usize], version[b as usize]),
        }
    };
    for (a, set) in touching.iter().enumerate() {
        for &b in set.iter().filter(|&&b| b > a as u32) {
            heap.push(offer(&moments, &own, &version, a as u32, b));
        }
    }
    let mut merges = Vec::with_capacity(parts);
    while let Some(Offer { cost: Reverse(bits), parts: Reverse((into, from)), versions }) = heap.pop() {
        if versions != (version[into as usize], version[from as usize]) {
            continue;
        }
        let (i, f) = (into as usize, from as usize);
        merges.push(Merge { from, into, cost: f64::from_bits(bits) });
        let moved = std::mem::take(&mut moments[f]);
        motion::merge(&mut moments[i], &moved);
        own[i] = motion::residual(&moments[i]);
        version[i] += 1;
        version[f] = u32::MAX;
        let others = std::mem::take(&mut touching[f]);
        for other in others {
            touching[other as usize].remove(&from);
            if other != into {
                touching[other as usize].insert(into);
                touching[i].insert(other);
            }
        }
        for &other in &touching[i] {
            heap.push(offer(&moments, &own, &version, into, other));
        }
    }
    merges
}

/// The part that each of `finest` parts belongs to when the merges have left `wanted` parts (or as few as there can be),
/// numbered from 0 in the order of their lowest finest part; and how many parts that makes.
pub fn cut(finest: usize, merges: &[Merge], wanted: usize) -> (Vec<u32>, usize) {
    let count = finest.saturating_sub(merges.len().min(finest.saturating_sub(wanted.max(1))));
    let mut root: Vec<u32> = (0..finest as u32).collect();
    for merge in &merges[..finest - count] {
        root[merge.from as usize] = merge.into;
    }
    // `into` is always the lower number, so that one pass in order finds every root.
    for i in 0..finest {
        root[i] = root[root[i] as usize];
    }
    let mut part = vec![u32::MAX; finest];
    let mut next = 0;
    for i in 0..finest {
        let r = root[i] as usize;
        if part[r] == u32::MAX {
            part[r] = next;
            next += 1;
        }
        part[i] = part[r];
    }
    (part, count)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::segmentation::motion::PoseMoments;
    use glam::{DMat3, DVec3};

    /// Six points in a row; the last two turn about the fourth.
    fn arm() -> Vec<PartMoments> {
        let turn = DMat3::from_rotation_z(1.0);
        let joint = DVec3::new(3.5, 0.0, 0.0);
        (0..6)
            .map(|i| {
                let mut m = PoseMoments::default();
                for offset in [DVec3::Y, DVec3::Z, DVec3::NEG_Y] {
                    let p = DVec3::new(f64::from(i), 0.0, 0.0) + 0.3 * offset;
                    m.add(1.0, 1.0, p, if i > 3 { turn * (p - joint) + joint } else { p });
                }
                vec![m]
            })
            .collect()
    }

    #[test]
    fn the_joint_is_the_last_to_go() {
        let neighbours: Vec<_> = (0..5).map(|i| (i, i + 1)).collect();
        let merges = build(arm(), &neighbours);
        assert_eq!(merges.len(), 5);
        assert!(merges[..4].iter().all(|m| m.cost < 1e-6) && merges[4].cost > 0.1);
        assert_eq!(cut(6, &merges, 2), (vec![0, 0, 0, 0, 1, 1], 2));
        assert_eq!(cut(6, &merges, 6).0, [0, 1, 2, 3, 4, 5]);
        assert_eq!(cut(6, &merges, 1), (vec![0; 6], 1));
    }

    #[test]
    fn parts_that_do_not_touch_never_join() {
        let merges = build(arm(), &[(0, 1), (2, 3)]);
        assert_eq!(merges.len(), 2);
        assert_eq!(cut(6, &merges, 1).1, 4);
    }
}
