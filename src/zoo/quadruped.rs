//! What four-legged creatures share: the names of their bones, and moving on four legs.

use super::body::{Body, Turns};
use super::gait::{Curve, Leg, Step, pitch, roll, wave, yaw};
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
    /// How often the body rises and sinks in a loop, how far, and how many degrees it pitches and rolls.
    pub beats: f64,
    /// See `beats`.
    pub rise: f64,
    /// See `beats`.
    pub pitch: f64,
    /// See `beats`.
    pub roll: f64,
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
        // The body is lowest when a foot of either end has just landed; it rolls once a loop.
        let beat = self.beats * (phase - self.fore[0]);
        let shift = skeleton.stride
            * DVec3::new(0.0075 * self.roll * wave(phase), -self.drop - self.rise * wave(beat + 0.25), 0.0);
        turns.set("trunk", roll(self.roll * wave(phase - 0.1)) * pitch(self.pitch * wave(beat)));
        // The head goes down as a fore foot bears weight.
        let nod = self.nod * wave(beat + 0.02);
        turns.set("lower neck", pitch(5.5 * nod) * yaw(2.0 * wave(phase)));
        turns.set("upper neck", pitch(-5.5 * self.nod * wave(beat - 0.10)) * yaw(-wave(phase)));
        turns.set("head", pitch(6.0 * self.nod * wave(beat - 0.22)));
        turns.set("tail root", yaw(9.0 * self.tail * wave(phase)) * pitch(-3.0 + 3.0 * wave(beat)));
        turns.set("tail", roll(11.0 * self.tail * wave(phase - 0.17)) * pitch(-4.0 * wave(beat - 0.2)));
        turns.set("tail tip", roll(13.0 * self.tail * wave(phase - 0.36)) * pitch(-6.0 * wave(beat - 0.4)));
        self.place(skeleton, &mut turns, shift, |step, landing| (*step, phase - landing));
        self.extras(&mut turns, phase);
        turns.pose(shift)
    }

    /// Keeps all feet flat where they are in the mesh, whatever the trunk does.
    pub fn stand(&self, skeleton: &Skeleton, turns: &mut Turns) {
        let still =
            |step: &Step| Step { stride: 0.0, ahead: 0.0, lift: 0.0, bend: Curve(&[]), foot: Curve(&[]), ..*step };
        self.place(skeleton, turns, DVec3::ZERO, |step, _| (still(step), 0.0));
    }

    /// Puts the feet where their steps want them; `at` gives the step and its phase by the phase of landing.
    fn place(&self, skeleton: &Skeleton, turns: &mut Turns, shift: DVec3, at: impl Fn(&Step, f64) -> (Step, f64)) {
        let legs =
            [(FORE, &self.fore_step, self.fore, self.fore_sole), (HIND, &self.hind_step, self.hind, self.hind_sole)];
        for (names, step, landing, sole) in legs {
            for (side, landing) in ["left", "right"].into_iter().zip(landing) {
                let bone = |i: usize| skeleton.find(&names[i].replace('*', side));
                if let (Some(upper), Some(lower), middle, Some(foot)) = (bone(0), bone(1), bone(2), bone(3)) {
                    let leg = Leg { upper, lower, middle, foot, sole };
                    let (step, phase) = at(step, landing);
                    step.place(&leg, phase, skeleton, shift, &mut turns.turns);
                }
            }
        }
    }

    /// What only some have: ears that flap, a trunk that swings.
    fn extras(&self, turns: &mut Turns, phase: f64) {
        for (side, sign) in [("left", 1.0), ("right", -1.0)] {
            let flap = 8.0 + 14.0 * wave(self.beats * phase + 0.1 * sign);
            turns.set(&format!("{side} ear"), yaw(-sign * flap));
        }
        for (i, name) in PROBOSCIS.into_iter().enumerate() {
            let later = 0.09 * i as f64;
            let swing = roll(7.0 * wave(phase - later)) * pitch(5.0 * wave(self.beats * phase - 0.2 - later));
            turns.set(name, swing);
        }
    }
}

/// The bones of an elephant's trunk, from the head on.
pub const PROBOSCIS: [&str; 6] =
    ["proboscis 1", "proboscis 2", "proboscis 3", "proboscis 4", "proboscis 5", "proboscis 6"];

/// A gallop: the hind feet land one after the other, then the fore feet; then all are in the air, gathered under
/// the body. `stride` is how far a foot moves back on the ground, the soles are as in [`Walk`].
pub const fn galloping(stride: f64, lift: f64, drop: f64, fore_sole: [f64; 2], hind_sole: [f64; 2]) -> Walk {
    Walk {
        hind: [0.0, 0.11],
        fore: [0.27, 0.40],
        fore_step: Step {
            duty: 0.27,
            stride,
            ahead: 0.04 * stride,
            lift,
            bend: Curve(&[(0.0, 0.0), (0.24, 0.0), (0.38, 45.0), (0.55, 88.0), (0.72, 52.0), (0.92, 4.0)]),
            foot: Curve(&[
                (0.0, -6.0),
                (0.04, 0.0),
                (0.18, 0.0),
                (0.29, 40.0),
                (0.45, 105.0),
                (0.60, 112.0),
                (0.78, 45.0),
                (0.94, -10.0),
            ]),
        },
        hind_step: Step {
            duty: 0.27,
            stride,
            ahead: 0.10 * stride,
            lift: 0.85 * lift,
            bend: Curve(&[(0.0, 0.0), (0.1, -6.0), (0.24, 6.0), (0.42, -26.0), (0.60, -40.0), (0.80, -20.0)]),
            foot: Curve(&[
                (0.0, -6.0),
                (0.05, 0.0),
                (0.18, 0.0),
                (0.29, 40.0),
                (0.44, 72.0),
                (0.62, 45.0),
                (0.82, 0.0),
                (0.95, -8.0),
            ]),
        },
        drop,
        beats: 1.0,
        rise: 0.22 * lift,
        pitch: 4.5,
        roll: 0.8,
        nod: 1.3,
        tail: 0.6,
        fore_sole,
        hind_sole,
    }
}
