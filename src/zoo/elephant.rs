//! The elephant: 1.9 high, two thirds of its true size, facing +z, with a trunk of six bones that curls.

use super::body::{Body, Turns, motion};
use super::gait::{Curve, Step, pitch, roll, wave, yaw};
use super::limb::{Station, station};
use super::lying::collapse_folded;
use super::quadruped::{Joints, PROBOSCIS, Walk, mid, quadruped_bones};
use super::skeleton::{Rigid, Skeleton};
use glam::DVec3;

/// What is written below in metres is made this much smaller.
const SCALE: f64 = 0.7;

const JOINTS: Joints = Joints {
    trunk: [[0.0, 1.72, -0.75], [0.0, 1.72, 0.60]],
    neck: [[0.0, 1.92, 0.80], [0.0, 2.04, 1.02], [0.0, 2.12, 1.22]],
    muzzle: [0.0, 1.72, 1.74],
    tail: [[0.0, 1.93, -1.45], [0.0, 1.62, -1.62], [0.0, 1.28, -1.65], [0.0, 0.90, -1.62]],
    fore: [[0.36, 1.72, 0.72], [0.38, 1.18, 0.60], [0.36, 0.64, 0.66], [0.355, 0.18, 0.66], [0.355, 0.0, 0.70]],
    hind: [[0.33, 1.66, -0.84], [0.38, 1.08, -0.68], [0.35, 0.54, -0.88], [0.345, 0.17, -0.85], [0.345, 0.0, -0.81]],
};

/// Where the bones of the trunk begin, and where it ends (y, z).
const NOSE: [[f64; 2]; 7] =
    [[1.80, 1.70], [1.47, 1.88], [1.16, 1.95], [0.88, 1.96], [0.63, 1.98], [0.42, 2.05], [0.27, 2.20]];

const FORE: &[Station] = &[
    station(0.28, 1.78, 0.66, 0.36, 0.58),
    station(0.34, 1.45, 0.69, 0.31, 0.68),
    station(0.375, 1.18, 0.64, 0.235, 0.82),
    station(0.370, 0.92, 0.645, 0.195, 0.92),
    station(0.362, 0.64, 0.665, 0.172, 1.0),
    station(0.358, 0.40, 0.66, 0.158, 1.0),
    station(0.355, 0.20, 0.665, 0.170, 1.0),
    station(0.355, 0.08, 0.680, 0.192, 1.0),
    station(0.355, 0.00, 0.685, 0.200, 1.0),
];
const HIND: &[Station] = &[
    station(0.24, 1.68, -0.82, 0.40, 0.66),
    station(0.31, 1.36, -0.80, 0.35, 0.68),
    station(0.365, 1.08, -0.72, 0.255, 0.78),
    station(0.362, 0.84, -0.78, 0.198, 0.88),
    station(0.350, 0.56, -0.87, 0.162, 0.96),
    station(0.347, 0.38, -0.865, 0.150, 1.0),
    station(0.345, 0.20, -0.855, 0.160, 1.0),
    station(0.345, 0.08, -0.840, 0.180, 1.0),
    station(0.345, 0.00, -0.835, 0.188, 1.0),
];

