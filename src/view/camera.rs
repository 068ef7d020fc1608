//! The camera: an orbit around a target, with a lens that looks at the part of the window that panels leave free.
//!
//! Window lengths are CSS pixels from the top left corner. The world has y up.

use glam::{Mat4, Vec3, Vec4};

/// Half the angle of view over the shorter side of the free part of the window, radians.
const HALF_ANGLE: f32 = 16.0 * std::f32::consts::PI / 180.0;
/// Share of the free part of the window that a framed figure takes.
const FILL: f32 = 0.88;
/// The steepest look up or down, radians.
const STEEPEST: f32 = 1.55;
/// Radians of turn a pixel of drag.
const TURN: f32 = 0.0075;

/// The part of the page that is drawn on.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Window {
    /// CSS pixels.
    pub width: f32,
    /// CSS pixels.
    pub height: f32,
    /// CSS pixels that panels cover at the left, top, right and bottom.
    pub insets: [f32; 4],
}

impl Window {
    /// Width and height of the part that no panel covers, at least a tenth of the window.
    pub fn free(&self) -> (f32, f32) {
        let [left, top, right, bottom] = self.insets;
        let (w, h) = (self.width.max(1.0), self.height.max(1.0));
        ((w - left - right).max(0.1 * w), (h - top - bottom).max(0.1 * h))
    }

    /// The middle of the part that no panel covers.
    pub fn centre(&self) -> (f32, f32) {
        let [left, top, right, bottom] = self.insets;
        (0.5 * (self.width + left - right), 0.5 * (self.height + top - bottom))
    }

    /// Focal length in CSS pixels.
    pub fn focal(&self) -> f32 {
        let (w, h) = self.free();
        0.5 * w.min(h) / HALF_ANGLE.tan()
    }
}

/// A ball around what there is to see.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ball {
    /// Its middle.
    pub centre: Vec3,
    /// Its radius, positive.
    pub radius: f32,
}

/// A straight line of sight.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: Vec3,
    /// Where it goes, of any length.
    pub direction: Vec3,
}

/// Where the camera is: `distance` from `target`, turned by `yaw` around y (0 looks along −z) and raised by `pitch`
/// (radians).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Camera {
    /// The point that it turns about and that stands in the middle of the free part of the window.
    pub target: Vec3,
    /// Radians.
    pub yaw: f32,
    /// Radians.
    pub pitch: f32,
    /// From the target, positive.
    pub distance: f32,
}

impl Default for Camera {
    /// A three-quarter view from a little above.
    fn default() -> Self {
        Self { target: Vec3::ZERO, yaw: 0.75, pitch: 0.2, distance: 5.0 }
    }
}

impl Camera {
    /// The directions to the right, up and backwards (towards the viewer), each of length 1.
    pub fn axes(&self) -> [Vec3; 3] {
        let (sy, cy) = self.yaw.sin_cos();
        let (sp, cp) = self.pitch.sin_cos();
        let back = Vec3::new(cp * sy, sp, cp * cy);
        let right = Vec3::new(cy, 0.0, -sy);
        [right, back.cross(right), back]
    }

    /// Where the camera stands.
    pub fn eye(&self) -> Vec3 {
        self.target + self.axes()[2] * self.distance
    }

    /// Distances along the line of sight between which all of `scene` lies.
    pub fn range(&self, scene: Ball) -> (f32, f32) {
        let depth = (self.eye() - scene.centre).dot(self.axes()[2]);
        let reach = 1.02 * scene.radius;
        let far = (depth + reach).max(0.02 * reach);
        ((depth - reach).max(0.002 * far), far)
    }

    /// World to clip space (depth 0 to 1).
    pub fn projection(&self, window: &Window, scene: Ball) -> Mat4 {
        let [right, up, back] = self.axes();
        let eye = self.eye();
        let (near, far) = self.range(scene);
        let (w, h) = (window.width.max(1.0), window.height.max(1.0));
        let (cx, cy) = window.centre();
        let f = window.focal();
        let lens = Mat4::from_cols(
            Vec4::new(2.0 * f / w, 0.0, 0.0, 0.0),
            Vec4::new(0.0, 2.0 * f / h, 0.0, 0.0),
            Vec4::new(1.0 - 2.0 * cx / w, 2.0 * cy / h - 1.0, far / (near - far), -1.0),
            Vec4::new(0.0, 0.0, near * far / (near - far), 0.0),
        );
        let view = Mat4::from_cols(
            Vec4::new(right.x, up.x, back.x, 0.0),
            Vec4::new(right.y, up.y, back.y, 0.0),
            Vec4::new(right.z, up.z, back.z, 0.0),
            Vec4::new(-right.dot(eye), -up.dot(eye), -back.dot(eye), 1.0),
        );
        lens * view
    }

