//! The steps in their order, and what is kept between two cuts through the merge tree.

use super::averages::{Exact, Landmarks};
use super::clustering::{self, Clustering};
use super::deformation::{self, Deformation, Scale};
use super::features::{self, Features, Thresholds};
use super::geometry::{Geometry, unit_scale};
use super::gradients::Gradients;
use super::motion::{self, FaceMotion};
use super::statistics::quantile;
use super::{Feature, Merge, Method, Parameters, Part, Segmentation, SegmentationError, Smoothing, Steps};
use super::{choice, finest, merge_tree, refinement, smoothing};
use crate::clock;
use crate::mesh::DualGraph;
use crate::observer::Observer;
use crate::sequence::Sequence;
use crate::stopwatch::Stopwatch;
use crate::warning::Warning;

/// Finest parts of the merge tree: enough that every joint lies between two of them.
const FINEST: usize = 240;

/// Pieces beyond which no room is made for the cutting of the others.
const MOST_PIECES: usize = 1000;

/// Faces of different pieces whose centroids are closer than this (at unit diagonal) lie against each other.
const CONTACT: f64 = 0.02;

/// Landmark faces that stand for all faces in the averages of Eq. 7.
const LANDMARKS: usize = 64;

/// ε of the default: this share of dual edges is not deformable.
const RIGID_EDGES: f64 = 0.8;

/// ε and γ of the paper's method, in the middle of their ranges.
const PAPER_EPSILON: f64 = 0.5;
const PAPER_GAMMA: f64 = 0.8;

/// Rounds of rigid refinement of one cut through the tree.
const REFINEMENTS: usize = 12;

/// How strongly rigidity holds a boundary against smoothing at first, how often the hold is tightened, and the growth of
/// the residual that smoothing may cost.
const PULL: f64 = 50.0;
const TIGHTER: f64 = 4.0;
const TRIES: usize = 4;
const SMOOTHING_COST: f64 = 1.08;

/// Everything of a segmentation that does not depend on the number of parts.
pub struct Segmenter {
    parameters: Parameters,
    geometry: Geometry,
    weights: Vec<f64>,
    deformation: Vec<f64>,
    faces: FaceMotion,
    /// The unit of the steps over the diagonal, in which results are stated: less than 1 where there is a backdrop.
    unit: f64,
    finest: Finest,
    steps: Steps,
    warnings: Vec<Warning>,
    seconds: Vec<(&'static str, f64)>,
}

/// The parts that cuts through the merge tree are made of.
struct Finest {
    /// #F numbers of finest parts.
    labels: Vec<u32>,
    /// How many there are.
    count: usize,
    /// Their summed squared residual, at unit diagonal.
    residual: f64,
}

impl Segmenter {
    /// Runs every step up to the merge tree (or, by the paper's letter, up to the clustering).
    pub fn new(
        sequence: &Sequence,
        parameters: &Parameters,
        observer: &mut dyn Observer,
    ) -> Result<Self, SegmentationError> {
        parameters.check()?;
        if sequence.faces().is_empty() {
            return Err(SegmentationError::NoFaces);
        }
        let mut watch = Stopwatch::new(observer);
        watch.begin("dual graph", 0.0)?;
        let scale = unit_scale(sequence);
        let geometry = Geometry::new(sequence, scale);
        let graph = &geometry.graph;

        watch.begin("deformation", 0.05)?;
        let gradients = Gradients::new(sequence.faces(), sequence.reference(), scale, graph);
        let mut faces = FaceMotion::new(sequence, graph, scale);
        let Deformation { distances, stretch } =
            deformation_over_poses(sequence, &geometry, &gradients, &faces, &mut watch)?;
        faces.weigh(deformation::rigidity(&stretch));
        let weights = deformation::edge_weights(&geometry.geodesic, &distances, parameters.delta, scale_of(parameters));

        watch.begin("feature faces", 0.3)?;
        let thresholds = thresholds(parameters, &weights);
        let (areas, poses) = (&geometry.areas, sequence.poses());
        let input = features::Input { graph, weights: &weights, areas, gradients: &gradients, poses };
        let Features { deformable, distance, features, .. } =
            features::extract(&input, thresholds, &mut |done| watch.tell(0.3 + 0.25 * done).is_ok())?;

        watch.begin("clustering", 0.55)?;
        let mut keep_going = |done: f64| watch.tell(0.55 + 0.25 * done).is_ok();
        let Clustering { mut rounds, partitions } = clusters(parameters, graph, &weights, &features, &mut keep_going)?;

        watch.begin("merge tree", 0.8)?;
        let labels = rounds.last().cloned().unwrap_or_default();
        let (finest, merges) = match parameters.method {
            Method::Paper => (Finest { labels, count: partitions, residual: 0.0 }, Vec::new()),
            Method::Tree => grow_tree(&geometry, &weights, &faces, labels, partitions),
        };
        let seconds = watch.stop();
        if parameters.method == Method::Tree {
            rounds.push(finest.labels.clone());
        }
        let steps = Steps {
            deformation: face_maximum(graph, &distances),
            weight: face_maximum(graph, &weights),
            deformable,
            epsilon: thresholds.epsilon,
            gamma: thresholds.gamma.unwrap_or(0.0),
            distance,
            features,
            rounds,
            merges,
            unsmoothed: Vec::new(),
            band: Vec::new(),
        };
        let warnings = warnings(sequence, gradients.degenerate());
        let parameters = parameters.clone();
        let unit = if sequence.diagonal() > 0.0 { sequence.acting_diagonal() / sequence.diagonal() } else { 1.0 };
        Ok(Self {
            parameters,
            geometry,
            weights,
            deformation: distances,
            faces,
            unit,
            finest,
            steps,
            warnings,
            seconds,
        })
    }

