//! The giraffe: about 2.6 high, half its true size, facing +z.

use super::body::{Body, airborne, motion};
use super::gait::{Curve, Step};
use super::limb::{Station, station};
use super::lying::collapse_folded;
use super::quadruped::{Joints, Walk, galloping, mid, quadruped_bones};
use super::skeleton::{Rigid, Skeleton};
use glam::DVec3;

/// What is written below in metres is made this much smaller.
const SCALE: f64 = 0.56;

const JOINTS: Joints = Joints {
    trunk: [[0.0, 2.15, -0.55], [0.0, 2.25, 0.45]],
    neck: [[0.0, 2.45, 0.62], [0.0, 3.36, 1.06], [0.0, 4.26, 1.40]],
    muzzle: [0.0, 4.05, 1.98],
    tail: [[0.0, 2.24, -0.88], [0.0, 1.95, -1.02], [0.0, 1.55, -1.06], [0.0, 1.10, -1.05]],
    fore: [[0.20, 2.20, 0.62], [0.20, 1.72, 0.47], [0.17, 1.00, 0.50], [0.165, 0.22, 0.50], [0.165, 0.0, 0.57]],
    hind: [[0.18, 2.05, -0.58], [0.21, 1.60, -0.42], [0.175, 1.02, -0.76], [0.165, 0.23, -0.71], [0.165, 0.0, -0.64]],
};

const FORE: &[Station] = &[
    station(0.15, 2.28, 0.50, 0.25, 0.50),
    station(0.18, 2.00, 0.58, 0.225, 0.55),
    station(0.195, 1.75, 0.49, 0.150, 0.70),
    station(0.19, 1.55, 0.475, 0.105, 0.80),
    station(0.175, 1.20, 0.49, 0.072, 0.88),
    station(0.170, 1.00, 0.505, 0.076, 0.95),
    station(0.168, 0.86, 0.498, 0.054, 0.92),
    station(0.166, 0.50, 0.495, 0.047, 0.92),
    station(0.165, 0.22, 0.500, 0.062, 0.95),
    station(0.165, 0.13, 0.535, 0.052, 1.0),
    station(0.165, 0.07, 0.560, 0.070, 1.0),
    station(0.165, 0.00, 0.580, 0.088, 0.98),
];
const HIND: &[Station] = &[
    station(0.13, 2.04, -0.56, 0.25, 0.60),
    station(0.16, 1.82, -0.58, 0.250, 0.56),
    station(0.20, 1.60, -0.48, 0.170, 0.64),
    station(0.195, 1.42, -0.55, 0.120, 0.74),
    station(0.180, 1.18, -0.68, 0.080, 0.78),
    station(0.173, 1.01, -0.755, 0.080, 0.82),
    station(0.170, 0.86, -0.755, 0.057, 0.88),
    station(0.167, 0.50, -0.730, 0.048, 0.92),
    station(0.165, 0.23, -0.712, 0.062, 0.95),
    station(0.165, 0.13, -0.675, 0.052, 1.0),
    station(0.165, 0.07, -0.650, 0.068, 1.0),
    station(0.165, 0.00, -0.630, 0.084, 0.98),
];

/// The giraffe's bones, limbs and motions.
pub fn giraffe() -> Body {
    let motions =
        [motion("walk", 1.7, walk), airborne("gallop", 0.8, gallop), motion("collapse", 3.6, collapse_folded)];
    let mut body = Body::new(0.042, &motions);
    quadruped_bones(&mut body, &JOINTS);
    body.limb(
        &["trunk"],
        0.12,
        &[
            mid(2.06, -0.74, 0.200, 0.95),
            mid(2.07, -0.60, 0.300, 0.92),
            mid(2.08, -0.32, 0.350, 0.90),
            mid(2.10, 0.04, 0.400, 0.85),
            mid(2.13, 0.34, 0.420, 0.78),
            mid(2.19, 0.56, 0.330, 0.78),
            mid(2.24, 0.70, 0.220, 0.85),
        ],
    );
    // The back slopes up to the withers.
    body.limb(
        &["trunk"],
        0.22,
        &[mid(2.33, -0.20, 0.12, 0.6), mid(2.46, 0.12, 0.155, 0.55), mid(2.56, 0.42, 0.16, 0.55)],
    );
    body.limbs(&["* upper arm", "* forearm", "* fore cannon", "* fore foot"], 0.14, FORE);
    body.limbs(&["* thigh", "* gaskin", "* hind cannon", "* hind foot"], 0.14, HIND);
    body.limb(
        &["trunk", "lower neck", "upper neck"],
        0.2,
        &[
            mid(2.22, 0.48, 0.340, 0.66),
            mid(2.52, 0.66, 0.280, 0.62),
            mid(2.90, 0.85, 0.205, 0.64),
            mid(3.40, 1.07, 0.160, 0.70),
            mid(3.90, 1.27, 0.135, 0.76),
            mid(4.20, 1.39, 0.125, 0.80),
            mid(4.30, 1.45, 0.115, 0.80),
        ],
    );
    // A short mane.
    body.limb(
        &["trunk", "lower neck", "upper neck"],
        0.08,
        &[
            mid(2.76, 0.52, 0.05, 0.7),
            mid(3.10, 0.76, 0.075, 0.5),
            mid(3.60, 1.00, 0.075, 0.5),
            mid(4.08, 1.19, 0.070, 0.5),
            mid(4.36, 1.32, 0.05, 0.6),
        ],
    );
    head(&mut body);
    body.limb(
        &["trunk", "tail root", "tail", "tail tip"],
        0.1,
        &[
            mid(2.22, -0.72, 0.10, 0.9),
            mid(2.22, -0.88, 0.062, 0.9),
            mid(2.00, -1.00, 0.048, 0.95),
            mid(1.70, -1.05, 0.046, 0.95),
            mid(1.45, -1.06, 0.060, 0.95),
            mid(1.25, -1.055, 0.078, 0.90),
            mid(1.06, -1.05, 0.030, 0.90),
        ],
    );
    body.enlarge(SCALE);
    body
}

