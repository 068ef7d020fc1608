//! The target's vertices, of what its faces should do.
//!
//! Sumner & Popović 2004, Eq. 5–8: the sum over faces of |S − T|² is a quadratic function of the vertices, whose matrix is
//! factored once for all poses. The image of a face's normal takes part in one term only and leaves nothing of it
//! ([`super::operator`]), so that the unknowns are the vertices alone, a third of the paper's.

use super::normal::{Equations, Terms, columns};
use super::operator::{Gradient, gradients};
use crate::linalg::cholesky::{Cholesky, NotPositiveDefinite};
use crate::mesh::near::bridges;
use crate::mesh::{DualGraph, face};
use crate::transfer::surface::WeldedSurface;
use glam::{DMat3, DVec3};

/// Poses that are solved at once: enough to read the factor seldom, few enough to stay in memory.
const AT_ONCE: usize = 16;

/// Pairs of faces over which the pieces of a surface, each as its edges connect it, hang together as one.
pub fn bridging(surface: &WeldedSurface, graph: &DualGraph) -> Vec<[u32; 2]> {
    bridges(graph, &face::centroids(&surface.faces, &surface.positions))
}

/// What the maps of one face or of two, in the mean, ask of a vertex: a share of the right side.
#[derive(Clone, Copy, Debug)]
struct Load {
    vertex: u32,
    faces: [u32; 2],
    arm: DVec3,
}

/// A mesh whose faces can be told what to do.
pub struct Solver {
    count: usize,
    loads: Vec<Load>,
    equations: Equations,
    factor: Cholesky,
    /// What the anchored vertex is held with.
    hold: f64,
    pins: Vec<u32>,
    /// For each pin, where all go when it is drawn with a force of 1 and nothing else is asked for, one after the other; and
    /// the factor of what they do to each other.
    answers: Vec<f64>,
    between: Option<Cholesky>,
}

impl Solver {
    /// Factors the system of a surface. `weights` are #F, positive; `pins` are places that will be told where to go.
    ///
    /// Pieces that do not touch are tied, each to the nearest, as the maps of the two faces there say. Faces without area
    /// keep their edges as their map says.
    pub fn new(surface: &WeldedSurface, weights: &[f64], pins: &[u32]) -> Result<Self, NotPositiveDefinite> {
        let gradients = gradients(surface);
        let mut sum =
            Sum { surface, terms: Terms::new(surface.len(), &[]), loads: Vec::with_capacity(3 * weights.len()) };
        for (f, (gradient, &weight)) in gradients.iter().zip(weights).enumerate() {
            match gradient {
                Some(gradient) => sum.mapped(f, gradient, weight),
                None => sum.edges(f, weight),
            }
        }
        for bridge in bridging(surface, &DualGraph::new(&surface.faces)) {
            sum.together(bridge, weights[bridge[0] as usize]);
        }
        let loads = sum.loads;
        let equations = sum.terms.finish()?;
        // The system tells everything but where the whole is: one vertex is held, and the solution moved afterwards.
        let hold = equations.mean_diagonal();
        let mut diagonal = vec![0.0; surface.len()];
        let anchor = pins.first().map_or(0, |&pin| pin as usize);
        if let Some(entry) = diagonal.get_mut(anchor) {
            *entry = hold;
        }
        let factor = equations.factor(&diagonal, None)?;
        let mut solver = Self {
            count: surface.len(),
            loads,
            equations,
            factor,
            hold,
            pins: pins.to_vec(),
            answers: Vec::new(),
            between: None,
        };
        solver.pin()?;
        Ok(solver)
    }

    fn pin(&mut self) -> Result<(), NotPositiveDefinite> {
        if self.pins.is_empty() {
            return Ok(());
        }
        self.answers = vec![0.0; self.count * self.pins.len()];
        self.answers.chunks_exact_mut(self.count).zip(&self.pins).for_each(|(answer, &pin)| answer[pin as usize] = 1.0);
        self.factor.solve(&mut self.answers);
        let mut between = Vec::new();
        for (i, answer) in (0_u32..).zip(self.answers.chunks_exact(self.count)) {
            between.extend(self.pins[..=i as usize].iter().zip(0_u32..).map(|(&p, j)| (i, j, answer[p as usize])));
        }
        self.between = Some(Cholesky::new(self.pins.len(), &between)?);
        Ok(())
    }

