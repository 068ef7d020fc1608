//! Where two bones meet: the part of a surface that follows both.

use super::weights::Row;
use crate::mesh::face;
use crate::transfer::surface::WeldedSurface;
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
    /// Adds a face whose corners have such shares of the two bones: the integrals of a b and of a b p, all linear.
    fn add(&mut self, area: f64, points: [DVec3; 3], a: DVec3, b: DVec3) {
        let (sum_a, sum_b) = (a.element_sum(), b.element_sum());
        let both = sum_a * sum_b + a.dot(b);
        self.weight += area / 12.0 * both;
        for k in 0..3 {
            self.sum += points[k] * (area / 60.0 * (both + a[k] * sum_b + b[k] * sum_a + 2.0 * a[k] * b[k]));
        }
    }

    /// Its middle.
    pub fn middle(&self) -> DVec3 {
        self.sum / self.weight
    }
}

/// Blends by bones, the lower number first; a bone with itself is where the bone is.
pub type Blends = BTreeMap<(u32, u32), Blend>;

/// The blends of `bones` bones; `rows` are their shares at the vertices of a surface, between which they are linear.
pub fn blends(surface: &WeldedSurface, rows: &[Row], bones: usize) -> Blends {
    // A bone meets few others.
    let mut met: Vec<Vec<(u32, Blend)>> = vec![Vec::new(); bones];
    let areas = face::areas(&surface.faces, &surface.positions);
    let total = areas.iter().sum::<f64>().max(f64::MIN_POSITIVE);
    let mut shares = Vec::new();
    for (corners, area) in surface.faces.iter().zip(&areas) {
        shares_in(rows, corners, &mut shares);
        let points = corners.map(|v| surface.positions[v as usize]);
        for (n, &(i, a)) in shares.iter().enumerate() {
            for &(j, b) in &shares[n..] {
                let Some(met) = met.get_mut(i.min(j) as usize) else { continue };
                let place = met.iter().position(|blend| blend.0 == i.max(j)).unwrap_or_else(|| {
                    met.push((i.max(j), Blend::default()));
                    met.len() - 1
                });
                met[place].1.add(area / total, points, a, b);
            }
        }
    }
    let named =
        met.into_iter().zip(0_u32..).flat_map(|(met, i)| met.into_iter().map(move |(j, blend)| ((i, j), blend)));
    named.filter(|(_, blend)| blend.weight > LEAST).collect()
}

/// The bones at the corners of a face, and their shares there.
fn shares_in(rows: &[Row], corners: &[u32; 3], shares: &mut Vec<(u32, DVec3)>) {
    shares.clear();
    for (corner, &v) in corners.iter().enumerate() {
        for &(bone, share) in &rows[v as usize] {
            match shares.iter_mut().find(|entry| entry.0 == bone) {
                Some(entry) => entry.1[corner] = share,
                None => shares.push((bone, DVec3::AXES[corner] * share)),
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sequence::Sequence;

    #[test]
    fn blends_are_integrals_over_the_faces() {
        let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
        let triangle = Sequence::new("triangle", vec![[0, 1, 2]], corners, Vec::new()).expect("a triangle");
        let surface = WeldedSurface::new(&triangle);
        let found = blends(&surface, &[vec![(0, 1.0)], vec![(1, 1.0)], vec![(1, 1.0)]], 2);
        // λ₀ (λ₁ + λ₂) has the mean 2/12, and its middle at 2/5, 3/10, 3/10.
        let both = found[&(0, 1)];
        assert!((both.weight - 2.0 / 12.0).abs() < 1e-12, "{}", both.weight);
        let middle = [0.4, 0.3, 0.3].iter().zip(&surface.positions).map(|(share, p)| *share * *p).sum::<DVec3>();
        assert!(both.middle().distance(middle) < 1e-12);
        let all: f64 = found.iter().map(|(&(i, j), blend)| if i == j { 1.0 } else { 2.0 } * blend.weight).sum();
        assert!((all - 1.0).abs() < 1e-12, "{all}");
    }
}
