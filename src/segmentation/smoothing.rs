//! Boundary smoothing (§3.4): within a band around the boundary of two parts, the cheapest cut through the dual graph.
//!
//! As printed, Eq. 8 makes a strongly deforming edge *expensive* to cut, against the sentence above it. The default
//! turns the first term round; [`Smoothing::Printed`] is the letter. Beyond the paper, a face that one of the two parts'
//! motions explains better pulls towards that part, so that a smooth boundary does not cost rigidity.

use super::Smoothing;
use super::geometry::Geometry;
use super::motion::{self, FaceMotion};
use super::statistics::{mean, over};
use crate::mesh::DualGraph;
use std::collections::{BTreeMap, VecDeque};

/// The moving mesh, as smoothing sees it.
pub struct Input<'a> {
    /// The reference pose.
    pub geometry: &'a Geometry,
    /// #E deformation distances (Eq. 4).
    pub deformation: &'a [f64],
    /// How the faces move.
    pub faces: &'a FaceMotion,
}

/// Half the width of the band in which a boundary may move, at unit diagonal, and in faces where faces are large.
const BAND: f64 = 0.02;
const BAND_FACES: u32 = 3;

/// Rms distance from a rigid motion (at unit diagonal) below which a boundary is not held back from being smooth.
const UNSEEN: f64 = 0.003;

/// #E prices of cutting each dual edge (Eq. 8, in mean edge lengths).
pub fn capacities(input: &Input<'_>, alpha: f64, smoothing: Smoothing) -> Vec<f64> {
    let edge_length = &input.geometry.edge_length;
    let (mean_deformation, mean_length) = (mean(input.deformation.iter().copied()), mean(edge_length.iter().copied()));
    let price = |(&d, &length): (&f64, &f64)| {
        let d = over(d, mean_deformation);
        let first = if smoothing == Smoothing::Printed { d } else { 1.0 / (1.0 + d) };
        alpha * first + (1.0 - alpha) * over(length, mean_length)
    };
    input.deformation.iter().zip(edge_length).map(price).collect()
}

/// Smooths the boundary between every two parts that touch, in the order of their numbers.
///
/// `pull` weighs rigidity against shortness: a region that lies on the wrong side and is explained worse by as much as
/// the mean squared residual costs `pull` times its area, at unit diagonal, where boundary costs its length; both do not
/// depend on how finely the mesh is divided. 0: the letter of the paper.
///
/// Returns #F: 1 where a face was in the band of a boundary, free to change sides.
pub fn smooth(input: &Input<'_>, capacity: &[f64], labels: &mut [u32], parts: usize, pull: f64) -> Vec<u8> {
    let mut free = vec![0; labels.len()];
    let moments = input.faces.moments(labels, parts);
    let mean_square = moments.iter().map(motion::residual).sum::<f64>() / labels.len().max(1) as f64
        + UNSEEN * UNSEEN * input.faces.pose_count() as f64;
    let motions: Vec<_> = moments.iter().map(motion::best_motion).collect();
    let mean_length = mean(input.geometry.edge_length.iter().copied());
    let pull = pull / (mean_square * mean_length);
    let pull = if pull.is_finite() { pull } else { 0.0 };
    let graph = &input.geometry.graph;
    let mut borders = Borders::new(graph, labels);
    for (a, b) in graph.touching(labels) {
        let band = Band::around(input, labels, a, b, &borders.between(a, b));
        let mut cut = super::max_flow::MinCut::new(band.faces.len());
        for (i, &f) in band.faces.iter().enumerate() {
            let [on_a, on_b] = match band.rim[i] {
                // The faces just outside the band hold their side.
                true if labels[f as usize] == a => [0.0, f64::INFINITY],
                true => [f64::INFINITY, 0.0],
                false if pull > 0.0 => {
                    let weight = pull * input.geometry.areas[f as usize];
                    [a, b].map(|part| weight * f64::from(input.faces.error(&motions[part as usize], f)))
                }
                false => [0.0, 0.0],
            };
            let common = on_a.min(on_b);
            cut.prefer(i, on_b - common, on_a - common);
            for link in graph.neighbours(f) {
                if let Some(&j) = band.slot.get(&link.face)
                    && i < j
                {
                    cut.edge(i, j, capacity[link.edge as usize]);
                }
            }
        }
        let (on_side_a, _) = cut.solve();
        for (i, &f) in band.faces.iter().enumerate().filter(|&(i, _)| !band.rim[i]) {
            let side = if on_side_a[i] { a } else { b };
            if labels[f as usize] != side {
                labels[f as usize] = side;
                borders.follow(graph, labels, f);
            }
            free[f as usize] = 1;
        }
    }
    free
}

