//! The dinosaur: a two-legged hunter, 3.6 long from snout to tail tip, facing +z, walking.
//!
//! The long tail balances the heavy head across the hips; the arms are small, the legs strong, and it walks on its toes.

use super::body::{Body, Turns, airborne, motion};
use super::gait::{Curve, Leg, Step, pitch, roll, wave, yaw};
use super::limb::{Station, station};
use super::quadruped::mid;
use super::skeleton::{Rigid, Skeleton};
use glam::DVec3;

/// The bones of the tail from its root on.
const TAIL: [&str; 5] = ["tail 1", "tail 2", "tail 3", "tail 4", "tail 5"];
/// Where they begin, and where the tail ends (y, z).
const TAIL_JOINTS: [[f64; 2]; 6] =
    [[1.14, -0.40], [1.13, -0.74], [1.11, -1.08], [1.10, -1.42], [1.10, -1.76], [1.12, -2.14]];

/// Hip, knee, ankle, ball of the foot, tip of the middle toe; left side.
const LEG: [[f64; 3]; 5] =
    [[0.15, 1.10, 0.0], [0.20, 0.74, 0.20], [0.185, 0.35, -0.12], [0.185, 0.075, 0.02], [0.205, 0.02, 0.31]];
/// Shoulder, elbow, wrist, claws.
const ARM: [[f64; 3]; 4] = [[0.165, 1.17, 0.70], [0.225, 0.99, 0.70], [0.215, 0.93, 0.87], [0.195, 0.85, 1.05]];

const LEG_STATIONS: &[Station] = &[
    station(0.130, 1.13, -0.02, 0.200, 0.68),
    station(0.165, 0.99, 0.05, 0.190, 0.66),
    station(0.190, 0.85, 0.13, 0.145, 0.74),
    station(0.200, 0.74, 0.18, 0.105, 0.86),
    station(0.197, 0.62, 0.10, 0.092, 0.90),
    station(0.190, 0.48, -0.02, 0.068, 0.92),
    station(0.185, 0.37, -0.105, 0.052, 0.95),
    station(0.185, 0.29, -0.095, 0.046, 1.0),
    station(0.185, 0.17, -0.03, 0.048, 1.0),
    station(0.185, 0.085, 0.02, 0.054, 1.0),
];

/// The dinosaur's bones, limbs and motion.
pub fn dinosaur() -> Body {
    let mut body = Body::new(0.036, &[motion("walk", 1.3, gait), airborne("run", 0.7, run)]);
    bones(&mut body);
    // The trunk, deepest at the belly, and the curve of the neck.
    body.limb(
        &["pelvis", "chest", "lower neck", "upper neck"],
        0.05,
        &[
            mid(1.12, -0.30, 0.190, 0.84),
            mid(1.12, -0.05, 0.255, 0.84),
            mid(1.13, 0.22, 0.285, 0.86),
            mid(1.18, 0.48, 0.265, 0.88),
            mid(1.30, 0.69, 0.195, 0.90),
            mid(1.45, 0.81, 0.155, 0.90),
            mid(1.62, 0.87, 0.135, 0.90),
            mid(1.75, 0.92, 0.120, 0.92),
        ],
    );
    let tail: Vec<&str> = std::iter::once("pelvis").chain(TAIL).collect();
    body.limb(
        &tail,
        0.08,
        &[
            mid(1.13, -0.15, 0.220, 0.84),
            mid(1.14, -0.45, 0.180, 0.84),
            mid(1.13, -0.78, 0.137, 0.86),
            mid(1.11, -1.10, 0.103, 0.88),
            mid(1.10, -1.45, 0.073, 0.90),
            mid(1.10, -1.80, 0.047, 0.95),
            mid(1.12, -2.12, 0.022, 1.0),
        ],
    );
    body.limbs(&["* thigh", "* shank", "* metatarsus"], 0.08, LEG_STATIONS);
    toes(&mut body);
    arms(&mut body);
    head(&mut body);
    body
}

