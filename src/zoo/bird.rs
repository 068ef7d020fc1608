//! The bird: 2.7 from wing tip to wing tip, an eagle in flight, facing +z.

use super::body::{Body, Turns, airborne};
use super::gait::{Curve, pitch, roll, wave, yaw};
use super::limb::station;
use super::quadruped::mid;
use super::skeleton::{Rigid, Skeleton};
use glam::DVec3;

/// Shoulder, elbow, wrist and tip of the left wing.
const WING: [[f64; 3]; 4] = [[0.10, 1.06, 0.12], [0.44, 1.08, 0.06], [0.84, 1.08, 0.12], [1.33, 1.06, -0.02]];
/// Hip, ankle and claws of the left leg, trailing.
const LEG: [[f64; 3]; 3] = [[0.065, 0.93, -0.16], [0.062, 0.87, -0.31], [0.060, 0.90, -0.50]];

/// The bird's bones, limbs and motions.
pub fn bird() -> Body {
    let mut body = Body::new(0.021, &[airborne("fly", 0.8, fly), airborne("glide", 4.0, glide)]);
    body.grounded = false;
    body.bone("trunk", None, [0.0, 1.0, -0.22], [0.0, 1.02, 0.20]);
    body.bone("neck", Some("trunk"), [0.0, 1.04, 0.24], [0.0, 1.11, 0.41]);
    body.bone("head", Some("neck"), [0.0, 1.11, 0.41], [0.0, 1.09, 0.70]);
    body.bone("tail", Some("trunk"), [0.0, 1.0, -0.32], [0.0, 1.0, -0.78]);
    let mut parent = "trunk";
    for (i, name) in ["* inner wing", "* middle wing", "* outer wing"].into_iter().enumerate() {
        body.bones(name, parent, WING[i], WING[i + 1]);
        parent = name;
    }
    body.bones("* shank", "trunk", LEG[0], LEG[1]);
    body.bones("* foot", "* shank", LEG[1], LEG[2]);
    body.limb(
        &["trunk", "neck"],
        0.06,
        &[
            mid(1.0, -0.40, 0.050, 1.1),
            mid(1.0, -0.26, 0.100, 1.0),
            mid(0.995, -0.06, 0.143, 0.95),
            mid(1.0, 0.12, 0.142, 0.95),
            mid(1.04, 0.26, 0.105, 0.98),
            mid(1.085, 0.36, 0.080, 1.0),
            mid(1.11, 0.43, 0.072, 1.0),
        ],
    );
    head(&mut body);
    wings(&mut body);
    tail(&mut body);
    legs(&mut body);
    body
}

fn head(body: &mut Body) {
    body.limb(
        &["head"],
        0.03,
        &[mid(1.125, 0.44, 0.074, 0.95), mid(1.130, 0.50, 0.073, 0.92), mid(1.118, 0.555, 0.050, 0.9)],
    );
    // A hooked beak under strong brows.
    body.limb(
        &["head"],
        0.025,
        &[
            mid(1.115, 0.555, 0.040, 0.8),
            mid(1.108, 0.615, 0.031, 0.75),
            mid(1.090, 0.662, 0.021, 0.8),
            mid(1.062, 0.682, 0.011, 1.0),
        ],
    );
    body.limb(&["head"], 0.02, &[mid(1.085, 0.54, 0.026, 0.9), mid(1.075, 0.61, 0.015, 1.0)]);
    body.limbs(&["head"], 0.02, &[station(0.042, 1.157, 0.505, 0.019, 1.0), station(0.038, 1.147, 0.545, 0.014, 1.0)]);
}

/// A feather from one place to another, flat, so wide.
fn feather(body: &mut Body, bone: &str, from: DVec3, to: DVec3, wide: f64) {
    let at = |t: f64, radius: f64, flat: f64| {
        let p = from.lerp(to, t);
        station(p.x, p.y, p.z, radius, flat)
    };
    let stations =
        [at(0.0, 0.9 * wide, 0.30), at(0.4, wide, 0.24), at(0.8, 0.85 * wide, 0.24), at(1.0, 0.5 * wide, 0.36)];
    body.limbs_facing(&[bone], 0.02, DVec3::Y, &stations);
}

