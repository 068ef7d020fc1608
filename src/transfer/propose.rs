//! Where the key points of one mesh lie on another, without being told, or told of some of them.
//!
//! Both surfaces are thinned out to samples with all distances between them (`sampled`). A spread of the source's
//! samples and the points asked for (`point_set`) look for their places together (`consensus`), from several starts
//! (`starts`): the figures laid over each other as they stand, turned (`orientations`), or pulled to given pairs and tips,
//! and from the other side; the outcome in which points agree best with each other counts (`placements`). Given pairs stay
//! as they are and are listened to more.
//! Where tips of both figures (`tips`) have come to lie next to each other, they are laid on each other, and the points
//! agree once more: limbs of other lengths are then followed to their ends. The rest is for the surfaces (`refine`).
//!
//! The idea of drawing points to places with the right distances to others is that of quadratic assignment (J. Maciel
//! and J. P. Costeira, *A global solution to sparse correspondence problems*, IEEE Transactions on Pattern Analysis and
//! Machine Intelligence 25(2), 2003, pp. 187–199), here relaxed by rounds of averages.

mod coarse;
mod consensus;
mod distances;
mod orientations;
mod placements;
mod point_set;
mod refine;
mod sampled;
mod similarity;
mod starts;
mod tips;

use super::Pair;
use crate::sequence::Sequence;
use consensus::{Consensus, LAST};
use glam::DVec3;
use placements::Placement;
use point_set::{Figures, PointSet, SPREAD};
use refine::{BentTarget, Refiner};
use sampled::{SAMPLES, SampledSurface};
use serde::Serialize;

/// How far points listen in the rounds after tips that have met are held.
const REACHES_WITH_TIPS: [f64; 4] = [0.1; 4];

/// Opinions that are not farther apart than this are both half right.
const ALIKE: f64 = 0.04;

/// What more a place may cost that the surfaces themselves suggest: another leg costs more.
const DEARER: f64 = 0.012;

/// So many pairs tell more of each other than proposals could.
pub const ENOUGH: usize = 50;

/// A proposed target point.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Proposal {
    /// A vertex of the target.
    pub target: u32,
    /// From 0 (a guess) to 1 (given).
    pub confidence: f64,
}

/// Proposed target points.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Proposals {
    /// One for each point; a known one is echoed with confidence 1.
    pub points: Vec<Proposal>,
    /// The point that is most worth placing by hand next; `None` if all are known.
    pub next: Option<usize>,
}

/// Why nothing can be proposed.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ProposeError {
    /// One of the meshes has no vertices.
    #[error("the {0} has no vertices: there is nothing to match")]
    Empty(&'static str),
    /// A point is not a vertex.
    #[error("point {index} is vertex {vertex}, but the {mesh} has only {vertices} vertices")]
    OutOfRange {
        /// Which point.
        index: usize,
        /// Its vertex number.
        vertex: u32,
        /// Which mesh.
        mesh: &'static str,
        /// How many vertices that has.
        vertices: usize,
    },
    /// Not one entry a point.
    #[error("{known} known places for {points} points: there must be one entry for each")]
    Count {
        /// How many points.
        points: usize,
        /// How many entries.
        known: usize,
    },
}

/// [`Proposer::guides`] for pairs that are known to exist; none without a proposer.
pub fn guides(proposer: Option<&Proposer>, pairs: &[Pair]) -> Vec<Pair> {
    proposer.and_then(|proposer| proposer.guides(pairs).ok()).unwrap_or_default()
}

/// Two meshes, prepared for proposals.
pub struct Proposer {
    source: SampledSurface,
    target: SampledSurface,
    /// How the figures may lie over each other, the likeliest first, and where a spread of its samples comes to lie.
    placements: Vec<Placement>,
    refiner: Option<Refiner>,
}

impl Proposer {
    /// Thins both meshes out and finds out which way round they lie.
    ///
    /// `faces` are #F triples of vertex numbers, `positions` #V points; the reference poses. Seams, pieces, holes and
    /// edges of many faces are fine. About a second for 6,000 + 6,000 vertices.
    pub fn new(
        source_faces: &[[u32; 3]],
        source_positions: &[DVec3],
        target_faces: &[[u32; 3]],
        target_positions: &[DVec3],
    ) -> Result<Self, ProposeError> {
        let source =
            SampledSurface::new(source_faces, source_positions, SAMPLES).ok_or(ProposeError::Empty("source"))?;
        let target =
            SampledSurface::new(target_faces, target_positions, SAMPLES).ok_or(ProposeError::Empty("target"))?;
        let refiner = Refiner::new(&source, &target);
        let mut proposer = Self { source, target, placements: Vec::new(), refiner };
        proposer.placements = placements::placements(proposer.figures());
        Ok(proposer)
    }

    /// As [`Proposer::new`], for what acts in a source, and a target, in their reference poses.
    pub fn of(source: &Sequence, target: &Sequence) -> Result<Self, ProposeError> {
        Self::new(&source.acting_faces(), source.reference(), target.faces(), target.reference())
    }

    /// Proposes a target vertex for every point (source vertices) whose place is not `known`.
    pub fn propose(&self, points: &[u32], known: &[Option<u32>]) -> Result<Proposals, ProposeError> {
        self.check(points, known)?;
        let (set, at) = self.gather(points, known);
        Ok(self.read(&self.figures().agree(&set, at, &REACHES_WITH_TIPS), points, known))
    }