fn bones(body: &mut Body) {
    body.bone("pelvis", None, [0.0, 1.12, -0.20], [0.0, 1.14, 0.22]);
    body.bone("chest", Some("pelvis"), [0.0, 1.15, 0.24], [0.0, 1.28, 0.66]);
    body.bone("lower neck", Some("chest"), [0.0, 1.32, 0.70], [0.0, 1.55, 0.85]);
    body.bone("upper neck", Some("lower neck"), [0.0, 1.53, 0.84], [0.0, 1.74, 0.92]);
    body.bone("head", Some("upper neck"), [0.0, 1.75, 0.93], [0.0, 1.72, 1.52]);
    body.bone("jaw", Some("head"), [0.0, 1.68, 1.02], [0.0, 1.55, 1.42]);
    let mut parent = "pelvis";
    for (name, joint) in TAIL.into_iter().zip(TAIL_JOINTS.windows(2)) {
        body.bone(name, Some(parent), [0.0, joint[0][0], joint[0][1]], [0.0, joint[1][0], joint[1][1]]);
        parent = name;
    }
    for (names, points) in [
        (&["* thigh", "* shank", "* metatarsus", "* toes"][..], &LEG[..]),
        (&["* upper arm", "* forearm", "* hand"], &ARM),
    ] {
        let mut parent = if points.len() == 5 { "pelvis" } else { "chest" };
        for (i, name) in names.iter().enumerate() {
            body.bones(name, parent, points[i], points[i + 1]);
            parent = name;
        }
    }
}

fn toes(body: &mut Body) {
    body.limbs(&["* toes"], 0.03, &[station(0.185, 0.050, -0.02, 0.052, 1.0), station(0.19, 0.046, 0.06, 0.052, 1.1)]);
    for [x, z] in [[0.208, 0.30], [0.105, 0.23], [0.300, 0.20]] {
        let at = |t: f64, y: f64, radius: f64| station(0.19 + t * (x - 0.19), y, 0.05 + t * (z - 0.05), radius, 1.0);
        body.limbs(&["* toes"], 0.025, &[at(0.0, 0.042, 0.040), at(0.55, 0.034, 0.034), at(1.0, 0.018, 0.018)]);
    }
}

fn arms(body: &mut Body) {
    body.limbs(
        &["* upper arm", "* forearm", "* hand"],
        0.05,
        &[
            station(0.165, 1.18, 0.69, 0.072, 0.85),
            station(0.205, 1.08, 0.70, 0.062, 0.9),
            station(0.226, 0.995, 0.715, 0.048, 1.0),
            station(0.222, 0.96, 0.79, 0.044, 1.0),
            station(0.215, 0.93, 0.87, 0.036, 1.0),
            station(0.208, 0.905, 0.93, 0.042, 1.0),
        ],
    );
    // Two claws, spread.
    for side in [1.0, -1.0] {
        let at = |along: f64, apart: f64, radius: f64| {
            let from = DVec3::new(0.207, 0.903, 0.93).lerp(DVec3::new(0.192, 0.840, 1.055), along);
            let at = from + side * apart * DVec3::new(0.6, 0.8, 0.0);
            station(at.x, at.y, at.z, radius, 1.0)
        };
        body.limbs(&["* hand"], 0.015, &[at(0.0, 0.014, 0.030), at(0.5, 0.040, 0.027), at(1.0, 0.055, 0.019)]);
    }
}

fn head(body: &mut Body) {
    body.limb(
        &["head"],
        0.06,
        &[
            mid(1.775, 0.94, 0.120, 0.85),
            mid(1.800, 1.06, 0.130, 0.80),
            mid(1.785, 1.20, 0.108, 0.72),
            mid(1.760, 1.34, 0.084, 0.74),
            mid(1.745, 1.46, 0.064, 0.80),
        ],
    );
    // The jaw, a little open.
    body.limb(
        &["jaw"],
        0.03,
        &[
            mid(1.695, 1.00, 0.072, 0.95),
            mid(1.630, 1.13, 0.060, 0.95),
            mid(1.580, 1.27, 0.047, 0.95),
            mid(1.550, 1.39, 0.036, 1.0),
        ],
    );
    // Brows and nostrils.
    body.limbs(&["head"], 0.03, &[station(0.078, 1.885, 1.07, 0.026, 1.0), station(0.066, 1.865, 1.16, 0.022, 1.0)]);
    body.limbs(&["head"], 0.025, &[station(0.030, 1.80, 1.44, 0.020, 1.0), station(0.030, 1.79, 1.47, 0.020, 1.0)]);
}

