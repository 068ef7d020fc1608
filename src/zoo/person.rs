//! The person: 1.75 tall, facing +z, in two reference poses with the same walk.
//!
//! The body is meshed with its arms half raised, where neither shoulder nor armpit is stretched; the reference pose
//! then lowers the arms or raises them. Both variants are one mesh, vertex by vertex, so the true answer of every
//! transfer between them is known.

use super::body::{Body, Motion, Turns, airborne, motion};
use super::gait::{Curve, Leg, Step, pitch, roll, wave, yaw};
use super::limb::{Station, station};
use super::skeleton::{Rigid, Skeleton};
use glam::{DQuat, DVec3};

/// How far the arms hang below the horizontal in the mesh, in degrees.
pub const MESHED: f64 = 45.0;
/// The same with the arms down and with the arms out.
const DOWN: f64 = 80.0;
const OUT: f64 = 4.0;

/// The left shoulder, and how far along the arm elbow, wrist and fingertips are.
const SHOULDER: [f64; 3] = [0.178, 1.405, -0.015];
const ELBOW: f64 = 0.285;
const WRIST: f64 = 0.535;
const FINGERTIPS: f64 = 0.72;

/// Hip, knee, ankle and toes, left side.
const LEG: [[f64; 3]; 4] = [[0.095, 0.93, 0.0], [0.098, 0.50, 0.012], [0.095, 0.085, -0.030], [0.105, 0.02, 0.17]];

const LEG_STATIONS: &[Station] = &[
    station(0.085, 0.95, -0.005, 0.108, 0.92),
    station(0.094, 0.84, 0.000, 0.097, 0.90),
    station(0.097, 0.68, 0.008, 0.078, 0.92),
    station(0.098, 0.55, 0.014, 0.061, 0.95),
    station(0.098, 0.49, 0.012, 0.058, 0.97),
    station(0.099, 0.40, -0.008, 0.060, 0.95),
    station(0.099, 0.32, -0.015, 0.057, 0.93),
    station(0.097, 0.20, -0.020, 0.043, 0.93),
    station(0.095, 0.10, -0.026, 0.038, 0.95),
    station(0.095, 0.045, -0.030, 0.040, 0.95),
];

/// The person with the arms down.
pub fn person() -> Body {
    build(|skeleton| stance(skeleton, DOWN))
}

/// The same with the arms out.
pub fn person_arms_out() -> Body {
    build(|skeleton| stance(skeleton, OUT))
}

/// A point so far along the left arm as it is meshed, with an offset forwards.
pub fn arm(along: f64, forward: f64) -> [f64; 3] {
    let (sine, cosine) = MESHED.to_radians().sin_cos();
    [SHOULDER[0] + along * cosine, SHOULDER[1] - along * sine, SHOULDER[2] + forward]
}

const MOTIONS: [Motion; 4] = [
    motion("walk", 1.1, gait),
    airborne("run", 0.68, run),
    motion("wave", 1.8, greet),
    motion("collapse", 3.2, collapse),
];

