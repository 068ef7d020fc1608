//! Face clustering (§3.3): every face goes to the partition with the smallest of its distance to the partition's
//! features and its average distance to the partition's faces (Eq. 7), again and again until none moves; partitions that
//! fall apart are split by their pieces and clustered again.

use super::averages::Averages;
use super::shortest_paths::{NONE, ShortestPaths};
use super::{Feature, SegmentationError};
use crate::mesh::DualGraph;

/// The paper saw fewer than 10 rounds; a cycle of states would never end.
const MOST_ROUNDS: usize = 30;

/// Splitting into pieces and clustering again settles within a few repeats.
const MOST_REPEATS: usize = 8;

/// #F partition numbers after every round of clustering; the last is the result, every partition in one piece.
#[derive(Clone, Debug)]
pub struct Clustering {
    /// The rounds.
    pub rounds: Vec<Vec<u32>>,
    /// Number of partitions of the last round.
    pub partitions: usize,
}

/// Eq. 6: every face goes to its nearest feature, each feature its own partition. One shortest-path search; partitions
/// are in one piece by construction.
pub fn nearest_features(graph: &DualGraph, weights: &[f64], features: &[Feature]) -> Clustering {
    let sources = features.iter().enumerate().map(|(i, feature)| (feature.face, i as u32));
    let mut labels = ShortestPaths::from_sources(graph, weights, sources).label;
    let partitions = compact(&mut labels);
    Clustering { rounds: vec![labels], partitions }
}

/// #F: whether the connected piece of a face has more than one feature. Where it has only one, there is nothing to
/// cluster, and a mesh of thousands of pieces does not need memory for faces × pieces.
pub fn contested(graph: &DualGraph, features: &[Feature]) -> Vec<bool> {
    let (piece, count) = graph.pieces();
    let mut features_on = vec![0; count];
    for feature in features {
        features_on[piece[feature.face as usize] as usize] += 1;
    }
    piece.iter().map(|&p| features_on[p as usize] > 1).collect()
}

/// Eq. 7 with the given way to average distances, on the faces that are [`contested`]; every other piece of the mesh is
/// a partition.
///
/// `keep_going` hears how far along it is (0 to 1) and may stop it.
pub fn cluster(
    graph: &DualGraph,
    weights: &[f64],
    features: &[Feature],
    contested: &[bool],
    averages: &mut dyn Averages,
    keep_going: &mut dyn FnMut(f64) -> bool,
) -> Result<Clustering, SegmentationError> {
    let taking_part = || features.iter().filter(|feature| contested[feature.face as usize]);
    let feature_faces: Vec<u32> = taking_part().map(|feature| feature.face).collect();
    let mut partition_of: Vec<u32> = taking_part().map(|feature| feature.partition).collect();
    compact(&mut partition_of);
    let mut rounds = Vec::new();
    for repeat in 0..MOST_REPEATS {
        let share = |x: f64| (repeat as f64 + x) / MOST_REPEATS as f64;
        let near = feature_distances(graph, weights, &feature_faces, &partition_of);
        let mut keep_going = |x| keep_going(share(x));
        iterate(&near, &feature_faces, &partition_of, contested, averages, &mut rounds, &mut keep_going)?;
        let labels = rounds.last().map_or(&[][..], Vec::as_slice);
        if !split_by_pieces(graph, labels, &feature_faces, &mut partition_of) {
            break;
        }
    }
    label_other_pieces(graph, &mut rounds);
    let mut labels = rounds.last().cloned().unwrap_or_default();
    absorb_fragments(graph, weights, &mut labels);
    let partitions = compact(&mut labels);
    if rounds.last() != Some(&labels) {
        rounds.push(labels);
    }
    Ok(Clustering { rounds, partitions })
}

/// Every piece that no partition was in reach of is a partition of its own.
fn label_other_pieces(graph: &DualGraph, rounds: &mut [Vec<u32>]) {
    let (piece, _) = graph.pieces();
    let first = rounds.iter().flatten().filter(|&&label| label != NONE).max().map_or(0, |&last| last + 1);
    for (f, label) in rounds.iter_mut().flat_map(|round| round.iter_mut().enumerate()) {
        if *label == NONE {
            *label = first + piece[f];
        }
    }
}

fn count(partition_of: &[u32]) -> usize {
    partition_of.iter().max().map_or(0, |&last| last as usize + 1)
}

/// For every partition, #F distances to the nearest of its features.
fn feature_distances(graph: &DualGraph, weights: &[f64], feature_faces: &[u32], partition_of: &[u32]) -> Vec<Vec<f32>> {
    let of_partition = |i: usize| {
        let own = feature_faces.iter().zip(partition_of).filter(move |&(_, &p)| p as usize == i);
        let paths = ShortestPaths::from_sources(graph, weights, own.map(|(&face, _)| (face, 0)));
        paths.distance.iter().map(|&d| d as f32).collect()
    };
    (0..count(partition_of)).map(of_partition).collect()
}

