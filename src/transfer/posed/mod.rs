//! The target turned, part by part, into the posture of the source's reference.
//!
//! Tong-Yee Lee, Yu-Shuen Wang, Tai-Guang Chen, *Segmenting a deforming mesh into near-rigid components*, The Visual
//! Computer 22(9), 2006, §5: deformation transfer wants both references in one posture. So the near-rigid parts of the
//! source become parts of the target through the correspondence, and each is given the rotation P that turns its normals
//! onto those of its twin. For column vectors the map that is asked of a face is S·P: first turned into the source's
//! posture, then moved as the source moves from there. (Eq. 9 prints P × S.)
//!
//! Beyond the paper: rotations are blended across the boundaries of parts ([`blend`]), so that no crease shows; and the
//! target so turned is easier to correspond to, so that both are done in turns.

pub mod blend;

use super::alignment::Alignment;
use super::correspondence::Correspondence;
use super::correspondence::fit::{face_normals, normals_at};
use super::gradients::solver::Solver;
use super::surface::WeldedSurface;
use crate::linalg::cholesky::NotPositiveDefinite;
use crate::linalg::outer::outer;
use crate::linalg::polar::angle;
use crate::linalg::rigid_fit::best_rotation;
use crate::mesh::face;
use glam::{DMat3, DVec3};

/// What positions about the middle of a part count beside its normals: they tell the direction of a part that is round.
const POSITIONS: f64 = 1.0;
/// A part that turns by less (radians) says where the whole stays.
const STAYS: f64 = 0.2;

/// The target in another posture.
#[derive(Clone, Debug, Default)]
pub struct Posture {
    /// #F rotations of its faces; none if it is as it was.
    pub turns: Vec<DMat3>,
    /// #N positions, in its unit ball.
    pub positions: Vec<DVec3>,
    /// The number of parts.
    pub parts: usize,
}

impl Posture {
    /// The target as it is.
    pub fn unturned(target: &WeldedSurface) -> Self {
        Self { turns: Vec::new(), positions: target.positions.clone(), parts: 0 }
    }
}

/// Finds the posture of the source's reference for the target. `parts` are #F numbers of the source's faces.
pub fn posture(
    source: &WeldedSurface,
    parts: &[u32],
    target: &WeldedSurface,
    correspondence: &Correspondence,
    alignment: Alignment,
) -> Result<Posture, NotPositiveDefinite> {
    let count = parts.iter().max().map_or(0, |&most| most as usize + 1);
    let aligned: Vec<DVec3> = source.positions.iter().map(|&p| alignment.apply(p)).collect();
    let labels = labels(parts, target, correspondence);
    let rotations = rotations(source, &aligned, target, correspondence, &labels, count);
    let shares = blend::shares(target, &labels, count)?;
    let turns = blend::blended(target, &shares, &rotations);
    let areas = face::areas(&target.faces, &target.positions);
    let mean = (areas.iter().sum::<f64>() / areas.len().max(1) as f64).max(f64::MIN_POSITIVE);
    let weights: Vec<f64> = areas.iter().map(|area| (area / mean).max(1e-3)).collect();
    let solver = Solver::new(target, &weights, &[])?;
    let mut positions = solver.solve(1, &|_| turns.clone(), &[]).pop().unwrap_or_default();
    stay(target, &turns, &areas, &mut positions);
    Ok(Posture { turns, positions, parts: count })
}

/// #F parts of the target's faces: that of most of their partners.
fn labels(parts: &[u32], target: &WeldedSurface, correspondence: &Correspondence) -> Vec<u32> {
    let mut labels = vec![0; target.faces.len()];
    for of_face in correspondence.pairs.chunk_by(|a, b| a[0] == b[0]) {
        let mut found: Vec<u32> = of_face.iter().map(|pair| parts[pair[1] as usize]).collect();
        found.sort_unstable();
        let most = found.chunk_by(|a, b| a == b).max_by_key(|same| same.len());
        labels[of_face[0][0] as usize] = most.and_then(|same| same.first().copied()).unwrap_or(0);
    }
    labels
}

/// For each part the rotation that turns its normals, and its positions about its middle, onto those of its twin.
fn rotations(
    source: &WeldedSurface,
    aligned: &[DVec3],
    target: &WeldedSurface,
    correspondence: &Correspondence,
    labels: &[u32],
    count: usize,
) -> Vec<DMat3> {
    let (own, other) = (normals_at(source, aligned), face_normals(target));
    let (from, to) = (face::centroids(&target.faces, &target.positions), face::centroids(&source.faces, aligned));
    let areas = face::areas(&target.faces, &target.positions);
    let mut middles = vec![(DVec3::ZERO, DVec3::ZERO, 0.0); count];
    let each = |act: &mut dyn FnMut(usize, usize, usize, f64)| {
        for of_face in correspondence.pairs.chunk_by(|a, b| a[0] == b[0]) {
            let face = of_face[0][0] as usize;
            for pair in of_face {
                act(labels[face] as usize, face, pair[1] as usize, areas[face] / of_face.len() as f64);
            }
        }
    };
    each(&mut |part, face, partner, weight| {
        let middle = &mut middles[part];
        (middle.0, middle.1, middle.2) =
            (middle.0 + weight * from[face], middle.1 + weight * to[partner], middle.2 + weight);
    });
    let mut normals = vec![DMat3::ZERO; count];
    let mut places = vec![(DMat3::ZERO, 0.0); count];
    each(&mut |part, face, partner, weight| {
        let (a, b, total) = middles[part];
        let total = total.max(f64::MIN_POSITIVE);
        let (p, q) = (from[face] - a / total, to[partner] - b / total);
        normals[part] += outer(weight * own[partner], other[face]);
        places[part].0 += outer(weight * q, p);
        places[part].1 += weight * p.length() * q.length();
    });
    let rotation = |part: usize| {
        let ((places, size), (_, _, total)) = (places[part], middles[part]);
        let scale = if size > 0.0 { POSITIONS * total / size } else { 0.0 };
        best_rotation(normals[part] + places * scale)
    };
    (0..count).map(rotation).collect()
}

/// Moves the turned target so that what hardly turned stays where it was.
fn stay(target: &WeldedSurface, turns: &[DMat3], areas: &[f64], positions: &mut [DVec3]) {
    let (mut off, mut total) = (DVec3::ZERO, 0.0);
    for ((corners, turn), area) in target.faces.iter().zip(turns).zip(areas) {
        let weight = area / (1.0 + (angle(*turn) / STAYS).powi(4));
        for &v in corners {
            off += weight * (positions[v as usize] - target.positions[v as usize]);
            total += weight;
        }
    }
    if total > 0.0 && off.is_finite() {
        positions.iter_mut().for_each(|p| *p -= off / total);
    }
}