    /// Where a point of a scene with some `radius` is on the window (x, y), and its depth, which is not positive behind
    /// the eye.
    pub fn place(&self, window: &Window, radius: f32, point: Vec3) -> [f32; 3] {
        let [right, up, back] = self.axes();
        let from = point - self.eye();
        let depth = -from.dot(back);
        let scale = window.focal() / depth.max(1e-6 * radius);
        let (cx, cy) = window.centre();
        [cx + from.dot(right) * scale, cy - from.dot(up) * scale, depth]
    }

    /// The line of sight through a point of the window.
    pub fn ray(&self, window: &Window, x: f32, y: f32) -> Ray {
        let [right, up, back] = self.axes();
        let (cx, cy) = window.centre();
        let f = window.focal();
        Ray { origin: self.eye(), direction: (right * ((x - cx) / f) + up * ((cy - y) / f) - back).normalize() }
    }

    /// Turns by a drag of (dx, dy) pixels.
    pub fn orbit(&mut self, dx: f32, dy: f32) {
        if dx.is_finite() && dy.is_finite() {
            self.yaw = (self.yaw - dx * TURN).rem_euclid(std::f32::consts::TAU);
            self.pitch = (self.pitch + dy * TURN).clamp(-STEEPEST, STEEPEST);
        }
    }

    /// Moves with a drag of (dx, dy) pixels, so that the target follows the pointer; the target stays near `scene`.
    pub fn pan(&mut self, window: &Window, scene: Ball, dx: f32, dy: f32) {
        if dx.is_finite() && dy.is_finite() {
            let [right, up, _] = self.axes();
            self.target += (up * dy - right * dx) * (self.distance / window.focal());
            self.keep_near(scene);
        }
    }

    /// Comes nearer by `factor` (above 1) or goes away (below 1); what is under (x, y) at the target's distance stays
    /// there.
    pub fn zoom(&mut self, window: &Window, scene: Ball, factor: f32, x: f32, y: f32) {
        if !(factor > 0.0 && factor.is_finite() && x.is_finite() && y.is_finite()) {
            return;
        }
        let distance = (self.distance / factor).clamp(0.12 * scene.radius, 40.0 * scene.radius);
        let [right, up, _] = self.axes();
        let (cx, cy) = window.centre();
        let aside = (right * (x - cx) + up * (cy - y)) / window.focal();
        self.target += aside * (self.distance - distance);
        self.distance = distance;
        self.keep_near(scene);
    }

    /// Goes where all `points` just fit the free part of the window, looking in the same direction; turns about the
    /// depth of `centre` from then on.
    pub fn frame(&mut self, window: &Window, points: impl Iterator<Item = Vec3>, centre: Vec3) {
        let [right, up, back] = self.axes();
        let (w, h) = window.free();
        let (tx, ty) = (0.5 * FILL * w / window.focal(), 0.5 * FILL * h / window.focal());
        // A point (x, y, z) in the camera's axes is inside the four sides of the view if ±x + z·tx and ±y + z·ty are
        // at most what they are at the apex; so the extremes over the points give the apex.
        let mut most = [f32::NEG_INFINITY; 4];
        for p in points {
            let (x, y, z) = (p.dot(right), p.dot(up), p.dot(back));
            for (m, v) in most.iter_mut().zip([x + z * tx, z * tx - x, y + z * ty, z * ty - y]) {
                *m = m.max(v);
            }
        }
        if !most.iter().all(|m| m.is_finite()) {
            return;
        }
        let z = ((most[0] + most[1]) / (2.0 * tx)).max((most[2] + most[3]) / (2.0 * ty));
        let eye = right * (0.5 * (most[0] - most[1])) + up * (0.5 * (most[2] - most[3])) + back * z;
        let distance = (eye - centre).dot(back);
        if distance > 0.0 && distance.is_finite() {
            self.distance = distance;
            self.target = eye - back * distance;
        }
    }

