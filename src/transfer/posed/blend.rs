//! Rotations of parts, blended where parts meet.

use crate::linalg::cholesky::{Cholesky, NotPositiveDefinite};
use crate::linalg::polar;
use crate::mesh::laplacian::Laplacian;
use crate::transfer::surface::WeldedSurface;
use glam::DMat3;

/// How far the rotation of one part reaches into the next, in radii of the mesh.
const REACH: f64 = 0.04;
/// Cotangents are kept above this, so that shares stay between 0 and 1.
const LEAST_COTANGENT: f64 = 0.01;

/// #N × `count` shares of the parts at the places of a surface, which sum to 1 in each row: the parts themselves (#F
/// numbers below `count`), diffused as heat is.
pub fn shares(surface: &WeldedSurface, labels: &[u32], count: usize) -> Result<Vec<f64>, NotPositiveDefinite> {
    let n = surface.len();
    let laplacian = Laplacian::new(&surface.faces, &surface.positions);
    // The places' areas sum to that of the surface, as lengths are those of the Laplacian.
    let total: f64 = crate::mesh::face::areas(&surface.faces, &surface.positions).iter().sum();
    let mass: Vec<f64> = surface.mass.iter().map(|m| m * total.max(f64::MIN_POSITIVE)).collect();
    let mut entries: Vec<(u32, u32, f64)> = mass.iter().zip(0_u32..).map(|(&m, v)| (v, v, m)).collect();
    for (&[a, b], &cotangent) in laplacian.edges.iter().zip(&laplacian.cotangents) {
        let w = REACH * REACH * cotangent.max(LEAST_COTANGENT);
        entries.extend([(a, a, w), (b, b, w), (a.max(b), a.min(b), -w)]);
    }
    let factor = Cholesky::new(n, &entries)?;
    let mut columns = vec![0.0; n * count];
    for (v, mass) in mass.iter().enumerate() {
        let faces = surface.faces_around(v);
        for &f in faces {
            columns[labels[f as usize] as usize * n + v] += mass / faces.len() as f64;
        }
    }
    factor.solve(&mut columns);
    let mut rows = vec![0.0; n * count];
    for v in 0..n {
        let row = &mut rows[v * count..(v + 1) * count];
        row.iter_mut().enumerate().for_each(|(k, share)| *share = columns[k * n + v].max(0.0));
        let sum: f64 = row.iter().sum();
        row.iter_mut().for_each(|share| *share /= sum.max(f64::MIN_POSITIVE));
    }
    Ok(rows)
}

/// #F rotations: those of the parts, blended by the shares of a face's corners.
pub fn blended(surface: &WeldedSurface, shares: &[f64], rotations: &[DMat3]) -> Vec<DMat3> {
    let count = rotations.len();
    let of_face = |corners: &[u32; 3]| {
        let mut sum = DMat3::ZERO;
        for &v in corners {
            for (rotation, &share) in rotations.iter().zip(&shares[v as usize * count..]) {
                sum += *rotation * share;
            }
        }
        polar::rotation(sum * (1.0 / 3.0))
    };
    surface.faces.iter().map(of_face).collect()
}
