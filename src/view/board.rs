//! The pins on the stage, and which of them the surface hides.

use super::camera::{Camera, Window};
use super::motion::{Moment, Motion};
use super::pins::{self, FLOATS, Pin, Spot};
use super::sight::Walk;
use super::skin::Map;
use glam::Vec3;

/// Vertices and faces that may be walked through in a frame. The walk through a larger mesh takes a few frames.
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
    /// For what it was last looked which are seen.
    looked: Option<View>,
    /// A look that is under way: for what, with which of the pins, and the maps of that moment.
    looking: Option<(View, Walk, Vec<usize>, Vec<Map>)>,
    /// Counts how often the figure changed the way it moves.
    epoch: usize,
}

/// All that decides which pins are seen.
#[derive(Clone, Debug, PartialEq)]
struct View {
    camera: Camera,
    moment: Moment,
    epoch: usize,
    points: Vec<Option<Vec3>>,
}

impl Board {
    /// Puts other pins in place of those there are.
    pub fn set(&mut self, pins: Vec<Pin>) {
        self.seen.resize(pins.len(), true);
        self.shown.resize(pins.len(), 1.0);
        if pins.len() != self.pins.len() {
            (self.looked, self.looking) = (None, None);
        }
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

    /// Goes on looking which pins the surface hides; whether there is more to look at in a frame to come. `maps` are
    /// those of [`Motion::maps`].
    pub fn look(&mut self, motion: &Motion, moment: Moment, maps: &[Map], camera: &Camera, window: &Window) -> bool {
        let points: Vec<Option<Vec3>> = self.spots.iter().map(|s| s.map(|s| s.point)).collect();
        let view = View { camera: *camera, moment, epoch: self.epoch, points };
        if self.pins.is_empty() || self.looked.as_ref() == Some(&view) {
            self.looking = None;
            return false;
        }
        let (looked_at, mut walk, which, then) = self.looking.take().unwrap_or_else(|| {
            let (which, marks): (Vec<usize>, Vec<_>) =
                self.spots.iter().enumerate().filter_map(|(i, s)| Some((i, s.as_ref()?.mark(window)))).unzip();
            (view.clone(), Walk::new(pins::eye(camera), &marks), which, maps.to_vec())
        });
        let place = |v: usize| motion.vertex(v as u32, looked_at.moment, &then);
        if !walk.step(WALK, motion.vertices(), place, motion.faces()) {
            self.looking = Some((looked_at, walk, which, then));
            return true;
        }
        for (&i, hidden) in which.iter().zip(walk.hidden) {
            self.seen[i] = !hidden;
        }
        if self.looked.is_none() {
            // Pins that were just put there do not come in one after the other.
            self.shown = self.seen.iter().map(|&s| f32::from(u8::from(s))).collect();
        }
        let up_to_date = looked_at == view;
        self.looked = Some(looked_at);
        !up_to_date
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

    /// The figure moves otherwise than before.
    pub fn moves_otherwise(&mut self) {
        self.epoch += 1;
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
            assert!(!board.look(&motion, moment, &[], &camera, &window), "a small mesh is looked at in one go");
            assert_eq!(board.spots().map(|s| s.1).collect::<Vec<_>>(), expected);
            while board.fade() {}
            let drawn = board.floats(2.0);
            let back_first: Vec<f32> = drawn.iter().map(|d| d[8]).collect();
            assert_eq!(back_first, [0.0, 1.0]);
            assert!(drawn.iter().flatten().all(|x| x.is_finite()));
        }
    }

    #[test]
    fn large_meshes_are_looked_at_over_several_frames() {
        // The two walls and a crowd of vertices that no face names.
        let walls = walls();
        let mut points: Vec<f32> = walls.shape(0).iter().flat_map(|p| p.to_array()).collect();
        points.resize(3 * 5 * WALK / 2, 0.0);
        let faces: Vec<u32> = walls.faces().concat();
        let motion = Motion::new(&faces, &points).unwrap();
        let mut board = board();
        let window = Window { width: 800.0, height: 600.0, insets: [0.0; 4] };
        let (moment, camera) = (motion.at(-1.0, false), Camera { yaw: 0.0, pitch: 0.0, ..Camera::default() });
        board.place(&motion, moment, &[], &camera, &window, 2.0);
        let steps: Vec<bool> = (0..4).map(|_| board.look(&motion, moment, &[], &camera, &window)).collect();
        assert_eq!(steps, [true, true, false, false]);
        assert_eq!(board.spots().map(|s| s.1).collect::<Vec<_>>(), [true, false]);
        board.moves_otherwise();
        assert!(board.look(&motion, moment, &[], &camera, &window), "another motion is looked at again");
        let turned = Camera { yaw: std::f32::consts::PI, ..camera };
        board.place(&motion, moment, &[], &turned, &window, 2.0);
        while board.look(&motion, moment, &[], &turned, &window) {}
        assert_eq!(board.spots().map(|s| s.1).collect::<Vec<_>>(), [false, true]);
    }
}
