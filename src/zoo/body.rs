//! A body: bones, the limbs around them, and how they move. What a creature's own file describes.

use super::limb::{Limb, Station};
use super::pieces::Piece;
use super::skeleton::{Rigid, Skeleton};
use glam::{DQuat, DVec3};

/// A creature before it is meshed.
#[derive(Clone, Debug)]
pub struct Body {
    /// The bones, in the pose in which the body is meshed.
    pub skeleton: Skeleton,
    /// The limbs in the order in which they are joined.
    pub limbs: Vec<Limb>,
    /// Rigid pieces that stand in for the limbs, if there are any.
    pub pieces: Vec<Piece>,
    /// Whether it stands on flat soles at y = 0.
    pub grounded: bool,
    /// Thickness of its thinnest limbs.
    pub thinnest: f64,
    /// Half the length of the stretch around a joint in which two bones share the skin, in radii of the limb.
    pub softness: f64,
    /// The reference pose.
    pub stance: fn(&Skeleton) -> Vec<Rigid>,
    /// How it moves; the first is what it does unless told otherwise.
    pub motions: Vec<Motion>,
}

/// A loop of poses.
#[derive(Clone, Copy, Debug)]
pub struct Motion {
    /// What people call it.
    pub name: &'static str,
    /// Seconds in one loop.
    pub period: f64,
    /// The pose at a phase of the loop (0 to 1).
    pub gait: fn(&Skeleton, f64) -> Vec<Rigid>,
    /// Whether the lowest point is put on the ground in every pose; else the poses themselves say how high it is.
    pub grounded: bool,
}

/// A motion that stays on the ground.
pub const fn motion(name: &'static str, period: f64, gait: fn(&Skeleton, f64) -> Vec<Rigid>) -> Motion {
    Motion { name, period, gait, grounded: true }
}

/// A motion that may leave the ground.
pub const fn airborne(name: &'static str, period: f64, gait: fn(&Skeleton, f64) -> Vec<Rigid>) -> Motion {
    Motion { name, period, gait, grounded: false }
}

impl Body {
    /// A body without bones.
    pub fn new(thinnest: f64, motions: &[Motion]) -> Self {
        Self {
            skeleton: Skeleton::default(),
            limbs: Vec::new(),
            pieces: Vec::new(),
            grounded: true,
            thinnest,
            softness: 0.9,
            stance: as_meshed,
            motions: motions.to_vec(),
        }
    }

    /// Adds a bone from `joint` to `end`; `parent` is the name of the bone that carries it.
    pub fn bone(&mut self, name: &str, parent: Option<&str>, joint: [f64; 3], end: [f64; 3]) {
        self.skeleton.add(name, parent, joint.into(), end.into());
    }

    /// Adds a left bone and its mirror image; `*` in names stands for left or right.
    pub fn bones(&mut self, name: &str, parent: &str, joint: [f64; 3], end: [f64; 3]) {
        for (side, sign) in [("left", 1.0), ("right", -1.0)] {
            let flip = |p: [f64; 3]| [sign * p[0], p[1], p[2]];
            self.bone(&name.replace('*', side), Some(&parent.replace('*', side)), flip(joint), flip(end));
        }
    }

    /// Adds a limb in the middle plane, or a single one, that follows the named bones.
    pub fn limb(&mut self, bones: &[&str], blend: f64, stations: &[Station]) {
        self.limb_facing(bones, blend, DVec3::X, stations);
    }

    /// The same, flattened along another direction than x.
    pub fn limb_facing(&mut self, bones: &[&str], blend: f64, direction: DVec3, stations: &[Station]) {
        let pair = self.limbs.len() as u32;
        self.limbs.push(Limb::new(self.numbers(bones, ""), blend, pair, direction.normalize(), stations.to_vec()));
    }

    /// Adds a left limb and its mirror image.
    pub fn limbs(&mut self, bones: &[&str], blend: f64, stations: &[Station]) {
        self.limbs_facing(bones, blend, DVec3::X, stations);
    }

    /// The same, flattened along another direction than x.
    pub fn limbs_facing(&mut self, bones: &[&str], blend: f64, direction: DVec3, stations: &[Station]) {
        let pair = self.limbs.len() as u32;
        let left = self.numbers(bones, "left");
        let left = Limb::new(left, blend, pair, direction.normalize(), stations.to_vec());
        let right = left.mirrored(self.numbers(bones, "right"));
        self.limbs.extend([left, right]);
    }

    /// Makes everything so many times larger, soles and motions excepted: those are given for the final size.
    pub fn enlarge(&mut self, scale: f64) {
        for bone in &mut self.skeleton.bones {
            bone.joint *= scale;
            bone.end *= scale;
        }
        for limb in &mut self.limbs {
            let larger = |s: &Station| Station { at: scale * s.at, radius: scale * s.radius, flat: s.flat };
            let stations = limb.stations.iter().map(larger).collect();
            *limb = Limb::new(limb.bones.clone(), scale * limb.blend, limb.pair, limb.direction, stations);
        }
        self.thinnest *= scale;
    }

    fn numbers(&self, bones: &[&str], side: &str) -> Vec<u32> {
        bones.iter().filter_map(|name| self.skeleton.find(&name.replace('*', side))).collect()
    }
}

/// The pose in which the body was meshed, as a reference pose.
pub fn as_meshed(skeleton: &Skeleton) -> Vec<Rigid> {
    vec![Rigid::REST; skeleton.bones.len()]
}

/// Turns of bones by name, all others at rest.
pub struct Turns<'a> {
    skeleton: &'a Skeleton,
    /// The turn of every bone relative to its parent.
    pub turns: Vec<DQuat>,
}

impl<'a> Turns<'a> {
    /// Nothing turned.
    pub fn new(skeleton: &'a Skeleton) -> Self {
        Self { skeleton, turns: vec![DQuat::IDENTITY; skeleton.bones.len()] }
    }

    /// Turns a bone relative to its parent.
    pub fn set(&mut self, name: &str, turn: DQuat) {
        if let Some(bone) = self.skeleton.find(name) {
            self.turns[bone as usize] = turn;
        }
    }

    /// The motions of all bones.
    pub fn pose(&self, shift: DVec3) -> Vec<Rigid> {
        self.skeleton.pose(&self.turns, shift)
    }
}