/// The dual edges between every two parts. Where parts have moved on, some edges are of another pair by now: whoever asks
/// looks at the labels.
struct Borders(BTreeMap<(u32, u32), Vec<u32>>);

impl Borders {
    fn new(graph: &DualGraph, labels: &[u32]) -> Self {
        let mut borders = Self(BTreeMap::new());
        for (e, edge) in graph.edges().iter().enumerate() {
            borders.add(e as u32, edge.faces.map(|f| labels[f as usize]));
        }
        borders
    }

    fn add(&mut self, edge: u32, [a, b]: [u32; 2]) {
        if a != b {
            self.0.entry((a.min(b), a.max(b))).or_default().push(edge);
        }
    }

    /// A face has another label.
    fn follow(&mut self, graph: &DualGraph, labels: &[u32], face: u32) {
        for link in graph.neighbours(face) {
            self.add(link.edge, [face, link.face].map(|f| labels[f as usize]));
        }
    }

    /// Edges that were ever between two parts, ascending.
    fn between(&mut self, a: u32, b: u32) -> Vec<u32> {
        let mut edges = self.0.remove(&(a.min(b), a.max(b))).unwrap_or_default();
        edges.sort_unstable();
        edges.dedup();
        edges
    }
}

/// The faces of two parts near their common boundary, and around them a rim of faces that do not move.
struct Band {
    faces: Vec<u32>,
    rim: Vec<bool>,
    slot: BTreeMap<u32, usize>,
}

impl Band {
    /// `border` are the dual edges among which those between the two parts are.
    fn around(input: &Input<'_>, labels: &[u32], a: u32, b: u32, border: &[u32]) -> Self {
        let of_pair = |f: u32| labels[f as usize] == a || labels[f as usize] == b;
        let mut band = Self { faces: Vec::new(), rim: Vec::new(), slot: BTreeMap::new() };
        let mut queue = VecDeque::new();
        for &edge in border {
            let [f, g] = input.geometry.graph.edges()[edge as usize].faces;
            if labels[f as usize] != labels[g as usize] && of_pair(f) && of_pair(g) {
                for face in [f, g] {
                    if band.insert(face, false) {
                        queue.push_back((face, 0u32, 0.0));
                    }
                }
            }
        }
        while let Some((f, steps, far)) = queue.pop_front() {
            for link in input.geometry.graph.neighbours(f) {
                if !of_pair(link.face) {
                    continue;
                }
                let (steps, far) = (steps + 1, far + input.geometry.geodesic[link.edge as usize]);
                let outside = steps > BAND_FACES && far > BAND;
                if band.insert(link.face, outside) && !outside {
                    queue.push_back((link.face, steps, far));
                }
            }
        }
        band.hold_each_side(labels, a, b);
        band
    }

    fn insert(&mut self, face: u32, rim: bool) -> bool {
        if self.slot.contains_key(&face) {
            return false;
        }
        self.slot.insert(face, self.faces.len());
        self.faces.push(face);
        self.rim.push(rim);
        true
    }

    /// A part that lies in the band as a whole would vanish: the face reached last holds its side.
    fn hold_each_side(&mut self, labels: &[u32], a: u32, b: u32) {
        for part in [a, b] {
            let own = |i: &usize| labels[self.faces[*i] as usize] == part;
            if !(0..self.faces.len()).any(|i| own(&i) && self.rim[i])
                && let Some(last) = (0..self.faces.len()).rev().find(own)
            {
                self.rim[last] = true;
            }
        }
    }
}