    /// Pairs all over both figures that seem to belong together if the given ones do. None of them is exact: they tell how
    /// one figure lies on the other. None at all where that is known from [`ENOUGH`] given ones.
    pub fn guides(&self, pairs: &[Pair]) -> Result<Vec<Pair>, ProposeError> {
        if pairs.len() >= ENOUGH {
            return Ok(Vec::new());
        }
        let points: Vec<u32> = pairs.iter().map(|pair| pair.source).collect();
        let known: Vec<Option<u32>> = pairs.iter().map(|pair| Some(pair.target)).collect();
        self.check(&points, &known)?;
        let (set, at) = self.gather(&points, &known);
        let consensus = self.figures().agree(&set, at, &REACHES_WITH_TIPS);
        let spread = consensus.trusted().filter(|&i| i < set.spread);
        let pair = |i: usize| {
            let target = self.target.samples[consensus.at[i]? as usize];
            Some(Pair { source: self.source.samples[i], target })
        };
        Ok(spread.filter_map(pair).collect())
    }

    /// Those who look for their places, and where they find them before the last rounds; tips that have met hold on to each
    /// other.
    fn gather(&self, points: &[u32], known: &[Option<u32>]) -> (PointSet, Vec<Option<u32>>) {
        let figures = self.figures();
        let mut set = figures.point_set(SPREAD[1], points, known);
        let at = placements::best(figures, &self.placements, &set);
        for (tip, other) in tips::met(&self.source, &self.target, set.spread, &at) {
            let place = || figures.place(self.target.samples[other as usize]);
            set.points[tip as usize].given.get_or_insert_with(place);
        }
        (set, at)
    }

    fn figures(&self) -> Figures<'_> {
        Figures { source: &self.source, target: &self.target }
    }

    fn check(&self, points: &[u32], known: &[Option<u32>]) -> Result<(), ProposeError> {
        if points.len() != known.len() {
            return Err(ProposeError::Count { points: points.len(), known: known.len() });
        }
        let outside = |mesh: &'static str, vertices: usize, index: usize, vertex: u32| {
            let error = ProposeError::OutOfRange { index, vertex, mesh, vertices };
            if (vertex as usize) < vertices { Ok(()) } else { Err(error) }
        };
        for (index, (&vertex, known)) in points.iter().zip(known).enumerate() {
            outside("source", self.source.points.len(), index, vertex)?;
            if let Some(vertex) = known {
                outside("target", self.target.points.len(), index, *vertex)?;
            }
        }
        Ok(())
    }

    fn read(&self, consensus: &Consensus, points: &[u32], known: &[Option<u32>]) -> Proposals {
        let first = consensus.at.len() - points.len();
        let found = self.refiner.as_ref().map(|refiner| BentTarget::new(&self.target, refiner.bent(consensus)));
        let proposal = |(i, known): (usize, &Option<u32>)| {
            if let Some(target) = known {
                return Proposal { target: *target, confidence: 1.0 };
            }
            let (agreed, cost) = consensus.vertex(first + i, &LAST).unwrap_or((self.target.samples[0], 1.0));
            let v = points[i] as usize;
            let settled =
                found.as_ref().and_then(|found| found.vertex(self.source.points[v], self.source.vertex_normals[v]));
            let price = consensus.price(first + i, &LAST);
            let target = match (settled, price) {
                (Some(settled), Some(price)) if price(settled) < cost + DEARER => self.between(agreed, settled),
                _ => agreed,
            };
            Proposal { target, confidence: (-cost / 0.004).exp().clamp(0.0, 0.99) }
        };
        let mut points: Vec<Proposal> = known.iter().enumerate().map(proposal).collect();
        self.part(&mut points, known);
        let unknown = (0..points.len()).filter(|&i| known[i].is_none());
        let next = unknown.min_by(|&a, &b| points[a].confidence.total_cmp(&points[b].confidence));
        Proposals { points, next }
    }
}

impl Proposer {
    /// Of points that came to one place of the target the surest stays, and the others go to the next places that are free,
    /// where there are any: two points of one place move nothing.
    fn part(&self, points: &mut [Proposal], known: &[Option<u32>]) {
        let mut order: Vec<usize> = (0..points.len()).collect();
        order.sort_by(|&a, &b| {
            known[b].is_some().cmp(&known[a].is_some()).then(points[b].confidence.total_cmp(&points[a].confidence))
        });
        let place = |v: u32| self.target.points[v as usize];
        let mut taken: Vec<DVec3> = Vec::with_capacity(points.len());
        for i in order {
            let at = points[i].target;
            if known[i].is_none() && taken.contains(&place(at)) {
                let far = |v: &u32| place(*v).distance_squared(place(at));
                let free = self.target.around(self.target.cell[at as usize]).filter(|&v| !taken.contains(&place(v)));
                points[i].target = free.min_by(|u, v| far(u).total_cmp(&far(v)).then(u.cmp(v))).unwrap_or(at);
            }
            taken.push(place(points[i].target));
        }
    }

    /// Of two opinions that differ little, the middle; of two that differ much, the second.
    fn between(&self, agreed: u32, settled: u32) -> u32 {
        let apart = self.target.points[agreed as usize].distance(self.target.points[settled as usize]);
        let share = 0.5 + 0.5 * ((apart - ALIKE) / ALIKE).clamp(0.0, 1.0);
        self.target.between(agreed, settled, share)
    }
}
