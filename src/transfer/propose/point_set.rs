//! Points of one figure that look for their places on the other together: a spread of its samples, and those asked for.

use super::consensus::{Consensus, LAST, Point, Rules, TargetPlace};
use super::sampled::SampledSurface;

/// Samples of the source that look for their places beside the points asked for: in the first rounds, and in the last.
pub const SPREAD: [usize; 2] = [60, 120];

/// Samples of the target that are considered in the first rounds.
pub const CONSIDERED: usize = 400;

/// How much is listened to a point asked for, where a sample counts one: users' points may lie close together.
const ASKED: f64 = 0.3;

/// And to one whose place is known.
const GIVEN: f64 = 3.0;

/// Two surfaces, one of which is to find its places on the other.
#[derive(Clone, Copy)]
pub struct Figures<'a> {
    /// Whose points look for places.
    pub source: &'a SampledSurface,
    /// Where they look.
    pub target: &'a SampledSurface,
}

/// Points of the source that look for their places together.
pub struct PointSet {
    /// A spread of samples first, then the points asked for.
    pub points: Vec<Point>,
    /// Distances between all of them, row by row.
    pub distances: Vec<f32>,
    /// How many are of the spread.
    pub spread: usize,
}

impl<'a> Figures<'a> {
    /// The other way round.
    pub fn reversed(self) -> Self {
        Self { source: self.target, target: self.source }
    }

    /// The first `spread` samples of the source and then the points asked for (vertices of the source), some of which
    /// have `known` places (vertices of the target).
    pub fn point_set(self, spread: usize, points: &[u32], known: &[Option<u32>]) -> PointSet {
        let source = self.source;
        let spread = spread.min(source.len());
        let vertices: Vec<u32> = source.samples[..spread].iter().chain(points).copied().collect();
        let rows: Vec<Vec<f32>> =
            vertices.iter().map(|&v| source.distances_from(&source.readings[v as usize])).collect();
        let mut distances = Vec::with_capacity(vertices.len() * vertices.len());
        for row in &rows {
            let far = |&v: &u32| source.readings[v as usize].iter().map(|&(s, w)| w * row[s as usize]).sum::<f32>();
            distances.extend(vertices.iter().map(far));
        }
        let given = |k: &Option<u32>| k.map(|v| self.place(v));
        let givens = (0..spread).map(|_| None).chain(known.iter().map(given));
        let points = vertices.iter().zip(givens).enumerate().map(|(i, (&v, given))| Point {
            place: source.points[v as usize],
            normal: source.vertex_normals[v as usize],
            remote: source.readings[v as usize].iter().map(|&(s, w)| w * source.remote[s as usize]).sum(),
            weight: match given {
                Some(_) => GIVEN,
                None if i < spread => 1.0,
                None => ASKED,
            },
            given,
        });
        PointSet { points: points.collect(), distances, spread }
    }

    /// A vertex of the target as a place.
    pub fn place(self, vertex: u32) -> TargetPlace {
        let reading = &self.target.readings[vertex as usize];
        TargetPlace {
            place: self.target.points[vertex as usize],
            distances: self.target.distances_from(reading),
            sample: self.target.cell[vertex as usize],
        }
    }

    /// The rounds in which a set moves from the places `at`, one for each reach.
    pub fn agree(self, set: &'a PointSet, at: Vec<Option<u32>>, reaches: &[f64]) -> Consensus<'a> {
        let mut consensus = Consensus::new(self.target, self.target.len(), &set.points, &set.distances, at);
        reaches.iter().for_each(|&reach| consensus.round(&Rules { reach, ..LAST }));
        consensus
    }
}

impl PointSet {
    /// The same points asked for, with a smaller spread.
    pub fn with_spread(&self, spread: usize) -> Self {
        let spread = spread.min(self.spread);
        let kept: Vec<usize> = (0..spread).chain(self.spread..self.points.len()).collect();
        let row = |i: usize| kept.iter().map(move |&j| self.distances[i * self.points.len() + j]);
        Self {
            points: kept.iter().map(|&i| self.points[i].clone()).collect(),
            distances: kept.iter().flat_map(|&i| row(i)).collect(),
            spread,
        }
    }

    /// Places of the whole set from those of its spread, or of one with this in front: the points asked for have none yet.
    pub fn placed_from_spread(&self, spread: &[Option<u32>]) -> Vec<Option<u32>> {
        let mut at = vec![None; self.points.len()];
        let known = self.spread.min(spread.len());
        at[..known].copy_from_slice(&spread[..known]);
        at
    }

    /// The places of a set with a smaller spread, in this one: what that does not have has none yet.
    pub fn placed_from(&self, fewer: &Self, places: &[Option<u32>]) -> Vec<Option<u32>> {
        let mut at = vec![None; self.points.len()];
        at[..fewer.spread].copy_from_slice(&places[..fewer.spread]);
        at[self.spread..].copy_from_slice(&places[fewer.spread..]);
        at
    }
}
