//! The pins on the stage, and which of them the surface hides.

use super::camera::{Camera, Window};
use super::motion::{Moment, Motion};
use super::pins::{self, FLOATS, Pin, Spot};
use super::sight::hidden;
use super::skin::Map;
use glam::Vec3;

/// Vertices and faces that may be walked through for each frame. A larger mesh is walked through every few frames.
const WALK: usize = 40_000;

/// How much of a head appears or fades in a frame.
const FADES: f32 = 0.34;

/// Pins, where they are now, and whether they are seen.
#[derive(Clone, Debug, Default)]
pub struct Board {
    pins: Vec<Pin>,
    /// As many as pins; none where the mesh has no such place.
    spots: Vec<Option<Spot>>,
    /// As many as pins.
    seen: Vec<bool>,
    /// How far heads that came into sight have appeared, and those that went out of it have faded: 0 to 1.
    shown: Vec<f32>,
    /// Where pins and camera were when it was last looked what is seen.
    looked: Option<(Camera, Moment, Vec<Option<Vec3>>)>,
    /// Vertices and faces that were saved up for the next walk.
    saved: usize,
}

impl Board {
    /// Puts other pins in place of those there are.
    pub fn set(&mut self, pins: Vec<Pin>) {
        self.seen.resize(pins.len(), true);
        self.shown.resize(pins.len(), 1.0);
        self.spots = vec![None; pins.len()];
        self.pins = pins;
    }

    /// The pins.
    pub fn pins(&self) -> &[Pin] {
        &self.pins
    }

    /// Where their heads are, and whether the surface leaves them in sight.
    pub fn spots(&self) -> impl Iterator<Item = (Option<Spot>, bool)> {
        self.spots.iter().copied().zip(self.seen.iter().copied())
    }

    /// The pin that is meant by a point of the window: see [`pins::pick`].
    pub fn pick(&self, x: f32, y: f32, reach: f32) -> Option<usize> {
        pins::pick(&self.spots, &self.seen, x, y, reach)
    }

    /// Puts the heads where they belong. `maps` are those of [`Motion::maps`]; the figure has `radius`.
    pub fn place(
        &mut self,
        motion: &Motion,
        moment: Moment,
        maps: &[Map],
        camera: &Camera,
        window: &Window,
        radius: f32,
    ) {
        let spot = |pin: &Pin| Some(pin.spot(pin.point(motion, moment, maps)?, camera, window, radius));
        self.spots = self.pins.iter().map(spot).collect();
    }

    /// Whether anything moved since [`Board::look`] looked. A frame that asks saves up for the walk.
    pub fn wants_to_look(&mut self, camera: &Camera, moment: Moment) -> bool {
        let points = self.spots.iter().map(|s| s.map(|s| s.point));
        let same = self.looked.as_ref().is_some_and(|(c, m, before)| {
            c == camera && *m == moment && before.len() == self.spots.len() && points.eq(before.iter().copied())
        });
        if !same && !self.pins.is_empty() {
            self.saved += WALK;
        }
        !same && !self.pins.is_empty()
    }

    /// Whether enough is saved up for a walk through so many vertices and faces. The first walk is free.
    pub fn can_look(&self, size: usize) -> bool {
        self.looked.is_none() || self.saved >= size
    }

    /// Looks which pins the faces hide; `positions` are #V points of `moment`.
    pub fn look(&mut self, camera: &Camera, moment: Moment, window: &Window, faces: &[[u32; 3]], positions: &[Vec3]) {
        let marks: Vec<(usize, _)> =
            self.spots.iter().enumerate().filter_map(|(i, s)| Some((i, s.as_ref()?.mark(window)))).collect();
        let points: Vec<_> = marks.iter().map(|m| m.1).collect();
        for ((i, _), hidden) in marks.iter().zip(hidden(pins::eye(camera), &points, faces, positions)) {
            self.seen[*i] = !hidden;
        }
        if self.looked.is_none() {
            // Pins that were just put there do not come in one after the other.
            self.shown = self.seen.iter().map(|&s| f32::from(u8::from(s))).collect();
        }
        self.looked = Some((*camera, moment, self.spots.iter().map(|s| s.map(|s| s.point)).collect()));
        self.saved = 0;
    }

