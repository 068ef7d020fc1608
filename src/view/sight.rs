//! Which points the surface hides from the camera: one walk through the faces for all points together.

use super::camera::Ray;
use glam::{Vec2, Vec3};

/// Where one looks from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Eye {
    /// Where the camera stands.
    pub at: Vec3,
    /// To the right, up and backwards, each of length 1.
    pub axes: [Vec3; 3],
}

impl Eye {
    /// Right and up of a point over its depth, and its depth along the line of sight.
    fn project(&self, p: Vec3) -> (Vec2, f32) {
        let from = p - self.at;
        let depth = -from.dot(self.axes[2]);
        (Vec2::new(from.dot(self.axes[0]), from.dot(self.axes[1])) / depth, depth)
    }
}

/// A point, and how far the surface may stand before it without hiding it.
pub type Mark = (Vec3, f32);

/// For each of `marks` whether a face hides it. `faces` is #F triples of vertex numbers, `positions` #V points.
pub fn hidden(eye: Eye, marks: &[Mark], faces: &[[u32; 3]], positions: &[Vec3]) -> Vec<bool> {
    let mut walk = Walk::new(eye, marks);
    walk.step(usize::MAX, positions.len(), |v| positions.get(v).copied(), faces);
    walk.hidden
}

/// A walk through the mesh that can be taken in steps.
#[derive(Clone, Debug)]
pub struct Walk {
    eye: Eye,
    /// Where the points are on the picture, how deep what hides them may at most be, and which they are; from left to
    /// right.
    aims: Vec<(Vec2, f32, usize)>,
    /// The vertices on the picture, and how deep, as far as the walk has come.
    seen: Vec<(Vec2, f32)>,
    /// The faces that are done.
    faces: usize,
    /// For each point whether a face hides it, as far as the walk has come.
    pub hidden: Vec<bool>,
}

impl Walk {
    /// A walk that has not begun.
    pub fn new(eye: Eye, marks: &[Mark]) -> Self {
        let aim = |(i, &(p, slack)): (usize, &Mark)| {
            let (at, depth) = eye.project(p);
            (at, depth - slack, i)
        };
        let mut aims: Vec<_> = marks.iter().enumerate().map(aim).filter(|a| a.0.is_finite() && a.1 > 0.0).collect();
        aims.sort_by(|a, b| a.0.x.total_cmp(&b.0.x));
        Self { eye, aims, seen: Vec::new(), faces: 0, hidden: vec![false; marks.len()] }
    }

    /// Goes on by at most `budget` vertices and faces; whether the walk is over. `position` tells where each of
    /// `vertices` vertices is; from step to step that, and `faces`, must be the same.
    pub fn step(
        &mut self,
        budget: usize,
        vertices: usize,
        position: impl Fn(usize) -> Option<Vec3>,
        faces: &[[u32; 3]],
    ) -> bool {
        if self.aims.is_empty() {
            return true;
        }
        let until = self.seen.len().saturating_add(budget).min(vertices);
        let left = budget - (until - self.seen.len());
        for v in self.seen.len()..until {
            self.seen.push(self.eye.project(position(v).unwrap_or(Vec3::NAN)));
        }
        if until < vertices {
            return false;
        }
        let until = self.faces.saturating_add(left).min(faces.len());
        for corners in &faces[self.faces.min(until)..until] {
            self.face(corners);
        }
        self.faces = until;
        until == faces.len()
    }

    fn face(&mut self, corners: &[u32; 3]) {
        let [Some(&a), Some(&b), Some(&c)] = corners.map(|v| self.seen.get(v as usize)) else { return };
        // What reaches behind the camera hides nothing that one would look for. Nor does what is nowhere.
        if !(a.1 > 0.0 && b.1 > 0.0 && c.1 > 0.0) {
            return;
        }
        let (left, right) = (a.0.x.min(b.0.x).min(c.0.x), a.0.x.max(b.0.x).max(c.0.x));
        let first = self.aims.partition_point(|aim| aim.0.x < left);
        for &(at, reach, i) in self.aims[first..].iter().take_while(|aim| aim.0.x <= right) {
            if depth_at(at, [a, b, c]).is_some_and(|depth| depth < reach) {
                self.hidden[i] = true;
            }
        }
    }
}

