//! The motions of given bones in a pose: rotations bone by bone, then all translations together.

use super::weights::Row;
use crate::linalg::polar::frobenius;
use crate::linalg::rigid_fit::Moments;
use crate::transfer::surface::WeldedSurface;
use glam::{DAffine3, DMat3, DVec3};
use nalgebra::{Cholesky, DMatrix, Dyn};

/// The rotation of a bone is that of the vertices which follow little else: shares count to this power.
const OWN: i32 = 4;
/// How much translations are held to those of the bones on their own.
const HOLD: f64 = 1e-3;
/// How much the rotation of a bone is drawn to those of the bones it blends with: only where few vertices, or vertices on a
/// line, leave it open is that felt.
const COMPANY: f64 = 1e-3;
/// Vertices that lie no farther apart than the root of this, in radii, are as good as one.
const POINT: f64 = 1e-6;

/// What the fit of a pose needs of the weights.
#[derive(Clone, Debug, Default)]
pub struct Motions {
    rows: Vec<Row>,
    bones: usize,
    hold: Vec<f64>,
    /// For each bone those that it blends with, and how much, in shares that sum to 1.
    company: Vec<Vec<(usize, f64)>>,
    system: Option<Cholesky<f64, Dyn>>,
}

impl Motions {
    /// Prepares the weights of a surface.
    pub fn new(surface: &WeldedSurface, rows: &[Row], bones: usize) -> Self {
        let mut system = DMatrix::zeros(bones, bones);
        let mut hold = vec![1e-12; bones];
        for (row, m) in rows.iter().zip(&surface.mass) {
            for &(i, a) in row {
                hold[i as usize] += HOLD * m * a;
                row.iter().for_each(|&(j, b)| system[(i as usize, j as usize)] += m * a * b);
            }
        }
        let company = (0..bones).map(|i| company(&system, i)).collect();
        (0..bones).for_each(|i| system[(i, i)] += hold[i]);
        Self { rows: rows.to_vec(), bones, hold, company, system: system.cholesky() }
    }

    /// The motion of each bone that carries the surface best to #N other positions.
    pub fn fit(&self, surface: &WeldedSurface, pose: &[DVec3]) -> Vec<DAffine3> {
        let mut moments = vec![Moments::default(); self.bones];
        for (v, row) in self.rows.iter().enumerate() {
            for &(bone, share) in row {
                let weight = surface.mass[v] * share.powi(OWN);
                moments[bone as usize].add(weight, surface.positions[v], pose[v]);
            }
        }
        let covariances: Vec<DMat3> = moments.iter().map(Moments::covariance).collect();
        let map = |(m, bone): (&Moments, usize)| {
            let motion = m.motion_with(self.drawn(&covariances, bone, POINT * m.weight));
            DAffine3::from_mat3_translation(motion.rotation, motion.translation)
        };
        let mut maps: Vec<DAffine3> = moments.iter().zip(0..).map(map).collect();
        self.translations(surface, pose, &mut maps);
        maps
    }

    /// What the bones that a bone blends with add to its covariance: theirs, at the scale of its own, which is `least` at
    /// least.
    fn drawn(&self, covariances: &[DMat3], bone: usize, least: f64) -> DMat3 {
        let own = frobenius(covariances[bone]).max(least);
        let others = self.company[bone].iter().map(|&(other, share)| (covariances[other], share));
        let scaled = others.filter(|(c, _)| frobenius(*c) > 0.0).map(|(c, share)| c * (share * own / frobenius(c)));
        COMPANY * scaled.sum::<DMat3>()
    }

    /// Given the rotations, the translations that carry the blended surface best.
    fn translations(&self, surface: &WeldedSurface, pose: &[DVec3], maps: &mut [DAffine3]) {
        let Some(system) = &self.system else { return };
        let mut side = DMatrix::zeros(self.bones, 3);
        for (i, map) in maps.iter().enumerate() {
            (0..3).for_each(|k| side[(i, k)] = self.hold[i] * map.translation[k]);
        }
        for (v, row) in self.rows.iter().enumerate() {
            let turned = row.iter().map(|&(b, share)| share * (maps[b as usize].matrix3 * surface.positions[v]));
            let left = pose[v] - turned.sum::<DVec3>();
            for &(i, share) in row {
                (0..3).for_each(|k| side[(i as usize, k)] += surface.mass[v] * share * left[k]);
            }
        }
        system.solve_mut(&mut side);
        for (i, map) in maps.iter_mut().enumerate() {
            let solved = DVec3::new(side[(i, 0)], side[(i, 1)], side[(i, 2)]);
            if solved.is_finite() {
                map.translation = solved;
            }
        }
    }
}

/// The bones that share vertices with a bone, and how much, in shares that sum to 1.
fn company(blends: &DMatrix<f64>, bone: usize) -> Vec<(usize, f64)> {
    let others = || (0..blends.nrows()).filter(|&other| other != bone && blends[(bone, other)] > 0.0);
    let all: f64 = others().map(|other| blends[(bone, other)]).sum();
    others().map(|other| (other, blends[(bone, other)] / all)).collect()
}
