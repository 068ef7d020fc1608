//! The stage: the figure, its paint, the camera and the light, and what of it the GPU does not have yet.

use super::board::Board;
use super::camera::{Ball, Camera, Window};
use super::closer;
use super::colormap::ColourMap;
use super::colour::srgb_to_linear;
use super::frame::{Frame, Theme, light_map};
use super::motion::{Extent, Moment, Motion};
use super::paint::{CLAY, Paint};
use super::picking::{Hit, pick};
use super::pins::{self, Pin, Spot};
use super::skin::{Map, Skin};
use super::surface::Surface;
use glam::Vec3;

/// Direction to the key light in the camera's horizontal axes: from the left, from above, from the front. The light
/// turns with the camera, as if the figure stood on a turntable.
const KEY: Vec3 = Vec3::new(-0.55, 1.0, 0.7);

/// So many times as large as without, what is seen may become for the reference to be seen whole as well.
const WITH_REFERENCE: f32 = 1.3;

/// Everything that a picture is made of.
#[derive(Clone, Debug)]
pub struct Stage {
    motion: Motion,
    /// Of the motion as it is; made when it is first needed.
    surface: Option<Surface>,
    /// Colours of the faces. Call [`Stage::repaint`] after changing them.
    pub paint: Paint,
    /// Where one looks from.
    pub camera: Camera,
    board: Board,
    window: Window,
    /// The margins of the room, if the window has only a part of it.
    room: Option<[f32; 4]>,
    pixel_ratio: f32,
    time: f32,
    loops: bool,
    dark: bool,
    boundaries: bool,
    wires: bool,
    contours: bool,
    plain: bool,
    flow: f32,
    hovered: Option<usize>,
    /// Packed normals of each shape, once it was seen.
    normals: Vec<Option<Vec<u32>>>,
    extents: Vec<Option<Extent>>,
    whole: [Extent; 2],
    positions: Vec<Vec3>,
    positions_at: Option<Moment>,
    stale: Stale,
}

/// What has changed since the last frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Stale {
    /// The faces.
    pub surface: bool,
    /// The paint.
    pub paint: bool,
    /// What moves the vertices, where a skin does.
    pub skin: bool,
    /// How it moves them.
    pub maps: bool,
    /// Anything.
    pub picture: bool,
}

impl Stale {
    const ALL: Self = Self { surface: true, paint: true, skin: true, maps: true, picture: true };
    const NOTHING: Self = Self { surface: false, paint: false, skin: false, maps: false, picture: false };
}

impl Default for Stage {
    fn default() -> Self {
        let extent = Motion::default().extent();
        Self {
            motion: Motion::default(),
            surface: None,
            paint: Paint::default(),
            camera: Camera::default(),
            board: Board::default(),
            window: Window { width: 1.0, height: 1.0, insets: [0.0; 4] },
            room: None,
            pixel_ratio: 1.0,
            time: -1.0,
            loops: false,
            dark: false,
            boundaries: true,
            wires: false,
            contours: true,
            plain: false,
            flow: 1.0,
            hovered: None,
            normals: vec![None],
            extents: vec![None],
            whole: [extent; 2],
            positions: Vec::new(),
            positions_at: None,
            stale: Stale::ALL,
        }
    }
}

impl Stage {
    /// Puts another mesh on the stage, in bare clay and still.
    pub fn set_motion(&mut self, motion: Motion) {
        self.paint.reset(motion.faces().len());
        self.hovered = None;
        self.flow = 1.0;
        self.time = -1.0;
        self.board.set(Vec::new());
        self.take(motion, false);
    }

