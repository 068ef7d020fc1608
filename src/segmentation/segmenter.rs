//! The steps in their order, and what is kept between two cuts through the merge tree.

use super::averages::{Averages, Exact, Landmarks};
use super::clustering::{self, Clustering};
use super::deformation::{self, Deformation, Scale};
use super::features::{self, Features, Thresholds};
use super::gradients::Gradients;
use super::motion::{self, FaceMotion};
use super::smoothing;
use super::{Merge, Method, Parameters, Part, Segmentation, SegmentationError, Smoothing, Steps};
use super::{choice, finest, merge_tree, refinement};
use crate::clock;
use crate::mesh::{DualGraph, face, near, weld};
use crate::observer::Observer;
use crate::sequence::Sequence;
use crate::warning::Warning;
use glam::DVec3;

/// Finest parts of the merge tree: enough that every joint lies between two of them.
const FINEST: usize = 240;

/// Vertices that stay closer than this (at unit diagonal) in every pose are one point of the surface.
const SEAM: f64 = 1e-7;

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
const PULL: f64 = 30.0;
const TIGHTER: f64 = 4.0;
const TRIES: usize = 4;
const SMOOTHING_COST: f64 = 1.08;

/// Everything of a segmentation that does not depend on the number of parts.
pub struct Segmenter {
    parameters: Parameters,
    graph: DualGraph,
    weights: Vec<f64>,
    deformation: Vec<f64>,
    geodesic: Vec<f64>,
    edge_length: Vec<f64>,
    areas: Vec<f64>,
    faces: FaceMotion,
    finest: Vec<u32>,
    finest_count: usize,
    base: f64,
    steps: Steps,
    warnings: Vec<Warning>,
    seconds: Vec<(&'static str, f64)>,
}

/// Tells the observer how far along a run is, and the seconds of its steps apart.
struct Stopwatch<'a> {
    observer: &'a mut dyn Observer,
    seconds: Vec<(&'static str, f64)>,
    stage: &'static str,
    started: f64,
}

impl<'a> Stopwatch<'a> {
    fn new(observer: &'a mut dyn Observer) -> Self {
        Self { observer, seconds: Vec::new(), stage: "", started: clock::seconds() }
    }

    /// Ends the step before and begins the next, `done` of the whole being behind it.
    fn begin(&mut self, stage: &'static str, done: f64) -> Result<(), SegmentationError> {
        self.end();
        self.stage = stage;
        self.tell(done)
    }

    fn tell(&mut self, done: f64) -> Result<(), SegmentationError> {
        if self.observer.progress(self.stage, done) { Ok(()) } else { Err(SegmentationError::Cancelled) }
    }

    fn end(&mut self) {
        let now = clock::seconds();
        if !self.stage.is_empty() {
            self.seconds.push((self.stage, now - self.started));
        }
        self.started = now;
    }
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
        let paper = parameters.method == Method::Paper;
        let mut watch = Stopwatch::new(observer);
        watch.begin("dual graph", 0.0)?;
        let diagonal = sequence.diagonal();
        let scale = if diagonal > 0.0 { 1.0 / diagonal } else { 1.0 };
        let reference: Vec<DVec3> = sequence.reference().iter().map(|&p| p * scale).collect();
        let graph = DualGraph::new(&joined_faces(sequence, diagonal));
        let areas = face::areas(sequence.faces(), &reference);
        let geodesic = graph.geodesic_lengths(sequence.faces(), &reference);
        let edge_length = graph.shared_lengths(&reference);

        watch.begin("deformation", 0.05)?;
        let gradients = Gradients::new(sequence.faces(), &reference, &graph);
        // Gradients relate poses at unit diagonal to the reference at unit diagonal.
        let scaled: Vec<Vec<DVec3>> =
            sequence.poses().iter().map(|pose| pose.positions.iter().map(|&p| p * scale).collect()).collect();
        let poses: Vec<&[DVec3]> = scaled.iter().map(Vec::as_slice).collect();
        let mut deformation = Deformation::new(&graph);
        for (t, positions) in poses.iter().enumerate() {
            watch.tell(0.05 + 0.25 * t as f64 / poses.len() as f64)?;
            deformation.add_pose(&gradients, &graph, &geodesic, positions);
        }
        let Deformation { distances, stretch } = deformation;
        let kind = if paper { Scale::Mean } else { Scale::Winsorised };
        let weights = deformation::edge_weights(&geodesic, &distances, parameters.delta, kind);

