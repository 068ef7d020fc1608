//! Pins: numbered points on the surface. Where they stick, how they look, and where they are on the window.

use super::camera::{Camera, Window};
use super::colour::{Srgb, oklch, srgb_to_linear};
use super::motion::{Moment, Motion};
use super::sight::{Eye, Mark};
use super::skin::Map;
use glam::Vec3;

/// Numbers that describe a pin: see `Pin::read`.
pub const NUMBERS: usize = 8;
/// Numbers that describe a pin to the shaders.
pub const FLOATS: usize = 12;

/// Radius of a head, CSS pixels, where neither of the limits holds.
const RADIUS: f32 = 11.0;
/// A head is at least and at most this large, in radii of the figure.
const LIMITS: [f32; 2] = [0.006, 0.055];
/// Heads of chosen pins and of the one under the pointer are larger.
const SELECTED: f32 = 1.12;
const HOVERED: f32 = 1.1;

/// Lightness of every enamel.
const LIGHTNESS: f32 = 0.7;
/// Chroma of every enamel: what a screen can show in every hue at that lightness.
const CHROMA: f32 = 0.116;
/// Hue of the first enamel, degrees; each following one is turned by the golden angle, so that any number of first
/// colours is spread well and none changes when there are more.
const FIRST_HUE: f32 = 28.0;
const GOLDEN_ANGLE: f32 = 137.507_76;

/// Where a pin sticks.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Anchor {
    /// In a vertex.
    Vertex(u32),
    /// In a face, at the point with these weights of its corners.
    Face(u32, [f32; 3]),
}

/// What a pin says of its point.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum State {
    /// It is here.
    Fixed,
    /// It may be here.
    Proposed,
    /// Its counterpart is not found yet.
    Missing,
}

/// A pin.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pin {
    /// Where it sticks.
    pub anchor: Anchor,
    /// Number of its enamel.
    pub colour: u32,
    /// What it says.
    pub state: State,
    /// Whether it is chosen.
    pub selected: bool,
    /// Whether the pointer is on it.
    pub hovered: bool,
}

/// Where a pin's head is on the window.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Spot {
    /// Where it sticks, in the world.
    pub point: Vec3,
    /// The middle of its head, CSS pixels.
    pub x: f32,
    /// The middle of its head, CSS pixels.
    pub y: f32,
    /// How far along the line of sight, in the world; not above 0 behind the camera.
    pub depth: f32,
    /// Radius of the head, CSS pixels.
    pub radius: f32,
}

impl Pin {
    /// The pin of eight numbers: vertex or −1, face or −1, three weights, colour, state (0 fixed, 1 proposed, 2
    /// missing), and 1 if chosen plus 2 if under the pointer.
    fn read(n: &[f32]) -> Option<Self> {
        let &[vertex, face, a, b, c, colour, state, flags] = n else { return None };
        let whole = |x: f32| (0.0..16_777_216.0).contains(&x).then_some(x as u32);
        let anchor = match (whole(vertex), whole(face)) {
            (Some(v), _) => Anchor::Vertex(v),
            (None, Some(f)) if (a + b + c).is_finite() => Anchor::Face(f, [a, b, c]),
            _ => return None,
        };
        let state = match whole(state)? {
            0 => State::Fixed,
            1 => State::Proposed,
            _ => State::Missing,
        };
        let flags = whole(flags)?;
        Some(Self { anchor, colour: whole(colour)?, state, selected: flags & 1 != 0, hovered: flags & 2 != 0 })
    }

    /// Where it sticks at a moment; `None` if the mesh has no such place. `maps` are those of [`Motion::maps`].
    pub fn point(&self, motion: &Motion, moment: Moment, maps: &[Map]) -> Option<Vec3> {
        match self.anchor {
            Anchor::Vertex(v) => motion.vertex(v, moment, maps),
            Anchor::Face(f, weights) => {
                let corners = motion.faces().get(f as usize)?;
                corners.iter().zip(weights).map(|(&v, w)| Some(motion.vertex(v, moment, maps)? * w)).sum()
            }
        }
    }

    /// Where its head is on the window, for a figure with `radius`.
    pub fn spot(&self, point: Vec3, camera: &Camera, window: &Window, radius: f32) -> Spot {
        let [x, y, depth] = camera.place(window, radius, point);
        let scale = window.focal() / depth.max(1e-6 * radius);
        let larger = if self.selected { SELECTED } else { 1.0 } * if self.hovered { HOVERED } else { 1.0 };
        let head = RADIUS.clamp(LIMITS[0] * radius * scale, (LIMITS[1] * radius * scale).max(1.0)) * larger;
        Spot { point, x, y, depth, radius: head }
    }

