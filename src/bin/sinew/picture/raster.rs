//! Which point of a mesh is seen at each sample of a picture.

use super::{Eye, Model};
use glam::DVec3;

/// What is seen at a sample.
#[derive(Clone, Copy)]
pub struct Sample {
    /// Distance from the eye's plane.
    pub depth: f64,
    /// Direction away from the surface, in the frame of the eye (x right, y up, z towards it).
    pub normal: DVec3,
    /// Number of the part.
    pub part: u32,
}

/// Samples of a picture.
pub struct Raster {
    width: usize,
    height: usize,
    samples: Vec<Option<Sample>>,
}

impl Raster {
    /// What the eye sees of a model.
    pub fn new(model: &Model, eye: &Eye, width: usize, height: usize) -> Self {
        let mut raster = Self { width, height, samples: vec![None; width * height] };
        let seen: Vec<DVec3> = model.points.iter().map(|&p| raster.pixel(eye.see(p))).collect();
        let normals = normals(model);
        let turned: Vec<DVec3> = normals.iter().map(|&n| eye.turn * n).collect();
        for (face, &part) in model.faces.iter().zip(model.labels) {
            let corners = face.map(|v| seen[v as usize]);
            let normals = face.map(|v| turned[v as usize]);
            raster.triangle(corners, normals, part, model.open);
        }
        raster
    }

    /// Half the shorter side in samples.
    fn unit(&self) -> f64 {
        0.5 * self.width.min(self.height) as f64
    }

    fn pixel(&self, seen: DVec3) -> DVec3 {
        let unit = self.unit();
        DVec3::new(0.5 * self.width as f64 + unit * seen.x, 0.5 * self.height as f64 - unit * seen.y, seen.z)
    }

    /// The place of a sample, as [`Eye::see`] gives places.
    pub fn place(&self, at: [usize; 2]) -> [f64; 2] {
        let unit = self.unit();
        [(at[0] as f64 + 0.5 - 0.5 * self.width as f64) / unit, (0.5 * self.height as f64 - at[1] as f64 - 0.5) / unit]
    }

    /// Samples across a length at a depth.
    pub fn across(&self, length: f64, depth: f64) -> f64 {
        length / (depth * super::NARROW) * self.unit()
    }

    /// What is seen at a sample.
    pub fn sample(&self, [x, y]: [usize; 2]) -> Option<&Sample> {
        if x < self.width { self.samples.get(y * self.width + x)?.as_ref() } else { None }
    }

    /// Whether another part begins to the right of a sample or below it.
    pub fn on_line(&self, [x, y]: [usize; 2]) -> bool {
        let part = |x: usize, y: usize| self.sample([x, y]).map(|s| s.part);
        let here = part(x, y);
        [(1, 0), (0, 1), (1, 1)].into_iter().any(|(i, j)| part(x + i, y + j).is_some_and(|other| Some(other) != here))
    }

    fn triangle(&mut self, [a, b, c]: [DVec3; 3], normals: [DVec3; 3], part: u32, open: bool) {
        let cross = |p: DVec3, q: DVec3, r: DVec3| (q.x - p.x) * (r.y - p.y) - (q.y - p.y) * (r.x - p.x);
        let area = cross(a, b, c);
        // Seen from the front, corners run clockwise where y points down.
        if area == 0.0 || area > 0.0 && !open {
            return;
        }
        let flip = if area > 0.0 { -1.0 } else { 1.0 };
        let span = |low: f64, high: f64, size: usize| {
            let from = (low - 0.5).ceil().max(0.0) as usize;
            from..((high + 0.5).floor().max(0.0) as usize).min(size)
        };
        for y in span(a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y), self.height) {
            for x in span(a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x), self.width) {
                let p = DVec3::new(x as f64 + 0.5, y as f64 + 0.5, 0.0);
                let [u, v, w] = [cross(p, b, c) / area, cross(p, c, a) / area, cross(p, a, b) / area];
                if u < 0.0 || v < 0.0 || w < 0.0 {
                    continue;
                }
                let depth = 1.0 / (u / a.z + v / b.z + w / c.z);
                let old = &mut self.samples[y * self.width + x];
                if old.is_none_or(|old| depth < old.depth) {
                    let normal = flip * (u * normals[0] + v * normals[1] + w * normals[2]).normalize_or(DVec3::Z);
                    *old = Some(Sample { depth, normal, part });
                }
            }
        }
    }
}

/// Normals of the vertices, weighted by area.
fn normals(model: &Model) -> Vec<DVec3> {
    let mut normals = vec![DVec3::ZERO; model.points.len()];
    for face in model.faces {
        let [a, b, c] = face.map(|v| model.points[v as usize]);
        for &v in face {
            normals[v as usize] += (b - a).cross(c - a);
        }
    }
    normals.into_iter().map(|n| n.normalize_or(DVec3::Y)).collect()
}