fn wings(body: &mut Body) {
    let bones = ["trunk", "* inner wing", "* middle wing", "* outer wing"];
    // The blade, and the arm along its front edge.
    body.limbs_facing(
        &bones,
        0.05,
        DVec3::Y,
        &[
            station(0.04, 1.045, -0.02, 0.16, 0.22),
            station(0.20, 1.065, -0.03, 0.18, 0.14),
            station(0.44, 1.080, -0.05, 0.185, 0.115),
            station(0.66, 1.080, -0.02, 0.175, 0.115),
            station(0.85, 1.078, 0.00, 0.150, 0.13),
            station(1.00, 1.074, -0.02, 0.120, 0.15),
        ],
    );
    body.limbs(
        &bones,
        0.05,
        &[
            station(0.06, 1.05, 0.11, 0.080, 1.0),
            station(0.20, 1.07, 0.10, 0.058, 1.0),
            station(0.44, 1.083, 0.075, 0.042, 1.0),
            station(0.66, 1.083, 0.105, 0.034, 1.0),
            station(0.85, 1.080, 0.120, 0.029, 1.0),
            station(1.05, 1.074, 0.080, 0.023, 1.0),
        ],
    );
    let trailing = |x: f64, bone: &str, body: &mut Body| {
        let from = DVec3::new(x, 1.075, -0.10);
        feather(body, bone, from, from + DVec3::new(0.03 * x, -0.008, -0.24 + 0.06 * x), 0.064);
    };
    for x in [0.14, 0.235, 0.33] {
        trailing(x, "* inner wing", body);
    }
    for x in [0.54, 0.63, 0.72] {
        trailing(x, "* middle wing", body);
    }
    // The fingers of the wing.
    let root = DVec3::new(0.93, 1.076, 0.0);
    for (tip, wide) in [
        ([1.36, 1.062, 0.06], 0.046),
        ([1.38, 1.062, -0.07], 0.048),
        ([1.33, 1.064, -0.20], 0.050),
        ([1.23, 1.066, -0.30], 0.054),
        ([1.09, 1.068, -0.35], 0.058),
        ([0.96, 1.070, -0.36], 0.058),
    ] {
        feather(body, "* outer wing", root, tip.into(), wide);
    }
}

fn tail(body: &mut Body) {
    let flat = |p: [f64; 3], radius: f64, flat: f64| station(p[0], p[1], p[2], radius, flat);
    body.limb_facing(
        &["trunk", "tail"],
        0.05,
        DVec3::Y,
        &[
            flat([0.0, 1.0, -0.24], 0.10, 0.6),
            flat([0.0, 1.0, -0.40], 0.10, 0.28),
            flat([0.0, 1.0, -0.54], 0.115, 0.16),
        ],
    );
    body.limb_facing(
        &["tail"],
        0.02,
        DVec3::Y,
        &[
            flat([0.0, 1.0, -0.44], 0.06, 0.3),
            flat([0.0, 0.997, -0.65], 0.065, 0.24),
            flat([0.0, 0.995, -0.77], 0.034, 0.36),
        ],
    );
    for aside in [0.10, 0.19] {
        feather(body, "tail", DVec3::new(0.03, 1.0, -0.40), DVec3::new(aside, 0.995, -0.77 + 0.35 * aside), 0.058);
    }
}