    /// #N positions for each of `count` poses: `maps` gives the #F linear maps of one. `goals` are, for each pose, where the
    /// pins go; without pins the first vertex is at the origin.
    pub fn solve(&self, count: usize, maps: &dyn Fn(usize) -> Vec<DMat3>, goals: &[Vec<DVec3>]) -> Vec<Vec<DVec3>> {
        let mut poses = Vec::with_capacity(count);
        while poses.len() < count {
            let next = poses.len()..count.min(poses.len() + AT_ONCE);
            // Maps take six times the room of positions: those of a pose go before the next come.
            let sides: Vec<Vec<DVec3>> = next.map(|pose| self.side(&maps(pose), goals.get(pose))).collect();
            self.solve_some(&sides, goals, &mut poses);
        }
        poses
    }

    /// Solves for the next poses, of which these are the right sides.
    fn solve_some(&self, sides: &[Vec<DVec3>], goals: &[Vec<DVec3>], poses: &mut Vec<Vec<DVec3>>) {
        let mut columns = columns(sides);
        self.factor.solve(&mut columns);
        for i in 0..sides.len() {
            let mut points = self.equations.points(&columns, i);
            if let Some(goals) = goals.get(poses.len()) {
                self.correct(&mut points, goals);
            }
            poses.push(points);
        }
    }

    fn side(&self, maps: &[DMat3], goals: Option<&Vec<DVec3>>) -> Vec<DVec3> {
        let mut side = vec![DVec3::ZERO; self.count];
        for load in &self.loads {
            let [f, g] = load.faces.map(|f| maps[f as usize]);
            side[load.vertex as usize] +=
                if load.faces[0] == load.faces[1] { f * load.arm } else { 0.5 * ((f + g) * load.arm) };
        }
        if let (Some(&pin), Some(&goal)) = (self.pins.first(), goals.and_then(|goals| goals.first())) {
            side[pin as usize] += self.hold * goal;
        }
        side
    }

    /// Brings the pins to their goals, and all others along.
    fn correct(&self, points: &mut [DVec3], goals: &[DVec3]) {
        let Some(between) = &self.between else { return };
        let missing: Vec<DVec3> =
            self.pins.iter().zip(goals).map(|(&pin, &goal)| goal - points[pin as usize]).collect();
        if missing.len() != self.pins.len() {
            return;
        }
        let mut forces = columns(&[missing]);
        between.solve(&mut forces);
        let n = self.pins.len();
        for (i, answer) in self.answers.chunks_exact(self.count).enumerate() {
            let force = DVec3::new(forces[i], forces[n + i], forces[2 * n + i]);
            points.iter_mut().zip(answer).for_each(|(point, &share)| *point += share * force);
        }
    }
}

/// The system as it is summed.
struct Sum<'a> {
    surface: &'a WeldedSurface,
    terms: Terms,
    loads: Vec<Load>,
}

impl Sum<'_> {
    /// A face does as its map says.
    fn mapped(&mut self, face: usize, gradient: &Gradient, weight: f64) {
        let corners = self.surface.faces[face];
        let parts = [0, 1, 2].map(|k| (corners[k], gradient.corners[k]));
        self.terms.add(&parts, DMat3::ZERO, weight);
        let load = |(vertex, g)| Load { vertex, faces: [face as u32; 2], arm: weight * g };
        self.loads.extend(parts.map(load));
    }

    /// A face without area: its edges do as its map says.
    fn edges(&mut self, face: usize, weight: f64) {
        let corners = self.surface.faces[face];
        for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (corners[i], corners[j])) {
            let edge = self.surface.positions[a as usize] - self.surface.positions[b as usize];
            self.tied([(a, 1.0), (b, -1.0)], edge, [face as u32; 2], weight / edge.length_squared().max(1e-12));
        }
    }

    /// Two faces of different pieces keep their distance as their maps say.
    fn together(&mut self, faces: [u32; 2], weight: f64) {
        let corners = faces.map(|f| face::corners(&self.surface.positions, self.surface.faces[f as usize]));
        let way = face::centroid(corners[0]) - face::centroid(corners[1]);
        let size = way.length_squared().max(corners[0][0].distance_squared(corners[0][1])).max(1e-12);
        let [f, g] = faces.map(|f| self.surface.faces[f as usize]);
        let third = 1.0 / 3.0;
        let parts = [(f[0], third), (f[1], third), (f[2], third), (g[0], -third), (g[1], -third), (g[2], -third)];
        self.tied(parts, way, faces, weight / size);
    }

    fn tied<const K: usize>(&mut self, parts: [(u32, f64); K], way: DVec3, faces: [u32; 2], weight: f64) {
        self.terms.tie(&parts, DVec3::ZERO, weight);
        self.loads.extend(parts.map(|(vertex, c)| Load { vertex, faces, arm: weight * c * way }));
    }
}
