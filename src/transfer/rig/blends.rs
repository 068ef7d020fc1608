//! Where two bones meet: the part of a surface that follows both.

use super::weights::Row;
use crate::transfer::surface::Surface;
use glam::DVec3;
use std::collections::BTreeMap;

/// The least part that counts, as a share of the area.
const LEAST: f64 = 1e-12;

/// The part of a surface that two bones share.
#[derive(Clone, Copy, Debug, Default)]
pub struct Blend {
    /// Its share of the area.
    pub weight: f64,
    sum: DVec3,
}

impl Blend {
    /// Its middle.
    pub fn middle(&self) -> DVec3 {
        self.sum / self.weight
    }
}

/// Blends by bones, the lower number first; a bone with itself is where the bone is.
pub type Blends = BTreeMap<(u32, u32), Blend>;

/// The blends of `bones` bones; `rows` are their shares at the vertices of a surface.
pub fn blends(surface: &Surface, rows: &[Row], bones: usize) -> Blends {
    // A bone meets few others.
    let mut met: Vec<Vec<(u32, Blend)>> = vec![Vec::new(); bones];
    for ((row, &m), &p) in rows.iter().zip(&surface.mass).zip(&surface.positions) {
        for &(i, a) in row {
            let Some(met) = met.get_mut(i as usize) else { continue };
            for &(j, b) in row.iter().filter(|other| other.0 >= i) {
                let place = met.iter().position(|blend| blend.0 == j).unwrap_or_else(|| {
                    met.push((j, Blend::default()));
                    met.len() - 1
                });
                let blend = &mut met[place].1;
                blend.weight += m * a * b;
                blend.sum += p * (m * a * b);
            }
        }
    }
    let named =
        met.into_iter().zip(0_u32..).flat_map(|(met, i)| met.into_iter().map(move |(j, blend)| ((i, j), blend)));
    named.filter(|(_, blend)| blend.weight > LEAST).collect()
}
