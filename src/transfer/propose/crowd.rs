//! Points of one figure that look for their places on the other together: a spread of its samples, and those asked for.

use super::consensus::{Consensus, LAST, Point, Rules, Target};
use super::sampled::SampledSurface;

/// Samples of the source that look for their places beside the points asked for: in the first rounds, and in the last.
pub const COMPANY: [usize; 2] = [60, 120];

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
pub struct Crowd {
    /// The company first, then the points asked for.
    pub points: Vec<Point>,
    /// Distances between all of them, row by row.
    pub distances: Vec<f32>,
    /// How many are company.
    pub company: usize,
}

impl<'a> Figures<'a> {
    /// The other way round.
    pub fn reversed(self) -> Self {
        Self { source: self.target, target: self.source }
    }

    /// The first `company` samples of the source and then the points asked for (vertices of the source), some of which
    /// have `known` places (vertices of the target).
    pub fn crowd(self, company: usize, points: &[u32], known: &[Option<u32>]) -> Crowd {
        let source = self.source;
        let company = company.min(source.len());
        let vertices: Vec<u32> = source.samples[..company].iter().chain(points).copied().collect();
        let rows: Vec<Vec<f32>> =
            vertices.iter().map(|&v| source.distances_from(&source.readings[v as usize])).collect();
        let mut distances = Vec::with_capacity(vertices.len() * vertices.len());
        for row in &rows {
            let far = |&v: &u32| source.readings[v as usize].iter().map(|&(s, w)| w * row[s as usize]).sum::<f32>();
            distances.extend(vertices.iter().map(far));
        }
        let given = |k: &Option<u32>| k.map(|v| self.place(v));
        let givens = (0..company).map(|_| None).chain(known.iter().map(given));
        let points = vertices.iter().zip(givens).enumerate().map(|(i, (&v, given))| Point {
            place: source.points[v as usize],
            normal: source.vertex_normals[v as usize],
            remote: source.readings[v as usize].iter().map(|&(s, w)| w * source.remote[s as usize]).sum(),
            weight: match given {
                Some(_) => GIVEN,
                None if i < company => 1.0,
                None => ASKED,
            },
            given,
        });
        Crowd { points: points.collect(), distances, company }
    }

    /// A vertex of the target as a place.
    pub fn place(self, vertex: u32) -> Target {
        let reading = &self.target.readings[vertex as usize];
        Target {
            place: self.target.points[vertex as usize],
            distances: self.target.distances_from(reading),
            sample: self.target.cell[vertex as usize],
        }
    }

    /// The rounds in which a crowd moves from the places `at`, one for each reach.
    pub fn agree(self, crowd: &'a Crowd, at: Vec<Option<u32>>, reaches: &[f64]) -> Consensus<'a> {
        let mut consensus = Consensus::new(self.target, self.target.len(), &crowd.points, &crowd.distances, at);
        reaches.iter().for_each(|&reach| consensus.round(&Rules { reach, ..LAST }));
        consensus
    }
}

impl Crowd {
    /// The same points asked for, with less company.
    pub fn with_company(&self, company: usize) -> Self {
        let company = company.min(self.company);
        let kept: Vec<usize> = (0..company).chain(self.company..self.points.len()).collect();
        let row = |i: usize| kept.iter().map(move |&j| self.distances[i * self.points.len() + j]);
        Self {
            points: kept.iter().map(|&i| self.points[i].clone()).collect(),
            distances: kept.iter().flat_map(|&i| row(i)).collect(),
            company,
        }
    }

    /// Places of the whole crowd from those of its company, or of a company with this one in front: the points asked for
    /// have none yet.
    pub fn with_strangers(&self, company: &[Option<u32>]) -> Vec<Option<u32>> {
        let mut at = vec![None; self.points.len()];
        let known = self.company.min(company.len());
        at[..known].copy_from_slice(&company[..known]);
        at
    }

    /// The places of a crowd with less company, in this one: the newcomers have none yet.
    pub fn with_newcomers(&self, fewer: &Self, places: &[Option<u32>]) -> Vec<Option<u32>> {
        let mut at = vec![None; self.points.len()];
        at[..fewer.company].copy_from_slice(&places[..fewer.company]);
        at[self.company..].copy_from_slice(&places[fewer.company..]);
        at
    }
}
