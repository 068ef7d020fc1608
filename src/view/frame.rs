//! What the shaders know of a frame: the struct `Stage` of `gpu/stage.wgsl`, field by field.

use super::colour::{Srgb, oklch, srgb_to_linear};
use glam::{Mat4, Vec3, Vec4};

/// Number of 32-bit floats in the struct.
pub const FLOATS: usize = 2 * 16 + 23 * 4;

/// The struct `Stage`.
#[derive(Clone, Copy, Debug, Default)]
#[allow(missing_docs, reason = "the fields are explained in stage.wgsl")]
pub struct Frame {
    pub view: Mat4,
    pub light: Mat4,
    pub eye: Vec4,
    pub right: Vec4,
    pub up: Vec4,
    pub back: Vec4,
    pub window: Vec4,
    pub room: Vec4,
    pub ground: Vec4,
    pub key: Vec4,
    pub lines: Vec4,
    pub moment: Vec4,
    pub flow: Vec4,
    pub field: Vec4,
    pub theme: Theme,
}

/// Light and ground.
#[derive(Clone, Copy, Debug, Default)]
#[allow(missing_docs, reason = "the fields are explained in stage.wgsl")]
pub struct Theme {
    pub key_light: Vec4,
    pub sky_light: Vec4,
    pub ground_light: Vec4,
    pub back_middle: Vec4,
    pub back_rim: Vec4,
    pub line_colour: Vec4,
    pub accents: [Vec4; 5],
}

impl Frame {
    /// Whether the figure throws shadows on itself.
    pub fn shadows(&self) -> bool {
        self.key.w > 0.0
    }

    /// The numbers in the order of the struct.
    pub fn floats(&self) -> [f32; FLOATS] {
        let t = &self.theme;
        let vectors = [
            self.eye,
            self.right,
            self.up,
            self.back,
            self.window,
            self.room,
            self.ground,
            self.key,
            self.lines,
            self.moment,
            self.flow,
            self.field,
            t.key_light,
            t.sky_light,
            t.ground_light,
            t.back_middle,
            t.back_rim,
            t.line_colour,
        ];
        let all = self.view.to_cols_array().into_iter().chain(self.light.to_cols_array());
        let all = all.chain(vectors.iter().chain(&t.accents).flat_map(|v| v.to_array()));
        let mut out = [0.0; FLOATS];
        for (to, number) in out.iter_mut().zip(all) {
            // A NaN would make the whole picture black on some machines.
            *to = if number.is_finite() { number } else { 0.0 };
        }
        out
    }
}

impl Theme {
    /// The light or the dark studio.
    pub fn new(dark: bool) -> Self {
        let (middle, rim) = if dark {
            (oklch(0.33, 0.008, 70.0), oklch(0.2, 0.006, 70.0))
        } else {
            (oklch(0.965, 0.008, 80.0), oklch(0.86, 0.014, 75.0))
        };
        let shadows = if dark { 1.25 } else { 1.0 };
        let accents =
            [oklch(0.66, 0.2, 36.0), oklch(0.6, 0.15, 255.0), oklch(0.82, 0.16, 95.0), oklch(0.62, 0.2, 350.0)];
        let light = Vec4::new;
        Self {
            key_light: light(0.88, 0.86, 0.83, if dark { 0.35 } else { 0.16 }),
            sky_light: if dark { light(0.30, 0.31, 0.33, 0.0) } else { light(0.37, 0.38, 0.40, 0.0) },
            ground_light: if dark { light(0.20, 0.185, 0.165, 0.0) } else { light(0.33, 0.30, 0.265, 0.0) },
            back_middle: with(middle, 0.0),
            back_rim: with(rim, shadows),
            line_colour: with(oklch(0.22, 0.02, 50.0), 0.88),
            accents: [
                with(accents[0], 0.9),
                with(accents[1], 0.85),
                with(accents[2], 0.85),
                with(accents[3], 0.85),
                with([255, 255, 255], 0.55),
            ],
        }
    }
}

fn with(colour: Srgb, w: f32) -> Vec4 {
    srgb_to_linear(colour).extend(w)
}

/// The map from the world to clip space of a light that shines along −`towards` on a ball.
pub fn light_map(towards: Vec3, centre: Vec3, radius: f32) -> Mat4 {
    let back = towards.normalize_or(Vec3::Y);
    let right = back.any_orthonormal_vector();
    let up = back.cross(right);
    let s = 1.0 / (1.05 * radius);
    let row = |axis: Vec3, scale: f32, shift: f32| (axis * scale).extend(shift - axis.dot(centre) * scale);
    // Depth 0 nearest to the light, 1 farthest.
    Mat4::from_cols(row(right, s, 0.0), row(up, s, 0.0), row(back, -0.5 * s, 0.5), Vec4::W).transpose()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_shaders_struct_has_as_many_floats() {
        let source = include_str!("gpu/stage.wgsl");
        let body = source.split("struct Stage {").nth(1).and_then(|s| s.split('}').next()).unwrap();
        let size = |line: &str| match line.split(':').nth(1).map(str::trim) {
            Some(t) if t.starts_with("mat4x4f") => 16,
            Some(t) if t.starts_with("vec4f") => 4,
            Some(t) if t.starts_with("array<vec4f, 5>") => 20,
            _ => 0,
        };
        assert_eq!(body.lines().map(size).sum::<usize>(), FLOATS);
    }

    #[test]
    fn no_nan_reaches_the_shaders() {
        let frame =
            Frame { eye: Vec4::splat(f32::NAN), view: Mat4::from_cols_array(&[f32::INFINITY; 16]), ..Frame::default() };
        assert!(frame.floats().iter().all(|x| x.is_finite()));
    }

    #[test]
    fn the_light_sees_the_whole_ball() {
        let (centre, radius, towards) = (Vec3::new(3.0, 1.0, -2.0), 2.5, Vec3::new(-0.5, 1.0, 0.3).normalize());
        let map = light_map(towards, centre, radius);
        for p in [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z, towards, -towards] {
            let at = map.project_point3(centre + p * radius);
            assert!(at.x.abs() <= 1.0 && at.y.abs() <= 1.0 && (0.0..=1.0).contains(&at.z), "{at}");
        }
        let depth = |p: Vec3| map.project_point3(p).z;
        assert!(depth(centre + towards) < depth(centre - towards));
    }

    #[test]
    fn themes_differ() {
        assert!(Theme::new(true).back_middle.x < 0.2 && Theme::new(false).back_middle.x > 0.7);
    }
}