    /// The camera as six numbers: target x, y, z, yaw, pitch, distance.
    pub fn numbers(&self) -> [f32; 6] {
        let t = self.target;
        [t.x, t.y, t.z, self.yaw, self.pitch, self.distance]
    }

    /// The camera of six numbers; `None` if they are not a camera.
    pub fn from_numbers(numbers: &[f32]) -> Option<Self> {
        let &[x, y, z, yaw, pitch, distance] = numbers else { return None };
        let whole = numbers.iter().all(|n| n.is_finite()) && distance > 0.0;
        whole.then(|| Self {
            target: Vec3::new(x, y, z),
            yaw: yaw.rem_euclid(std::f32::consts::TAU),
            pitch: pitch.clamp(-STEEPEST, STEEPEST),
            distance,
        })
    }

    /// The six numbers with lengths in radii of `ball` and places from its middle, so that they show another figure
    /// in the same way.
    pub fn numbers_about(&self, ball: Ball) -> [f32; 6] {
        let target = (self.target - ball.centre) / ball.radius;
        Self { target, distance: self.distance / ball.radius, ..*self }.numbers()
    }

    /// The camera of the numbers of [`Camera::numbers_about`]; `None` if they are not a camera.
    pub fn from_numbers_about(numbers: &[f32], ball: Ball) -> Option<Self> {
        let camera = Self::from_numbers(numbers)?;
        let target = ball.centre + camera.target.clamp_length_max(100.0) * ball.radius;
        Some(Self { target, distance: camera.distance.clamp(0.01, 1000.0) * ball.radius, ..camera })
    }

