//! The source bent into the target.
//!
//! Sumner & Popović 2004, Eq. 11–14: neighbouring triangles should be mapped alike (smoothness), no triangle should change
//! much (identity), marked points lie where they belong, and the others, ever more strongly, on the nearest point of the
//! target that faces as they do. The unknowns are the vertices and, for each triangle, the image of its normal (see
//! [`super::super::gradients::operator`]); x, y and z share a matrix, of which only the diagonal changes from round to round.
//!
//! Beyond the paper, hints of where other places belong count until the nearest points do: by few markers alone a limb may
//! come to lie nearest to another.

use crate::linalg::cholesky::{Cholesky, NotPositiveDefinite};
use crate::mesh::DualGraph;
use crate::mesh::bvh::Bvh;
use crate::mesh::face;
use crate::transfer::gradients::normal::{Equations, Terms, columns};
use crate::transfer::gradients::operator::{Gradient, gradients};
use crate::transfer::gradients::solver::bridging;
use crate::transfer::surface::WeldedSurface;
use glam::{DMat3, DVec3};
use serde::{Deserialize, Serialize};

/// How the source is bent; all from 0 to 1,000,000.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, rename_all = "kebab-case")]
pub struct Fitting {
    /// What differences between neighbouring triangles count (the paper: 1).
    pub smoothness: f64,
    /// What any change of a triangle counts (the paper: 0.001).
    pub identity: f64,
    /// What the squared distance from the target, in radii of the target, counts in each round; 0 where only the marked
    /// points count (the paper: 0, then growing from 1 to 5000).
    pub closeness: Vec<f64>,
}

impl Default for Fitting {
    fn default() -> Self {
        Self {
            smoothness: 1.0,
            identity: 0.001,
            closeness: vec![0.0, 1.0, 5.0, 20.0, 100.0, 300.0, 1000.0, 2000.0, 5000.0],
        }
    }
}

/// What the squared distance of a hint counts, in radii of the target, in the rounds where the nearest points do not.
const HINTED: f64 = 10.0;

/// A marked point: a place of the source and where it belongs.
pub type Marker = (u32, DVec3);

/// What a mesh to be bent keeps in every fit: matrix and right side of smoothness and identity.
pub struct Fit<'a> {
    surface: &'a WeldedSurface,
    /// The surface as it lies before it is bent.
    rest: Vec<DVec3>,
    equations: Equations,
    /// For each place its number among the unknowns.
    unknown: Vec<Option<usize>>,
}

impl<'a> Fit<'a> {
    /// Prepares a surface that lies at `rest` (#N positions) and some markers on it, one at least.
    pub fn new(
        surface: &'a WeldedSurface,
        rest: Vec<DVec3>,
        markers: &[Marker],
        fitting: &Fitting,
    ) -> Result<Self, NotPositiveDefinite> {
        let posed = surface.bent(rest.clone());
        let gradients = gradients(&posed);
        let graph = DualGraph::new(&surface.faces);
        let bridges = bridging(&posed, &graph);
        let mut sum = Sum {
            surface: &posed,
            gradients: &gradients,
            terms: Terms::new(surface.len() + surface.faces.len(), markers),
        };
        for edge in graph.edges() {
            sum.alike(edge.faces, fitting.smoothness);
        }
        for bridge in bridges {
            sum.alike(bridge, fitting.smoothness);
            sum.together(bridge, fitting.smoothness);
        }
        (0..surface.faces.len()).for_each(|f| sum.unchanged(f, fitting.identity));
        let unknown = (0..surface.len()).map(|v| sum.terms.unknown(v)).collect();
        Ok(Self { surface, rest, equations: sum.terms.finish()?, unknown })
    }

    /// Bends the surface into the target, whose faces are in `tree`. `shape` hears of every round with #N positions and the
    /// share that is done, and may stop by `false`; the last of them is the answer.
    pub fn bend(
        &self,
        tree: &Bvh,
        fitting: &Fitting,
        hints: &[Marker],
        mut shape: impl FnMut(&[DVec3], f64) -> bool,
    ) -> Result<Vec<DVec3>, NotPositiveDefinite> {
        let mut at = self.rest.clone();
        let mut factor: Option<Cholesky> = None;
        for (round, &weight) in fitting.closeness.iter().enumerate() {
            let mut diagonal = vec![0.0; self.equations.side().len()];
            let mut side = self.equations.side().to_vec();
            let mut pull = |v: usize, goal: DVec3, weight: f64| {
                if let Some(u) = self.unknown[v] {
                    diagonal[u] += weight;
                    side[u] += weight * goal;
                }
            };
            if weight > 0.0 {
                let goals = self.goals(&at, tree).into_iter().enumerate();
                goals.for_each(|(v, goal)| goal.into_iter().for_each(|goal| pull(v, goal, weight)));
            } else {
                hints.iter().for_each(|&(v, goal)| pull(v as usize, goal, HINTED));
            }
            let ready = self.equations.factor(&diagonal, factor.take())?;
            let mut columns = columns(&[side]);
            ready.solve(&mut columns);
            factor = Some(ready);
            let mut solved = self.equations.points(&columns, 0);
            solved.truncate(at.len());
            if solved.iter().all(|p| p.is_finite()) {
                at = solved;
            }
            if !shape(&at, (round + 1) as f64 / fitting.closeness.len() as f64) {
                break;
            }
        }
        Ok(at)
    }

