//! Rigid refinement (beyond the paper): a face at a boundary moves to the neighbouring part whose motion explains it
//! better over all poses; the motions are fitted again; and so on.

use super::clustering::absorb_fragments;
use super::motion::{self, FaceMotion};
use crate::mesh::DualGraph;
use std::collections::VecDeque;

/// A face moves only for an error smaller by this share, so that equals do not swap for ever.
const BETTER: f32 = 0.999;

/// Improves #F labels `0..parts` for at most `rounds` fits; stops when a round gains less than a thousandth. Every label
/// stays in one piece on each connected piece of the mesh. Every face counts alike.
pub fn refine(
    graph: &DualGraph,
    weights: &[f64],
    faces: &FaceMotion,
    labels: &mut Vec<u32>,
    parts: usize,
    rounds: usize,
) {
    let total = |labels: &[u32]| faces.moments(labels, parts).iter().map(motion::residual).sum::<f64>();
    let mut best = total(labels);
    for _ in 0..rounds {
        let mut next = labels.clone();
        sweep(graph, faces, &mut next, parts);
        absorb_fragments(graph, weights, &mut next);
        let residual = total(&next);
        if residual >= best || next == *labels {
            break;
        }
        let gain = best - residual;
        best = residual;
        *labels = next;
        if gain < 1e-3 * best {
            break;
        }
    }
}

/// Moves faces between fixed motions until none wants to; changes spread from the boundaries as far as they go.
fn sweep(graph: &DualGraph, faces: &FaceMotion, labels: &mut [u32], parts: usize) {
    let motions: Vec<_> = faces.moments(labels, parts).iter().map(motion::best_motion).collect();
    let mut size = vec![0usize; parts];
    labels.iter().for_each(|&l| size[l as usize] += 1);
    let mut queue: VecDeque<u32> = VecDeque::new();
    let mut waiting = vec![false; labels.len()];
    for edge in graph.edges() {
        let [a, b] = edge.faces;
        if labels[a as usize] != labels[b as usize] {
            for f in [a, b] {
                if !std::mem::replace(&mut waiting[f as usize], true) {
                    queue.push_back(f);
                }
            }
        }
    }
    while let Some(f) = queue.pop_front() {
        waiting[f as usize] = false;
        let own = labels[f as usize];
        if size[own as usize] == 1 {
            continue;
        }
        let mut choice = (BETTER * faces.error(&motions[own as usize], f), own);
        for (i, link) in graph.neighbours(f).iter().enumerate() {
            let other = labels[link.face as usize];
            let seen = graph.neighbours(f)[..i].iter().any(|l| labels[l.face as usize] == other);
            if other != own && !seen {
                let error = faces.error(&motions[other as usize], f);
                if error < choice.0 {
                    choice = (error, other);
                }
            }
        }
        if choice.1 != own {
            labels[f as usize] = choice.1;
            size[own as usize] -= 1;
            size[choice.1 as usize] += 1;
            for link in graph.neighbours(f) {
                if labels[link.face as usize] != choice.1 && !std::mem::replace(&mut waiting[link.face as usize], true)
                {
                    queue.push_back(link.face);
                }
            }
        }
    }
}
