//! The dog: a hound, twice its true size, facing +z.

use super::body::{Body, airborne, motion};
use super::gait::{Curve, Step};
use super::limb::{Station, station};
use super::lying::collapse_ahead;
use super::quadruped::{Joints, Walk, galloping, mid, quadruped_bones};
use super::skeleton::{Rigid, Skeleton};
use glam::DVec3;

/// What is written below in metres is made this much larger.
const SCALE: f64 = 2.0;

const JOINTS: Joints = Joints {
    trunk: [[0.0, 0.52, -0.22], [0.0, 0.50, 0.18]],
    neck: [[0.0, 0.550, 0.235], [0.0, 0.640, 0.310], [0.0, 0.725, 0.370]],
    muzzle: [0.0, 0.670, 0.605],
    tail: [[0.0, 0.570, -0.330], [0.0, 0.600, -0.435], [0.0, 0.660, -0.530], [0.0, 0.740, -0.605]],
    fore: [
        [0.075, 0.50, 0.21],
        [0.080, 0.345, 0.14],
        [0.072, 0.120, 0.165],
        [0.072, 0.046, 0.180],
        [0.072, 0.0, 0.215],
    ],
    hind: [
        [0.065, 0.50, -0.24],
        [0.085, 0.335, -0.15],
        [0.075, 0.160, -0.315],
        [0.073, 0.046, -0.295],
        [0.073, 0.0, -0.255],
    ],
};

const FORE: &[Station] = &[
    station(0.055, 0.540, 0.160, 0.075, 0.50),
    station(0.066, 0.460, 0.200, 0.070, 0.55),
    station(0.076, 0.365, 0.155, 0.050, 0.70),
    station(0.077, 0.300, 0.148, 0.036, 0.82),
    station(0.075, 0.200, 0.157, 0.026, 0.92),
    station(0.073, 0.125, 0.164, 0.0255, 0.95),
    station(0.072, 0.085, 0.170, 0.0225, 1.0),
    station(0.072, 0.045, 0.182, 0.0265, 1.06),
    station(0.072, 0.022, 0.207, 0.0290, 1.12),
    station(0.072, 0.010, 0.222, 0.0240, 1.15),
];
const HIND: &[Station] = &[
    station(0.050, 0.500, -0.235, 0.085, 0.60),
    station(0.062, 0.430, -0.235, 0.090, 0.58),
    station(0.080, 0.345, -0.182, 0.062, 0.66),
    station(0.080, 0.290, -0.212, 0.044, 0.74),
    station(0.077, 0.220, -0.272, 0.029, 0.80),
    station(0.075, 0.162, -0.314, 0.0255, 0.85),
    station(0.074, 0.100, -0.307, 0.0215, 0.95),
    station(0.073, 0.046, -0.293, 0.0255, 1.06),
    station(0.073, 0.022, -0.268, 0.0290, 1.12),
    station(0.073, 0.010, -0.252, 0.0240, 1.15),
];

/// The dog's bones, limbs and motions.
pub fn dog() -> Body {
    let motions =
        [motion("walk", 0.9, walk), airborne("gallop", 0.44, gallop), motion("collapse", 2.8, collapse_ahead)];
    let mut body = Body::new(0.016, &motions);
    quadruped_bones(&mut body, &JOINTS);
    // A deep chest and a narrow waist.
    body.limb(
        &["trunk"],
        0.05,
        &[
            mid(0.515, -0.285, 0.066, 0.95),
            mid(0.517, -0.190, 0.086, 0.90),
            mid(0.512, -0.060, 0.090, 0.90),
            mid(0.490, 0.060, 0.116, 0.82),
            mid(0.482, 0.155, 0.122, 0.74),
            mid(0.495, 0.235, 0.088, 0.80),
        ],
    );
    body.limbs(&["* upper arm", "* forearm", "* fore cannon", "* fore foot"], 0.05, FORE);
    body.limbs(&["* thigh", "* gaskin", "* hind cannon", "* hind foot"], 0.05, HIND);
    // Point of the hock.
    body.limbs(
        &["* gaskin", "* hind cannon"],
        0.02,
        &[
            station(0.077, 0.230, -0.290, 0.010, 1.0),
            station(0.075, 0.172, -0.334, 0.0135, 0.9),
            station(0.074, 0.125, -0.324, 0.011, 0.9),
        ],
    );
    body.limb(
        &["trunk", "lower neck", "upper neck"],
        0.06,
        &[
            mid(0.505, 0.170, 0.098, 0.72),
            mid(0.560, 0.245, 0.086, 0.74),
            mid(0.635, 0.307, 0.070, 0.80),
            mid(0.705, 0.355, 0.062, 0.86),
            mid(0.738, 0.380, 0.060, 0.88),
        ],
    );
    head(&mut body);
    body.limb(
        &["trunk", "tail root", "tail", "tail tip"],
        0.03,
        &[
            mid(0.555, -0.270, 0.038, 0.9),
            mid(0.570, -0.330, 0.030, 0.95),
            mid(0.600, -0.435, 0.0245, 1.0),
            mid(0.660, -0.530, 0.0215, 1.0),
            mid(0.705, -0.576, 0.0180, 1.0),
            mid(0.740, -0.606, 0.0120, 1.0),
        ],
    );
    body.enlarge(SCALE);
    body
}

