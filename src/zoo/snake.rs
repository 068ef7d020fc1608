//! The snake: 3 long, its head at +z, slithering.

use super::body::{Body, Turns, motion};
use super::gait::{Curve, pitch, roll, wave, yaw};
use super::limb::{Station, station};
use super::skeleton::{Rigid, Skeleton};
use glam::{DQuat, DVec3};
use std::f64::consts::TAU;

/// The bones of the trunk from the neck to the tail; the head is one more.
const NAMES: [&str; 11] = [
    "neck",
    "chest",
    "trunk 1",
    "trunk 2",
    "trunk 3",
    "trunk 4",
    "trunk 5",
    "trunk 6",
    "tail root",
    "tail",
    "tail tip",
];
/// Where the neck begins (z) and how long each bone is.
const NECK: f64 = 1.20;
const LENGTH: f64 = 0.25;
/// Half the height of the trunk.
const HALF: f64 = 0.065;
/// Waves along the body, and the largest turn from one bone to the next in degrees.
const WAVES: f64 = 1.35;
const BEND: f64 = 27.0;

/// The snake's bones, limbs and motion.
pub fn snake() -> Body {
    let mut body = Body::new(0.024, &[motion("slither", 1.6, gait), motion("rear", 3.2, rear)]);
    body.stance = stance;
    // A body without elbows.
    body.softness = 1.8;
    body.bone("head", None, [0.0, 0.09, NECK], [0.0, 0.08, 1.52]);
    let mut parent = "head";
    for (i, name) in NAMES.into_iter().enumerate() {
        let z = NECK - LENGTH * i as f64;
        body.bone(name, Some(parent), [0.0, HALF, z], [0.0, HALF, z - LENGTH]);
        parent = name;
    }
    let all: Vec<&str> = std::iter::once("head").chain(NAMES).collect();
    // Belly on the ground: the centre is as high as the body is thick, less what is cut off.
    let round = |z: f64, radius: f64| station(0.0, 0.92 * radius, z, radius, 1.06);
    let stations: Vec<Station> = [
        (1.26, 0.038),
        (1.16, 0.040),
        (1.00, 0.049),
        (0.75, 0.061),
        (0.45, 0.072),
        (0.10, 0.075),
        (-0.25, 0.074),
        (-0.60, 0.065),
        (-0.90, 0.052),
        (-1.15, 0.037),
        (-1.35, 0.024),
        (-1.50, 0.013),
    ]
    .map(|(z, radius)| round(z, radius))
    .to_vec();
    body.limb(&all, 0.05, &stations);
    head(&mut body);
    body
}

fn head(body: &mut Body) {
    body.limb(
        &["head"],
        0.05,
        &[
            station(0.0, 0.050, 1.20, 0.042, 1.15),
            station(0.0, 0.058, 1.27, 0.052, 1.45),
            station(0.0, 0.060, 1.34, 0.052, 1.42),
            station(0.0, 0.054, 1.42, 0.043, 1.25),
            station(0.0, 0.047, 1.49, 0.033, 1.18),
            station(0.0, 0.044, 1.51, 0.028, 1.18),
        ],
    );
    // Brows with eyes, and nostrils.
    body.limbs(&["head"], 0.025, &[station(0.046, 0.094, 1.35, 0.015, 1.0), station(0.041, 0.087, 1.41, 0.014, 1.0)]);
    body.limbs(&["head"], 0.02, &[station(0.016, 0.062, 1.515, 0.010, 1.0), station(0.015, 0.058, 1.528, 0.009, 1.0)]);
}

/// A wave that runs from head to tail; the path of the body stays put while the snake moves along it.
fn gait(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    bent(skeleton, phase, 1.0)
}

/// A gentle bend, as at rest.
fn stance(skeleton: &Skeleton) -> Vec<Rigid> {
    bent(skeleton, 0.35, 0.4)
}

fn bent(skeleton: &Skeleton, phase: f64, amount: f64) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    let count = NAMES.len() as f64;
    // The heading of bone s (head: 0) is a wave; turns between bones are its differences.
    let heading = |s: f64| {
        let reach = if s < 1.5 { 0.55 + 0.3 * s } else { 1.0 };
        let amplitude = amount * BEND * reach * count / (TAU * WAVES);
        amplitude * (TAU * (phase - WAVES * s / count)).sin()
    };
    turns.set("head", yaw(heading(0.0)));
    for (i, name) in NAMES.into_iter().enumerate() {
        turns.set(name, yaw(heading(i as f64 + 1.0) - heading(i as f64)));
    }
    centred(skeleton, &turns.pose(DVec3::ZERO))
}

/// Shifts a pose sideways and along so that the middle of the body stays in its place.
fn centred(skeleton: &Skeleton, motions: &[Rigid]) -> Vec<Rigid> {
    let count = motions.len().max(1) as f64;
    let drift: DVec3 =
        skeleton.bones.iter().zip(motions).map(|(bone, motion)| motion.apply(bone.joint) - bone.joint).sum();
    let back = Rigid { turn: DQuat::IDENTITY, shift: -drift / count };
    motions.iter().map(|motion| Rigid { turn: motion.turn, shift: motion.shift + back.shift }).collect()
}

/// How far it is raised.
const RAISED: Curve = Curve(&[(0.0, 0.0), (0.05, 0.0), (0.32, 1.0), (0.72, 1.0), (0.97, 0.0)]);

/// Raises its head, sways and lies down again; the rest of the body is wound.
fn rear(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    let (up, sway) = (RAISED.at(phase), RAISED.at(phase) * wave(2.0 * phase));
    // Where each bone heads and how steep it is, from the head on; only the front is raised.
    let steep = [-38.0, -66.0, -52.0, -26.0, -7.0];
    let winding = [6.0, 10.0, 16.0, 24.0, 30.0, 32.0, -8.0, -34.0, -38.0, -30.0, 12.0];
    let mut heading = 12.0 * sway;
    let mut carrier = yaw(heading) * pitch(10.0 * up) * roll(4.0 * sway);
    turns.set("head", carrier);
    for (i, name) in NAMES.into_iter().enumerate() {
        let raised = steep.get(i).map_or(0.0, |degrees| degrees * RAISED.at(phase - 0.012 * i as f64));
        heading += winding[i] * (0.8 + 0.2 * wave(phase - 0.06 * i as f64)) - if i < 4 { 3.0 * sway } else { 0.0 };
        let lean = if i < 4 { 7.0 * RAISED.at(phase) * wave(2.0 * phase - 0.08 * i as f64) } else { 0.0 };
        let own = yaw(heading) * roll(lean) * pitch(raised);
        turns.set(name, carrier.inverse() * own);
        carrier = own;
    }
    centred(skeleton, &turns.pose(DVec3::ZERO))
}