    /// #E pairs of neighbouring faces, and the weight (Eq. 5) of the dual edge between them.
    pub fn dual_edges(&self) -> impl Iterator<Item = ([u32; 2], f64)> {
        self.geometry.graph.edges().iter().zip(&self.weights).map(|(edge, &weight)| (edge.faces, weight))
    }

    /// The merges of the tree, cheapest first.
    pub fn merges(&self) -> &[Merge] {
        &self.steps.merges
    }

    /// The segmentation into the given number of parts, or into as many as the costs of the merge tree suggest.
    pub fn segmentation(&self, parts: Option<usize>) -> Segmentation {
        let mut seconds = self.seconds.clone();
        let started = clock::seconds();
        let mut labels = self.finest.labels.clone();
        let mut count = self.finest.count;
        let mut warnings = self.warnings.clone();
        if self.parameters.method == Method::Tree {
            let wanted = parts.unwrap_or_else(|| self.best_number_of_parts());
            let (part_of, n) = merge_tree::cut(self.finest.count, &self.steps.merges, wanted);
            labels.iter_mut().for_each(|l| *l = part_of[*l as usize]);
            count = n;
            if n < wanted {
                let message = format!("{wanted} parts were asked for; this mesh is cut into {n} at the most.");
                warnings.push(Warning::new("fewer-parts", message));
            }
            refinement::refine(&self.geometry.graph, &self.weights, &self.faces, &mut labels, count, REFINEMENTS);
        }
        let refined = clock::seconds();
        seconds.push(("refinement", refined - started));
        let unsmoothed = labels.clone();
        let residual_before_smoothing = self.residual(&labels, count);
        let band = self.smooth(&mut labels, count, residual_before_smoothing);
        count = clustering::compact(&mut labels);
        seconds.push(("smoothing", clock::seconds() - refined));
        let steps = Steps { unsmoothed, band, ..self.steps.clone() };
        Segmentation {
            parts: self.parts(&labels, count),
            rigid_residual: self.unit * self.residual(&labels, count),
            residual_before_smoothing: self.unit * residual_before_smoothing,
            labels,
            steps,
            warnings,
            seconds,
        }
    }

    /// The number of parts that the costs of the merge tree suggest.
    fn best_number_of_parts(&self) -> usize {
        let (_, pieces) = self.geometry.graph.pieces();
        let sizes = [self.faces.face_count(), self.faces.pose_count(), pieces];
        choice::number_of_parts(&self.steps.merges, self.finest.residual, sizes)
    }

    /// Smooths the boundaries; by default with a hold that is tightened until smoothing costs little rigidity. Returns
    /// the band in which they could move.
    fn smooth(&self, labels: &mut Vec<u32>, parts: usize, before: f64) -> Vec<u8> {
        let mut band = vec![0; labels.len()];
        if self.parameters.smoothing == Smoothing::None {
            return band;
        }
        let input = smoothing::Input { geometry: &self.geometry, deformation: &self.deformation, faces: &self.faces };
        let capacity = smoothing::capacities(&input, self.parameters.alpha, self.parameters.smoothing);
        let smoothed = |pull: f64| {
            let mut result = labels.clone();
            let band = smoothing::smooth(&input, &capacity, &mut result, parts, pull);
            clustering::absorb_fragments(&self.geometry.graph, &self.weights, &mut result);
            (result, band)
        };
        if self.parameters.method == Method::Paper {
            (*labels, band) = smoothed(0.0);
            return band;
        }
        let mut pull = PULL;
        for _ in 0..TRIES {
            let result;
            (result, band) = smoothed(pull);
            if self.residual(&result, parts) <= SMOOTHING_COST * before + finest::RIGID {
                *labels = result;
                break;
            }
            pull *= TIGHTER;
        }
        band
    }

    /// Rms distance of face centroids from their parts' best rigid motions, over faces and poses, at unit diagonal.
    fn residual(&self, labels: &[u32], parts: usize) -> f64 {
        let sum = self.faces.moments(labels, parts).iter().map(motion::residual).sum();
        rms(sum, labels.len(), self.faces.pose_count())
    }

