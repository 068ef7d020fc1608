//! Where to look from, to see some faces among all others.

use super::camera::{Ball, Camera, Window};
use super::sight::{Eye, Mark, hidden};
use glam::Vec3;

/// Faces that are looked for; more are thinned out evenly.
const LOOKED_FOR: usize = 40;

/// The camera comes no nearer than this, in radii of the scene: what lies around is to be seen, too.
const NEAREST: f32 = 2.0;

/// Directions around the figure that are tried, and how far they look down, radians.
const AROUND: usize = 8;
const PITCHES: [f32; 3] = [0.25, -0.35, 0.9];

/// How far the surface may stand before a face without hiding it, in radii of the scene.
const SLACK: f32 = 0.004;

/// How many more faces another direction must show, as a share of all, for the camera to turn.
const WORTH: f32 = 0.1;

/// A camera that shows as many as can be of `wanted` faces: `camera` if it does, else one that looks against the way they
/// look, else one from another side.
///
/// `faces` is #F triples of vertex numbers, `positions` #V points, `scene` a ball around them. `None` if no face of
/// `wanted` has a place.
pub fn look_at(
    camera: &Camera,
    window: &Window,
    scene: Ball,
    wanted: &[u32],
    faces: &[[u32; 3]],
    positions: &[Vec3],
) -> Option<Camera> {
    let place = |&f: &u32| {
        let [a, b, c] = faces.get(f as usize)?.map(|v| positions.get(v as usize).copied());
        Some([a?, b?, c?]).filter(|corners| corners.iter().all(|p| p.is_finite()))
    };
    let triangles: Vec<[Vec3; 3]> = wanted.iter().filter_map(place).collect();
    if triangles.is_empty() {
        return None;
    }
    let step = triangles.len().div_ceil(LOOKED_FOR);
    let slack = SLACK * scene.radius;
    let marks: Vec<Mark> = triangles.iter().step_by(step).map(|[a, b, c]| ((a + b + c) / 3.0, slack)).collect();
    let framed = |turned: Camera| framed(turned, window, scene, &triangles);
    let shown = |camera: &Camera| {
        let eye = Eye { at: camera.eye(), axes: camera.axes() };
        let hidden = hidden(eye, &marks, faces, positions);
        hidden.iter().filter(|hidden| !**hidden).count() as f32 / marks.len() as f32
    };
    let mut best = framed(*camera);
    let mut most = shown(&best);
    for (yaw, pitch) in directions(camera, &triangles) {
        if most > 1.0 - WORTH {
            break;
        }
        let tried = framed(Camera { yaw, pitch, ..*camera });
        let share = shown(&tried);
        if share > most + WORTH {
            (best, most) = (tried, share);
        }
    }
    Some(best)
}

/// Yaw and pitch of directions worth trying: against the way that the faces look, then all around.
fn directions(camera: &Camera, triangles: &[[Vec3; 3]]) -> Vec<(f32, f32)> {
    let normal: Vec3 = triangles.iter().map(|[a, b, c]| (b - a).cross(c - a)).sum();
    let outward = normal.try_normalize().map(|n| (n.x.atan2(n.z), n.y.clamp(-0.95, 0.95).asin()));
    let turn = |i: usize| camera.yaw + std::f32::consts::TAU * i as f32 / AROUND as f32;
    let around = PITCHES.iter().flat_map(|&pitch| (0..AROUND).map(move |i| (turn(i), pitch)));
    outward.into_iter().chain(around).collect()
}

/// The camera with the triangles in the middle of the picture and not too near.
fn framed(mut camera: Camera, window: &Window, scene: Ball, triangles: &[[Vec3; 3]]) -> Camera {
    let corners = || triangles.iter().flatten().copied();
    let low = corners().fold(Vec3::INFINITY, Vec3::min);
    let high = corners().fold(Vec3::NEG_INFINITY, Vec3::max);
    let middle = 0.5 * low + 0.5 * high;
    camera.target = middle;
    camera.frame(window, corners(), middle);
    camera.distance = camera.distance.max(NEAREST * scene.radius);
    camera
}

#[cfg(test)]
mod tests {
    use super::*;

    const WINDOW: Window = Window { width: 900.0, height: 600.0, insets: [0.0; 4] };

    /// A cube of twelve faces, two on each side.
    fn cube() -> (Vec<[u32; 3]>, Vec<Vec3>) {
        let at = |i: u32| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32) * 2.0 - Vec3::ONE;
        let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let faces = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        (faces, (0..8).map(at).collect())
    }

    #[test]
    fn goes_round_to_what_is_behind() {
        let (faces, positions) = cube();
        let scene = Ball { centre: Vec3::ZERO, radius: 3_f32.sqrt() };
        for wanted in 0..faces.len() as u32 {
            let camera = look_at(&Camera::default(), &WINDOW, scene, &[wanted], &faces, &positions).unwrap();
            let [a, b, c] = faces[wanted as usize].map(|v| positions[v as usize]);
            let outward = (b - a).cross(c - a);
            assert!((camera.eye() - a).dot(outward) > 0.0, "face {wanted} is seen from behind");
            assert!(camera.distance >= NEAREST * scene.radius && camera.target.distance((a + b + c) / 3.0) < 1.0);
        }
    }

    #[test]
    fn stays_where_everything_is_seen_and_goes_nowhere_for_nothing() {
        let (faces, positions) = cube();
        let scene = Ball { centre: Vec3::ZERO, radius: 3_f32.sqrt() };
        let before = Camera { yaw: 0.1, pitch: 0.1, ..Camera::default() };
        let after = look_at(&before, &WINDOW, scene, &[2, 3], &faces, &positions).unwrap();
        assert_eq!((after.yaw, after.pitch), (before.yaw, before.pitch));
        assert_eq!(look_at(&before, &WINDOW, scene, &[], &faces, &positions), None);
        assert_eq!(look_at(&before, &WINDOW, scene, &[99], &faces, &positions), None);
        assert_eq!(look_at(&before, &WINDOW, scene, &[0], &[[0, 1, 9]], &positions), None);
    }
}
