//! Automatic extraction of feature faces (§3.2): the deformable set A, then, again and again, the face farthest from A,
//! its influence region, and the partition that the region founds or joins.

use super::average::{AverageGradient, average_gradient};
use super::gradients::Gradients;
use super::harmonic::Regions;
use super::shortest_paths::ShortestPaths;
use super::{Feature, SegmentationError};
use crate::mesh::DualGraph;
use crate::sequence::Pose;

/// Where extraction stops, whatever the stopping share of area: the merge tree has nothing to gain from more, and
/// clustering by the letter takes memory for faces × partitions.
const MOST_FEATURES: usize = 1000;

/// What extraction needs to know of the mesh.
pub struct Input<'a> {
    /// The dual graph.
    pub graph: &'a DualGraph,
    /// #E weights of Eq. 5.
    pub weights: &'a [f64],
    /// #F areas in the reference pose.
    pub areas: &'a [f64],
    /// Deformation gradients.
    pub gradients: &'a Gradients<'a>,
    /// The #T poses.
    pub poses: &'a [Pose],
}

/// The thresholds of §3.2.
#[derive(Clone, Copy, Debug)]
pub struct Thresholds {
    /// ε: a dual edge above it makes both its faces deformable.
    pub epsilon: f64,
    /// γ: regions whose average gradients differ by at most this join; `None`: every feature founds a partition.
    pub gamma: Option<f64>,
    /// The smallest region that goes on, as a share of the total area.
    pub min_area: f64,
    /// The harmonic value down to which a face belongs to a region.
    pub level: f64,
}

/// The features and the fields on the way to them.
#[derive(Clone, Debug)]
pub struct Features {
    /// #F: 1 where a face is in A at the start.
    pub deformable: Vec<u8>,
    /// #F distances from A at the start; infinite where no A is in reach.
    pub distance: Vec<f64>,
    /// The features in the order in which they were found.
    pub features: Vec<Feature>,
    /// Number of partitions.
    pub partitions: u32,
}

/// Step 1: faces with an edge of weight above ε.
pub fn deformable_faces(graph: &DualGraph, weights: &[f64], epsilon: f64) -> Vec<u8> {
    let mut deformable = vec![0; graph.face_count()];
    for (edge, &weight) in graph.edges().iter().zip(weights) {
        if weight > epsilon {
            for f in edge.faces {
                deformable[f as usize] = 1;
            }
        }
    }
    deformable
}

/// Steps 1 to 4. Every connected piece gets at least one feature, so that clustering can reach all its faces.
///
/// `keep_going` hears the share of faces that are settled and may stop the extraction.
pub fn extract(
    input: &Input<'_>,
    thresholds: Thresholds,
    keep_going: &mut dyn FnMut(f64) -> bool,
) -> Result<Features, SegmentationError> {
    let start = deformable_faces(input.graph, input.weights, thresholds.epsilon);
    let faces_of_a = |set: &[u8]| (0..set.len() as u32).filter(|&f| set[f as usize] != 0).collect::<Vec<_>>();
    let mut paths =
        ShortestPaths::from_sources(input.graph, input.weights, faces_of_a(&start).into_iter().map(|f| (f, 0)));
    let mut result =
        Features { distance: paths.distance.clone(), deformable: start.clone(), features: Vec::new(), partitions: 0 };
    let mut partitions = Partitions::default();
    let mut settled = start;
    let mut regions = Regions::new(input.graph, input.weights);
    let total: f64 = input.areas.iter().sum();
    let mut done = settled.iter().filter(|&&s| s != 0).count();

    while result.features.len() < MOST_FEATURES {
        if !keep_going(done as f64 / settled.len() as f64) {
            return Err(SegmentationError::Cancelled);
        }
        let Some(face) = farthest(&paths.distance, &settled) else { break };
        let out_of_reach = paths.distance[face as usize].is_infinite();
        let region = regions.around(face, &settled, thresholds.level);
        let area: f64 = region.iter().map(|&f| input.areas[f as usize]).sum();
        if area < thresholds.min_area * total && !out_of_reach && !result.features.is_empty() {
            break;
        }
        let partition = partitions.place(input, thresholds.gamma, &region);
        for &f in &region {
            settled[f as usize] = 1;
        }
        done += region.len();
        paths.lower(input.graph, input.weights, region.iter().map(|&f| (f, 0)));
        result.features.push(Feature { face, partition, region });
    }
    add_missing_pieces(input, &mut result, &mut partitions);
    result.partitions = partitions.count();
    Ok(result)
}

/// Step 2: the face outside A that is farthest from it, the lowest number among equals.
fn farthest(distance: &[f64], settled: &[u8]) -> Option<u32> {
    let mut best: Option<u32> = None;
    for (f, &d) in distance.iter().enumerate() {
        if settled[f] == 0 && best.is_none_or(|b| d > distance[b as usize]) {
            best = Some(f as u32);
        }
    }
    best
}

/// A piece that is deformable all over has no feature yet: it gets its largest face, and a partition of its own.
fn add_missing_pieces(input: &Input<'_>, result: &mut Features, partitions: &mut Partitions) {
    let (piece, count) = input.graph.pieces();
    let mut has_feature = vec![false; count];
    for feature in &result.features {
        has_feature[piece[feature.face as usize] as usize] = true;
    }
    let mut largest: Vec<Option<u32>> = vec![None; count];
    for (f, &p) in piece.iter().enumerate() {
        let slot = &mut largest[p as usize];
        if slot.is_none_or(|b| input.areas[f] > input.areas[b as usize]) {
            *slot = Some(f as u32);
        }
    }
    for face in (0..count).filter(|&p| !has_feature[p]).filter_map(|p| largest[p]) {
        let region = vec![face];
        let partition = partitions.place(input, None, &region);
        result.features.push(Feature { face, partition, region });
    }
}

/// Step 3: the partitions so far, each with the average gradients of the region that founded it.
#[derive(Default)]
struct Partitions {
    averages: Vec<Option<AverageGradient>>,
}

impl Partitions {
    /// The partition that a region joins: the one with the most similar average gradients, if they differ by at most
    /// γ in every pose, else a new one.
    fn place(&mut self, input: &Input<'_>, gamma: Option<f64>, region: &[u32]) -> u32 {
        let Some(gamma) = gamma else {
            self.averages.push(None);
            return self.count() - 1;
        };
        let average = average_gradient(input.gradients, input.areas, input.poses, region);
        let mut nearest: Option<(f64, usize)> = None;
        for (i, other) in self.averages.iter().enumerate() {
            let Some(other) = other else { continue };
            let difference = average.difference(other);
            if difference <= gamma && nearest.is_none_or(|(best, _)| difference < best) {
                nearest = Some((difference, i));
            }
        }
        match nearest {
            Some((_, i)) => i as u32,
            None => {
                self.averages.push(Some(average));
                self.count() - 1
            }
        }
    }

    fn count(&self) -> u32 {
        self.averages.len() as u32
    }
}