fn head(body: &mut Body) {
    body.limb(
        &["head"],
        0.035,
        &[
            mid(0.742, 0.380, 0.064, 0.94),
            mid(0.744, 0.415, 0.068, 0.96),
            mid(0.728, 0.452, 0.058, 0.95),
            mid(0.704, 0.492, 0.043, 0.92),
            mid(0.690, 0.540, 0.037, 0.92),
            mid(0.681, 0.580, 0.033, 0.96),
        ],
    );
    // Nose, jaw, brows.
    body.limb(&["head"], 0.012, &[mid(0.692, 0.600, 0.016, 1.15), mid(0.688, 0.607, 0.015, 1.15)]);
    body.limb(
        &["head"],
        0.02,
        &[mid(0.680, 0.450, 0.034, 1.0), mid(0.658, 0.510, 0.024, 1.05), mid(0.648, 0.565, 0.021, 1.1)],
    );
    body.limbs(&["head"], 0.02, &[station(0.036, 0.772, 0.442, 0.019, 1.0), station(0.036, 0.760, 0.460, 0.017, 1.0)]);
    // Ears that hang.
    body.limbs_facing(
        &["head"],
        0.014,
        DVec3::new(1.0, 0.25, 0.15),
        &[
            station(0.040, 0.785, 0.395, 0.020, 0.7),
            station(0.068, 0.775, 0.398, 0.028, 0.55),
            station(0.083, 0.735, 0.405, 0.034, 0.42),
            station(0.088, 0.690, 0.412, 0.032, 0.40),
            station(0.087, 0.655, 0.416, 0.020, 0.55),
        ],
    );
}

/// A walk of four beats.
const WALK: Walk = Walk {
    hind: [0.0, 0.5],
    fore: [0.22, 0.72],
    fore_step: Step {
        duty: 0.60,
        stride: 0.52,
        ahead: 0.0,
        lift: 0.10,
        bend: Curve(&[(0.0, 0.0), (0.50, -8.0), (0.62, 15.0), (0.76, 58.0), (0.90, 18.0), (0.97, 0.0)]),
        foot: Curve(&[(0.0, -6.0), (0.06, 0.0), (0.42, 0.0), (0.60, 42.0), (0.74, 88.0), (0.88, 28.0), (0.96, -8.0)]),
    },
    hind_step: Step {
        duty: 0.60,
        stride: 0.52,
        ahead: 0.02,
        lift: 0.085,
        bend: Curve(&[(0.0, 0.0), (0.15, -6.0), (0.5, 10.0), (0.62, 0.0), (0.78, -24.0), (0.94, -5.0)]),
        foot: Curve(&[(0.0, -6.0), (0.06, 0.0), (0.42, 0.0), (0.60, 40.0), (0.72, 58.0), (0.88, 12.0), (0.96, -8.0)]),
    },
    drop: 0.03,
    beats: 2.0,
    rise: 0.008,
    pitch: 0.9,
    roll: 1.8,
    nod: 1.05,
    tail: 1.7,
    fore_sole: [-0.02, 0.11],
    hind_sole: [-0.02, 0.11],
};

const GALLOP: Walk = galloping(0.90, 0.22, 0.07, WALK.fore_sole, WALK.hind_sole);

fn walk(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    WALK.pose(skeleton, phase)
}

fn gallop(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    GALLOP.pose(skeleton, phase)
}
