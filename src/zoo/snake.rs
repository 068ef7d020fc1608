//! The snake: 3 long, its head at +z, slithering.

use super::body::{Body, Motion, Turns, as_meshed};
use super::gait::yaw;
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
const HALF: f64 = 0.085;
/// Waves along the body, and the largest turn from one bone to the next in degrees.
const WAVES: f64 = 1.35;
const BEND: f64 = 27.0;

/// The snake's bones, limbs and motion.
pub fn snake() -> Body {
    let mut body = Body::new(0.030, Motion { period: 1.6, stance: as_meshed, gait });
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
        (1.26, 0.052),
        (1.16, 0.054),
        (1.00, 0.066),
        (0.75, 0.083),
        (0.45, 0.097),
        (0.10, 0.102),
        (-0.25, 0.100),
        (-0.60, 0.088),
        (-0.90, 0.070),
        (-1.15, 0.050),
        (-1.35, 0.033),
        (-1.50, 0.018),
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
        0.06,
        &[
            station(0.0, 0.070, 1.20, 0.050, 1.15),
            station(0.0, 0.085, 1.28, 0.068, 1.45),
            station(0.0, 0.084, 1.37, 0.066, 1.35),
            station(0.0, 0.074, 1.45, 0.054, 1.20),
            station(0.0, 0.066, 1.52, 0.040, 1.15),
        ],
    );
    // Brows with eyes, and nostrils.
    body.limbs(&["head"], 0.025, &[station(0.052, 0.128, 1.36, 0.020, 1.0), station(0.046, 0.120, 1.42, 0.018, 1.0)]);
    body.limbs(&["head"], 0.02, &[station(0.022, 0.088, 1.535, 0.012, 1.0), station(0.020, 0.084, 1.548, 0.011, 1.0)]);
}

/// A wave that runs from head to tail; the path of the body stays put while the snake moves along it.
fn gait(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    let count = NAMES.len() as f64;
    // The heading of bone s (head: 0) is a wave; turns between bones are its differences.
    let heading = |s: f64| {
        let reach = if s < 1.5 { 0.55 + 0.3 * s } else { 1.0 };
        let amplitude = BEND * reach * count / (TAU * WAVES);
        amplitude * (TAU * (phase - WAVES * s / count)).sin()
    };
    turns.set("head", yaw(heading(0.0)));
    for (i, name) in NAMES.into_iter().enumerate() {
        turns.set(name, yaw(heading(i as f64 + 1.0) - heading(i as f64)));
    }
    let motions = turns.pose(DVec3::ZERO);
    centred(skeleton, &motions)
}

/// Shifts a pose sideways and along so that the middle of the body stays in its place.
fn centred(skeleton: &Skeleton, motions: &[Rigid]) -> Vec<Rigid> {
    let count = motions.len().max(1) as f64;
    let drift: DVec3 =
        skeleton.bones.iter().zip(motions).map(|(bone, motion)| motion.apply(bone.joint) - bone.joint).sum();
    let back = Rigid { turn: DQuat::IDENTITY, shift: -drift / count };
    motions.iter().map(|motion| Rigid { turn: motion.turn, shift: motion.shift + back.shift }).collect()
}