    /// The numbers for the shaders: point, radius in device pixels, linear colour, state, then how much of the head is
    /// `shown` (0 where the surface hides it, to 1), 1 if chosen, 1 if under the pointer, and 0.
    pub fn floats(&self, spot: &Spot, shown: f32, pixel_ratio: f32) -> [f32; FLOATS] {
        let [x, y, z] = spot.point.to_array();
        let [r, g, b] = srgb_to_linear(colour(self.colour)).to_array();
        let flag = |on: bool| f32::from(u8::from(on));
        let state = match self.state {
            State::Fixed => 0.0,
            State::Proposed => 1.0,
            State::Missing => 2.0,
        };
        let radius = spot.radius * pixel_ratio;
        [x, y, z, radius, r, g, b, state, shown, flag(self.selected), flag(self.hovered), 0.0]
    }
}

impl Spot {
    /// Radius of the head in the world.
    pub fn world(&self, window: &Window) -> f32 {
        self.radius * self.depth.max(0.0) / window.focal()
    }

    /// What decides whether the surface hides it: the surface has to stand before the whole head.
    pub fn mark(&self, window: &Window) -> Mark {
        (self.point, self.world(window))
    }
}

/// Pins of [`NUMBERS`] numbers each. The error is a sentence.
pub fn read(numbers: &[f32]) -> Result<Vec<Pin>, &'static str> {
    if !numbers.len().is_multiple_of(NUMBERS) {
        return Err("A pin needs eight numbers.");
    }
    numbers.chunks_exact(NUMBERS).map(|n| Pin::read(n).ok_or("A pin must stick in a vertex or in a face.")).collect()
}

/// The pin whose head is under a point of the window, or within `reach` CSS pixels of it: rather one that is seen
/// than one that is not, rather the one whose rim is nearest. `spots` are as many as `seen`.
pub fn pick(spots: &[Option<Spot>], seen: &[bool], x: f32, y: f32, reach: f32) -> Option<usize> {
    let mut best: Option<(bool, bool, f32, usize)> = None;
    for (i, (spot, &seen)) in spots.iter().zip(seen).enumerate() {
        let Some(spot) = spot.filter(|s| s.depth > 0.0) else { continue };
        let off = (spot.x - x).hypot(spot.y - y) - spot.radius;
        // Inside heads that lie over one another, the nearer one is meant.
        let (outside, far) = (off > 0.0, if off > 0.0 { off } else { spot.depth });
        if off <= reach && best.is_none_or(|(s, o, f, _)| (!seen, outside, far) < (!s, o, f)) {
            best = Some((seen, outside, far, i));
        }
    }
    best.map(|b| b.3)
}

/// The enamel with a number.
pub fn colour(number: u32) -> Srgb {
    oklch(LIGHTNESS, CHROMA, (FIRST_HUE + GOLDEN_ANGLE * (number % 360) as f32).rem_euclid(360.0))
}

/// Where the camera is, for deciding what hides what.
pub fn eye(camera: &Camera) -> Eye {
    Eye { at: camera.eye(), axes: camera.axes() }
}

#[cfg(test)]
mod tests {
    use super::super::colour::{linear_to_oklab, srgb_to_linear};
    use super::*;

    const WINDOW: Window = Window { width: 900.0, height: 600.0, insets: [40.0, 0.0, 200.0, 80.0] };

