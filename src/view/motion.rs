//! The figure on the stage: faces, reference and poses, and what is in between at a given time.

use super::camera::Ball;
use super::skin::{Map, Skin};
use glam::Vec3;

/// Faces and positions, checked.
#[derive(Clone, Debug, Default)]
pub struct Motion {
    faces: Vec<[u32; 3]>,
    reference: Vec<Vec3>,
    poses: Vec<Vec3>,
    /// What moves the reference instead of poses.
    skin: Option<Skin>,
}

/// A moment between two shapes. Shape 0 is the reference, shape k > 0 the pose k − 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Moment {
    /// The earlier shape.
    pub from: usize,
    /// The later shape.
    pub to: usize,
    /// How far on the way (0 to 1).
    pub part: f32,
}

/// Box around points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Extent {
    /// Least coordinates.
    pub low: Vec3,
    /// Greatest coordinates.
    pub high: Vec3,
}

impl Extent {
    /// The box around `points`; a small box at the origin if there are none.
    pub fn of<'a>(points: impl Iterator<Item = &'a Vec3>) -> Self {
        let (low, high) =
            points.fold((Vec3::INFINITY, Vec3::NEG_INFINITY), |(low, high), &p| (low.min(p), high.max(p)));
        if low.x <= high.x { Self { low, high } } else { Self { low: Vec3::NEG_ONE, high: Vec3::ONE } }
    }

    /// The middle.
    pub fn centre(&self) -> Vec3 {
        (self.low + self.high) * 0.5
    }

    /// The ball around the box.
    pub fn ball(&self) -> Ball {
        Ball { centre: self.centre(), radius: (0.5 * self.low.distance(self.high)).max(1e-6) }
    }

    /// The box around this one and another.
    pub fn and(&self, other: &Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// The box a share `t` of the way to `other`.
    pub fn towards(&self, other: &Self, t: f32) -> Self {
        Self { low: self.low.lerp(other.low, t), high: self.high.lerp(other.high, t) }
    }
}

