//! The hand: a left hand with its forearm, larger than life, that grasps.
//!
//! It lies on its edge and points to +z, the thumb up and the palm to its right (−x). One after the other the fingers
//! curl into the palm and open again.

use super::body::{Body, Turns, motion};
use super::gait::{Curve, pitch, wave, yaw};
use super::limb::{Station, station};
use super::skeleton::{Rigid, Skeleton};
use glam::{DQuat, DVec3};

/// A finger: where its knuckle is (y, z), how far it points up in degrees, the lengths of its bones, where its
/// ray begins at the wrist (y), its thickness, and when it begins to curl.
struct Finger {
    bones: [&'static str; 3],
    knuckle: [f64; 2],
    up: f64,
    lengths: [f64; 3],
    wrist: f64,
    thickness: f64,
    begins: f64,
}

const FINGERS: [Finger; 4] = [
    Finger {
        bones: ["index 1", "index 2", "index 3"],
        knuckle: [0.485, 0.47],
        up: 9.0,
        lengths: [0.27, 0.17, 0.13],
        wrist: 0.375,
        thickness: 1.0,
        begins: 0.21,
    },
    Finger {
        bones: ["middle 1", "middle 2", "middle 3"],
        knuckle: [0.362, 0.50],
        up: 2.5,
        lengths: [0.30, 0.19, 0.14],
        wrist: 0.335,
        thickness: 1.02,
        begins: 0.14,
    },
    Finger {
        bones: ["ring 1", "ring 2", "ring 3"],
        knuckle: [0.240, 0.465],
        up: -4.0,
        lengths: [0.27, 0.18, 0.13],
        wrist: 0.295,
        thickness: 0.97,
        begins: 0.07,
    },
    Finger {
        bones: ["little 1", "little 2", "little 3"],
        knuckle: [0.130, 0.41],
        up: -11.0,
        lengths: [0.21, 0.13, 0.115],
        wrist: 0.260,
        thickness: 0.86,
        begins: 0.0,
    },
];

/// The joints of the thumb, and its tip.
const THUMB: [[f64; 3]; 4] = [[-0.045, 0.41, 0.10], [-0.115, 0.56, 0.27], [-0.135, 0.645, 0.43], [-0.135, 0.70, 0.57]];
const THUMB_BONES: [&str; 3] = ["thumb 1", "thumb 2", "thumb 3"];

/// How far the bones of a finger turn when it is curled, in degrees.
const CURLED: [f64; 3] = [66.0, 82.0, 46.0];
/// The same at rest.
const RELAXED: [f64; 3] = [8.0, 12.0, 8.0];
/// Where the bones of the thumb turn to, and how far.
const THUMB_CURLS: [([f64; 3], f64); 3] =
    [([-1.0, -0.1, 0.0], 42.0), ([-0.1, -1.0, 0.3], 38.0), ([0.1, -1.0, 0.2], 48.0)];

/// How far a finger is curled, by the time since it began.
const GRASP: Curve = Curve(&[(0.0, 0.0), (0.26, 1.0), (0.44, 1.0), (0.70, 0.0)]);

/// The hand's bones, limbs and motion.
pub fn hand() -> Body {
    let mut body = Body::new(0.05, &[motion("grasp", 2.4, gait), motion("wave", 1.6, greet)]);
    body.stance = stance;
    body.grounded = false;
    body.bone("forearm", None, [0.0, 0.21, -0.85], [0.0, 0.30, 0.0]);
    body.bone("palm", Some("forearm"), [0.0, 0.305, 0.0], [0.0, 0.33, 0.45]);
    for finger in &FINGERS {
        let mut parent = "palm";
        for (i, name) in finger.bones.into_iter().enumerate() {
            let length: f64 = finger.lengths[..i].iter().sum();
            body.bone(name, Some(parent), finger.at(length), finger.at(length + finger.lengths[i]));
            parent = name;
        }
    }
    let mut parent = "palm";
    for (name, ends) in THUMB_BONES.into_iter().zip(THUMB.windows(2)) {
        body.bone(name, Some(parent), ends[0], ends[1]);
        parent = name;
    }
    body.limb(
        &["forearm", "palm"],
        0.05,
        &[
            station(0.0, 0.200, -0.90, 0.165, 0.92),
            station(0.0, 0.215, -0.70, 0.180, 0.90),
            station(0.0, 0.240, -0.45, 0.165, 0.85),
            station(0.0, 0.275, -0.18, 0.132, 0.78),
            station(0.0, 0.300, -0.02, 0.120, 0.70),
            station(0.0, 0.315, 0.10, 0.130, 0.62),
        ],
    );
    for finger in &FINGERS {
        finger.grow(&mut body);
    }
    // The heel of the hand on the side of the little finger, and the web to the thumb.
    body.limb(&["palm"], 0.06, &[station(-0.045, 0.225, 0.06, 0.075, 0.9), station(-0.035, 0.175, 0.27, 0.065, 0.9)]);
    thumb(&mut body);
    body
}

impl Finger {
    /// The point so far beyond the knuckle.
    fn at(&self, along: f64) -> [f64; 3] {
        let (sine, cosine) = self.up.to_radians().sin_cos();
        [0.0, self.knuckle[0] + along * sine, self.knuckle[1] + along * cosine]
    }