    fn motion() -> Motion {
        let mut motion = Motion::new(&[0, 1, 2], &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]).unwrap();
        motion.set_poses(&[0.0, 0.0, 2.0, 1.0, 0.0, 2.0, 0.0, 1.0, 2.0]).unwrap();
        motion
    }

    fn pins() -> Vec<Pin> {
        read(&[1.0, -1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0, -1.0, 0.0, 0.2, 0.3, 0.5, 1.0, 1.0, 2.0]).unwrap()
    }

    #[test]
    fn numbers_become_pins() {
        let [a, b] = pins()[..] else { panic!() };
        assert_eq!((a.anchor, a.state, a.selected, a.hovered), (Anchor::Vertex(1), State::Fixed, true, false));
        assert_eq!((b.anchor, b.colour, b.state), (Anchor::Face(0, [0.2, 0.3, 0.5]), 1, State::Proposed));
        assert!(!b.selected && b.hovered);
        assert!(read(&[0.0; 7]).is_err() && read(&[-1.0; 8]).is_err() && read(&[f32::NAN; 8]).is_err());
    }

    #[test]
    fn pins_follow_the_surface() {
        let motion = motion();
        for (time, z) in [(-1.0, 0.0), (-0.5, 1.0), (0.0, 2.0)] {
            let moment = motion.at(time, false);
            let at: Vec<_> = pins().iter().map(|p| p.point(&motion, moment, &[]).unwrap()).collect();
            assert!(at[0].distance(Vec3::new(1.0, 0.0, z)) < 1e-6 && at[1].distance(Vec3::new(0.3, 0.5, z)) < 1e-6);
        }
        let nowhere = Pin { anchor: Anchor::Face(7, [1.0, 0.0, 0.0]), ..pins()[0] };
        assert_eq!(nowhere.point(&motion, motion.at(0.0, false), &[]), None);
    }

    #[test]
    fn a_spot_is_where_the_camera_draws() {
        let (camera, p) = (Camera { distance: 6.0, ..Camera::default() }, Vec3::new(0.4, 0.3, -0.2));
        let spot = pins()[0].spot(p, &camera, &WINDOW, 1.0);
        let ball = super::super::camera::Ball { centre: Vec3::ZERO, radius: 1.0 };
        let at = camera.projection(&WINDOW, ball).project_point3(p);
        let (x, y) = ((at.x + 1.0) * 0.5 * WINDOW.width, (1.0 - at.y) * 0.5 * WINDOW.height);
        assert!((spot.x - x).abs() < 0.01 && (spot.y - y).abs() < 0.01);
    }

    #[test]
    fn heads_keep_their_size_within_limits() {
        let pin = Pin { selected: false, hovered: false, ..pins()[0] };
        let head = |distance: f32| {
            let camera = Camera { distance, ..Camera::default() };
            pin.spot(Vec3::ZERO, &camera, &WINDOW, 1.0)
        };
        assert_eq!(head(2.0).radius, RADIUS);
        assert_eq!(head(4.0).radius, RADIUS);
        let far = head(20.0);
        assert!(far.radius < RADIUS && (far.world(&WINDOW) - LIMITS[1]).abs() < 1e-3);
        let near = head(0.4);
        assert!(near.radius > RADIUS && (near.world(&WINDOW) - LIMITS[0]).abs() < 1e-4);
        assert!(pins()[0].spot(Vec3::ZERO, &Camera::default(), &WINDOW, 1.0).radius > RADIUS, "chosen ones are larger");
    }

    #[test]
    fn the_pin_one_means_is_picked() {
        let spot = |x: f32, depth: f32| Some(Spot { point: Vec3::ZERO, x, y: 0.0, depth, radius: 10.0 });
        let spots = [spot(0.0, 5.0), spot(8.0, 4.0), spot(30.0, 3.0), None, spot(33.0, 9.0)];
        let all = [true; 5];
        assert_eq!(pick(&spots, &all, 4.0, 0.0, 6.0), Some(1), "the nearer of two");
        assert_eq!(pick(&spots, &[true, false, true, true, true], 4.0, 0.0, 6.0), Some(0), "the one that is seen");
        assert_eq!(pick(&spots, &all, -14.0, 0.0, 6.0), Some(0));
        assert_eq!(pick(&spots, &all, -18.0, 0.0, 6.0), None);
        assert_eq!(pick(&spots, &[false; 5], 36.0, 0.0, 6.0), Some(2), "hidden ones can be picked, too");
    }

    #[test]
    fn enamels_are_alike_but_for_their_hue() {
        let labs: Vec<Vec3> = (0..24).map(|i| linear_to_oklab(srgb_to_linear(colour(i)))).collect();
        for (i, lab) in labs.iter().enumerate() {
            assert!((lab.x - LIGHTNESS).abs() < 0.012, "{i}: {lab}");
            assert!((lab.y.hypot(lab.z) - CHROMA).abs() < 0.012, "{i}: {lab}");
        }
        for (i, a) in labs.iter().take(13).enumerate() {
            for b in labs.iter().take(13).skip(i + 1) {
                assert!(a.distance(*b) > 0.035);
            }
            assert!(a.distance(labs[i + 1]) > 0.15, "neighbours in number are far apart");
        }
    }
}
