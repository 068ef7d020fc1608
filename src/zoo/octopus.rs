//! The octopus: eight arms of four bones each, 2.6 across, facing +z.

use super::body::{Body, Turns, airborne, motion};
use super::gait::{Curve, pitch, roll, wave};
use super::limb::{Station, station};
use super::quadruped::mid;
use super::skeleton::{Rigid, Skeleton};
use glam::{DQuat, DVec3};

/// The pairs of arms from the front to the back, and how many degrees they point aside.
const PAIRS: [(&str, f64); 4] = [("first", 24.0), ("second", 68.0), ("third", 112.0), ("fourth", 156.0)];
/// Along an arm: how far out, how high, how thick.
const ARM: [[f64; 3]; 9] = [
    [0.06, 0.36, 0.130],
    [0.16, 0.28, 0.118],
    [0.27, 0.185, 0.100],
    [0.42, 0.105, 0.084],
    [0.60, 0.072, 0.070],
    [0.79, 0.060, 0.057],
    [0.97, 0.050, 0.044],
    [1.13, 0.050, 0.031],
    [1.26, 0.062, 0.016],
];
/// The joints of an arm and its tip: how far out and how high.
const JOINTS: [[f64; 2]; 5] = [[0.20, 0.24], [0.46, 0.095], [0.72, 0.064], [0.97, 0.050], [1.26, 0.062]];

/// The octopus's bones, limbs and motions.
pub fn octopus() -> Body {
    let mut body = Body::new(0.026, &[motion("crawl", 2.4, crawl), airborne("swim", 1.6, swim)]);
    body.grounded = false;
    body.softness = 2.6;
    body.bone("head", None, [0.0, 0.36, 0.0], [0.0, 0.52, 0.02]);
    body.bone("mantle", Some("head"), [0.0, 0.56, -0.04], [0.0, 1.02, -0.32]);
    for (pair, angle) in PAIRS {
        let mut parent = "head".to_owned();
        for (i, ends) in JOINTS.windows(2).enumerate() {
            let name = format!("* {pair} arm {}", i + 1);
            body.bones(&name, &parent, place(angle, ends[0]), place(angle, ends[1]));
            parent = name;
        }
    }
    body.limb(
        &["head", "mantle"],
        0.08,
        &[
            mid(0.30, 0.02, 0.150, 1.05),
            mid(0.42, 0.02, 0.165, 1.02),
            mid(0.54, -0.01, 0.165, 1.02),
            mid(0.68, -0.08, 0.215, 1.08),
            mid(0.84, -0.19, 0.225, 1.08),
            mid(0.97, -0.29, 0.165, 1.06),
            mid(1.03, -0.335, 0.095, 1.05),
        ],
    );
    for (pair, angle) in PAIRS {
        let names: Vec<String> = (1..5).map(|i| format!("* {pair} arm {i}")).collect();
        let bones: Vec<&str> = std::iter::once("head").chain(names.iter().map(String::as_str)).collect();
        let stations: Vec<Station> = ARM
            .map(|[out, up, radius]| {
                let [x, y, z] = place(angle, [out, up]);
                station(x, y, z, radius, 1.0)
            })
            .to_vec();
        body.limbs(&bones, 0.09, &stations);
    }
    // Eyes on bulges, and the siphon.
    body.limbs(&["head"], 0.05, &[station(0.125, 0.52, 0.09, 0.062, 1.0), station(0.140, 0.55, 0.10, 0.050, 1.0)]);
    body.limbs(&["head"], 0.015, &[station(0.165, 0.555, 0.125, 0.028, 1.0), station(0.168, 0.557, 0.128, 0.027, 1.0)]);
    body.limbs(&["head"], 0.05, &[station(0.130, 0.44, -0.09, 0.05, 1.0), station(0.165, 0.43, -0.04, 0.038, 1.0)]);
    body
}

/// A place on the arm that points so many degrees aside.
fn place(angle: f64, [out, up]: [f64; 2]) -> [f64; 3] {
    let (sine, cosine) = angle.to_radians().sin_cos();
    [out * sine, up, out * cosine]
}

/// A turn that lifts an arm (positive degrees: its tip rises).
fn lift(angle: f64, sign: f64, degrees: f64) -> DQuat {
    let [x, _, z] = place(angle, [1.0, 0.0]);
    DQuat::from_axis_angle(DVec3::new(sign * x, 0.0, z).cross(DVec3::Y).normalize(), degrees.to_radians())
}

/// A turn that swings an arm aside (positive: against the sun).
fn swing(degrees: f64) -> DQuat {
    DQuat::from_rotation_y(degrees.to_radians())
}

/// Calls `bend` for every bone of every arm: its turn by angle, sign of the side, number of the pair and of the bone.
fn arms(turns: &mut Turns, bend: impl Fn(f64, f64, usize, usize) -> DQuat) {
    for (side, sign) in [("left", 1.0), ("right", -1.0)] {
        for (number, (pair, angle)) in PAIRS.into_iter().enumerate() {
            for bone in 0..4 {
                turns.set(&format!("{side} {pair} arm {}", bone + 1), bend(angle, sign, number, bone));
            }
        }
    }
}

/// Waves run along the arms, each in its own time; the mantle breathes.
fn crawl(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    turns.set("head", roll(wave(phase)) * pitch(wave(phase + 0.2)));
    turns.set("mantle", pitch(-4.0 + 9.0 * wave(phase + 0.1)) * roll(6.0 * wave(phase - 0.15)));
    arms(&mut turns, |angle, sign, pair, bone| {
        let own = phase - 0.27 * pair as f64 - if sign < 0.0 { 0.5 } else { 0.0 } - 0.13 * bone as f64;
        let size = [10.0, 14.0, 17.0, 20.0][bone];
        // Roots stay low, so that most arms touch the ground.
        let (rest, rise) = ([2.0, -3.0, 3.0, 8.0][bone], [1.5, 4.0, 9.0, 12.0][bone]);
        lift(angle, sign, rest + rise * wave(own)) * swing(sign * size * wave(own + 0.22))
    });
    turns.pose(DVec3::ZERO)
}

/// How far the arms are closed: quickly together, slowly apart.
const JET: Curve = Curve(&[(0.0, 0.0), (0.08, 0.02), (0.30, 1.0), (0.42, 0.95), (0.85, 0.05)]);

/// Swims by jets: the arms open like an umbrella and close, the mantle swells and the body shoots up.
fn swim(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    turns.set("head", pitch(-12.0 + 3.0 * wave(phase)));
    turns.set("mantle", pitch(22.0 + 8.0 * wave(phase + 0.05)) * roll(3.0 * wave(phase)));
    arms(&mut turns, |angle, sign, pair, bone| {
        let own = phase - 0.07 * bone as f64 - 0.02 * pair as f64;
        let (open, closed) = ([12.0, 12.0, 2.0, -18.0][bone], [-46.0, -20.0, -6.0, 14.0][bone]);
        let curl = open + (closed - open) * JET.at(own);
        lift(angle, sign, curl) * swing(sign * [2.0, 4.0, 7.0, 12.0][bone] * wave(own + 0.15 * pair as f64))
    });
    turns.pose(DVec3::new(0.0, 0.85 + 0.16 * wave(phase - 0.38), 0.0))
}