    fn keep_near(&mut self, scene: Ball) {
        self.target = scene.centre + (self.target - scene.centre).clamp_length_max(3.0 * scene.radius);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const WINDOW: Window = Window { width: 1200.0, height: 800.0, insets: [60.0, 0.0, 300.0, 80.0] };
    const SCENE: Ball = Ball { centre: Vec3::new(1.0, 2.0, 3.0), radius: 2.0 };

    fn camera() -> Camera {
        Camera { target: Vec3::new(1.0, 2.1, 2.8), yaw: 1.1, pitch: 0.3, distance: 9.0 }
    }

    /// Where a point is on the window, CSS pixels, and its depth.
    fn project(camera: &Camera, p: Vec3) -> Vec3 {
        let ndc = camera.projection(&WINDOW, SCENE).project_point3(p);
        Vec3::new((ndc.x + 1.0) * 0.5 * WINDOW.width, (1.0 - ndc.y) * 0.5 * WINDOW.height, ndc.z)
    }

    #[test]
    fn target_stands_in_the_middle_of_the_free_part() {
        let at = project(&camera(), camera().target);
        let (cx, cy) = WINDOW.centre();
        assert!((at.x - cx).abs() < 0.01 && (at.y - cy).abs() < 0.01, "{at}");
    }

    #[test]
    fn rays_go_through_what_is_drawn() {
        let (camera, p) = (camera(), Vec3::new(0.4, 3.0, 2.0));
        let at = project(&camera, p);
        let ray = camera.ray(&WINDOW, at.x, at.y);
        let off = (p - ray.origin).cross(ray.direction).length();
        assert!(off < 1e-3, "{off}");
    }

    #[test]
    fn the_scene_is_never_clipped() {
        for distance in [0.3, 2.0, 9.0, 70.0] {
            let camera = Camera { distance, ..camera() };
            let back = camera.axes()[2];
            let far = project(&camera, SCENE.centre - back * SCENE.radius).z;
            assert!((0.0..=1.0).contains(&far), "{far}");
            if distance > 5.0 {
                let near = project(&camera, SCENE.centre + back * SCENE.radius).z;
                assert!((0.0..=1.0).contains(&near) && near < far);
            }
        }
    }

    #[test]
    fn framing_touches_two_sides_and_no_point_is_outside() {
        let points: Vec<Vec3> = (0..200)
            .map(|i| SCENE.centre + Vec3::new((i as f32).sin(), 0.4 * (1.7 * i as f32).cos(), (2.3 * i as f32).sin()))
            .collect();
        let mut camera = camera();
        camera.frame(&WINDOW, points.iter().copied(), SCENE.centre);
        let (w, h) = WINDOW.free();
        let (cx, cy) = WINDOW.centre();
        let share = |p: &Vec3| {
            let at = project(&camera, *p);
            (2.0 * (at.x - cx) / w, 2.0 * (at.y - cy) / h)
        };
        let (mut x, mut y) = ((0.0_f32, 0.0_f32), (0.0_f32, 0.0_f32));
        for (a, b) in points.iter().map(share) {
            x = (x.0.min(a), x.1.max(a));
            y = (y.0.min(b), y.1.max(b));
        }
        assert!(x.0 > -FILL - 1e-3 && x.1 < FILL + 1e-3 && y.0 > -FILL - 1e-3 && y.1 < FILL + 1e-3, "{x:?} {y:?}");
        assert!(x.1 - x.0 > 2.0 * FILL - 1e-2 || y.1 - y.0 > 2.0 * FILL - 1e-2, "{x:?} {y:?}");
    }

    #[test]
    fn zoom_keeps_the_point_under_the_pointer() {
        let mut camera = camera();
        let [right, up, _] = camera.axes();
        let p = camera.target + right * 0.8 + up * 0.3;
        let before = project(&camera, p);
        camera.zoom(&WINDOW, SCENE, 1.3, before.x, before.y);
        let after = project(&camera, p);
        assert!(before.truncate().distance(after.truncate()) < 0.05);
    }

    #[test]
    fn pan_follows_the_pointer() {
        let mut camera = camera();
        let p = camera.target;
        let before = project(&camera, p);
        camera.pan(&WINDOW, SCENE, 30.0, -12.0);
        let after = project(&camera, p);
        assert!((after - before).truncate().distance(glam::Vec2::new(30.0, -12.0)) < 0.05);
    }

    #[test]
    fn linked_cameras_see_their_figures_alike() {
        // The same figure, ten times as large and elsewhere.
        let other = Ball { centre: Vec3::new(-40.0, 3.0, 8.0), radius: 10.0 * SCENE.radius };
        let camera = camera();
        let linked = Camera::from_numbers_about(&camera.numbers_about(SCENE), other).unwrap();
        for aside in [Vec3::ZERO, Vec3::X, Vec3::new(-0.3, 0.8, 0.4)] {
            let here = project(&camera, SCENE.centre + aside * SCENE.radius);
            let ndc = linked.projection(&WINDOW, other).project_point3(other.centre + aside * other.radius);
            let there = Vec3::new((ndc.x + 1.0) * 0.5 * WINDOW.width, (1.0 - ndc.y) * 0.5 * WINDOW.height, ndc.z);
            assert!(here.distance(there) < 0.02, "{here} {there}");
        }
        let back = Camera::from_numbers_about(&linked.numbers_about(other), SCENE).unwrap();
        assert!(back.target.distance(camera.target) < 1e-4 && (back.distance - camera.distance).abs() < 1e-4);
        assert_eq!(Camera::from_numbers_about(&[f32::NAN; 6], SCENE), None);
    }

    #[test]
    fn limits_hold() {
        let mut camera = camera();
        camera.orbit(0.0, 1e6);
        assert!(camera.pitch <= STEEPEST);
        camera.orbit(f32::NAN, 0.0);
        camera.zoom(&WINDOW, SCENE, 1e9, 0.0, 0.0);
        camera.pan(&WINDOW, SCENE, 1e9, 0.0);
        assert!(camera.target.distance(SCENE.centre) < 3.1 * SCENE.radius);
        assert!(camera.numbers().iter().all(|n| n.is_finite()));
        assert_eq!(Camera::from_numbers(&camera.numbers()), Some(camera));
        assert_eq!(Camera::from_numbers(&[0.0, 0.0, 0.0, 0.0, 0.0, -1.0]), None);
        assert_eq!(Camera::from_numbers(&[0.0; 5]), None);
    }
}