    /// Lets heads appear and fade by a step; whether there are steps to come.
    pub fn fade(&mut self) -> bool {
        let mut on = false;
        for (shown, &seen) in self.shown.iter_mut().zip(&self.seen) {
            *shown = if seen { (*shown + FADES).min(1.0) } else { (*shown - FADES).max(0.0) };
            on |= *shown != f32::from(u8::from(seen));
        }
        on
    }

    /// What the surface hides is to be looked up again.
    pub fn forget(&mut self) {
        self.looked = None;
    }

    /// Numbers for the shaders, farthest first: see [`Pin::floats`].
    pub fn floats(&self, pixel_ratio: f32) -> Vec<[f32; FLOATS]> {
        let mut drawn: Vec<(f32, [f32; FLOATS])> = self
            .pins
            .iter()
            .zip(self.spots.iter().zip(&self.shown))
            .filter_map(|(pin, (spot, &shown))| {
                let spot = spot.filter(|s| s.depth > 0.0)?;
                Some((spot.depth, pin.floats(&spot, shown, pixel_ratio)))
            })
            .collect();
        drawn.sort_by(|a, b| b.0.total_cmp(&a.0));
        drawn.into_iter().map(|d| d.1).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::pins::read;

    /// Two walls, one a step behind the other, with a pin on each.
    fn walls() -> Motion {
        let wall = |z: f32| [-1.0, -1.0, z, 1.0, -1.0, z, 0.0, 2.0, z];
        Motion::new(&[0, 1, 2, 3, 4, 5], &[wall(0.0), wall(-1.0)].concat()).unwrap()
    }

    fn board() -> Board {
        let mut board = Board::default();
        let pin = |face: f32| [-1.0, face, 0.3, 0.3, 0.4, face, 0.0, 0.0];
        board.set(read(&[pin(0.0), pin(1.0)].concat()).unwrap());
        board
    }

    #[test]
    fn pins_behind_the_figure_are_known() {
        let (motion, mut board) = (walls(), board());
        let window = Window { width: 800.0, height: 600.0, insets: [0.0; 4] };
        let moment = motion.at(-1.0, false);
        for (yaw, expected) in [(0.0, [true, false]), (std::f32::consts::PI, [false, true])] {
            let camera = Camera { yaw, pitch: 0.0, distance: 8.0, ..Camera::default() };
            board.place(&motion, moment, &[], &camera, &window, 2.0);
            assert!(board.wants_to_look(&camera, moment) && board.can_look(5));
            board.look(&camera, moment, &window, motion.faces(), motion.shape(0));
            assert!(!board.wants_to_look(&camera, moment));
            assert_eq!(board.spots().map(|s| s.1).collect::<Vec<_>>(), expected);
            while board.fade() {}
            let drawn = board.floats(2.0);
            let back_first: Vec<f32> = drawn.iter().map(|d| d[8]).collect();
            assert_eq!(back_first, [0.0, 1.0]);
            assert!(drawn.iter().flatten().all(|x| x.is_finite()));
        }
    }

    #[test]
    fn large_meshes_are_walked_through_less_often() {
        let (motion, mut board) = (walls(), board());
        let window = Window { width: 800.0, height: 600.0, insets: [0.0; 4] };
        let moment = motion.at(-1.0, false);
        let mut walks = 0;
        assert!(!board.fade());
        for turn in 0..20 {
            let camera = Camera { yaw: 0.1 * turn as f32, ..Camera::default() };
            board.place(&motion, moment, &[], &camera, &window, 2.0);
            if board.wants_to_look(&camera, moment) && board.can_look(5 * WALK) {
                board.look(&camera, moment, &window, motion.faces(), motion.shape(0));
                walks += 1;
            }
        }
        assert_eq!(walks, 4);
    }
}