impl Motion {
    /// A still mesh: `faces` is 3·#F vertex numbers, `reference` 3·#V coordinates. The error is a sentence.
    pub fn new(faces: &[u32], reference: &[f32]) -> Result<Self, &'static str> {
        if !faces.len().is_multiple_of(3) || !reference.len().is_multiple_of(3) {
            return Err("Faces need three corners each and vertices three coordinates each.");
        }
        let reference = points(reference)?;
        if faces.iter().any(|&v| v as usize >= reference.len()) {
            return Err("A face of this mesh names a vertex that does not exist.");
        }
        let faces = faces.chunks_exact(3).map(|c| [c[0], c[1], c[2]]).collect();
        Ok(Self { faces, reference, poses: Vec::new(), skin: None })
    }

    /// Puts other poses in place of those there are: T·3·#V coordinates. The error is a sentence.
    pub fn set_poses(&mut self, positions: &[f32]) -> Result<(), &'static str> {
        let each = 3 * self.reference.len();
        if !positions.is_empty() && (each == 0 || !positions.len().is_multiple_of(each)) {
            return Err("The poses have another number of vertices than the mesh.");
        }
        self.poses = points(positions)?;
        self.skin = None;
        Ok(())
    }

    /// Puts a skin in place of the poses: see [`Skin::new`].
    pub fn set_skin(
        &mut self,
        handles: usize,
        indices: &[u16],
        weights: &[f32],
        each: usize,
        matrices: &[f32],
    ) -> Result<(), &'static str> {
        self.skin = Some(Skin::new(&self.reference, handles, indices, weights, each, matrices)?);
        self.poses = Vec::new();
        Ok(())
    }

    /// Puts other maps into the skin: see [`Skin::set_maps`].
    pub fn set_maps(&mut self, matrices: &[f32]) -> Result<(), &'static str> {
        self.skin.as_mut().ok_or("There is no skin to move.")?.set_maps(matrices)
    }

    /// The skin, where one moves the mesh.
    pub fn skin(&self) -> Option<&Skin> {
        self.skin.as_ref()
    }

    /// #F triples of vertex numbers.
    pub fn faces(&self) -> &[[u32; 3]] {
        &self.faces
    }

    /// Number of vertices.
    pub fn vertices(&self) -> usize {
        self.reference.len()
    }

    /// Number of poses, the reference not counted.
    pub fn poses(&self) -> usize {
        if let Some(skin) = &self.skin {
            return skin.poses();
        }
        self.poses.len().checked_div(self.reference.len()).unwrap_or(0)
    }

    /// #V positions of a shape: 0 is the reference, k > 0 the pose k − 1; the reference where there is no such pose or
    /// a skin moves the mesh.
    pub fn shape(&self, shape: usize) -> &[Vec3] {
        let n = self.reference.len();
        shape.checked_sub(1).and_then(|k| self.poses.get(k * n..(k + 1) * n)).unwrap_or(&self.reference)
    }

    /// What is between which shapes at time `t`, in poses: 2.25 is a quarter of the way from pose 2 to pose 3, −1 the
    /// reference, from which one comes to pose 0. Where the motion `loops`, the last pose goes over into the first;
    /// otherwise it stays.
    pub fn at(&self, t: f32, loops: bool) -> Moment {
        let count = self.poses();
        if count == 0 || t.is_nan() || t <= -1.0 {
            return Moment { from: 0, to: 0, part: 0.0 };
        }
        if t < 0.0 {
            return Moment { from: 0, to: 1, part: t + 1.0 };
        }
        let last = (count - 1) as f32;
        let t = if loops { t.rem_euclid(count as f32) } else { t.min(last) };
        let k = (t as usize).min(count - 1);
        let next = if k + 1 < count {
            k + 1
        } else if loops {
            0
        } else {
            k
        };
        Moment { from: k + 1, to: next + 1, part: (t - k as f32).clamp(0.0, 1.0) }
    }

    /// #V positions at a moment, into `out`.
    pub fn positions(&self, moment: Moment, out: &mut Vec<Vec3>) {
        if let Some(skin) = &self.skin {
            skin.positions(&self.reference, &skin.maps(moment), out);
            return;
        }
        let (from, to) = (self.shape(moment.from), self.shape(moment.to));
        out.clear();
        out.extend(from.iter().zip(to).map(|(&a, &b)| a.lerp(b, moment.part)));
    }

    /// The skin's maps at a moment; none without a skin.
    pub fn maps(&self, moment: Moment) -> Vec<Map> {
        self.skin.as_ref().map_or_else(Vec::new, |skin| skin.maps(moment))
    }

    /// Where a vertex is at a moment; `maps` are those of [`Motion::maps`].
    pub fn vertex(&self, vertex: u32, moment: Moment, maps: &[Map]) -> Option<Vec3> {
        let v = vertex as usize;
        match &self.skin {
            Some(skin) => Some(skin.place(v, *self.reference.get(v)?, maps)),
            None => Some(self.shape(moment.from).get(v)?.lerp(*self.shape(moment.to).get(v)?, moment.part)),
        }
    }

    /// The box around the reference.
    pub fn reference_extent(&self) -> Extent {
        Extent::of(self.reference.iter())
    }

    /// The box around a shape.
    pub fn shape_extent(&self, shape: usize) -> Extent {
        match &self.skin {
            Some(skin) => skin.extent(&self.reference, shape),
            None => Extent::of(self.shape(shape).iter()),
        }
    }

    /// The box around all poses; around the reference if there are none.
    pub fn extent(&self) -> Extent {
        if self.poses() == 0 {
            return self.reference_extent();
        }
        match &self.skin {
            Some(_) => Extent::of(self.sample(false).iter()),
            None => Extent::of(self.poses.iter()),
        }
    }

    /// Points that stand for the whole motion (or for the reference alone): every vertex, or evenly taken ones where
    /// there are very many, or those that stand out where a skin moves the mesh.
    pub fn sample(&self, reference: bool) -> Vec<Vec3> {
        if let (Some(skin), false) = (&self.skin, reference || self.poses() == 0) {
            return (1..=self.poses()).flat_map(|shape| skin.outline(&self.reference, shape)).collect();
        }
        let all = if reference || self.poses.is_empty() { &self.reference } else { &self.poses };
        // A stride that shares no factor with a likely number of vertices would be nicer; the loss is invisible.
        all.iter().step_by(all.len() / 150_000 + 1).copied().collect()
    }
}