    fn parts(&self, labels: &[u32], count: usize) -> Vec<Part> {
        let total: f64 = self.geometry.areas.iter().sum();
        let mut parts = vec![Part { faces: 0, area: 0.0, residual: 0.0 }; count];
        for (&label, &area) in labels.iter().zip(&self.geometry.areas) {
            let part = &mut parts[label as usize];
            part.faces += 1;
            part.area += if total > 0.0 { area / total } else { 0.0 };
        }
        for (part, moments) in parts.iter_mut().zip(self.faces.moments(labels, count)) {
            part.residual = self.unit * rms(motion::residual(&moments), part.faces, self.faces.pose_count());
        }
        parts
    }
}

/// Eq. 4 over all poses.
fn deformation_over_poses(
    sequence: &Sequence,
    geometry: &Geometry,
    gradients: &Gradients<'_>,
    faces: &FaceMotion,
    watch: &mut Stopwatch<'_>,
) -> Result<Deformation, SegmentationError> {
    let mut deformation = Deformation::new(&geometry.graph);
    let poses = sequence.poses();
    for (t, pose) in poses.iter().enumerate() {
        watch.tell(0.05 + 0.25 * t as f64 / poses.len() as f64)?;
        let m = gradients.all(&pose.positions);
        deformation.add_pose(&m, |f| faces.sizes(f)[t], &geometry.graph, &geometry.geodesic);
    }
    Ok(deformation)
}

fn scale_of(parameters: &Parameters) -> Scale {
    match parameters.method {
        Method::Paper => Scale::Mean,
        Method::Tree => Scale::Winsorised,
    }
}

/// The thresholds that were asked for, else those of the method.
fn thresholds(parameters: &Parameters, weights: &[f64]) -> Thresholds {
    let (epsilon, gamma) = match parameters.method {
        Method::Paper => (PAPER_EPSILON, Some(PAPER_GAMMA)),
        Method::Tree => (quantile(weights, RIGID_EDGES), None),
    };
    Thresholds {
        epsilon: parameters.epsilon.unwrap_or(epsilon),
        gamma: parameters.gamma.or(gamma),
        min_area: parameters.min_area,
        level: parameters.harmonic_level,
    }
}

/// §3.3: Eq. 7 by the paper's letter, or where exact averages are asked for; else Eq. 6, which the merge tree mends.
fn clusters(
    parameters: &Parameters,
    graph: &DualGraph,
    weights: &[f64],
    features: &[Feature],
    keep_going: &mut dyn FnMut(f64) -> bool,
) -> Result<Clustering, SegmentationError> {
    let contested = clustering::contested(graph, features);
    if parameters.exact {
        clustering::cluster(graph, weights, features, &contested, &mut Exact::new(graph, weights), keep_going)
    } else if parameters.method == Method::Paper {
        let mut averages = Landmarks::new(graph, weights, &contested, LANDMARKS);
        clustering::cluster(graph, weights, features, &contested, &mut averages, keep_going)
    } else {
        Ok(clustering::nearest_features(graph, weights, features))
    }
}

/// Cuts the `partitions` under #F `labels` into finest parts and builds the merge tree over them.
fn grow_tree(
    geometry: &Geometry,
    weights: &[f64],
    faces: &FaceMotion,
    mut labels: Vec<u32>,
    partitions: usize,
) -> (Finest, Vec<Merge>) {
    let graph = &geometry.graph;
    // A piece needs no cutting to be a cell; what is cut is what many small pieces would otherwise leave no room for.
    let (_, pieces) = graph.pieces();
    let wanted = FINEST + (pieces - 1).min(MOST_PIECES);
    let moments = finest::split_cells(graph, weights, faces, &mut labels, partitions, wanted);
    let (count, residual) = (moments.len(), moments.iter().map(motion::residual).sum());
    let mut pairs = graph.touching(&labels);
    // Pieces that share no edge may join the nearest (eyes in a head, the links of a robot) and what they lie against
    // (a sleeve on an arm), and small ones those around them (the plates of an armour).
    let near = geometry.bridges().into_iter().chain(geometry.beside()).chain(geometry.contacts(&labels, CONTACT));
    pairs.extend(near.map(|pair| pair.map(|f| labels[f as usize])).map(|[a, b]| (a, b)));
    let merges = merge_tree::build(moments, &pairs);
    (Finest { labels, count, residual }, merges)
}

fn warnings(sequence: &Sequence, degenerate: &[u32]) -> Vec<Warning> {
    let mut warnings = Vec::new();
    if sequence.poses().is_empty() {
        warnings.push(Warning::new("no-poses", "This mesh does not move, so all of it is one rigid part."));
    }
    if !degenerate.is_empty() {
        let message = match degenerate.len() {
            1 => "1 face has no area; it takes the deformation of its nearest neighbour.".to_owned(),
            n => format!("{n} faces have no area; each takes the deformation of its nearest neighbour."),
        };
        warnings.push(Warning::on_faces("degenerate-faces", message, degenerate.to_vec()));
    }
    warnings
}

fn rms(sum: f64, faces: usize, poses: usize) -> f64 {
    (sum / (faces * poses).max(1) as f64).sqrt()
}

/// #F: the largest of the values of a face's dual edges.
fn face_maximum(graph: &DualGraph, values: &[f64]) -> Vec<f64> {
    (0..graph.face_count() as u32)
        .map(|f| graph.neighbours(f).iter().map(|link| values[link.edge as usize]).fold(0.0, f64::max))
        .collect()
}