const STEP: Step = Step {
    duty: 0.60,
    stride: 0.74,
    ahead: 0.06,
    lift: 0.11,
    bend: Curve(&[(0.0, -6.0), (0.2, -12.0), (0.5, 8.0), (0.62, 4.0), (0.78, -34.0), (0.93, -10.0)]),
    foot: Curve(&[(0.0, -10.0), (0.08, 0.0), (0.40, 0.0), (0.52, 24.0), (0.62, 52.0), (0.74, 58.0), (0.88, 6.0)]),
};

const RUN: Step = Step {
    duty: 0.40,
    stride: 0.95,
    ahead: 0.02,
    lift: 0.22,
    bend: Curve(&[(0.0, -6.0), (0.12, -14.0), (0.34, 8.0), (0.45, 2.0), (0.66, -42.0), (0.90, -12.0)]),
    foot: Curve(&[(0.0, -8.0), (0.06, 0.0), (0.24, 0.0), (0.36, 34.0), (0.46, 70.0), (0.64, 74.0), (0.86, 8.0)]),
};

fn gait(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    moving(skeleton, phase, &STEP, -0.045, 0.018)
}

fn run(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    moving(skeleton, phase, &RUN, -0.055, 0.045)
}

fn moving(skeleton: &Skeleton, phase: f64, step: &Step, height: f64, bounce: f64) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    // The left foot meets the ground at phase 0; the body is lowest a little later, twice a loop.
    let stride = wave(phase + 0.25);
    let beat = 2.0 * phase;
    let shift = skeleton.stride * DVec3::new(0.03 * wave(phase + 0.02), height - bounce * wave(beat + 0.19), 0.0);
    turns.set("pelvis", yaw(-5.0 * stride) * roll(3.0 * wave(phase)) * pitch(1.2 * wave(beat)));
    turns.set("chest", yaw(8.0 * stride) * roll(-3.5 * wave(phase)) * pitch(-1.5 * wave(beat)));
    // The head is thrust forwards with every step and held level.
    let nod = wave(beat + 0.05);
    turns.set("lower neck", pitch(7.5 * nod) * yaw(-2.0 * stride));
    turns.set("upper neck", pitch(-8.0 * wave(beat - 0.03)) * yaw(-2.0 * stride));
    turns.set("head", pitch(3.0 + 5.5 * wave(beat - 0.20)) * yaw(4.0 * wave(phase + 0.1)));
    turns.set("jaw", pitch(-6.0 + 9.0 * wave(phase + 0.30)));
    for (i, name) in TAIL.into_iter().enumerate() {
        let later = 0.11 * i as f64;
        let sway = yaw((7.5 + i as f64) * wave(phase + 0.35 - later));
        turns.set(name, sway * pitch(1.5 * wave(beat - 2.0 * later)));
    }
    for (side, sign) in [("left", 1.0), ("right", -1.0)] {
        let own = if sign > 0.0 { 0.0 } else { 0.5 };
        turns.set(&format!("{side} upper arm"), pitch(14.0 * sign * stride - 4.0));
        turns.set(&format!("{side} forearm"), pitch(-4.0 + 13.0 * wave(phase + own + 0.15)));
        turns.set(&format!("{side} hand"), pitch(15.0 * wave(phase + own)));
        let bone = |name: &str| skeleton.find(&format!("{side} {name}"));
        if let (Some(upper), Some(lower), middle, Some(foot)) =
            (bone("thigh"), bone("shank"), bone("metatarsus"), bone("toes"))
        {
            let leg = Leg { upper, lower, middle, foot, sole: [-0.07, 0.27] };
            step.place(&leg, phase - own, skeleton, shift, &mut turns.turns);
        }
    }
    turns.pose(shift)
}
