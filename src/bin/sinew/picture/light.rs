//! A wide key light, fill from the sky and from the warm ground, and dimness in corners.

use super::raster::{Raster, Sample};
use glam::{DVec3, Vec3};

/// Where the key light is, in the frame of the eye: left, above, in front.
pub const KEY: DVec3 = DVec3::new(-0.45, 0.65, 0.61);

const KEY_LIGHT: Vec3 = Vec3::new(0.86, 0.83, 0.78);
const SKY: Vec3 = Vec3::new(0.34, 0.36, 0.40);
const GROUND: Vec3 = Vec3::new(0.22, 0.19, 0.16);
/// How far the key light reaches around.
const WRAP: f64 = 0.35;
/// Radius in which corners are looked for, as a share of the extent.
const CORNER: f64 = 0.05;
/// How dark they are.
const DARKEST: f64 = 0.75;

/// The light that a matte surface sends on, for a white one.
pub fn clay(normal: DVec3, key: DVec3) -> Vec3 {
    let direct = ((normal.dot(key.normalize()) + WRAP) / (1.0 + WRAP)).max(0.0) as f32;
    let above = (0.5 + 0.5 * normal.y) as f32;
    KEY_LIGHT * direct + GROUND.lerp(SKY, above)
}

/// How open the surroundings of a sample are, 0 to 1, from the depths around it (after Mittring, *Finding next gen:
/// CryEngine 2*, SIGGRAPH courses 2007, §8.5).
pub fn openness(raster: &Raster, at: [usize; 2], seen: &Sample, extent: f64) -> f32 {
    let radius = CORNER * extent;
    let reach = raster.across(radius, seen.depth);
    let (mut hidden, mut count) = (0.0, 0.0);
    for i in 0..24 {
        // A spiral by the golden angle covers the disc evenly.
        let (r, angle) = (((f64::from(i) + 0.5) / 24.0).sqrt(), 2.399_963 * f64::from(i));
        let (dx, dy) = (r * reach * angle.cos(), r * reach * angle.sin());
        let (x, y) = (at[0] as f64 + dx, at[1] as f64 + dy);
        count += 1.0;
        if x < 0.0 || y < 0.0 {
            continue;
        }
        let Some(other) = raster.sample([x as usize, y as usize]) else { continue };
        let across = radius / reach.max(1e-9);
        let offset = DVec3::new(dx * across, -dy * across, seen.depth - other.depth);
        let length = offset.length();
        let rise = offset.dot(seen.normal) / length.max(1e-9);
        let near = (1.0 - (length / (2.0 * radius)).powi(2)).max(0.0);
        hidden += (rise - 0.1).max(0.0) * near;
    }
    (1.0 - DARKEST * (1.8 * hidden / count).min(1.0)) as f32
}
