//! Candidates for key points: farthest point sampling (§3.1).
//!
//! Yuval Eldar, Michael Lindenbaum, Moshe Porat, Yehoshua Y. Zeevi. The farthest point strategy for progressive image
//! sampling. IEEE Transactions on Image Processing 6(9), 1997.

use super::welded::WeldedSequence;
use crate::mesh::paths::{Graph, Paths};
use glam::DVec3;

/// Times that the farthest vertex is sought, at most; three are usual.
const SWEEPS: usize = 6;

/// Ends of limbs that are tried as ends of the longest path.
const LIMBS: usize = 6;

/// Candidates in the order in which they are found, as vertices of the surface.
///
/// The first is an end of the longest path over the largest piece, as far as it is found ([`end`]) from the vertex farthest
/// from the middle, or for `seed` other than 0 from any vertex: nearly every seed ends at the same place, and with the
/// same candidates. Then every piece gets one, the largest first, and then whatever vertex is farthest along the surface.
/// If pieces alone take more than half of `count`, more candidates are added, so that the largest still get half of
/// `count` by distance.
pub fn candidates(surface: &WeldedSequence, graph: &Graph, count: usize, seed: u64) -> Vec<u32> {
    let pieces = &surface.pieces;
    let mut paths = Paths::new(graph);
    let mut found = Vec::new();
    for (number, piece) in pieces.iter().take(count).enumerate() {
        let mut start = farthest_from_the_middle(piece, &surface.reference);
        if number == 0 {
            if seed != 0 {
                start = piece[(scrambled(seed) % piece.len() as u64) as usize];
            }
            start = end(surface, graph, start);
        }
        paths.add(graph, start, found.len() as u32);
        found.push(start);
    }
    let wanted = count.max((count / 2 + found.len()).min(count + count / 2));
    while found.len() < wanted {
        let farther = |best: Option<(f64, u32)>, &v: &u32| {
            let d = paths.distance[v as usize];
            if d.is_finite() && best.is_none_or(|b| d > b.0) { Some((d, v)) } else { best }
        };
        match surface.used.iter().fold(None, farther) {
            Some((d, v)) if d > 0.0 => {
                paths.add(graph, v, found.len() as u32);
                found.push(v);
            }
            _ => break,
        }
    }
    found
}

/// One end of the longest path that is found: the end that is farther from the middle of all.
///
/// From a vertex to the farthest, again and again, leads to a path that cannot be made longer at one end. Of a body with
/// limbs there are several, nearly as long as each other; so vertices that are far from all ends so far are tried, too.
fn end(surface: &WeldedSequence, graph: &Graph, from: u32) -> u32 {
    let mut longest = Path { ends: [from, from], length: 0.0 };
    for _ in 0..SWEEPS {
        let next = Path::from(longest.ends[1], &Paths::from(graph, longest.ends[1]).distance);
        if next.length <= longest.length {
            break;
        }
        longest = next;
    }
    let mut nearest = Paths::from(graph, longest.ends[0]);
    nearest.add(graph, longest.ends[1], 1);
    let mut nearest = nearest.distance;
    for _ in 0..LIMBS {
        let limb = Path::from(from, &nearest).ends[1];
        let distance = Paths::from(graph, limb).distance;
        nearest.iter_mut().zip(&distance).for_each(|(nearest, &d)| *nearest = d.min(*nearest));
        let path = Path::from(limb, &distance);
        if path.length > longest.length {
            longest = path;
        }
    }
    let middle = surface.reference.iter().sum::<DVec3>() / surface.reference.len().max(1) as f64;
    let far = |v: u32| surface.reference[v as usize].distance_squared(middle);
    let [a, b] = longest.ends;
    if far(b).total_cmp(&far(a)).then(a.cmp(&b)).is_gt() { b } else { a }
}

/// A path along the surface.
struct Path {
    ends: [u32; 2],
    length: f64,
}

impl Path {
    /// The path to the farthest vertex, given the paths' lengths to all.
    fn from(from: u32, distance: &[f64]) -> Self {
        let reached = distance.iter().enumerate().filter(|(_, d)| d.is_finite());
        let (to, length) = reached.fold((from, 0.0), |best, (v, &d)| if d > best.1 { (v as u32, d) } else { best });
        Self { ends: [from, to], length }
    }
}

fn farthest_from_the_middle(piece: &[u32], points: &[DVec3]) -> u32 {
    let middle = piece.iter().map(|&v| points[v as usize]).sum::<DVec3>() / piece.len().max(1) as f64;
    let farther = |best: (f64, u32), &v: &u32| {
        let d = points[v as usize].distance_squared(middle);
        if d > best.0 { (d, v) } else { best }
    };
    piece.iter().fold((-1.0, piece.first().copied().unwrap_or(0)), farther).1
}

/// A number that tells nothing of its neighbours (the finaliser of splitmix64).
fn scrambled(seed: u64) -> u64 {
    let mut z = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15);
    z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    z ^ (z >> 31)
}
