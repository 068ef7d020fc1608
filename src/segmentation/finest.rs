//! The finest parts of the merge tree: the cells around the features, those that do not move rigidly cut in two again
//! and again. Whatever the thresholds of feature extraction were, every joint then lies between two finest parts.

use super::motion::{self, FaceMotion, PartMoments, PoseMoments};
use crate::mesh::DualGraph;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Rms distance from a rigid motion (at unit diagonal) that nobody would see: such a cell is left whole.
pub const RIGID: f64 = 1e-4;

/// Cuts the cells with the largest residual in two until there are `wanted` cells or all are rigid. `labels` are #F cell
/// numbers `0..cells`, each cell in one piece; new cells get numbers from `cells` on. Returns the moments of the cells.
pub fn split_cells(
    graph: &DualGraph,
    weights: &[f64],
    faces: &FaceMotion,
    labels: &mut [u32],
    cells: usize,
    wanted: usize,
) -> Vec<PartMoments> {
    let mut members = vec![Vec::new(); cells];
    for (f, &label) in labels.iter().enumerate() {
        members[label as usize].push(f as u32);
    }
    let mut moments = faces.weighted_moments(labels, cells);
    let mut heap = BinaryHeap::new();
    let urgency = |members: &[u32], moments: &PartMoments, cell: u32| {
        let residual = motion::residual(moments);
        let tolerance = RIGID * RIGID * members.len() as f64 * faces.pose_count() as f64;
        (members.len() > 1 && residual > tolerance).then_some((residual.to_bits(), Reverse(cell)))
    };
    heap.extend((0..cells).filter_map(|c| urgency(&members[c], &moments[c], c as u32)));
    let mut bisector =
        Bisector { graph, weights, distance: vec![f64::INFINITY; labels.len()], heap: BinaryHeap::new() };
    while members.len() < wanted {
        let Some((_, Reverse(cell))) = heap.pop() else { break };
        let old = std::mem::take(&mut members[cell as usize]);
        let (stay, leave) = bisector.bisect(&old, labels, cell, faces, &moments[cell as usize]);
        let fresh = members.len() as u32;
        for &f in &leave {
            labels[f as usize] = fresh;
        }
        for (number, own) in [(cell, stay), (fresh, leave)] {
            let mut sum = vec![PoseMoments::default(); faces.pose_count()];
            own.iter().for_each(|&f| faces.add_face(&mut sum, f));
            heap.extend(urgency(&own, &sum, number));
            if number == fresh {
                members.push(own);
                moments.push(sum);
            } else {
                members[number as usize] = own;
                moments[number as usize] = sum;
            }
        }
    }
    moments
}

/// Cuts one cell along the middle between its worst-explained face and the face farthest from that.
struct Bisector<'a> {
    graph: &'a DualGraph,
    weights: &'a [f64],
    distance: Vec<f64>,
    heap: BinaryHeap<(Reverse<u64>, Reverse<u32>)>,
}

impl Bisector<'_> {
    /// The faces that stay and those that leave; both sets connected and not empty (a cell has at least two faces).
    fn bisect(
        &mut self,
        members: &[u32],
        labels: &[u32],
        cell: u32,
        faces: &FaceMotion,
        moments: &PartMoments,
    ) -> (Vec<u32>, Vec<u32>) {
        let best = motion::best_motion(moments);
        let error = |f: u32| faces.error(&best, f);
        let worst = members.iter().copied().reduce(|a, b| if error(b) > error(a) { b } else { a }).unwrap_or(0);
        let from_worst = self.distances(members, labels, cell, worst);
        let far = (0..members.len()).fold(0, |best, i| if from_worst[i] > from_worst[best] { i } else { best });
        let from_far = self.distances(members, labels, cell, members[far]);
        let (mut stay, mut leave) = (Vec::new(), Vec::new());
        for (i, &f) in members.iter().enumerate() {
            if from_far[i] < from_worst[i] || i == far { stay.push(f) } else { leave.push(f) }
        }
        (stay, leave)
    }

    /// Shortest paths inside the cell from `start` to each member.
    fn distances(&mut self, members: &[u32], labels: &[u32], cell: u32, start: u32) -> Vec<f64> {
        for &f in members {
            self.distance[f as usize] = f64::INFINITY;
        }
        self.distance[start as usize] = 0.0;
        self.heap.push((Reverse(0), Reverse(start)));
        while let Some((Reverse(bits), Reverse(f))) = self.heap.pop() {
            let d = f64::from_bits(bits);
            if d > self.distance[f as usize] {
                continue;
            }
            for link in self.graph.neighbours(f) {
                let further = d + self.weights[link.edge as usize];
                if labels[link.face as usize] == cell && further < self.distance[link.face as usize] {
                    self.distance[link.face as usize] = further;
                    self.heap.push((Reverse(further.to_bits()), Reverse(link.face)));
                }
            }
        }
        members.iter().map(|&f| self.distance[f as usize]).collect()
    }
}
