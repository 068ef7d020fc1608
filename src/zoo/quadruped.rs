//! What horse and camel share: the names of their bones, and walking on four legs.

use super::body::{Body, Turns};
use super::gait::{Leg, Step, pitch, roll, wave, yaw};
use super::limb::{Station, station};
use super::skeleton::{Rigid, Skeleton};
use glam::DVec3;

/// Where the joints of a quadruped are; legs on the left side (+x), from the trunk down to the sole.
#[derive(Clone, Copy, Debug)]
pub struct Joints {
    /// Both ends of the trunk's bone.
    pub trunk: [[f64; 3]; 2],
    /// Root of the neck, its middle, the poll.
    pub neck: [[f64; 3]; 3],
    /// Tip of the muzzle.
    pub muzzle: [f64; 3],
    /// Root of the tail, two joints, its tip.
    pub tail: [[f64; 3]; 4],
    /// Shoulder, elbow, carpus, fetlock, sole.
    pub fore: [[f64; 3]; 5],
    /// Hip, stifle, hock, fetlock, sole.
    pub hind: [[f64; 3]; 5],
}

/// The bones of a fore leg, from the trunk down.
pub const FORE: [&str; 4] = ["* upper arm", "* forearm", "* fore cannon", "* fore foot"];
/// The bones of a hind leg, from the trunk down.
pub const HIND: [&str; 4] = ["* thigh", "* gaskin", "* hind cannon", "* hind foot"];

/// A station in the middle plane, at `y, z`.
pub const fn mid(y: f64, z: f64, radius: f64, flat: f64) -> Station {
    station(0.0, y, z, radius, flat)
}

/// Adds the bones of a quadruped.
pub fn quadruped_bones(body: &mut Body, joints: &Joints) {
    body.bone("trunk", None, joints.trunk[0], joints.trunk[1]);
    body.bone("lower neck", Some("trunk"), joints.neck[0], joints.neck[1]);
    body.bone("upper neck", Some("lower neck"), joints.neck[1], joints.neck[2]);
    body.bone("head", Some("upper neck"), joints.neck[2], joints.muzzle);
    body.bone("tail root", Some("trunk"), joints.tail[0], joints.tail[1]);
    body.bone("tail", Some("tail root"), joints.tail[1], joints.tail[2]);
    body.bone("tail tip", Some("tail"), joints.tail[2], joints.tail[3]);
    for (names, points) in [(FORE, joints.fore), (HIND, joints.hind)] {
        let mut parent = "trunk";
        for (i, name) in names.into_iter().enumerate() {
            body.bones(name, parent, points[i], points[i + 1]);
            parent = name;
        }
    }
}

/// How a quadruped walks.
#[derive(Clone, Copy, Debug)]
pub struct Walk {
    /// Phase at which the left and the right hind foot meet the ground.
    pub hind: [f64; 2],
    /// The same for the fore feet.
    pub fore: [f64; 2],
    /// The step of the fore legs.
    pub fore_step: Step,
    /// The step of the hind legs.
    pub hind_step: Step,
    /// How much lower the body is carried than in the reference pose.
    pub drop: f64,
    /// How much head and neck nod (1: a horse's walk).
    pub nod: f64,
    /// How much the tail swings.
    pub tail: f64,
    /// Back and front end of the fore soles, before the joint of the foot (z).
    pub fore_sole: [f64; 2],
    /// The same for the hind soles.
    pub hind_sole: [f64; 2],
}

impl Walk {
    /// The pose at a phase of the loop.
    pub fn pose(&self, skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
        let mut turns = Turns::new(skeleton);
        // The body is lowest when a foot of either end has just landed, twice a loop; it rolls once.
        let beat = 2.0 * (phase - self.fore[0]);
        let shift = skeleton.stride * DVec3::new(0.012 * wave(phase), -self.drop - 0.008 * wave(beat + 0.25), 0.0);
        turns.set("trunk", roll(1.6 * wave(phase - 0.1)) * pitch(0.8 * wave(beat)));
        // The head goes down as a fore foot bears weight.
        let nod = self.nod * wave(beat + 0.02);
        turns.set("lower neck", pitch(5.5 * nod) * yaw(2.0 * wave(phase)));
        turns.set("upper neck", pitch(-5.5 * self.nod * wave(beat - 0.10)) * yaw(-wave(phase)));
        turns.set("head", pitch(6.0 * self.nod * wave(beat - 0.22)));
        turns.set("tail root", yaw(9.0 * self.tail * wave(phase)) * pitch(-3.0 + 3.0 * wave(beat)));
        turns.set("tail", roll(11.0 * self.tail * wave(phase - 0.17)) * pitch(-4.0 * wave(beat - 0.2)));
        turns.set("tail tip", roll(13.0 * self.tail * wave(phase - 0.36)) * pitch(-6.0 * wave(beat - 0.4)));
        let legs =
            [(FORE, &self.fore_step, self.fore, self.fore_sole), (HIND, &self.hind_step, self.hind, self.hind_sole)];
        for (names, step, landing, sole) in legs {
            for (side, landing) in ["left", "right"].into_iter().zip(landing) {
                let bone = |i: usize| skeleton.find(&names[i].replace('*', side));
                if let (Some(upper), Some(lower), middle, Some(foot)) = (bone(0), bone(1), bone(2), bone(3)) {
                    let leg = Leg { upper, lower, middle, foot, sole };
                    step.place(&leg, phase - landing, skeleton, shift, &mut turns.turns);
                }
            }
        }
        turns.pose(shift)
    }
}
