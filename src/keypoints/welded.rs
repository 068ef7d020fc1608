//! The mesh on which key points are sought: welded, in the unit sphere.

use crate::mesh::ball::unit_ball;
use crate::mesh::face;
use crate::mesh::laplacian::Laplacian;
use crate::mesh::pieces::pieces;
use crate::mesh::weld::{compact, weld};
use crate::poses::spread;
use crate::sequence::Sequence;
use glam::DVec3;

/// Vertices nearer than this (in unit-sphere radii), in every pose, are one.
const WELD: f64 = 1e-7;

/// Coordinates of poses beyond this (in unit-sphere radii) are taken as this, so that squares stay in range.
const FAR: f64 = 1e60;

/// Poses that take part in the search; all take part in the errors that are reported.
const MOST_POSES: usize = 12;

/// Vertices by which poses are compared.
const COMPARED: usize = 500;

/// A mesh and its poses, vertices that agree welded, lengths in unit-sphere radii.
pub struct WeldedSequence {
    /// Triples of vertices; faces that name a vertex twice are left out.
    pub faces: Vec<[u32; 3]>,
    /// #V points.
    pub reference: Vec<DVec3>,
    /// #V points a pose.
    pub poses: Vec<Vec<DVec3>>,
    /// #V: how many vertices of the sequence each stands for that faces use.
    pub counts: Vec<f64>,
    /// #V vertices of the sequence.
    pub origin: Vec<u32>,
    /// For each vertex of the sequence, its number here.
    pub number: Vec<u32>,
    /// The vertices of each connected piece, the piece of largest area first.
    pub pieces: Vec<Vec<u32>>,
    /// Vertices with a face, ascending.
    pub used: Vec<u32>,
    /// Cotangents and areas.
    pub laplacian: Laplacian,
    /// Centre and radius of the unit sphere, in mesh units.
    pub ball: (DVec3, f64),
}

impl WeldedSequence {
    /// Welds and scales a sequence.
    pub fn new(sequence: &Sequence) -> Self {
        let faces = sequence.acting_faces();
        let ball = unit_ball(&faces, sequence.reference());
        let scaled = |points: &[DVec3]| -> Vec<DVec3> {
            let place = |p: &DVec3| ((*p - ball.0) / ball.1).clamp(DVec3::splat(-FAR), DVec3::splat(FAR));
            points.iter().map(place).collect()
        };
        let reference = scaled(sequence.reference());
        let poses: Vec<Vec<DVec3>> = sequence.poses().iter().map(|pose| scaled(&pose.positions)).collect();
        let all: Vec<&[DVec3]> = std::iter::once(&reference).chain(&poses).map(Vec::as_slice).collect();
        let (origin, number) = compact(&weld(&all, WELD));
        let welded: Vec<[u32; 3]> =
            (faces.iter().map(|face| face.map(|v| number[v as usize]))).filter(face::is_whole).collect();
        let mut seen = vec![false; number.len()];
        faces.iter().flatten().for_each(|&v| seen[v as usize] = true);
        let mut counts = vec![0.0; origin.len()];
        number.iter().zip(&seen).filter(|(_, seen)| **seen).for_each(|(&n, _)| counts[n as usize] += 1.0);
        let kept = |points: &[DVec3]| origin.iter().map(|&v| points[v as usize]).collect();
        Self::assemble(welded, kept(&reference), poses.iter().map(|p| kept(p)).collect(), counts, origin, number, ball)
    }

    /// From welded parts.
    pub fn assemble(
        faces: Vec<[u32; 3]>,
        reference: Vec<DVec3>,
        poses: Vec<Vec<DVec3>>,
        counts: Vec<f64>,
        origin: Vec<u32>,
        number: Vec<u32>,
        ball: (DVec3, f64),
    ) -> Self {
        let laplacian = Laplacian::new(&faces, &reference);
        let mut used: Vec<u32> = faces.iter().flatten().copied().collect();
        used.sort_unstable();
        used.dedup();
        let pieces = by_area(&faces, &reference);
        Self { faces, reference, poses, counts, origin, number, pieces, used, laplacian, ball }
    }

    /// A few poses that are far from the reference and from each other, in ascending order.
    pub fn telling_poses(&self) -> Vec<usize> {
        let step = self.used.len().div_ceil(COMPARED).max(1);
        let compared: Vec<usize> = self.used.iter().step_by(step).map(|&v| v as usize).collect();
        spread(&self.reference, &self.poses, &compared, MOST_POSES, f64::NEG_INFINITY)
    }
}

/// The vertices of each piece in ascending order, the largest piece first.
fn by_area(faces: &[[u32; 3]], points: &[DVec3]) -> Vec<Vec<u32>> {
    let found = pieces(faces, points.len());
    let mut list = vec![(0.0, Vec::new()); found.count];
    for (face, &piece) in faces.iter().zip(&found.face) {
        let entry = &mut list[piece as usize];
        entry.0 += face::double_area_normal(face::corners(points, *face)).length();
        entry.1.extend(*face);
    }
    for (_, vertices) in &mut list {
        vertices.sort_unstable();
        vertices.dedup();
    }
    list.sort_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));
    list.into_iter().map(|(_, vertices)| vertices).collect()
}