/// How deep a projected triangle is at a place, if it is there.
fn depth_at(at: Vec2, [a, b, c]: [(Vec2, f32); 3]) -> Option<f32> {
    let area = (b.0 - a.0).perp_dot(c.0 - a.0);
    let u = (b.0 - at).perp_dot(c.0 - at) / area;
    let v = (c.0 - at).perp_dot(a.0 - at) / area;
    let w = 1.0 - u - v;
    // Over depth everything is linear on the picture. Also none where a number is not finite.
    (u >= 0.0 && v >= 0.0 && w >= 0.0).then(|| 1.0 / (u / a.1 + v / b.1 + w / c.1))
}

/// The line of sight to a point.
pub fn ray_to(eye: Eye, p: Vec3) -> Ray {
    Ray { origin: eye.at, direction: (p - eye.at).normalize_or(-eye.axes[2]) }
}

#[cfg(test)]
mod tests {
    use super::super::picking::pick;
    use super::*;
    use proptest::prelude::*;

    fn point() -> impl Strategy<Value = Vec3> {
        (-1.0f32..1.0, -1.0f32..1.0, -1.0f32..1.0).prop_map(|(x, y, z)| Vec3::new(x, y, z))
    }

    fn eye() -> Eye {
        let camera = super::super::camera::Camera { target: Vec3::new(0.1, 0.0, -0.1), ..Default::default() };
        Eye { at: camera.eye(), axes: camera.axes() }
    }

    proptest! {
        #[test]
        fn agrees_with_a_ray(
            positions in prop::collection::vec(point(), 12),
            corners in prop::collection::vec([0u32..12, 0u32..12, 0u32..12], 1..30),
            marks in prop::collection::vec(point(), 1..6),
            slack in 0.0f32..0.2,
        ) {
            let marks: Vec<Mark> = marks.into_iter().map(|p| (p, slack)).collect();
            let found = hidden(eye(), &marks, &corners, &positions);
            for (&(p, slack), found) in marks.iter().zip(found) {
                let deep = |q: Vec3| -(q - eye().at).dot(eye().axes[2]);
                let hit = pick(ray_to(eye(), p), &corners, &positions);
                let ahead = hit.map_or(f32::INFINITY, |h| deep(h.point)) - (deep(p) - slack);
                let edge = hit.is_some_and(|h| h.weights.iter().any(|w| *w < 1e-3)) || hit.is_none();
                prop_assume!(ahead.abs() > 1e-3 && (!edge || !found));
                prop_assert_eq!(found, ahead < 0.0);
            }
        }
    }

    #[test]
    fn a_wall_hides_what_is_behind_it() {
        let eye = Eye { at: Vec3::new(0.0, 0.0, 5.0), axes: [Vec3::X, Vec3::Y, Vec3::Z] };
        let wall = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(0.0, 2.0, 0.0)];
        let at = |z: f32| (Vec3::new(0.0, 0.1, z), 0.1);
        let marks = [at(-1.0), at(0.0), at(1.0), at(-0.05), (Vec3::new(3.0, 0.0, -1.0), 0.1), at(9.0), at(f32::NAN)];
        let found = hidden(eye, &marks, &[[0, 1, 2], [0, 1, 99]], &wall);
        assert_eq!(found, [true, false, false, false, false, false, false]);
        assert!(hidden(eye, &[], &[[0, 1, 2]], &wall).is_empty());
        let mut walk = Walk::new(eye, &marks);
        let steps = (1..).find(|_| walk.step(1, 3, |v| wall.get(v).copied(), &[[0, 1, 2], [0, 1, 99]]));
        assert_eq!((walk.hidden, steps), (found, Some(5)), "in steps it is the same");
    }
}