fn build(stance: fn(&Skeleton) -> Vec<Rigid>) -> Body {
    let mut body = Body::new(0.022, &MOTIONS);
    body.stance = stance;
    body.bone("pelvis", None, [0.0, 0.96, 0.0], [0.0, 1.08, 0.0]);
    body.bone("chest", Some("pelvis"), [0.0, 1.09, 0.0], [0.0, 1.44, -0.01]);
    body.bone("head", Some("chest"), [0.0, 1.48, -0.012], [0.0, 1.75, 0.02]);
    body.bones("* upper arm", "chest", SHOULDER, arm(ELBOW, 0.0));
    body.bones("* forearm", "* upper arm", arm(ELBOW, 0.0), arm(WRIST, 0.012));
    body.bones("* hand", "* forearm", arm(WRIST, 0.012), arm(FINGERTIPS, 0.02));
    body.bones("* thigh", "pelvis", LEG[0], LEG[1]);
    body.bones("* shank", "* thigh", LEG[1], LEG[2]);
    body.bones("* foot", "* shank", LEG[2], LEG[3]);
    body.limb(
        &["pelvis", "chest"],
        0.05,
        &[
            station(0.0, 0.90, -0.005, 0.085, 1.55),
            station(0.0, 0.99, -0.005, 0.112, 1.42),
            station(0.0, 1.10, 0.004, 0.100, 1.36),
            station(0.0, 1.21, 0.006, 0.106, 1.42),
            station(0.0, 1.32, 0.000, 0.115, 1.44),
            station(0.0, 1.405, -0.012, 0.085, 1.62),
            station(0.0, 1.44, -0.016, 0.055, 1.7),
        ],
    );
    // Shoulders slope from the neck.
    body.limbs(
        &["chest"],
        0.07,
        &[station(0.03, 1.462, -0.018, 0.056, 1.0), station(0.145, 1.408, -0.015, 0.058, 1.0)],
    );
    body.limbs(&["* thigh", "* shank"], 0.075, LEG_STATIONS);
    body.limbs(
        &["* foot"],
        0.04,
        &[
            station(0.096, 0.040, -0.055, 0.040, 0.95),
            station(0.098, 0.048, 0.010, 0.044, 0.95),
            station(0.103, 0.030, 0.085, 0.038, 1.20),
            station(0.107, 0.016, 0.150, 0.028, 1.50),
            station(0.108, 0.012, 0.172, 0.022, 1.5),
        ],
    );
    arms(&mut body);
    body.limb(
        &["chest", "head"],
        0.05,
        &[
            station(0.0, 1.42, -0.02, 0.058, 1.0),
            station(0.0, 1.50, -0.012, 0.053, 1.0),
            station(0.0, 1.58, 0.0, 0.056, 1.0),
        ],
    );
    head(&mut body);
    body
}

fn arms(body: &mut Body) {
    let at = |along: f64, forward: f64, radius: f64, flat: f64| {
        let [x, y, z] = arm(along, forward);
        station(x, y, z, radius, flat)
    };
    body.limbs(
        &["* upper arm", "* forearm", "* hand"],
        0.055,
        &[
            at(-0.01, 0.0, 0.057, 1.0),
            at(0.06, 0.0, 0.056, 1.0),
            at(0.17, 0.0, 0.048, 1.0),
            at(0.285, 0.0, 0.042, 1.0),
            at(0.36, 0.002, 0.043, 1.0),
            at(0.46, 0.008, 0.034, 1.0),
            at(0.535, 0.012, 0.027, 1.0),
        ],
    );
    // A mitten of a hand, flat towards the body, with a thumb.
    let flat = DVec3::new(1.0, 1.0, 0.0);
    body.limbs_facing(
        &["* hand"],
        0.03,
        flat,
        &[
            at(0.535, 0.012, 0.030, 0.80),
            at(0.585, 0.016, 0.043, 0.62),
            at(0.635, 0.018, 0.044, 0.56),
            at(0.680, 0.018, 0.038, 0.60),
            at(0.705, 0.016, 0.031, 0.68),
        ],
    );
    body.limbs(
        &["* hand"],
        0.025,
        &[at(0.56, 0.040, 0.018, 1.0), at(0.605, 0.066, 0.019, 1.0), at(0.635, 0.074, 0.017, 1.0)],
    );
}

fn head(body: &mut Body) {
    // Skull, face with chin, a small nose, ears.
    body.limb(
        &["head"],
        0.04,
        &[
            station(0.0, 1.632, -0.018, 0.094, 0.84),
            station(0.0, 1.662, -0.012, 0.106, 0.82),
            station(0.0, 1.685, -0.002, 0.094, 0.86),
        ],
    );
    body.limb(
        &["head"],
        0.06,
        &[
            station(0.0, 1.645, 0.030, 0.074, 0.90),
            station(0.0, 1.590, 0.042, 0.056, 0.92),
            station(0.0, 1.556, 0.058, 0.034, 1.05),
        ],
    );
    body.limb(&["head"], 0.03, &[station(0.0, 1.655, 0.092, 0.012, 0.9), station(0.0, 1.628, 0.106, 0.015, 0.9)]);
    body.limbs(&["head"], 0.02, &[station(0.086, 1.655, -0.01, 0.024, 0.5), station(0.084, 1.618, -0.003, 0.018, 0.5)]);
}

