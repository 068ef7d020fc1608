//! Where each point of the target lies on the source: the target is bent, as rigidly as it can, onto the source.
//!
//! The energy is that of Olga Sorkine and Marc Alexa, *As-rigid-as-possible surface modeling*, SGP 2007, plus a pull
//! towards the nearest point of the source whose normal agrees, which grows from round to round as in Robert Sumner and
//! Jovan Popović, *Deformation transfer for triangle meshes*, SIGGRAPH 2004, §4. The system of each strength of the pull
//! is factored once; a round is one solve.

use super::surface::{SurfacePoint, WeldedSurface};
use crate::linalg::cholesky::{Cholesky, NotPositiveDefinite};
use crate::linalg::outer::outer;
use crate::linalg::polar;
use crate::mesh::kd_tree::KdTree;
use crate::mesh::laplacian::Laplacian;
use glam::{DMat3, DVec3};

/// The pull towards the source, by round of growth: density over the unit of area share.
const PULLS: [f64; 4] = [9.0, 90.0, 900.0, 9000.0];
/// Solves with each.
const ROUNDS: usize = 2;
/// What a difference of unit normals counts, as a length in the unit ball.
const NORMAL: f64 = 0.2;
/// From what is farther away, normals counted, it does not matter which of the near points is the nearest.
const FAR: f64 = 0.15;
/// Cosine between normals below which a nearest point is none.
const AGREE: f64 = 0.3;
/// What lies farther from the source than this, in its radii, after the first rounds of growth has no twin there.
pub const LOST: f64 = 0.08;
const ROUGH: usize = 2;
/// How far the shape that the bent target keeps is that which is thought of it, not its own.
const BELIEF: f64 = 0.5;
/// A place of the source belongs to what is known to lie nearest to it, and to what on the target is no farther from that
/// than this, in radii,
const NEAR: f64 = 0.35;
/// and so many times the way from it to the place: proportions differ.
const STRETCH: f64 = 3.0;
/// Cotangents are kept above this: obtuse triangles do not push.
const LEAST_COTANGENT: f64 = 0.01;
/// What a tie between two pieces weighs, as a cotangent.
const TIE: f64 = 0.1;

/// The closest points of the source, for points with normals.
pub struct ClosestPoints {
    tree: KdTree<6>,
}

impl ClosestPoints {
    /// Prepares a surface.
    pub fn new(surface: &WeldedSurface) -> Self {
        let points: Vec<[f64; 6]> = surface.positions.iter().zip(&surface.normals).map(|(&p, &n)| key(p, n)).collect();
        Self { tree: KdTree::new(&points) }
    }

    /// The closest point of the source to a point with a normal, where that is, and the nearest vertex, from which it is
    /// seen; `None` for a surface without faces.
    pub fn of(&self, surface: &WeldedSurface, point: DVec3, normal: DVec3) -> Option<(SurfacePoint, DVec3, u32)> {
        let vertex = self.tree.nearest_roughly(FAR, &key(point, normal))?;
        let (found, at) = surface.nearest_around(vertex, point)?;
        Some((found, at, vertex))
    }
}

fn key(p: DVec3, n: DVec3) -> [f64; 6] {
    [p.x, p.y, p.z, NORMAL * n.x, NORMAL * n.y, NORMAL * n.z]
}

/// A pair: a vertex of the target and where it belongs on the source.
#[derive(Clone, Copy, Debug)]
pub struct Pin {
    /// The number of the target's vertex.
    pub vertex: u32,
    /// A point of the source.
    pub point: DVec3,
}

/// What is known of where the target lies.
#[derive(Clone, Copy, Debug)]
pub struct Known<'a> {
    /// What is held there.
    pub pins: &'a [Pin],
    /// What is thought to lie near there. Either tells whose the places of the source are: a tail that the source has not is
    /// not drawn to the legs, though these are what lies nearest to it.
    pub hints: &'a [Pin],
}

/// How many rounds are done.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Effort {
    /// All.
    Whole,
    /// One with each strength of the pull.
    Once,
    /// The last ones, for a start that was a result before.
    Last,
}

/// The target as something to be bent, with its factored systems.
pub struct Registration {
    edges: Vec<([u32; 2], f64)>,
    factors: Vec<Cholesky>,
}

impl Registration {
    /// Factors the systems of a target.
    pub fn new(target: &WeldedSurface) -> Result<Self, NotPositiveDefinite> {
        let laplacian = Laplacian::new(&target.faces, &target.positions);
        let within = laplacian.edges.iter().zip(&laplacian.cotangents).map(|(&e, &c)| (e, c.max(LEAST_COTANGENT)));
        let edges: Vec<([u32; 2], f64)> = within.chain(target.ties().iter().map(|&(a, b)| ([a, b], TIE))).collect();
        let mut entries = Vec::with_capacity(3 * edges.len() + target.len());
        for &([a, b], weight) in &edges {
            entries.extend([(a, a, weight), (b, b, weight), (a.max(b), a.min(b), -weight)]);
        }
        let stiff = entries.len();
        let mut factors = Vec::with_capacity(PULLS.len());
        for pull in PULLS {
            entries.truncate(stiff);
            entries.extend(target.mass.iter().zip(0_u32..).map(|(&m, v)| (v, v, pull * m)));
            factors.push(Cholesky::new(target.len(), &entries)?);
        }
        Ok(Self { edges, factors })
    }