/// Assigns all contested faces until none moves or a state comes back; `near` are the [`feature_distances`].
fn iterate(
    near: &[Vec<f32>],
    feature_faces: &[u32],
    partition_of: &[u32],
    contested: &[bool],
    averages: &mut dyn Averages,
    rounds: &mut Vec<Vec<u32>>,
    keep_going: &mut dyn FnMut(f64) -> bool,
) -> Result<(), SegmentationError> {
    let (faces, partitions) = (contested.len(), near.len());
    // F_i = P_i at the start; the other faces belong to no partition yet.
    let mut labels = vec![NONE; faces];
    for (&face, &partition) in feature_faces.iter().zip(partition_of) {
        labels[face as usize] = partition;
    }
    let first = rounds.len();
    for round in 0..MOST_ROUNDS {
        let mut sub = |x: f64| keep_going((round as f64 + x) / MOST_ROUNDS as f64);
        averages.update(&labels, partitions, &mut sub)?;
        let mut row = vec![0.0; partitions];
        let mut nearest = |f: usize| -> u32 {
            averages.of(f as u32, &mut row);
            let mut best = (f32::INFINITY, NONE);
            for i in 0..partitions {
                let d = near[i][f].min(row[i]);
                if d < best.0 {
                    best = (d, i as u32);
                }
            }
            best.1
        };
        let next: Vec<u32> = contested.iter().enumerate().map(|(f, &c)| if c { nearest(f) } else { NONE }).collect();
        let settled = rounds[first..].contains(&next);
        labels.clone_from(&next);
        if settled {
            break;
        }
        rounds.push(next);
    }
    Ok(())
}

/// Gives the features of every piece of a partition that fell apart a partition of their own. False if none did.
fn split_by_pieces(graph: &DualGraph, labels: &[u32], feature_faces: &[u32], partition_of: &mut [u32]) -> bool {
    let (piece, _) = graph.pieces_where(|a, b| labels[a as usize] == labels[b as usize]);
    let mut keys: Vec<(u32, u32)> =
        partition_of.iter().zip(feature_faces).map(|(&partition, &face)| (partition, piece[face as usize])).collect();
    let key_of_feature = keys.clone();
    keys.sort_unstable();
    keys.dedup();
    let before = count(partition_of);
    for (partition, key) in partition_of.iter_mut().zip(key_of_feature) {
        *partition = keys.partition_point(|k| *k < key) as u32;
    }
    keys.len() > before
}

/// On each connected piece of the mesh, the largest piece of every label stays and its other pieces join the neighbour
/// across their cheapest edge (as soon as that is one that stays), until every label is in one piece there.
pub fn absorb_fragments(graph: &DualGraph, weights: &[f64], labels: &mut [u32]) {
    let (component, _) = graph.pieces();
    loop {
        let (piece, count) = graph.pieces_where(|a, b| labels[a as usize] == labels[b as usize]);
        let mut size = vec![0usize; count];
        let mut label = vec![NONE; count];
        let mut place = vec![0; count];
        for (f, &p) in piece.iter().enumerate() {
            size[p as usize] += 1;
            label[p as usize] = labels[f];
            place[p as usize] = component[f];
        }
        let mut order: Vec<usize> = (0..count).collect();
        order.sort_by_key(|&p| (label[p], place[p], std::cmp::Reverse(size[p])));
        let mut is_fragment = vec![false; count];
        for pair in order.windows(2) {
            is_fragment[pair[1]] = label[pair[0]] == label[pair[1]] && place[pair[0]] == place[pair[1]];
        }
        let mut target: Vec<Option<(f64, u32)>> = vec![None; count];
        for (edge, &w) in graph.edges().iter().zip(weights) {
            let [a, b] = edge.faces.map(|f| piece[f as usize]);
            for (from, to) in [(a, b), (b, a)] {
                let better = target[from as usize].is_none_or(|(best, _)| w < best);
                if from != to && is_fragment[from as usize] && !is_fragment[to as usize] && better {
                    target[from as usize] = Some((w, label[to as usize]));
                }
            }
        }
        let mut changed = false;
        for (f, &p) in piece.iter().enumerate() {
            if let Some((_, to)) = target[p as usize] {
                labels[f] = to;
                changed = true;
            }
        }
        if !changed {
            return;
        }
    }
}

/// Numbers the labels in use from 0 in the order of their first faces; returns how many there are. Faces without a label
/// ([`NONE`]) get labels of their own, one for all of them.
pub fn compact(labels: &mut [u32]) -> usize {
    let mut new = std::collections::BTreeMap::new();
    for label in labels.iter_mut() {
        let next = new.len() as u32;
        *label = *new.entry(*label).or_insert(next);
    }
    new.len()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::mesh::DualEdge;

    #[test]
    fn a_label_may_have_one_piece_on_every_piece_of_the_mesh() {
        // A chain of six faces and a chain of four: a body and a garment.
        let links = [0, 1, 2, 3, 4, 6, 7, 8];
        let edges = links.map(|i| DualEdge { faces: [i, i + 1], vertices: [0, 1] }).to_vec();
        let graph = DualGraph::from_edges(10, edges);
        let weights = [1.0; 8];
        let worn = [0, 0, 0, 0, 1, 1, 0, 0, 1, 1];
        let mut labels = worn;
        absorb_fragments(&graph, &weights, &mut labels);
        assert_eq!(labels, worn);
        let mut labels = [0, 0, 0, 1, 0, 0, 0, 1, 0, 0];
        absorb_fragments(&graph, &weights, &mut labels);
        assert_eq!(labels, [0, 0, 0, 1, 1, 1, 1, 1, 0, 0]);
    }
}