    fn grow(&self, body: &mut Body) {
        let [a, b, c] = self.lengths;
        let beyond = |along: f64, radius: f64, aside: f64| {
            let [x, y, z] = self.at(along);
            station(x + aside, y, z, radius * self.thickness, 1.0)
        };
        let stations: Vec<Station> = vec![
            station(0.0, self.wrist, 0.02, 0.075, 0.85),
            station(0.005, 0.5 * (self.wrist + self.knuckle[0]), 0.5 * self.knuckle[1], 0.068, 0.9),
            beyond(-0.02, 0.067, 0.006),
            beyond(0.08, 0.058, -0.004),
            beyond(0.55 * a, 0.053, -0.006),
            beyond(a, 0.052, 0.004),
            beyond(a + 0.5 * b, 0.046, -0.003),
            beyond(a + b, 0.045, 0.002),
            beyond(a + b + 0.5 * c, 0.042, -0.003),
            beyond(a + b + c - 0.032, 0.034, -0.001),
        ];
        let [one, two, three] = self.bones;
        body.limb(&["palm", one, two, three], 0.035, &stations);
    }

    /// The turn that brings the finger towards the palm, and so many degrees down.
    fn flex(&self, degrees: f64, down: f64) -> DQuat {
        let down = pitch(down);
        let along = down * (DVec3::from(self.at(1.0)) - DVec3::from(self.at(0.0))).normalize();
        DQuat::from_axis_angle(along.cross(DVec3::NEG_X).normalize(), degrees.to_radians()) * down
    }
}

fn thumb(body: &mut Body) {
    let between = |bone: usize, t: f64, radius: f64| {
        let at = DVec3::from(THUMB[bone]).lerp(DVec3::from(THUMB[bone + 1]), t);
        station(at.x, at.y, at.z, radius, 1.0)
    };
    body.limb(
        &["palm", "thumb 1", "thumb 2", "thumb 3"],
        0.06,
        &[
            station(-0.010, 0.345, 0.03, 0.080, 1.0),
            between(0, 0.1, 0.088),
            between(0, 0.55, 0.088),
            between(1, 0.0, 0.068),
            between(1, 0.5, 0.058),
            between(2, 0.0, 0.057),
            between(2, 0.5, 0.052),
            between(2, 0.8, 0.040),
        ],
    );
}

/// Bends the fingers and the thumb; `curl` says how far, from 0 to 1.
fn bend(turns: &mut Turns, curl: impl Fn(f64) -> f64) {
    for finger in &FINGERS {
        let amount = curl(finger.begins);
        for (i, name) in finger.bones.into_iter().enumerate() {
            // Spread fingers come together as they curl.
            let down = if i == 0 { 0.9 * amount * finger.up } else { 0.0 };
            turns.set(name, finger.flex(RELAXED[i] + amount * (CURLED[i] - RELAXED[i]), down));
        }
    }
    // The thumb comes last: out of the way first, then over the fingers.
    let amount = curl(0.27);
    for (i, name) in THUMB_BONES.into_iter().enumerate() {
        let along = (DVec3::from(THUMB[i + 1]) - DVec3::from(THUMB[i])).normalize();
        let axis = along.cross(DVec3::from(THUMB_CURLS[i].0)).normalize();
        turns.set(name, DQuat::from_axis_angle(axis, (amount * THUMB_CURLS[i].1).to_radians()));
    }
}

fn stance(skeleton: &Skeleton) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    bend(&mut turns, |_| 0.0);
    turns.pose(DVec3::ZERO)
}

fn gait(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    bend(&mut turns, |begins| GRASP.at(phase - begins));
    // The wrist gives way as the fingers close, and lifts the hand a little.
    turns.set("forearm", yaw(2.0 * wave(phase - 0.1)));
    turns.set("palm", yaw(9.0 * wave(phase - 0.15)) * pitch(-3.0 - 5.0 * wave(phase - 0.2)));
    turns.pose(DVec3::ZERO)
}

/// Waves: the wrist swings, the fingers follow.
fn greet(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    bend(&mut turns, |begins| 0.10 + 0.12 * wave(phase - 0.6 * begins));
    turns.set("forearm", yaw(5.0 * wave(phase + 0.2)));
    // The hand swings up from the ground, on which the forearm stays.
    turns.set("palm", pitch(-22.0 + 22.0 * wave(phase)) * yaw(8.0 * wave(phase - 0.1)));
    turns.pose(DVec3::ZERO)
}