        watch.begin("feature faces", 0.3)?;
        let epsilon = parameters
            .epsilon
            .unwrap_or_else(|| if paper { PAPER_EPSILON } else { deformation::quantile(&weights, RIGID_EDGES) });
        let gamma = parameters.gamma.or(paper.then_some(PAPER_GAMMA));
        let thresholds = Thresholds { epsilon, gamma, min_area: parameters.min_area, level: parameters.harmonic_level };
        let input =
            features::Input { graph: &graph, weights: &weights, areas: &areas, gradients: &gradients, poses: &poses };
        let Features { deformable, distance, features, .. } =
            features::extract(&input, thresholds, &mut |done| watch.tell(0.3 + 0.25 * done).is_ok())?;

        watch.begin("clustering", 0.55)?;
        let mut keep_going = |done: f64| watch.tell(0.55 + 0.25 * done).is_ok();
        let Clustering { rounds, partitions } = if paper || parameters.exact {
            let mut averages: Box<dyn Averages> = if parameters.exact {
                Box::new(Exact::new(&graph, &weights))
            } else {
                Box::new(Landmarks::new(&graph, &weights, LANDMARKS))
            };
            clustering::cluster(&graph, &weights, &features, averages.as_mut(), &mut keep_going)?
        } else {
            clustering::nearest_features(&graph, &weights, &features)
        };

        watch.begin("merge tree", 0.8)?;
        let faces = FaceMotion::new(sequence, scale, deformation::rigidity(&stretch));
        let mut finest_labels = rounds.last().cloned().unwrap_or_default();
        let (merges, finest_count, base) = if paper {
            (Vec::new(), partitions, 0.0)
        } else {
            let moments = finest::split_cells(&graph, &weights, &faces, &mut finest_labels, partitions, FINEST);
            let (count, base) = (moments.len(), moments.iter().map(motion::residual).sum());
            let mut pairs = touching(&graph, &finest_labels);
            // Pieces that do not touch (eyes in a head, the links of a robot) may join the piece that is nearest.
            let bridges = near::bridges(&graph, &face::centroids(sequence.faces(), &reference));
            pairs.extend(bridges.iter().map(|b| b.map(|f| finest_labels[f as usize])).map(|[a, b]| (a, b)));
            (merge_tree::build(moments, &pairs), count, base)
        };
        watch.end();
        let mut steps = Steps {
            deformation: face_maximum(&graph, &distances),
            weight: face_maximum(&graph, &weights),
            deformable,
            epsilon,
            gamma: gamma.unwrap_or(0.0),
            distance,
            features,
            rounds,
            merges,
            unsmoothed: Vec::new(),
        };
        if !paper {
            steps.rounds.push(finest_labels.clone());
        }
        let mut warnings = Vec::new();
        if sequence.poses().is_empty() {
            warnings.push(Warning::new("no-poses", "This mesh does not move, so all of it is one rigid part."));
        }
        if !gradients.degenerate().is_empty() {
            let flat = gradients.degenerate();
            let message =
                format!("{} faces have no area; each takes the deformation of its nearest neighbour.", flat.len());
            warnings.push(Warning::on_faces("degenerate-faces", message, flat.to_vec()));
        }
        let seconds = watch.seconds;
        let parameters = parameters.clone();
        Ok(Self {
            parameters,
            graph,
            weights,
            deformation: distances,
            geodesic,
            edge_length,
            areas,
            faces,
            finest: finest_labels,
            finest_count,
            base,
            steps,
            warnings,
            seconds,
        })
    }

    /// The merges of the tree, cheapest first.
    pub fn merges(&self) -> &[Merge] {
        &self.steps.merges
    }

    /// The segmentation into the given number of parts, or into as many as the costs of the merge tree suggest.
    pub fn segmentation(&self, parts: Option<usize>) -> Segmentation {
        let mut seconds = self.seconds.clone();
        let started = clock::seconds();
        let mut labels = self.finest.clone();
        let mut count = self.finest_count;
        if self.parameters.method == Method::Tree {
            let wanted = parts.unwrap_or_else(|| {
                choice::number_of_parts(
                    &self.steps.merges,
                    self.base,
                    self.faces.face_count() * self.faces.pose_count(),
                )
            });
            let (part_of, n) = merge_tree::cut(self.finest_count, &self.steps.merges, wanted);
            labels.iter_mut().for_each(|l| *l = part_of[*l as usize]);
            count = n;
            refinement::refine(&self.graph, &self.weights, &self.faces, &mut labels, count, REFINEMENTS);
        }
        let refined = clock::seconds();
        seconds.push(("refinement", refined - started));
        let unsmoothed = labels.clone();
        let residual_before_smoothing = self.residual(&labels, count);
        self.smooth(&mut labels, count, residual_before_smoothing);
        count = clustering::compact(&mut labels);
        seconds.push(("smoothing", clock::seconds() - refined));
        let steps = Steps { unsmoothed, ..self.steps.clone() };
        Segmentation {
            parts: self.parts(&labels, count),
            rigid_residual: self.residual(&labels, count),
            residual_before_smoothing,
            labels,
            steps,
            warnings: self.warnings.clone(),
            seconds,
        }
    }

