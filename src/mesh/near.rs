//! Which connected pieces of a mesh lie nearest to each other.

use super::DualGraph;
use super::groups::Groups;
use super::kd_tree::KdTree;
use glam::DVec3;

/// Faces of one piece that are asked for their nearest face on another piece; more are thinned out evenly.
const ASKED: usize = 400;

/// Pieces that are looked for around each, and how far away, in roots of its area.
const BESIDE: usize = 12;
const AROUND: f64 = 2.0;

/// No more pairs than this are looked for: of thousands of pieces fewer around each.
const MOST_BESIDE: usize = 12_000;

/// Faces of one cell, or of one piece, that are asked for a face of another piece against which they lie.
const FELT: usize = 30;

/// Pairs of faces that join all connected pieces into one: each piece to the piece nearest to it (by face centroids),
/// then the groups so made, until all hang together (Borůvka's minimum spanning tree). Empty for a mesh in one piece.
pub fn bridges(graph: &DualGraph, centroids: &[DVec3]) -> Vec<[u32; 2]> {
    let (piece, count) = graph.pieces();
    let mut bridges = Vec::new();
    if count < 2 {
        return bridges;
    }
    let mut faces_of = vec![Vec::new(); count];
    for (f, &p) in piece.iter().enumerate() {
        faces_of[p as usize].push(f as u32);
    }
    let tree = KdTree::of_points(centroids);
    let at = |face: u32| centroids[face as usize].to_array();
    let mut group = Groups::new(count);
    loop {
        let of_piece: Vec<u32> = (0..count as u32).map(|p| group.root(p)).collect();
        let labels = tree.labels(|face| of_piece[piece[face as usize] as usize]);
        let mut best: Vec<Option<(f64, [u32; 2])>> = vec![None; count];
        for (own, &g) in faces_of.iter().zip(&of_piece) {
            let best = &mut best[g as usize];
            let step = own.len().div_ceil(ASKED);
            for &f in own.iter().step_by(step) {
                let limit = best.map_or(f64::INFINITY, |(d, _)| d);
                if let Some((d, face)) = tree.nearest_other(limit, &at(f), &labels, g) {
                    *best = Some((d, [f, face]));
                }
            }
        }
        let before = bridges.len();
        for (_, pair) in best.into_iter().flatten() {
            let [a, b] = pair.map(|f| piece[f as usize]);
            if group.join(a, b) {
                bridges.push(pair);
            }
        }
        if bridges.len() == before || bridges.len() + 1 == count {
            break;
        }
    }
    bridges
}

/// Pairs of faces of each piece and up to a dozen of the nearest ones that are not far from it, for its size: the plates of an
/// armour that sit on one limb. `areas` are those of the faces. Empty for a mesh in one piece.
pub fn beside(graph: &DualGraph, centroids: &[DVec3], areas: &[f64]) -> Vec<[u32; 2]> {
    let (piece, count) = graph.pieces();
    if count < 2 {
        return Vec::new();
    }
    let mut faces_of = vec![Vec::new(); count];
    for (f, &p) in piece.iter().enumerate() {
        faces_of[p as usize].push(f as u32);
    }
    let tree = KdTree::of_points(centroids);
    let at = |face: u32| centroids[face as usize].to_array();
    let mut pairs = Vec::new();
    for (own, faces) in (0_u32..).zip(&faces_of) {
        let reach = AROUND * faces.iter().map(|&f| areas[f as usize]).sum::<f64>().sqrt();
        let mut known = vec![own];
        for _ in 0..(MOST_BESIDE / count).min(BESIDE) {
            let other = |face: u32| !known.contains(&piece[face as usize]);
            let nearest = faces.iter().step_by(faces.len().div_ceil(FELT)).fold((reach * reach, None), |best, &f| {
                tree.nearest_within(best.0, &at(f), other).map_or(best, |(d, face)| (d, Some([f, face])))
            });
            let Some(pair) = nearest.1 else { break };
            known.push(piece[pair[1] as usize]);
            pairs.push(pair);
        }
    }
    pairs
}

/// Pairs of faces of different pieces where the cells of a mesh lie against each other, as a sleeve lies on an arm: from
/// some faces of every cell, evenly thinned, the nearest face of another piece not farther than `reach` (a length, between
/// centroids). `cell` is #F cell numbers, each cell within one piece. Empty for a mesh in one piece.
pub fn contacts(graph: &DualGraph, centroids: &[DVec3], cell: &[u32], reach: f64) -> Vec<[u32; 2]> {
    let (piece, count) = graph.pieces();
    if count < 2 {
        return Vec::new();
    }
    let cells = cell.iter().max().map_or(0, |&m| m as usize + 1);
    let mut faces_of = vec![Vec::new(); cells];
    for (f, &c) in cell.iter().enumerate() {
        faces_of[c as usize].push(f as u32);
    }
    let tree = KdTree::of_points(centroids);
    let at = |face: u32| centroids[face as usize].to_array();
    let mut contacts = Vec::new();
    for own in &faces_of {
        for &f in own.iter().step_by(own.len().div_ceil(FELT).max(1)) {
            let other = |face: u32| piece[face as usize] != piece[f as usize];
            if let Some((_, face)) = tree.nearest_within(reach * reach, &at(f), other) {
                contacts.push([f, face]);
            }
        }
    }
    contacts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_what_lies_close_is_in_contact() {
        // Four single faces along a line, at 0, 1, 5 and 5.5, each a piece and a cell.
        let faces: Vec<[u32; 3]> = (0..4).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let centroids = [0.0, 1.0, 5.0, 5.5].map(|x| DVec3::new(x, 0.0, 0.0));
        let found = contacts(&DualGraph::new(&faces), &centroids, &[0, 1, 2, 3], 0.7);
        assert_eq!(found, [[2, 3], [3, 2]]);
    }

    #[test]
    fn pieces_hang_together_by_their_nearest_faces() {
        // Four single faces along a line, at 0, 1, 5 and 5.5.
        let faces: Vec<[u32; 3]> = (0..4).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let centroids = [0.0, 1.0, 5.0, 5.5].map(|x| DVec3::new(x, 0.0, 0.0));
        let mut found = bridges(&DualGraph::new(&faces), &centroids);
        found.iter_mut().for_each(|b| b.sort_unstable());
        found.sort_unstable();
        assert_eq!(found, [[0, 1], [1, 2], [2, 3]]);
    }
}