/// The elephant's bones, limbs and motions.
pub fn elephant() -> Body {
    let motions = [motion("walk", 1.6, walk), motion("wave", 3.0, salute), motion("collapse", 4.0, collapse_folded)];
    let mut body = Body::new(0.055, &motions);
    bones(&mut body);
    body.limb(
        &["trunk"],
        0.2,
        &[
            mid(1.70, -1.14, 0.36, 0.95),
            mid(1.70, -0.84, 0.55, 0.92),
            mid(1.66, -0.40, 0.64, 0.93),
            mid(1.62, 0.10, 0.68, 0.92),
            mid(1.68, 0.52, 0.60, 0.86),
            mid(1.78, 0.82, 0.44, 0.88),
        ],
    );
    body.limbs(&["* upper arm", "* forearm", "* fore cannon", "* fore foot"], 0.18, FORE);
    body.limbs(&["* thigh", "* gaskin", "* hind cannon", "* hind foot"], 0.18, HIND);
    body.limb(
        &["trunk", "lower neck", "upper neck"],
        0.2,
        &[
            mid(1.76, 0.62, 0.46, 0.80),
            mid(1.92, 0.84, 0.41, 0.82),
            mid(2.04, 1.06, 0.35, 0.88),
            mid(2.10, 1.24, 0.32, 0.90),
        ],
    );
    head(&mut body);
    nose(&mut body);
    body.limb(
        &["trunk", "tail root", "tail", "tail tip"],
        0.1,
        &[
            mid(1.90, -1.22, 0.12, 0.9),
            mid(1.93, -1.43, 0.090, 0.9),
            mid(1.80, -1.555, 0.068, 0.95),
            mid(1.62, -1.62, 0.056, 0.95),
            mid(1.30, -1.645, 0.050, 0.95),
            mid(1.10, -1.635, 0.060, 0.95),
            mid(0.96, -1.62, 0.070, 0.90),
            mid(0.84, -1.615, 0.035, 0.90),
        ],
    );
    body.enlarge(SCALE);
    body
}

fn bones(body: &mut Body) {
    quadruped_bones(body, &JOINTS);
    body.bones("* ear", "head", [0.27, 2.14, 1.26], [0.74, 1.86, 0.90]);
    let mut parent = "head";
    for (name, ends) in PROBOSCIS.into_iter().zip(NOSE.windows(2)) {
        body.bone(name, Some(parent), [0.0, ends[0][0], ends[0][1]], [0.0, ends[1][0], ends[1][1]]);
        parent = name;
    }
}

fn head(body: &mut Body) {
    // A domed skull that runs out into the trunk.
    body.limb(
        &["head"],
        0.14,
        &[
            mid(2.18, 1.24, 0.34, 0.84),
            mid(2.22, 1.38, 0.34, 0.82),
            mid(2.06, 1.52, 0.29, 0.84),
            mid(1.86, 1.64, 0.215, 0.92),
            mid(1.74, 1.70, 0.18, 0.96),
        ],
    );
    body.limbs(&["head"], 0.12, &[station(0.12, 2.40, 1.30, 0.15, 1.0), station(0.11, 2.38, 1.42, 0.14, 1.0)]);
    // Jaw, cheeks, brows.
    body.limb(&["head"], 0.1, &[mid(1.78, 1.38, 0.17, 1.05), mid(1.60, 1.54, 0.10, 1.1), mid(1.52, 1.64, 0.065, 1.1)]);
    body.limbs(&["head"], 0.08, &[station(0.20, 2.17, 1.54, 0.07, 1.0), station(0.21, 2.08, 1.60, 0.06, 1.0)]);
    // Tusks.
    body.limbs(
        &["head"],
        0.05,
        &[
            station(0.150, 1.72, 1.56, 0.085, 1.0),
            station(0.215, 1.50, 1.70, 0.068, 1.0),
            station(0.250, 1.33, 1.88, 0.058, 1.0),
            station(0.255, 1.27, 2.06, 0.046, 1.0),
            station(0.240, 1.29, 2.20, 0.034, 1.0),
        ],
    );
    // Ears like sails.
    body.limbs_facing(
        &["* ear"],
        0.07,
        DVec3::new(0.58, 0.0, 0.81),
        &[
            station(0.24, 2.14, 1.28, 0.20, 0.36),
            station(0.38, 2.06, 1.17, 0.34, 0.19),
            station(0.54, 1.96, 1.05, 0.41, 0.15),
            station(0.68, 1.86, 0.95, 0.37, 0.15),
            station(0.77, 1.74, 0.89, 0.25, 0.20),
        ],
    );
}