    /// Smooths the boundaries; by default with a hold that is tightened until smoothing costs little rigidity.
    fn smooth(&self, labels: &mut Vec<u32>, parts: usize, before: f64) {
        if self.parameters.smoothing == Smoothing::None {
            return;
        }
        let input = smoothing::Input {
            graph: &self.graph,
            deformation: &self.deformation,
            geodesic: &self.geodesic,
            edge_length: &self.edge_length,
            areas: &self.areas,
            faces: &self.faces,
        };
        let capacity = smoothing::capacities(&input, self.parameters.alpha, self.parameters.smoothing);
        let smoothed = |pull: f64| {
            let mut result = labels.clone();
            smoothing::smooth(&input, &capacity, &mut result, parts, pull);
            clustering::absorb_fragments(&self.graph, &self.weights, &mut result);
            result
        };
        if self.parameters.method == Method::Paper {
            *labels = smoothed(0.0);
            return;
        }
        let mut pull = PULL;
        for _ in 0..TRIES {
            let result = smoothed(pull);
            if self.residual(&result, parts) <= SMOOTHING_COST * before + finest::RIGID {
                *labels = result;
                return;
            }
            pull *= TIGHTER;
        }
    }

    /// Rms distance of face centroids from their parts' best rigid motions, over faces and poses, at unit diagonal.
    fn residual(&self, labels: &[u32], parts: usize) -> f64 {
        let sum = self.faces.moments(labels, parts).iter().map(motion::residual).sum::<f64>();
        rms(sum, labels.len(), self.faces.pose_count())
    }

    fn parts(&self, labels: &[u32], count: usize) -> Vec<Part> {
        let total: f64 = self.areas.iter().sum();
        let mut parts = vec![Part { faces: 0, area: 0.0, residual: 0.0 }; count];
        for (&label, &area) in labels.iter().zip(&self.areas) {
            let part = &mut parts[label as usize];
            part.faces += 1;
            part.area += if total > 0.0 { area / total } else { 0.0 };
        }
        for (part, moments) in parts.iter_mut().zip(self.faces.moments(labels, count)) {
            part.residual = rms(motion::residual(&moments), part.faces, self.faces.pose_count());
        }
        parts
    }
}

/// The faces with vertices that agree in every pose taken as one, so that a seam of a file is no boundary of the mesh.
fn joined_faces(sequence: &Sequence, diagonal: f64) -> Vec<[u32; 3]> {
    let poses: Vec<&[DVec3]> =
        std::iter::once(sequence.reference()).chain(sequence.poses().iter().map(|p| p.positions.as_slice())).collect();
    let stands = weld::weld(&poses, SEAM * diagonal);
    sequence.faces().iter().map(|face| face.map(|v| stands[v as usize])).collect()
}

fn rms(sum: f64, faces: usize, poses: usize) -> f64 {
    (sum / (faces * poses).max(1) as f64).sqrt()
}

/// The pairs of parts that share a mesh edge.
fn touching(graph: &DualGraph, labels: &[u32]) -> Vec<(u32, u32)> {
    let mut pairs: Vec<(u32, u32)> = graph
        .edges()
        .iter()
        .map(|edge| edge.faces.map(|f| labels[f as usize]))
        .filter(|[a, b]| a != b)
        .map(|[a, b]| (a.min(b), a.max(b)))
        .collect();
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}

/// #F: the largest of the values of a face's dual edges.
fn face_maximum(graph: &DualGraph, values: &[f64]) -> Vec<f64> {
    (0..graph.face_count() as u32)
        .map(|f| graph.neighbours(f).iter().map(|link| values[link.edge as usize]).fold(0.0, f64::max))
        .collect()
}