fn points(numbers: &[f32]) -> Result<Vec<Vec3>, &'static str> {
    // Beyond this, squares in the shaders overflow.
    if numbers.iter().any(|x| x.is_nan() || x.abs() >= 1e15) {
        return Err("A coordinate of this mesh is not a usable number.");
    }
    Ok(numbers.chunks_exact(3).map(Vec3::from_slice).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion() -> Motion {
        let mut motion = Motion::new(&[0, 1, 2], &[0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0]).unwrap();
        let poses: Vec<f32> = (1..=3).flat_map(|k| (0..9).map(move |i| (k * 10 + i) as f32)).collect();
        motion.set_poses(&poses).unwrap();
        motion
    }

    #[test]
    fn times() {
        let m = motion();
        assert_eq!(m.poses(), 3);
        assert_eq!(m.at(-1.0, false), Moment { from: 0, to: 0, part: 0.0 });
        assert_eq!(m.at(-0.25, false), Moment { from: 0, to: 1, part: 0.75 });
        assert_eq!(m.at(1.25, false), Moment { from: 2, to: 3, part: 0.25 });
        assert_eq!(m.at(7.0, false), Moment { from: 3, to: 3, part: 0.0 });
        assert_eq!(m.at(2.5, true), Moment { from: 3, to: 1, part: 0.5 });
        assert_eq!(m.at(3.5, true), Moment { from: 1, to: 2, part: 0.5 });
        assert_eq!(m.at(f32::NAN, true), Moment { from: 0, to: 0, part: 0.0 });
    }

    #[test]
    fn positions_between_poses() {
        let m = motion();
        let mut out = Vec::new();
        m.positions(m.at(0.5, false), &mut out);
        assert_eq!(out, [Vec3::new(15.0, 16.0, 17.0), Vec3::new(18.0, 19.0, 20.0), Vec3::new(21.0, 22.0, 23.0)]);
    }

    #[test]
    fn bad_arrays_are_refused() {
        assert!(Motion::new(&[0, 1, 3], &[0.0; 9]).is_err());
        assert!(Motion::new(&[0, 1], &[0.0; 9]).is_err());
        assert!(Motion::new(&[], &[f32::NAN; 3]).is_err());
        assert!(motion().set_poses(&[0.0; 10]).is_err());
        assert!(motion().set_poses(&[f32::INFINITY; 9]).is_err());
        assert!(Motion::default().set_poses(&[0.0; 3]).is_err());
    }

    #[test]
    fn a_skin_moves_like_the_poses_it_makes() {
        let mut skinned = motion();
        let shift = |x: f32| [1.0, 0.0, 0.0, x, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 1.0, 0.0];
        let matrices: Vec<f32> = [shift(2.0), shift(-2.0), shift(5.0), shift(3.0)].concat();
        skinned.set_skin(2, &[0, 1, 0, 1, 1, 0], &[0.5, 0.5, 1.0, 0.0, 0.75, 0.25], 2, &matrices).unwrap();
        let mut posed = motion();
        let pose = [0.0, 0.0, 0.0, 3.0, 0.0, 0.0, -1.0, 1.0, 0.0, 4.0, 0.0, 0.0, 6.0, 0.0, 0.0, 3.5, 1.0, 0.0];
        posed.set_poses(&pose).unwrap();
        let (mut a, mut b) = (Vec::new(), Vec::new());
        for t in [-1.0, -0.5, 0.0, 0.3, 1.0, 1.5] {
            let moment = skinned.at(t, true);
            assert_eq!(moment, posed.at(t, true));
            skinned.positions(moment, &mut a);
            posed.positions(moment, &mut b);
            assert!(a.iter().zip(&b).all(|(p, q)| p.distance(*q) < 1e-5), "{a:?} {b:?}");
            let maps = skinned.maps(moment);
            for v in 0..3 {
                assert_eq!(skinned.vertex(v, moment, &maps), Some(a[v as usize]));
                assert_eq!(posed.vertex(v, moment, &[]), Some(b[v as usize]));
            }
        }
        assert_eq!(skinned.extent(), posed.extent());
        assert_eq!(skinned.vertex(9, skinned.at(0.0, false), &[]), None);
        assert!(skinned.set_maps(&[0.0; 13]).is_err() && posed.set_maps(&[]).is_err());
    }

    #[test]
    fn an_empty_mesh_has_an_extent() {
        let ball = Motion::default().extent().ball();
        assert!(ball.radius > 0.0 && ball.centre.is_finite());
    }
}
