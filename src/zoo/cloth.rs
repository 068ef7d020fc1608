//! The cloth: a flag that deforms everywhere and has no parts.
//!
//! Every row keeps its length: it is a curve whose heading is a wave that runs from the pole outwards and grows on the
//! way. From row to row the wave is a little late, so that the folds lean; shear stays small, as in woven cloth.

use super::Recipe;
use glam::DVec3;
use std::f64::consts::TAU;

/// Width and height, and how high the lower edge hangs.
const WIDTH: f64 = 1.8;
const HEIGHT: f64 = 1.2;
const ABOVE: f64 = 0.8;
/// Waves along a row.
const WAVES: f64 = 1.25;
/// Steps of the integration along a row.
const STEPS: usize = 512;

/// What the cloth does, and how many seconds a loop takes.
pub const MOTIONS: [(&str, f64); 2] = [("wave", 1.4), ("ripple", 2.4)];

/// A rectangle of cloth.
pub struct Cloth {
    /// Where each vertex is on the cloth: along (0 at the pole to 1), up (0 to 1).
    pub places: Vec<[f64; 2]>,
    /// Triples of vertex numbers.
    pub faces: Vec<[u32; 3]>,
}

/// A cloth of about as many faces as the recipe says.
pub fn cloth(recipe: &Recipe) -> Cloth {
    let faces = recipe.faces.clamp(1_000, 1_000_000) as f64;
    let rows = (0.5 * faces * HEIGHT / WIDTH).sqrt().round().max(2.0) as u32;
    let columns = (0.5 * faces / f64::from(rows)).round().max(2.0) as u32;
    let places = (0..=rows)
        .flat_map(|j| (0..=columns).map(move |i| [f64::from(i) / f64::from(columns), f64::from(j) / f64::from(rows)]))
        .collect();
    let corner = |i: u32, j: u32| j * (columns + 1) + i;
    let quad = |i: u32, j: u32| {
        let [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
        // Diagonals alternate, so that no direction is preferred.
        if (i + j).is_multiple_of(2) { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] }
    };
    let faces = (0..rows).flat_map(|j| (0..columns).flat_map(move |i| quad(i, j))).collect();
    Cloth { places, faces }
}

impl Cloth {
    /// The flat cloth.
    pub fn flat(&self) -> Vec<DVec3> {
        self.places.iter().map(|&[s, t]| DVec3::new(0.0, ABOVE + HEIGHT * t, WIDTH * (0.5 - s))).collect()
    }

    /// The cloth in a motion at a phase.
    pub fn pose(&self, motion: &str, phase: f64) -> Vec<DVec3> {
        let ripple = motion == "ripple";
        self.in_rows(|s, t| if ripple { rippling(s, t, phase) } else { fluttering(s, t, phase) })
    }

    /// Follows each row outwards in the headings that `heading` gives: aside and down, in radians.
    fn in_rows(&self, heading: impl Fn(f64, f64) -> [f64; 2]) -> Vec<DVec3> {
        let mut positions = Vec::with_capacity(self.places.len());
        let mut row: Option<(f64, Vec<DVec3>)> = None;
        for &[s, t] in &self.places {
            if row.as_ref().is_none_or(|(up, _)| *up != t) {
                row = Some((t, follow(DVec3::new(0.0, ABOVE + HEIGHT * t, 0.5 * WIDTH), |s| heading(s, t))));
            }
            if let Some((_, row)) = &row {
                let along = (s * STEPS as f64).clamp(0.0, STEPS as f64);
                let before = (along as usize).min(STEPS - 1);
                positions.push(row[before].lerp(row[before + 1], along - before as f64));
            }
        }
        positions
    }
}

/// The curve with the given headings, in equal steps.
fn follow(start: DVec3, heading: impl Fn(f64) -> [f64; 2]) -> Vec<DVec3> {
    let step = WIDTH / STEPS as f64;
    let mut at = start;
    let mut row = vec![start];
    for i in 0..STEPS {
        let [aside, down] = heading((i as f64 + 0.5) / STEPS as f64);
        at += step * DVec3::new(aside.sin() * down.cos(), -down.sin(), -aside.cos() * down.cos());
        row.push(at);
    }
    row
}

/// A flag in the wind: held along one edge, its folds lean and run outwards.
fn fluttering(s: f64, t: f64, phase: f64) -> [f64; 2] {
    let grows = 0.16 + 0.86 * smooth(s / 0.75);
    let late = 0.20 * (1.0 - t);
    let wave = (TAU * (WAVES * s + late - phase)).sin();
    let small = (TAU * (2.3 * s - 0.34 * (1.0 - t) - 2.0 * phase)).sin();
    let sag = 0.16 * smooth(s) + 0.05 * (TAU * (0.5 * s - phase)).sin() * s;
    [grows * wave + 0.14 * s * small, sag]
}

/// A curtain in a draught: slow wide folds.
fn rippling(s: f64, t: f64, phase: f64) -> [f64; 2] {
    let grows = 0.55 * smooth((1.15 - t) / 0.9) + 0.12;
    let wave = (TAU * (2.5 * s + 0.12 * (1.0 - t) - phase)).sin();
    let drift = (TAU * (0.5 * s - phase + 0.2)).sin();
    [grows * wave + 0.16 * (1.0 - t) * drift, 0.0]
}

fn smooth(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}
