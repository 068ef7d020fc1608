//! What a set of points leaves of the poses, and how much of it one more point would take.

use super::coarse::CoarseMesh;
use super::field::{Field, NOTHING};
use crate::skinning::Rows;
use crate::skinning::factor::Factor;
use glam::DVec3;

/// What a set leaves of the poses when it is fitted by least squares alone.
pub struct Leftover<'a> {
    coarse: &'a CoarseMesh,
    at: Vec<DVec3>,
    rows: Rows,
    factor: Factor,
    /// #V displacements left, pose by pose.
    left: Vec<Vec<DVec3>>,
    hold: f64,
}

impl<'a> Leftover<'a> {
    /// Fits the set of `handles` (vertices of the coarse mesh) with `weights`, #V × #H row-major.
    pub fn new(coarse: &'a CoarseMesh, handles: &[u32], weights: &[f64], hold: f64) -> Self {
        let surface = &coarse.surface;
        let at: Vec<DVec3> = handles.iter().map(|&v| surface.reference[v as usize]).collect();
        let rows = Rows::new(weights, handles.len());
        let n = 4 * at.len();
        let mut a = vec![0.0; n * n];
        let mut held = vec![0.0; at.len()];
        for (v, &m) in surface.counts.iter().enumerate() {
            let row: Vec<(usize, [f64; 4])> = entries(&rows, v, surface.reference[v], &at).collect();
            for (r, (k, f)) in row.iter().enumerate() {
                held[*k] += hold * m * f[3];
                for (l, g) in &row[..=r] {
                    for (i, f) in f.iter().enumerate() {
                        (0..4).for_each(|j| a[(4 * k + i) * n + 4 * l + j] += m * f * g[j]);
                    }
                }
            }
        }
        (0..n).for_each(|i| a[i * n + i] += held[i / 4]);
        let factor = Factor::new(a, n);
        let left = coarse.placed.iter().map(|placed| {
            let d = &placed.displacements;
            let mut x = vec![[0.0; 3]; n];
            for (v, (&m, d)) in surface.counts.iter().zip(d).enumerate() {
                for (k, f) in entries(&rows, v, surface.reference[v], &at) {
                    for (x, f) in x[4 * k..4 * k + 4].iter_mut().zip(f) {
                        (0..3).for_each(|c| x[c] += m * f * d[c]);
                    }
                }
            }
            factor.solve(&mut x);
            let left = |(v, d): (usize, &DVec3)| {
                let mut d = *d;
                for (k, f) in entries(&rows, v, surface.reference[v], &at) {
                    x[4 * k..4 * k + 4].iter().zip(f).for_each(|(x, f)| d -= f * DVec3::from_array(*x));
                }
                d
            };
            d.iter().enumerate().map(left).collect()
        });
        let left = left.collect();
        Self { coarse, at, rows, factor, left, hold }
    }

    /// By how much the summed squared distance falls when the functions `field [p − c, 1]` may be added.
    pub fn gain(&self, candidate: u32, field: &Field) -> f64 {
        let surface = &self.coarse.surface;
        let c = surface.reference[candidate as usize];
        let mut own = [[0.0; 4]; 4];
        let mut cross = vec![[0.0; 4]; 4 * self.at.len()];
        let mut pull = vec![[[0.0; 3]; 4]; self.left.len()];
        for (v, (&m, &w)) in surface.counts.iter().zip(&field.value).enumerate() {
            if w <= NOTHING || m <= 0.0 {
                continue;
            }
            let p = surface.reference[v] - c;
            let f = [w * p.x, w * p.y, w * p.z, w];
            let mf = f.map(|f| m * f);
            for (own, mf) in own.iter_mut().zip(mf) {
                (0..4).for_each(|j| own[j] += mf * f[j]);
            }
            for (k, g) in entries(&self.rows, v, surface.reference[v], &self.at) {
                for (cross, g) in cross[4 * k..4 * k + 4].iter_mut().zip(g) {
                    (0..4).for_each(|j| cross[j] += g * mf[j]);
                }
            }
            for (pull, left) in pull.iter_mut().zip(&self.left) {
                let left = left[v];
                for (pull, mf) in pull.iter_mut().zip(mf) {
                    (0..3).for_each(|i| pull[i] += mf * left[i]);
                }
            }
        }
        let mut x = cross.clone();
        self.factor.solve(&mut x);
        let held = self.hold * own[3][3].max(f64::MIN_POSITIVE);
        let mut schur = vec![0.0; 16];
        for i in 0..4 {
            for j in 0..4 {
                let known: f64 = cross.iter().zip(&x).map(|(a, b)| a[i] * b[j]).sum();
                schur[4 * i + j] = own[i][j] - known + if i == j { held } else { 0.0 };
            }
        }
        let factor = Factor::new(schur, 4);
        let gain = |pull: &[[f64; 3]; 4]| -> f64 {
            let mut x = pull.to_vec();
            factor.solve(&mut x);
            x.as_flattened().iter().zip(pull.as_flattened()).map(|(a, b)| a * b).sum()
        };
        pull.iter().map(gain).sum()
    }
}

fn entries<'a>(rows: &'a Rows, v: usize, p: DVec3, at: &'a [DVec3]) -> impl Iterator<Item = (usize, [f64; 4])> + 'a {
    rows.entries(v).map(move |(k, w)| {
        let local = p - at[k as usize];
        (k as usize, [w * local.x, w * local.y, w * local.z, w])
    })
}