    /// For each place the nearest point of the target that faces as the place does.
    fn goals(&self, at: &[DVec3], tree: &Bvh) -> Vec<Option<DVec3>> {
        let own = self.surface.normals_of(at);
        at.iter().zip(&own).map(|(&p, &n)| Some(tree.nearest_facing(p, n)?.point)).collect()
    }
}

/// #F unit normals in the reference pose.
pub fn face_normals(surface: &WeldedSurface) -> Vec<DVec3> {
    normals_at(surface, &surface.positions)
}

/// #F unit normals of the faces at other positions (#N).
pub fn normals_at(surface: &WeldedSurface, positions: &[DVec3]) -> Vec<DVec3> {
    let normal = |&f: &[u32; 3]| face::double_area_normal(face::corners(positions, f)).normalize_or_zero();
    surface.faces.iter().map(normal).collect()
}

/// The terms of smoothness and identity as they are summed. Points of the terms are the places, then the images of the
/// faces' normals.
struct Sum<'a> {
    surface: &'a WeldedSurface,
    gradients: &'a [Option<Gradient>],
    terms: Terms,
}

impl Sum<'_> {
    /// The map of a face as parts of a term, times `factor`.
    fn map(&self, face: usize, gradient: &Gradient, factor: f64) -> [(u32, DVec3); 4] {
        let [a, b, c] = self.surface.faces[face];
        let [x, y, z] = gradient.corners;
        let image = (self.surface.len() + face) as u32;
        [(a, factor * x), (b, factor * y), (c, factor * z), (image, factor * gradient.normal)]
    }

    /// Two faces are mapped alike.
    fn alike(&mut self, faces: [u32; 2], weight: f64) {
        let [f, g] = faces.map(|f| f as usize);
        let (Some(first), Some(second)) = (self.gradients[f], self.gradients[g]) else { return };
        let mut parts = self.map(f, &first, 1.0).to_vec();
        for (point, d) in self.map(g, &second, -1.0) {
            match parts.iter_mut().find(|part| part.0 == point) {
                Some(part) => part.1 += d,
                None => parts.push((point, d)),
            }
        }
        self.terms.add(&parts, DMat3::ZERO, weight);
    }

    /// Two faces keep their distance, as their maps change it; over the size of the longer of distance and face.
    fn together(&mut self, faces: [u32; 2], weight: f64) {
        let middles =
            faces.map(|f| face::centroid(face::corners(&self.surface.positions, self.surface.faces[f as usize])));
        let way = middles[0] - middles[1];
        let mut size = way.length_squared();
        let mut parts: Vec<(u32, f64)> = Vec::new();
        let mut wanted = DVec3::ZERO;
        for (f, sign) in faces.into_iter().zip([1.0, -1.0]) {
            let f = f as usize;
            let corners = face::corners(&self.surface.positions, self.surface.faces[f]);
            size = size.max(corners[0].distance_squared(corners[1]));
            parts.extend(self.surface.faces[f].map(|v| (v, sign / 3.0)));
            match self.gradients[f] {
                Some(gradient) => parts.extend(self.map(f, &gradient, -0.5).map(|(p, d)| (p, d.dot(way)))),
                None => wanted += 0.5 * way,
            }
        }
        self.terms.tie(&parts, wanted, weight / size.max(1e-12));
    }

    /// A face is mapped by the identity; one without a gradient keeps its edges.
    fn unchanged(&mut self, face: usize, weight: f64) {
        if let Some(gradient) = self.gradients[face] {
            let parts = self.map(face, &gradient, 1.0);
            self.terms.add(&parts, DMat3::IDENTITY, weight);
            return;
        }
        let corners = self.surface.faces[face];
        for (a, b) in [(0, 1), (1, 2), (2, 0)].map(|(i, j)| (corners[i], corners[j])) {
            let edge = self.surface.positions[a as usize] - self.surface.positions[b as usize];
            self.terms.tie(&[(a, 1.0), (b, -1.0)], edge, weight / edge.length_squared().max(1e-12));
        }
        // Its image of a normal is asked for by no other term.
        let image = (self.surface.len() + face) as u32;
        self.terms.tie(&[(image, 1.0)], DVec3::ZERO, 1.0);
    }
}
