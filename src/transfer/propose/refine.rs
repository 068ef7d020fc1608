//! Proposals settled on the surface: the target is bent onto the source, starting from where the points have agreed that it
//! lies, and then everything has its place.
//!
//! What the points say of each other is right on the whole and wrong by a few samples here and there; how one surface lies
//! on another is decided there by the surfaces themselves.

use super::consensus::Consensus;
use super::sampled::SampledSurface;
use crate::mesh::face::vertex_normals;
use crate::mesh::kd_tree::KdTree;
use crate::sequence::Sequence;
use crate::transfer::registration::{ClosestPoints, Effort, Known, Pin, Registration, shape_to_keep};
use crate::transfer::spline::Spline;
use crate::transfer::surface::WeldedSurface;
use glam::DVec3;

/// Points that say where the target lies.
const GUIDES: usize = 140;
/// Samples of the bent target near a point, whose cells are searched.
const NEAR: usize = 6;
/// What a difference of unit normals counts, as a length.
const NORMAL: f64 = 0.1;
/// A place that lies farther than this from the point when the target is bent is none.
const FAR: f64 = 0.08;

/// Both surfaces on their samples, ready to be laid on each other.
pub struct Refiner {
    source: WeldedSurface,
    closest: ClosestPoints,
    target: WeldedSurface,
    registration: Registration,
}

impl Refiner {
    /// `None` where one of the surfaces is no surface.
    pub fn new(source: &SampledSurface, target: &SampledSurface) -> Option<Self> {
        let [source, target] = [source, target].map(|surface| {
            let sequence = Sequence::new("", surface.coarse.clone(), surface.places.clone(), Vec::new()).ok()?;
            let shape = WeldedSurface::new(&sequence);
            (!shape.is_empty() && shape.radius > 0.0 && shape.positions.iter().all(|p| p.is_finite())).then_some(shape)
        });
        let (source, target) = (source?, target?.tied());
        let registration = Registration::new(&target).ok()?;
        Some(Self { closest: ClosestPoints::new(&source), source, target, registration })
    }

    /// The samples of the target where they come to lie on the source, in the source's lengths.
    pub fn bent(&self, consensus: &Consensus) -> Vec<DVec3> {
        let inward = |p: DVec3| self.source.inward(p);
        let places = consensus.target_places();
        let rest: Vec<DVec3> = self.target.vertex.iter().map(|&s| inward(places[s as usize])).collect();
        let guides = consensus.guides(GUIDES);
        let known: Vec<(DVec3, DVec3)> =
            guides.iter().map(|&(from, to)| (inward(to), inward(from) - inward(to))).collect();
        let spline = Spline::loose(&known);
        let start: Vec<DVec3> = rest.iter().map(|&p| p + spline.at(p)).collect();
        let shape = shape_to_keep(&rest, &start);
        let pins: Vec<Pin> = consensus
            .given()
            .map(|(point, sample)| Pin { vertex: self.target.place[sample as usize], point: inward(point) })
            .collect();
        let known = Known { pins: &pins, hints: &[] };
        let bent =
            self.registration.bend((&self.source, &self.closest), &self.target, &shape, start, known, Effort::Once);
        let outward = |p: DVec3| p * self.source.radius + self.source.centre;
        (0..places.len()).map(|s| bent.get(self.target.place[s] as usize).map_or(places[s], |&p| outward(p))).collect()
    }
}

/// The bent target as something on which to find points of the source.
pub struct BentTarget<'a> {
    target: &'a SampledSurface,
    bent: Vec<DVec3>,
    normals: Vec<DVec3>,
    tree: KdTree<6>,
}

impl<'a> BentTarget<'a> {
    /// `bent` are the places of the target's samples on the source.
    pub fn new(target: &'a SampledSurface, bent: Vec<DVec3>) -> Self {
        let normals = vertex_normals(&target.coarse, &bent);
        let points: Vec<[f64; 6]> = bent.iter().zip(&normals).map(|(&p, &n)| key(p, n)).collect();
        Self { target, bent, normals, tree: KdTree::new(&points) }
    }

    /// The vertex of the target that lies nearest to a point of the source with a normal; `None` if none lies near.
    pub fn vertex(&self, point: DVec3, normal: DVec3) -> Option<u32> {
        let to = key(point, normal);
        let mut near: Vec<u32> = Vec::with_capacity(NEAR);
        while near.len() < NEAR {
            let Some(sample) = self.tree.nearest_of(&to, |s| !near.contains(&s)) else { break };
            near.push(sample);
        }
        let cost = |v: u32| {
            let mean = |of: &[DVec3]| -> DVec3 {
                self.target.readings[v as usize].iter().map(|&(s, w)| f64::from(w) * of[s as usize]).sum()
            };
            let (p, n) = (mean(&self.bent), mean(&self.normals).normalize_or_zero());
            let off = p.distance_squared(point);
            (off + NORMAL * NORMAL * n.distance_squared(normal), off)
        };
        let members = near.iter().flat_map(|&s| &self.target.members[s as usize]);
        let best = members.map(|&v| (v, cost(v))).min_by(|a, b| a.1.0.total_cmp(&b.1.0).then(a.0.cmp(&b.0)))?;
        (best.1.1 < FAR * FAR).then_some(best.0)
    }
}

fn key(p: DVec3, n: DVec3) -> [f64; 6] {
    [p.x, p.y, p.z, NORMAL * n.x, NORMAL * n.y, NORMAL * n.z]
}