fn nose(body: &mut Body) {
    let radii = [0.185, 0.152, 0.128, 0.108, 0.092, 0.078, 0.060];
    let mut stations = vec![mid(1.98, 1.58, 0.19, 0.98)];
    stations.extend(NOSE.iter().zip(radii).map(|(&[y, z], radius)| mid(y, z, radius, 1.0)));
    let bones: Vec<&str> = std::iter::once("head").chain(PROBOSCIS).collect();
    body.limb(&bones, 0.06, &stations);
}

/// A heavy walk; three feet are on the ground most of the time.
const WALK: Walk = Walk {
    hind: [0.0, 0.5],
    fore: [0.21, 0.71],
    fore_step: Step {
        duty: 0.68,
        stride: 0.46,
        ahead: 0.02,
        lift: 0.085,
        bend: Curve(&[(0.0, 0.0), (0.60, 0.0), (0.70, 18.0), (0.82, 52.0), (0.92, 18.0), (0.98, 0.0)]),
        foot: Curve(&[(0.0, -4.0), (0.06, 0.0), (0.54, 0.0), (0.68, 24.0), (0.79, 58.0), (0.90, 20.0), (0.97, -5.0)]),
    },
    hind_step: Step {
        duty: 0.68,
        stride: 0.46,
        ahead: 0.0,
        lift: 0.07,
        bend: Curve(&[(0.0, 0.0), (0.3, -3.0), (0.6, 4.0), (0.70, -3.0), (0.82, -16.0), (0.95, -3.0)]),
        foot: Curve(&[(0.0, -4.0), (0.06, 0.0), (0.54, 0.0), (0.68, 26.0), (0.78, 40.0), (0.90, 14.0), (0.97, -5.0)]),
    },
    drop: 0.022,
    beats: 2.0,
    rise: 0.006,
    pitch: 0.7,
    roll: 1.8,
    nod: 1.05,
    tail: 1.2,
    fore_sole: [-0.09, 0.13],
    hind_sole: [-0.09, 0.12],
};

fn walk(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    WALK.pose(skeleton, phase)
}

/// How far the trunk is curled, and how far raised.
const CURL: Curve = Curve(&[(0.0, 0.0), (0.10, 0.0), (0.34, 1.0), (0.44, 0.82), (0.52, 1.0), (0.62, 0.9), (0.88, 0.0)]);
const RAISE: Curve = Curve(&[(0.0, 0.0), (0.08, 0.0), (0.40, 1.0), (0.62, 1.0), (0.90, 0.0)]);

/// Lifts its trunk over the head, curled, and lowers it again.
fn salute(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    let (curl, raise) = (CURL.at(phase), RAISE.at(phase));
    turns.set("trunk", pitch(-1.2 * raise));
    turns.set("lower neck", pitch(-5.0 * raise) * yaw(2.0 * wave(phase)));
    turns.set("upper neck", pitch(-6.0 * raise));
    turns.set("head", pitch(-10.0 * raise) * yaw(3.0 * wave(phase)));
    // First the root rises, then the curl runs to the tip.
    let most = [-46.0, -34.0, -24.0, -26.0, -38.0, -44.0];
    for (i, (name, most)) in PROBOSCIS.into_iter().zip(most).enumerate() {
        let own = CURL.at(phase - 0.018 * i as f64);
        let idle = 4.0 * wave(phase - 0.1 * i as f64) * (1.0 - raise);
        turns.set(name, pitch(most * own) * roll(idle + 3.0 * curl * wave(2.0 * phase - 0.1 * i as f64)));
    }
    for (side, sign) in [("left", 1.0), ("right", -1.0)] {
        turns.set(&format!("{side} ear"), yaw(-sign * (6.0 + 20.0 * raise + 9.0 * wave(2.0 * phase))));
    }
    turns.set("tail root", yaw(12.0 * wave(phase)));
    turns.set("tail", roll(14.0 * wave(phase - 0.15)));
    turns.set("tail tip", roll(16.0 * wave(phase - 0.3)));
    // The feet stay where they are as the body leans.
    WALK.stand(skeleton, &mut turns);
    turns.pose(DVec3::ZERO)
}