    /// Bends the target onto the source: #N positions of its vertices near the source's surface.
    ///
    /// `rest` has the shape that is kept, `start` is where the target is thought to end.
    pub fn bend(
        &self,
        (source, closest): (&WeldedSurface, &ClosestPoints),
        target: &WeldedSurface,
        rest: &[DVec3],
        start: Vec<DVec3>,
        known: Known,
        effort: Effort,
    ) -> Vec<DVec3> {
        let mut at = start;
        let owners = Owners::new(known);
        let (first, rounds) = match effort {
            Effort::Whole => (0, ROUNDS),
            Effort::Once => (0, 1),
            Effort::Last => (PULLS.len() - 2, 1),
        };
        for level in first..PULLS.len() {
            for _ in 0..rounds {
                let reach = if level < ROUGH { f64::INFINITY } else { LOST };
                let mut goal = goals((source, closest), target, &at, &owners, reach);
                known.pins.iter().for_each(|pin| goal[pin.vertex as usize] = pin.point);
                self.solve(level, target, rest, &mut at, &goal);
            }
        }
        at
    }

    /// One round: rotations of the vertices, then positions.
    fn solve(&self, level: usize, target: &WeldedSurface, rest: &[DVec3], at: &mut [DVec3], goal: &[DVec3]) {
        let (Some(factor), Some(pull)) = (self.factors.get(level), PULLS.get(level)) else { return };
        let turns = self.turns(rest, at);
        let n = at.len();
        let mut side: Vec<DVec3> = goal.iter().zip(&target.mass).map(|(&g, &m)| g * (pull * m)).collect();
        for &([a, b], weight) in &self.edges {
            let (a, b) = (a as usize, b as usize);
            let edge = (turns[a] + turns[b]) * (rest[a] - rest[b]) * (0.5 * weight);
            side[a] += edge;
            side[b] -= edge;
        }
        let mut columns = vec![0.0; 3 * n];
        for (v, s) in side.iter().enumerate() {
            (columns[v], columns[n + v], columns[2 * n + v]) = (s.x, s.y, s.z);
        }
        factor.solve(&mut columns);
        for (v, p) in at.iter_mut().enumerate() {
            let solved = DVec3::new(columns[v], columns[n + v], columns[2 * n + v]);
            if solved.is_finite() {
                *p = solved;
            }
        }
    }

    /// #N rotations that carry the edges around each vertex best from `rest` to `at`.
    fn turns(&self, rest: &[DVec3], at: &[DVec3]) -> Vec<DMat3> {
        let mut sums = vec![DMat3::ZERO; rest.len()];
        for &([a, b], weight) in &self.edges {
            let (a, b) = (a as usize, b as usize);
            let (from, to) = ((rest[a] - rest[b]) * weight, at[a] - at[b]);
            let share = outer(to, from);
            sums[a] += share;
            sums[b] += share;
        }
        sums.into_iter().map(polar::rotation).collect()
    }
}

/// Whose the places of the source are, as far as that is known.
struct Owners {
    tree: KdTree<3>,
    pins: Vec<Pin>,
}

impl Owners {
    fn new(known: Known) -> Self {
        let pins: Vec<Pin> = known.pins.iter().chain(known.hints).copied().collect();
        Self { tree: KdTree::new(&pins.iter().map(|pin| pin.point.to_array()).collect::<Vec<_>>()), pins }
    }

    /// Whether a place of the source may be that of a vertex of the target.
    fn allow(&self, target: &WeldedSurface, vertex: usize, place: DVec3) -> bool {
        let nearest = self.tree.nearest(&place.to_array()).and_then(|number| self.pins.get(number as usize));
        nearest.is_none_or(|pin| {
            let apart = target.positions[vertex].distance(target.positions[pin.vertex as usize]);
            apart < NEAR + STRETCH * place.distance(pin.point)
        })
    }
}

/// For each vertex the nearest place of the source, or where it is if that faces another way, is farther than `lost`, or
/// another's.
fn goals(
    (source, closest): (&WeldedSurface, &ClosestPoints),
    target: &WeldedSurface,
    at: &[DVec3],
    owners: &Owners,
    lost: f64,
) -> Vec<DVec3> {
    let normals = target.normals_of(at);
    let goal = |(v, (&p, &n)): (usize, (&DVec3, &DVec3))| {
        let (_, found, vertex) = closest.of(source, p, n)?;
        let agrees = source.normals[vertex as usize].dot(n) > AGREE && found.distance_squared(p) < lost * lost;
        (agrees && owners.allow(target, v, found)).then_some(found)
    };
    at.iter().zip(&normals).enumerate().map(|vertex| goal(vertex).unwrap_or(*vertex.1.0)).collect()
}

/// The shape to keep lies between the target's own and the one that it is thought to have, with its points where they belong:
/// proportions differ, and so do poses.
pub fn shape_to_keep(rest: &[DVec3], placed: &[DVec3]) -> Vec<DVec3> {
    rest.iter().zip(placed).map(|(r, p)| r.lerp(*p, BELIEF)).collect()
}

/// For each vertex of the bent target the closest point of the source, and how far that is.
pub fn closest_points(
    source: &WeldedSurface,
    closest: &ClosestPoints,
    target: &WeldedSurface,
    at: &[DVec3],
) -> Vec<Option<(SurfacePoint, f64)>> {
    let normals = target.normals_of(at);
    let of_vertex = |(&p, &n)| closest.of(source, p, n).map(|(found, at, _)| (found, at.distance(p)));
    at.iter().zip(&normals).map(of_vertex).collect()
}
