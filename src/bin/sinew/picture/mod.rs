//! Small pictures of meshes, drawn without a graphics card: matte clay in the colours of its parts, on nothing but its
//! own shadow.

mod light;
mod raster;
mod shadow;

use glam::{DMat3, DVec3, Vec3};
use raster::{Raster, Sample};
use shadow::Shadow;
use sinew::view::colour::{linear_to_srgb, srgb_to_linear};

/// Samples of a pixel along each side.
const SAMPLES: usize = 3;
/// Half the field of view, as a tangent.
const NARROW: f64 = 0.16;
/// What is left free around the creature, as a share of the picture.
const MARGIN: f64 = 0.04;
/// Lines between parts keep this share of the light.
const LINE: f32 = 0.45;

/// A picture with straight alpha, row by row from the top.
#[derive(Clone)]
pub struct Picture {
    /// Pixels in a row.
    pub width: usize,
    /// Rows.
    pub height: usize,
    /// sRGB and alpha.
    pub pixels: Vec<[u8; 4]>,
}

/// From where a creature is looked at.
#[derive(Clone, Copy)]
pub struct Eye {
    turn: DMat3,
    /// What the picture is centred on.
    centre: DVec3,
    distance: f64,
}

impl Eye {
    /// An eye that sees all of `points` in a picture of the given aspect (width over height), turned so many degrees
    /// to the creature's left and up.
    pub fn around<'a>(points: impl Iterator<Item = &'a DVec3> + Clone, left: f64, up: f64, aspect: f64) -> Self {
        let turn = DMat3::from_rotation_x(up.to_radians()) * DMat3::from_rotation_y(-left.to_radians());
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for &p in points.clone() {
            low = low.min(turn * p);
            high = high.max(turn * p);
        }
        let centre = 0.5 * (low + high);
        let room = NARROW * (1.0 - 2.0 * MARGIN);
        let needed = points.map(|&p| {
            let q = turn * p - centre;
            q.z + (q.x.abs() / aspect.max(1.0)).max(q.y.abs() * aspect.min(1.0)) / room
        });
        let distance = needed.fold(1e-6, f64::max);
        Self { turn, centre: turn.transpose() * centre, distance }
    }

    /// Where a point is seen: right, up (−1 to 1 across the shorter side) and how far in front of the eye.
    fn see(&self, p: DVec3) -> DVec3 {
        let q = self.turn * (p - self.centre);
        let depth = (self.distance - q.z).max(1e-6);
        DVec3::new(q.x / (depth * NARROW), q.y / (depth * NARROW), depth)
    }

    /// Where the ray through a place of the picture meets the ground, if it does.
    fn ground(&self, right: f64, up: f64) -> Option<DVec3> {
        let back = self.turn.transpose();
        let from = self.centre + back * DVec3::new(0.0, 0.0, self.distance);
        let along = back * DVec3::new(right * NARROW, up * NARROW, -1.0);
        let t = -from.y / along.y;
        (along.y < 0.0 && t > 0.0).then(|| from + t * along)
    }
}

/// What is drawn.
pub struct Model<'a> {
    /// Positions.
    pub points: &'a [DVec3],
    /// Triples of position numbers.
    pub faces: &'a [[u32; 3]],
    /// #F part numbers.
    pub labels: &'a [u32],
    /// A colour a part.
    pub colours: &'a [[u8; 3]],
    /// Whether both sides of a face can be seen.
    pub open: bool,
}

/// Draws a mesh.
pub fn draw(model: &Model, eye: &Eye, width: usize, height: usize) -> Picture {
    let raster = Raster::new(model, eye, width * SAMPLES, height * SAMPLES);
    let shadow = Shadow::new(model.points, model.faces);
    let scale = shadow.extent();
    let colours: Vec<Vec3> = model.colours.iter().map(|&c| srgb_to_linear(c)).collect();
    let mut pixels = Vec::with_capacity(width * height);
    for y in 0..height {
        for x in 0..width {
            let (mut light, mut alpha) = (Vec3::ZERO, 0.0);
            for sample in 0..SAMPLES * SAMPLES {
                let at = [x * SAMPLES + sample % SAMPLES, y * SAMPLES + sample / SAMPLES];
                let (colour, cover) = match raster.sample(at) {
                    Some(seen) => (shaded(&raster, eye, at, seen, &colours, scale), 1.0),
                    None => {
                        let [right, up] = raster.place(at);
                        (Vec3::ZERO, eye.ground(right, up).map_or(0.0, |p| shadow.at(p)))
                    }
                };
                light += cover * colour;
                alpha += cover;
            }
            let colour = linear_to_srgb(light / alpha.max(1e-6));
            let alpha = (alpha * 255.0 / (SAMPLES * SAMPLES) as f32 + 0.5) as u8;
            pixels.push([colour[0], colour[1], colour[2], alpha]);
        }
    }
    Picture { width, height, pixels }
}

fn shaded(raster: &Raster, eye: &Eye, at: [usize; 2], seen: &Sample, colours: &[Vec3], scale: f64) -> Vec3 {
    let clay = colours.get(seen.part as usize).copied().unwrap_or(Vec3::splat(0.5));
    let open = light::openness(raster, at, seen, scale);
    let normal = eye.turn.transpose() * seen.normal;
    let lit = clay * light::clay(normal, eye.turn.transpose() * light::KEY) * open;
    if raster.on_line(at) { lit * LINE } else { lit }
}

impl Picture {
    /// An empty picture.
    pub fn new(width: usize, height: usize) -> Self {
        Self { width, height, pixels: vec![[0; 4]; width * height] }
    }

    /// Puts another picture into this one with its upper left corner at `x`, `y`.
    pub fn put(&mut self, other: &Self, x: usize, y: usize) {
        for (row, line) in other.pixels.chunks_exact(other.width.max(1)).enumerate() {
            for (column, &pixel) in line.iter().enumerate() {
                if x + column < self.width && y + row < self.height {
                    self.pixels[(y + row) * self.width + x + column] = pixel;
                }
            }
        }
    }
}