/// Turns the arms of the meshed pose to hang so many degrees below the horizontal.
fn lower_arms(turns: &mut Turns, degrees: f64) {
    turns.set("left upper arm", roll(MESHED - degrees));
    turns.set("right upper arm", roll(degrees - MESHED));
}

fn stance(skeleton: &Skeleton, degrees: f64) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    lower_arms(&mut turns, degrees);
    turns.pose(DVec3::ZERO)
}

const STEP: Step = Step {
    duty: 0.60,
    stride: 0.57,
    ahead: 0.02,
    lift: 0.06,
    bend: Curve(&[]),
    foot: Curve(&[
        (0.0, -20.0),
        (0.10, 0.0),
        (0.36, 0.0),
        (0.50, 20.0),
        (0.60, 46.0),
        (0.70, 50.0),
        (0.86, 0.0),
        (0.95, -18.0),
    ]),
};

/// How arms and body go with the steps.
#[derive(Clone, Copy)]
struct Manner {
    step: Step,
    /// Lowest point of the body and how far it bounces.
    drop: f64,
    bounce: f64,
    /// When it is lowest: 0 is when a foot lands.
    lowest: f64,
    /// How far chest and head lean ahead.
    lean: f64,
    /// How far the arms swing, and how far the elbows are bent in the middle.
    swing: f64,
    elbow: f64,
    /// How far the pelvis turns.
    twist: f64,
}

const WALK: Manner =
    Manner { step: STEP, drop: 0.019, bounce: 0.015, lowest: 0.19, lean: 2.5, swing: 26.0, elbow: -22.0, twist: 6.0 };

const RUN: Manner = Manner {
    step: Step {
        duty: 0.36,
        stride: 0.66,
        ahead: -0.02,
        lift: 0.24,
        bend: Curve(&[]),
        foot: Curve(&[
            (0.0, -8.0),
            (0.06, 0.0),
            (0.20, 0.0),
            (0.32, 32.0),
            (0.42, 62.0),
            (0.58, 88.0),
            (0.76, 40.0),
            (0.93, -8.0),
        ]),
    },
    drop: 0.035,
    bounce: 0.035,
    lowest: 0.0,
    lean: 9.0,
    swing: 36.0,
    elbow: -84.0,
    twist: 8.0,
};

fn gait(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    WALK.pose(skeleton, phase)
}

fn run(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    RUN.pose(skeleton, phase)
}

impl Manner {
    fn pose(&self, skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
        let mut turns = Turns::new(skeleton);
        let stride = wave(phase + 0.25);
        // The left foot meets the ground at phase 0: the pelvis turns left forwards, the chest against it.
        let shift = skeleton.stride
            * DVec3::new(0.018 * wave(phase + 0.02), -self.drop - self.bounce * wave(2.0 * phase + self.lowest), 0.0);
        turns.set("pelvis", yaw(-self.twist * stride) * roll(2.5 * wave(phase)));
        turns.set("chest", yaw(2.1 * self.twist * stride) * roll(-3.0 * wave(phase)) * pitch(self.lean));
        turns.set("head", yaw(-1.1 * self.twist * stride) * pitch(0.5 - self.lean + 3.0 * wave(2.0 * phase + 0.1)));
        for (side, sign) in [("left", 1.0), ("right", -1.0)] {
            let swing = sign * stride;
            let hang = roll(sign * (MESHED - DOWN));
            // The arm swings against the leg of its side; the elbow bends as it comes forward.
            turns.set(&format!("{side} upper arm"), pitch(4.0 + self.swing * swing) * hang);
            let bend = self.elbow + 16.0 * wave(phase + 0.20 + if sign > 0.0 { 0.0 } else { 0.5 });
            turns.set(&format!("{side} forearm"), hang.inverse() * pitch(bend) * hang);
            let wrist = 9.0 * wave(phase + 0.10 + if sign > 0.0 { 0.0 } else { 0.5 });
            turns.set(&format!("{side} hand"), hang.inverse() * pitch(wrist - 4.0) * hang);
            let bone = |name: &str| skeleton.find(&format!("{side} {name}"));
            if let (Some(upper), Some(lower), Some(foot)) = (bone("thigh"), bone("shank"), bone("foot")) {
                let leg = Leg { upper, lower, middle: None, foot, sole: [-0.055, 0.195] };
                let landing = if sign > 0.0 { 0.0 } else { 0.5 };
                self.step.place(&leg, phase - landing, skeleton, shift, &mut turns.turns);
            }
        }
        debug_assert!(turns.turns.iter().all(|t: &DQuat| t.is_finite()));
        turns.pose(shift)
    }
}