fn head(body: &mut Body) {
    body.limb(
        &["head"],
        0.1,
        &[
            mid(4.33, 1.44, 0.120, 0.82),
            mid(4.32, 1.54, 0.130, 0.82),
            mid(4.26, 1.64, 0.110, 0.80),
            mid(4.18, 1.76, 0.086, 0.82),
            mid(4.10, 1.88, 0.078, 0.86),
            mid(4.07, 1.94, 0.068, 0.90),
        ],
    );
    body.limb(
        &["head"],
        0.06,
        &[mid(4.19, 1.56, 0.075, 1.0), mid(4.08, 1.74, 0.050, 1.1), mid(4.02, 1.87, 0.045, 1.2)],
    );
    body.limbs(&["head"], 0.05, &[station(0.090, 4.355, 1.58, 0.034, 1.0), station(0.088, 4.325, 1.62, 0.034, 1.0)]);
    body.limbs(&["head"], 0.04, &[station(0.042, 4.11, 1.95, 0.026, 1.0), station(0.040, 4.09, 1.98, 0.024, 1.0)]);
    // Horns with knobs, ears that stand aside.
    body.limbs(
        &["head"],
        0.05,
        &[
            station(0.055, 4.40, 1.48, 0.046, 1.0),
            station(0.066, 4.52, 1.455, 0.036, 1.0),
            station(0.072, 4.60, 1.445, 0.040, 1.0),
            station(0.074, 4.635, 1.44, 0.044, 1.0),
        ],
    );
    body.limbs_facing(
        &["head"],
        0.05,
        DVec3::new(0.0, 0.7, 0.7),
        &[
            station(0.100, 4.34, 1.43, 0.045, 0.8),
            station(0.180, 4.38, 1.39, 0.062, 0.6),
            station(0.260, 4.41, 1.36, 0.055, 0.6),
            station(0.320, 4.42, 1.34, 0.030, 0.8),
        ],
    );
}

/// The pace: both legs of one side go together.
const WALK: Walk = Walk {
    hind: [0.0, 0.5],
    fore: [0.10, 0.60],
    fore_step: Step {
        duty: 0.62,
        stride: 0.62,
        ahead: 0.02,
        lift: 0.12,
        bend: Curve(&[(0.0, 0.0), (0.55, 0.0), (0.66, 18.0), (0.78, 52.0), (0.90, 18.0), (0.97, 0.0)]),
        foot: Curve(&[(0.0, -5.0), (0.06, 0.0), (0.46, 0.0), (0.62, 30.0), (0.74, 74.0), (0.88, 22.0), (0.96, -8.0)]),
    },
    hind_step: Step {
        duty: 0.62,
        stride: 0.62,
        ahead: 0.03,
        lift: 0.10,
        bend: Curve(&[(0.0, 0.0), (0.15, -4.0), (0.5, 5.0), (0.62, -4.0), (0.78, -22.0), (0.94, -5.0)]),
        foot: Curve(&[(0.0, -5.0), (0.06, 0.0), (0.46, 0.0), (0.62, 26.0), (0.72, 42.0), (0.88, 10.0), (0.96, -8.0)]),
    },
    drop: 0.025,
    beats: 2.0,
    rise: 0.008,
    pitch: 0.7,
    roll: 1.5,
    nod: 1.05,
    tail: 1.0,
    fore_sole: [-0.01, 0.09],
    hind_sole: [-0.01, 0.09],
};

const GALLOP: Walk = galloping(0.95, 0.26, 0.05, WALK.fore_sole, WALK.hind_sole);

fn walk(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    WALK.pose(skeleton, phase)
}

fn gallop(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    GALLOP.pose(skeleton, phase)
}