    /// Puts other poses in place of those there are: T·3·#V coordinates. The error is a sentence.
    pub fn set_poses(&mut self, positions: &[f32]) -> Result<(), &'static str> {
        let mut motion = std::mem::take(&mut self.motion);
        let result = motion.set_poses(positions);
        self.take(motion, false);
        result
    }

    /// Puts a skin in place of the poses: see [`super::skin::Skin::new`]. The error is a sentence.
    pub fn set_skin(
        &mut self,
        handles: usize,
        indices: &[u16],
        weights: &[f32],
        each: usize,
        matrices: &[f32],
    ) -> Result<(), &'static str> {
        let mut motion = std::mem::take(&mut self.motion);
        // With a skin, as without poses, the surface follows from the reference alone.
        let same_surface = motion.skin().is_some() || motion.poses() == 0;
        let result = motion.set_skin(handles, indices, weights, each, matrices);
        self.take(motion, same_surface);
        result
    }

    /// Puts other maps into the skin: see [`super::skin::Skin::set_maps`]. The error is a sentence.
    pub fn set_maps(&mut self, matrices: &[f32]) -> Result<(), &'static str> {
        self.motion.set_maps(matrices)?;
        self.moves_otherwise();
        Ok(())
    }

    /// Takes a motion; keeps the surface if it is known to be the same.
    fn take(&mut self, motion: Motion, same_surface: bool) {
        self.motion = motion;
        self.moves_otherwise();
        self.stale.skin = true;
        if !same_surface || self.surface.is_none() {
            self.surface = None;
            self.normals = vec![None; self.motion.poses() + 1];
            self.stale = Stale::ALL;
        }
    }

    /// Forgets all that followed from how the figure moved before.
    fn moves_otherwise(&mut self) {
        self.extents = vec![None; self.motion.poses() + 1];
        self.whole = [self.motion.reference_extent(), self.motion.extent()];
        self.positions_at = None;
        self.board.moves_otherwise();
        self.stale.maps = true;
        self.redraw();
    }

    /// The motion.
    pub fn motion(&self) -> &Motion {
        &self.motion
    }

    /// Its surface.
    pub fn surface(&mut self) -> &Surface {
        self.surface.get_or_insert_with(|| Surface::new(&self.motion))
    }

    /// Its surface and its skin, where one moves it.
    pub fn skinned(&mut self) -> (&Surface, Option<&Skin>) {
        (self.surface.get_or_insert_with(|| Surface::new(&self.motion)), self.motion.skin())
    }

    /// Paints by parts: see [`Paint::parts`].
    pub fn paint_parts(&mut self, labels: &[u32], count: usize) -> Result<(), &'static str> {
        let surface = self.surface.get_or_insert_with(|| Surface::new(&self.motion));
        self.paint.parts(surface, labels, count)?;
        self.repaint();
        Ok(())
    }

    /// Paints by groups of vertices: see [`Paint::groups`].
    pub fn paint_groups(&mut self, labels: &[u32], count: usize) -> Result<(), &'static str> {
        self.paint.groups(&self.motion, labels, count)?;
        self.repaint();
        Ok(())
    }

    /// Paints a field on the vertices: see [`Paint::vertices`].
    pub fn paint_vertices(&mut self, values: &[f32], low: f32, high: f32, map: ColourMap) -> Result<(), &'static str> {
        self.paint.vertices(self.motion.vertices(), values, low, high, map)?;
        self.repaint();
        Ok(())
    }

    /// Lets paint flow in from some faces: nothing of it is seen until [`Stage::set_flow`] says so.
    pub fn flow_from(&mut self, faces: &[u32]) {
        let surface = self.surface.get_or_insert_with(|| Surface::new(&self.motion));
        self.paint.flow_from(surface, faces);
        self.flow = 0.0;
        self.repaint();
    }

    /// Sets how far the paint has flowed, 0 to 1.
    pub fn set_flow(&mut self, share: f32) {
        self.changed(|s| &mut s.flow, if share >= 0.0 { share.min(1.0) } else { 1.0 });
    }

    /// The paint has changed.
    pub fn repaint(&mut self) {
        self.stale.paint = true;
        self.stale.picture = true;
    }

    /// The picture is to be drawn again.
    pub fn redraw(&mut self) {
        self.stale.picture = true;
    }

    /// What has changed since the last call.
    pub fn take_stale(&mut self) -> Stale {
        std::mem::replace(&mut self.stale, Stale::NOTHING)
    }

    /// What has changed.
    pub fn stale(&self) -> Stale {
        self.stale
    }

    /// The window.
    pub fn window(&self) -> &Window {
        &self.window
    }

    /// Sets the size of the window, CSS pixels, and the device pixels in one of them.
    pub fn set_window(&mut self, width: f32, height: f32, pixel_ratio: f32) {
        let usable = |x: f32| if x > 0.0 && x.is_finite() { x } else { 1.0 };
        (self.window.width, self.window.height) = (usable(width), usable(height));
        self.pixel_ratio = usable(pixel_ratio).min(4.0);
        self.redraw();
    }

    /// Device pixels in a CSS pixel.
    pub fn pixel_ratio(&self) -> f32 {
        self.pixel_ratio
    }

    /// Sets what panels cover at the left, top, right and bottom, CSS pixels.
    pub fn set_insets(&mut self, insets: [f32; 4]) {
        let insets = insets.map(|x| if x > 0.0 && x.is_finite() { x } else { 0.0 });
        self.changed(|s| &mut s.window.insets, insets);
    }

    /// Sets how far the room that several windows show together reaches into this one from its left, top, right and
    /// bottom, CSS pixels (below 0: beyond it), so that its light does not end at their edges. Without one, the window
    /// is a room of its own.
    pub fn set_room(&mut self, margins: Option<[f32; 4]>) {
        self.changed(|s| &mut s.room, margins.filter(|m| m.iter().all(|x| x.is_finite())));
    }

    /// Sets the time, in poses: see [`Motion::at`].
    pub fn set_time(&mut self, time: f32) {
        let before = self.moment();
        self.time = if time.is_nan() { -1.0 } else { time };
        self.stale.picture |= before != self.moment();
    }

    /// Sets whether the last pose goes over into the first.
    pub fn set_loop(&mut self, on: bool) {
        self.changed(|s| &mut s.loops, on);
    }

    /// Sets the dark or the light studio.
    pub fn set_dark(&mut self, on: bool) {
        self.changed(|s| &mut s.dark, on);
    }

    /// Sets whether lines are drawn where labels differ.
    pub fn set_boundaries(&mut self, on: bool) {
        self.changed(|s| &mut s.boundaries, on);
    }

    /// Sets whether edges are drawn.
    pub fn set_wires(&mut self, on: bool) {
        self.changed(|s| &mut s.wires, on);
    }

    /// Sets whether fields on the vertices have lines of equal value.
    pub fn set_contours(&mut self, on: bool) {
        self.changed(|s| &mut s.contours, on);
    }

    /// Sets whether the figure throws no shadow on itself, which is twice as fast.
    pub fn set_plain(&mut self, on: bool) {
        self.changed(|s| &mut s.plain, on);
    }

    /// Sets the face under the pointer.
    pub fn hover(&mut self, face: Option<usize>) {
        self.changed(|s| &mut s.hovered, face);
    }

    fn changed<T: PartialEq>(&mut self, place: impl Fn(&mut Self) -> &mut T, value: T) {
        if *place(self) != value {
            *place(self) = value;
            self.stale.picture = true;
        }
    }

    /// Where vertices are at the moment that is shown; `None` for one that does not exist.
    pub fn places(&self, vertices: &[u32]) -> Vec<Option<Vec3>> {
        let moment = self.moment();
        let maps = self.motion.maps(moment);
        vertices.iter().map(|&v| self.motion.vertex(v, moment, &maps)).collect()
    }

    /// Where a point is on the window, and its depth.
    pub fn project(&self, point: Vec3) -> [f32; 3] {
        self.camera.place(&self.window, self.ball().radius, point)
    }

    /// The moment that is shown.
    pub fn moment(&self) -> Moment {
        self.motion.at(self.time, self.loops)
    }

    /// Positions of a shape and packed normals of the drawn vertices in it.
    pub fn shape(&mut self, shape: usize) -> (&Surface, &[Vec3], &[u32]) {
        let surface = self.surface.get_or_insert_with(|| Surface::new(&self.motion));
        let positions = self.motion.shape(shape);
        let normals: &[u32] = match self.normals.get_mut(shape) {
            Some(kept) => kept.get_or_insert_with(|| surface.normals(self.motion.faces(), positions)),
            None => &[],
        };
        (surface, positions, normals)
    }

    /// Four words of paint for each face.
    pub fn words(&mut self) -> Vec<[u32; 4]> {
        let surface = self.surface.get_or_insert_with(|| Surface::new(&self.motion));
        self.paint.words(surface, self.motion.faces())
    }

    /// The box around all that the time's part of the motion (poses, or reference) does.
    fn whole(&self) -> Extent {
        let moment = self.moment();
        if moment.from > 0 {
            return self.whole[1];
        }
        self.whole[0].towards(&self.whole[1], if moment.to > 0 { moment.part } else { 0.0 })
    }

    /// The ball around it.
    pub fn ball(&self) -> Ball {
        self.whole().ball()
    }

    fn extent(&mut self, shape: usize) -> Extent {
        let motion = &self.motion;
        match self.extents.get_mut(shape) {
            Some(kept) => *kept.get_or_insert_with(|| motion.shape_extent(shape)),
            None => self.whole[0],
        }
    }

    /// Moves the camera so that the whole motion fits into the free part of the window, and the reference with it where that
    /// takes little more room: far away it would make the motion small.
    pub fn frame_all(&mut self) {
        let reference = self.moment().to == 0;
        let centre = self.whole().centre();
        let mut points = self.motion.sample(reference);
        let [rest, motion] = self.whole;
        if !reference && motion.and(&rest).ball().radius <= WITH_REFERENCE * motion.ball().radius {
            points.extend(self.motion.sample(true));
        }
        self.camera.frame(&self.window, points.into_iter(), centre);
        self.redraw();
    }

    /// Moves the camera to where most of these faces are seen: see [`closer::look_at`]. Nothing happens where there is
    /// none of them.
    pub fn frame_faces(&mut self, faces: &[u32]) {
        self.positions(self.moment());
        let scene = self.whole().ball();
        let (all, positions) = (self.motion.faces(), &self.positions);
        if let Some(camera) = closer::look_at(&self.camera, &self.window, scene, faces, all, positions) {
            self.camera = camera;
            self.redraw();
        }
    }

    /// The camera as six numbers that do not depend on where the figure stands and how large it is: where the camera
    /// looks, from the middle of the motion's ball, yaw and pitch, and how far it is; lengths in radii of that ball.
    pub fn camera_numbers(&self) -> [f32; 6] {
        self.camera.numbers_about(self.whole[1].ball())
    }

    /// Sets the camera from such numbers; whether they were a camera.
    pub fn set_camera_numbers(&mut self, numbers: &[f32]) -> bool {
        let camera = Camera::from_numbers_about(numbers, self.whole[1].ball());
        if let Some(camera) = camera {
            self.camera = camera;
            self.redraw();
        }
        camera.is_some()
    }

    /// Positions of all vertices at a moment.
    fn positions(&mut self, moment: Moment) {
        if self.positions_at != Some(moment) {
            self.motion.positions(moment, &mut self.positions);
            self.positions_at = Some(moment);
        }
    }

    /// The point of the surface under a point of the window, CSS pixels.
    pub fn pick(&mut self, x: f32, y: f32) -> Option<Hit> {
        self.positions(self.moment());
        pick(self.camera.ray(&self.window, x, y), self.motion.faces(), &self.positions)
    }

    /// Puts other pins in place of those there are.
    pub fn set_pins(&mut self, pins: Vec<Pin>) {
        self.board.set(pins);
        self.redraw();
    }

    /// Where the pins' heads are at this moment, and whether the surface leaves them in sight as far as it was
    /// looked up: see [`Stage::look`].
    pub fn pin_spots(&mut self) -> impl Iterator<Item = (Option<Spot>, bool)> {
        let moment = self.moment();
        self.place_pins(moment, &self.motion.maps(moment));
        self.board.spots()
    }

    /// The pin that is meant by a point of the window: see [`pins::pick`].
    pub fn pick_pin(&mut self, x: f32, y: f32, reach: f32) -> Option<usize> {
        let moment = self.moment();
        self.place_pins(moment, &self.motion.maps(moment));
        self.board.pick(x, y, reach)
    }

    fn place_pins(&mut self, moment: Moment, maps: &[Map]) {
        let radius = self.radius();
        self.board.place(&self.motion, moment, maps, &self.camera, &self.window, radius);
    }

    /// Places the pins for a frame and looks which of them the surface hides; for large meshes over several frames.
    /// Whether there is more to do in a frame to come. `maps` are the skin's at this moment.
    pub fn look(&mut self, maps: &[Map]) -> bool {
        let moment = self.moment();
        self.place_pins(moment, maps);
        let more = self.board.look(&self.motion, moment, maps, &self.camera, &self.window);
        self.board.fade() || more
    }

    /// Numbers of the pins for the shaders: see [`Board::floats`].
    pub fn pin_floats(&self) -> Vec<[f32; pins::FLOATS]> {
        self.board.floats(self.pixel_ratio)
    }

    /// Radius of the figure in its first pose.
    fn radius(&mut self) -> f32 {
        self.extent(if self.motion.poses() > 0 { 1 } else { 0 }).ball().radius
    }

    /// What the shaders need to know of this moment.
    pub fn frame(&mut self) -> Frame {
        let moment = self.moment();
        let now = self.extent(moment.from).towards(&self.extent(moment.to), moment.part);
        let radius = self.radius();
        let ball = now.ball();
        let (camera, ratio) = (self.camera, self.pixel_ratio);
        let [right, up, back] = camera.axes();
        let (near, far) = camera.range(ball);
        let (cx, cy) = self.window.centre();
        let room = Window { insets: self.room.unwrap_or(self.window.insets), ..self.window };
        let (rx, ry) = room.centre();
        let level = right.cross(Vec3::Y);
        let key = (right * KEY.x + Vec3::Y * KEY.y + level * KEY.z).normalize();
        let floor = self.whole().low.y;
        // The middle between the figure and its shadow.
        let middle = ball.centre - Vec3::new(key.x, 0.0, key.z) / key.y * (0.5 * (ball.centre.y - floor));
        let side = 1.1 * ball.radius + 0.75 * radius;
        let label = self.hovered.and_then(|f| self.paint.label(f)).map_or(0.0, |l| l as f32 + 1.0);
        let on = |yes: bool, strength: f32| if yes { strength } else { 0.0 };
        Frame {
            view: camera.projection(&self.window, ball),
            light: light_map(key, ball.centre, ball.radius),
            eye: camera.eye().extend(radius),
            right: right.extend(near),
            up: up.extend(far),
            back: back.extend(self.window.focal() * ratio),
            window: glam::Vec4::new(self.window.width, self.window.height, cx, cy) * ratio,
            room: glam::Vec4::new(rx, ry, room.focal(), 0.0) * ratio,
            ground: Vec3::new(middle.x, floor, middle.z).extend(side),
            key: key.extend(if self.plain { 0.0 } else { 0.8 }),
            lines: glam::Vec4::new(0.62 * ratio, 0.18 * ratio, on(self.boundaries, 1.0), on(self.wires, 0.4)),
            // A skin makes one shape of this moment.
            moment: glam::Vec4::new(
                if self.motion.skin().is_some() { 0.0 } else { moment.part },
                self.hovered.map_or(-1.0, |f| f as f32),
                label,
                1.0 / 255.0,
            ),
            field: glam::Vec4::new(on(self.contours, 0.32), 0.7 * ratio, 0.0, 0.0),
            flow: srgb_to_linear(CLAY).extend(self.flow),
            theme: Theme::new(self.dark),
        }
    }
}

#[cfg(test)]
mod tests;