/// Keeps both feet flat where they are in the mesh, and puts a hand's turns on.
fn standing(skeleton: &Skeleton, turns: &mut Turns, shift: DVec3) {
    let still = Step { stride: 0.0, ahead: 0.0, lift: 0.0, foot: Curve(&[]), ..STEP };
    for side in ["left", "right"] {
        let bone = |name: &str| skeleton.find(&format!("{side} {name}"));
        if let (Some(upper), Some(lower), Some(foot)) = (bone("thigh"), bone("shank"), bone("foot")) {
            let leg = Leg { upper, lower, middle: None, foot, sole: [-0.055, 0.195] };
            still.place(&leg, 0.0, skeleton, shift, &mut turns.turns);
        }
    }
}

/// Stands and waves with the right hand.
fn greet(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    let shift = skeleton.stride * DVec3::new(0.016 * wave(phase), -0.012 - 0.006 * wave(2.0 * phase), 0.0);
    turns.set("pelvis", roll(2.5 * wave(phase)) * yaw(2.0 * wave(phase + 0.2)));
    turns.set("chest", roll(3.0 - 4.0 * wave(phase)) * yaw(-5.0));
    turns.set("head", roll(-6.0 + 4.0 * wave(phase + 0.1)) * yaw(8.0 * wave(phase)));
    let hang = roll(MESHED - DOWN);
    turns.set("left upper arm", pitch(3.0 + 7.0 * wave(phase)) * hang);
    turns.set("left forearm", hang.inverse() * pitch(-18.0 - 7.0 * wave(phase)) * hang);
    turns.set("left hand", hang.inverse() * pitch(-4.0 + 6.0 * wave(phase - 0.1)) * hang);
    let beat = 2.0 * phase;
    turns.set("right upper arm", roll(-(MESHED + 22.0) - 7.0 * wave(beat)) * pitch(-6.0));
    turns.set("right forearm", roll(-62.0 - 24.0 * wave(beat - 0.06)));
    turns.set("right hand", roll(4.0 - 20.0 * wave(beat - 0.16)));
    standing(skeleton, &mut turns, shift);
    turns.pose(shift)
}

/// How far down the person is, by phase.
const SUNK: Curve = Curve(&[(0.0, 0.0), (0.06, 0.03), (0.30, 1.04), (0.37, 0.98), (0.62, 1.0), (0.92, 0.0)]);

/// The knees give way, the body slumps over them; then it stands up again.
fn collapse(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    let (down, late, later) = (SUNK.at(phase), SUNK.at(phase - 0.025), SUNK.at(phase - 0.05));
    let shift = skeleton.stride * DVec3::new(0.01 * wave(phase), -0.50 * down, -0.10 * down);
    turns.set("pelvis", pitch(26.0 * down));
    turns.set("chest", pitch(34.0 * late) * roll(4.0 * later));
    turns.set("head", pitch(36.0 * later) * yaw(8.0 * later));
    for (side, sign) in [("left", 1.0), ("right", -1.0)] {
        let hang = roll(sign * (MESHED - DOWN - 3.0 * late));
        turns.set(&format!("{side} upper arm"), pitch(-62.0 * later + 4.0) * hang);
        turns.set(&format!("{side} forearm"), hang.inverse() * pitch(-12.0 - 20.0 * later) * hang);
        turns.set(&format!("{side} hand"), hang.inverse() * pitch(14.0 * later) * hang);
    }
    standing(skeleton, &mut turns, shift);
    turns.pose(shift)
}
