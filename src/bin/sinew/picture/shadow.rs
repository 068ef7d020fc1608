//! The soft shadow on the ground: dark where the body is close above it.

use glam::{DVec2, DVec3};

/// Cells along each side of the map.
const CELLS: usize = 96;
/// Free cells around the body.
const BORDER: usize = 12;
/// The darkest that the ground gets.
const DARK: f32 = 0.42;
/// Height at which the shadow is a third as dark, as a share of the extent.
const FADE: f64 = 0.12;

/// A map of the ground around y = 0.
pub struct Shadow {
    low: DVec2,
    cell: f64,
    extent: f64,
    dark: Vec<f32>,
}

impl Shadow {
    /// The shadow of a mesh.
    pub fn new(points: &[DVec3], faces: &[[u32; 3]]) -> Self {
        let flat = |p: &DVec3| DVec2::new(p.x, p.z);
        let (low, high) = points.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), |(l, h), &p| (l.min(p), h.max(p)));
        let extent = if points.is_empty() { 1.0 } else { (high - low).max_element().max(1e-9) };
        let cell = extent / (CELLS - 2 * BORDER) as f64;
        let low = flat(&(0.5 * (low + high))) - 0.5 * cell * CELLS as f64;
        let mut dark = vec![0.0_f32; CELLS * CELLS];
        for face in faces {
            let [a, b, c] = face.map(|v| points[v as usize]);
            let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
            let steps = (1.5 * longest / cell).ceil().clamp(1.0, 64.0) as usize;
            for i in 0..=steps {
                for j in 0..=steps - i {
                    let (u, v) = (i as f64 / steps as f64, j as f64 / steps as f64);
                    let p = a + u * (b - a) + v * (c - a);
                    let at = ((flat(&p) - low) / cell).floor();
                    let shade = (-p.y.max(0.0) / (FADE * extent)).exp() as f32;
                    if at.min_element() >= 0.0 && at.max_element() < CELLS as f64 {
                        let cell = &mut dark[at.y as usize * CELLS + at.x as usize];
                        *cell = cell.max(shade);
                    }
                }
            }
        }
        for _ in 0..3 {
            dark = blurred(&dark);
        }
        Self { low, cell, extent, dark }
    }

    /// The longest side of the mesh.
    pub fn extent(&self) -> f64 {
        self.extent
    }

    /// How dark the ground is at a point, 0 to 1.
    pub fn at(&self, p: DVec3) -> f32 {
        let at = (DVec2::new(p.x, p.z) - self.low) / self.cell - 0.5;
        if at.min_element() < 0.0 || at.max_element() >= (CELLS - 1) as f64 {
            return 0.0;
        }
        let (i, j, u, v) = (at.x as usize, at.y as usize, at.x.fract() as f32, at.y.fract() as f32);
        let value = |i: usize, j: usize| self.dark[j * CELLS + i];
        let row = |j: usize| value(i, j) * (1.0 - u) + value(i + 1, j) * u;
        DARK * (row(j) * (1.0 - v) + row(j + 1) * v)
    }
}

/// The mean of each cell and its neighbours, three by three.
fn blurred(dark: &[f32]) -> Vec<f32> {
    let line = |from: &[f32], step: usize, stride: usize| -> Vec<f32> {
        let mut out = vec![0.0; from.len()];
        for row in 0..CELLS {
            for i in 0..CELLS {
                let at = |i: usize| from[row * stride + i * step];
                let (before, after) = (at(i.saturating_sub(1)), at((i + 1).min(CELLS - 1)));
                out[row * stride + i * step] = (before + at(i) + after) / 3.0;
            }
        }
        out
    };
    line(&line(dark, 1, CELLS), CELLS, 1)
}