fn legs(body: &mut Body) {
    body.limbs(
        &["trunk", "* shank", "* foot"],
        0.04,
        &[
            station(0.062, 0.945, -0.10, 0.070, 0.9),
            station(0.065, 0.925, -0.17, 0.062, 0.9),
            station(0.063, 0.895, -0.25, 0.042, 0.95),
            station(0.062, 0.872, -0.31, 0.026, 1.0),
            station(0.061, 0.880, -0.40, 0.0195, 1.0),
            station(0.060, 0.888, -0.44, 0.024, 1.0),
        ],
    );
    for (aside, up) in [(-0.034, 0.0), (0.0, 0.022), (0.034, 0.0)] {
        let at = |t: f64, radius: f64| station(0.06 + t * aside, 0.888 + t * up, -0.43 - 0.085 * t, radius, 1.0);
        body.limbs(&["* foot"], 0.012, &[at(0.0, 0.020), at(0.5, 0.016), at(1.0, 0.0115)]);
    }
}

/// How high the wing is, from −1 to 1: the stroke down is quicker than the one up.
const STROKE: Curve = Curve(&[(0.0, 1.0), (0.20, -0.1), (0.42, -1.0), (0.60, -0.5), (0.82, 0.6)]);

fn fly(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    // On the way up the wing is drawn in.
    let fold = (-(STROKE.at(phase) - STROKE.at(phase - 0.08))).min(0.0).abs();
    for (side, sign) in [("left", 1.0), ("right", -1.0)] {
        let up = |degrees: f64| roll(sign * degrees);
        let back = |degrees: f64| yaw(sign * degrees);
        turns.set(
            &format!("{side} inner wing"),
            up(9.0 + 34.0 * STROKE.at(phase)) * back(-26.0 * fold) * pitch(-5.0 * wave(phase)),
        );
        turns.set(&format!("{side} middle wing"), up(-3.0 + 24.0 * STROKE.at(phase - 0.10)) * back(44.0 * fold));
        turns.set(&format!("{side} outer wing"), up(-2.0 + 30.0 * STROKE.at(phase - 0.19)) * back(40.0 * fold));
        turns.set(&format!("{side} shank"), pitch(8.0 * wave(phase + 0.1)));
        turns.set(&format!("{side} foot"), pitch(14.0 * wave(phase + 0.1 * sign)));
    }
    // The body rises as the wings go down; the head is held still.
    let beat = wave(phase + 0.02);
    turns.set("trunk", pitch(3.0 * beat - 3.0));
    turns.set("neck", pitch(-7.0 * beat + 2.0));
    turns.set("head", pitch(7.0 * beat));
    turns.set("tail", pitch(-9.0 * wave(phase - 0.1)));
    turns.pose(DVec3::new(0.0, -0.07 * wave(phase + 0.22), 0.0))
}

/// Soars in a bank, now to one side and now to the other.
fn glide(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    let bank = wave(phase);
    turns.set("trunk", roll(-20.0 * bank) * pitch(-2.0));
    turns.set("neck", yaw(12.0 * wave(phase + 0.06)) * roll(8.0 * bank));
    turns.set("head", yaw(10.0 * wave(phase + 0.06)) * roll(9.0 * bank));
    turns.set("tail", roll(16.0 * wave(phase + 0.08)) * pitch(6.0 * wave(2.0 * phase)));
    for (side, sign) in [("left", 1.0), ("right", -1.0)] {
        let tremble = 3.0 * wave(3.0 * phase + 0.2 * sign);
        turns.set(&format!("{side} inner wing"), roll(sign * (9.0 + 6.0 * sign * bank)) * pitch(5.0 * sign * bank));
        turns.set(&format!("{side} middle wing"), roll(sign * (3.0 + 8.0 * wave(phase + 0.1 * sign))));
        turns.set(
            &format!("{side} outer wing"),
            roll(sign * (9.0 + 9.0 * wave(2.0 * phase) + tremble)) * yaw(sign * (8.0 + 8.0 * sign * bank)),
        );
        turns.set(&format!("{side} shank"), pitch(7.0 * wave(2.0 * phase)));
        turns.set(&format!("{side} foot"), pitch(12.0 * wave(phase + 0.25 * sign)));
    }
    turns.pose(DVec3::new(0.12 * wave(phase - 0.2), 0.05 * wave(2.0 * phase), 0.0))
}
