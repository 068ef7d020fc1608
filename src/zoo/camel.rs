//! The dromedary: 1.85 tall at the shoulder, long-legged and long-necked, facing +z.

use super::body::{Body, airborne, motion};
use super::gait::{Curve, Step};
use super::limb::{Station, station};
use super::lying::collapse_folded;
use super::quadruped::{Joints, Walk, galloping, mid, quadruped_bones};
use super::skeleton::{Rigid, Skeleton};
use glam::DVec3;

/// Where the joints are, left side.
const JOINTS: Joints = Joints {
    trunk: [[0.0, 1.42, -0.45], [0.0, 1.40, 0.45]],
    neck: [[0.0, 1.38, 0.58], [0.0, 1.36, 1.02], [0.0, 1.97, 1.17]],
    muzzle: [0.0, 1.90, 1.68],
    tail: [[0.0, 1.50, -0.74], [0.0, 1.32, -0.87], [0.0, 1.12, -0.90], [0.0, 0.88, -0.90]],
    fore: [[0.17, 1.42, 0.50], [0.17, 1.06, 0.38], [0.155, 0.60, 0.43], [0.15, 0.20, 0.43], [0.15, 0.0, 0.50]],
    hind: [[0.15, 1.42, -0.44], [0.18, 1.08, -0.33], [0.155, 0.68, -0.62], [0.15, 0.22, -0.60], [0.15, 0.0, -0.53]],
};

/// Stations of the left legs, top to bottom; wide soft feet.
const FORE: &[Station] = &[
    station(0.13, 1.46, 0.42, 0.17, 0.55),
    station(0.150, 1.26, 0.47, 0.165, 0.60),
    station(0.165, 1.08, 0.41, 0.120, 0.74),
    station(0.162, 0.92, 0.405, 0.090, 0.82),
    station(0.157, 0.74, 0.420, 0.064, 0.90),
    station(0.155, 0.61, 0.435, 0.074, 0.95),
    station(0.153, 0.50, 0.425, 0.050, 0.95),
    station(0.151, 0.34, 0.425, 0.043, 0.95),
    station(0.150, 0.20, 0.430, 0.054, 1.0),
    station(0.150, 0.115, 0.455, 0.056, 1.1),
    station(0.150, 0.050, 0.495, 0.082, 1.08),
    station(0.150, 0.000, 0.505, 0.094, 1.06),
];
const HIND: &[Station] = &[
    station(0.11, 1.44, -0.43, 0.20, 0.66),
    station(0.14, 1.25, -0.42, 0.190, 0.60),
    station(0.17, 1.08, -0.39, 0.140, 0.68),
    station(0.170, 0.93, -0.46, 0.102, 0.76),
    station(0.160, 0.79, -0.555, 0.070, 0.80),
    station(0.155, 0.68, -0.620, 0.070, 0.84),
    station(0.152, 0.57, -0.635, 0.052, 0.90),
    station(0.150, 0.38, -0.620, 0.044, 0.94),
    station(0.150, 0.22, -0.605, 0.054, 1.0),
    station(0.150, 0.125, -0.575, 0.054, 1.1),
    station(0.150, 0.050, -0.535, 0.078, 1.08),
    station(0.150, 0.000, -0.525, 0.088, 1.06),
];

/// The camel's bones, limbs and motion.
pub fn camel() -> Body {
    let mut body = Body::new(
        0.034,
        &[motion("walk", 1.5, gait), airborne("gallop", 0.66, gallop), motion("collapse", 3.2, collapse_folded)],
    );
    quadruped_bones(&mut body, &JOINTS);
    body.limb(
        &["trunk"],
        0.1,
        &[
            mid(1.40, -0.64, 0.120, 0.95),
            mid(1.41, -0.50, 0.200, 0.92),
            mid(1.42, -0.26, 0.240, 0.95),
            mid(1.37, 0.00, 0.300, 0.92),
            mid(1.33, 0.24, 0.340, 0.82),
            mid(1.35, 0.44, 0.290, 0.76),
            mid(1.37, 0.58, 0.200, 0.82),
        ],
    );
    // The hump, leaning back a little, and the callus on the chest.
    body.limb(
        &["trunk"],
        0.20,
        &[
            mid(1.50, 0.05, 0.30, 0.62),
            mid(1.72, 0.00, 0.215, 0.60),
            mid(1.87, -0.03, 0.125, 0.62),
            mid(1.93, -0.05, 0.075, 0.7),
        ],
    );
    body.limb(&["trunk"], 0.08, &[mid(1.02, 0.28, 0.07, 1.0), mid(1.02, 0.40, 0.07, 1.0)]);
    body.limbs(&["* upper arm", "* forearm", "* fore cannon", "* fore foot"], 0.10, FORE);
    body.limbs(&["* thigh", "* gaskin", "* hind cannon", "* hind foot"], 0.10, HIND);
    body.limbs(
        &["* gaskin", "* hind cannon"],
        0.05,
        &[
            station(0.163, 0.86, -0.565, 0.02, 1.0),
            station(0.156, 0.735, -0.665, 0.03, 0.8),
            station(0.153, 0.61, -0.662, 0.022, 0.9),
        ],
    );
    // A neck that sinks before it rises.
    body.limb(
        &["trunk", "lower neck", "upper neck"],
        0.16,
        &[
            mid(1.38, 0.46, 0.230, 0.66),
            mid(1.34, 0.66, 0.185, 0.64),
            mid(1.30, 0.86, 0.145, 0.68),
            mid(1.36, 1.03, 0.122, 0.72),
            mid(1.53, 1.13, 0.108, 0.74),
            mid(1.74, 1.15, 0.098, 0.76),
            mid(1.92, 1.15, 0.092, 0.78),
            mid(1.98, 1.18, 0.088, 0.78),
        ],
    );
    head(&mut body);
    body.limb(
        &["trunk", "tail root", "tail", "tail tip"],
        0.06,
        &[
            mid(1.50, -0.62, 0.06, 0.9),
            mid(1.49, -0.74, 0.040, 0.9),
            mid(1.38, -0.84, 0.034, 0.95),
            mid(1.22, -0.88, 0.034, 0.95),
            mid(1.08, -0.90, 0.042, 0.95),
            mid(0.97, -0.905, 0.052, 0.90),
            mid(0.87, -0.90, 0.022, 0.90),
        ],
    );
    body
}

fn head(body: &mut Body) {
    body.limb(
        &["head"],
        0.07,
        &[
            mid(2.00, 1.16, 0.085, 0.84),
            mid(2.015, 1.24, 0.104, 0.80),
            mid(1.995, 1.34, 0.096, 0.76),
            mid(1.955, 1.44, 0.078, 0.76),
            mid(1.920, 1.53, 0.070, 0.80),
            mid(1.895, 1.60, 0.068, 0.84),
            mid(1.880, 1.635, 0.058, 0.88),
        ],
    );
    // Jaw, brow, split upper lip, lower lip.
    body.limbs(&["head"], 0.05, &[station(0.030, 1.95, 1.21, 0.070, 0.6), station(0.030, 1.92, 1.31, 0.060, 0.6)]);
    body.limbs(&["head"], 0.03, &[station(0.066, 2.060, 1.29, 0.026, 1.0), station(0.066, 2.040, 1.345, 0.024, 1.0)]);
    body.limbs(&["head"], 0.03, &[station(0.030, 1.915, 1.64, 0.032, 1.0), station(0.028, 1.880, 1.665, 0.032, 1.0)]);
    body.limb(&["head"], 0.03, &[mid(1.850, 1.53, 0.032, 1.1), mid(1.832, 1.60, 0.036, 1.2)]);
    // Small round ears.
    body.limbs_facing(
        &["head"],
        0.03,
        DVec3::new(0.6, 0.0, 1.0),
        &[
            station(0.060, 2.070, 1.190, 0.026, 0.8),
            station(0.082, 2.120, 1.175, 0.032, 0.65),
            station(0.098, 2.165, 1.170, 0.026, 0.62),
            station(0.104, 2.195, 1.170, 0.014, 0.8),
        ],
    );
    // A tuft on the crown.
    body.limb(
        &["head"],
        0.05,
        &[mid(2.075, 1.17, 0.04, 1.0), mid(2.095, 1.23, 0.042, 1.0), mid(2.075, 1.29, 0.03, 1.0)],
    );
}

/// The pace: both legs of one side go together, the hind foot a little before the fore foot.
const PACE: Walk = Walk {
    hind: [0.0, 0.5],
    fore: [0.09, 0.59],
    fore_step: Step {
        duty: 0.60,
        stride: 0.62,
        ahead: 0.03,
        lift: 0.10,
        bend: Curve(&[(0.0, 0.0), (0.55, 0.0), (0.66, 18.0), (0.78, 58.0), (0.90, 20.0), (0.97, 0.0)]),
        foot: Curve(&[(0.0, -5.0), (0.06, 0.0), (0.46, 0.0), (0.62, 30.0), (0.74, 78.0), (0.88, 24.0), (0.96, -8.0)]),
    },
    hind_step: Step {
        duty: 0.60,
        stride: 0.62,
        ahead: 0.03,
        lift: 0.09,
        bend: Curve(&[(0.0, 0.0), (0.15, -5.0), (0.5, 6.0), (0.62, -4.0), (0.78, -24.0), (0.94, -6.0)]),
        foot: Curve(&[(0.0, -5.0), (0.06, 0.0), (0.46, 0.0), (0.62, 26.0), (0.72, 42.0), (0.88, 10.0), (0.96, -8.0)]),
    },
    drop: 0.03,
    beats: 2.0,
    rise: 0.008,
    pitch: 0.8,
    roll: 1.6,
    nod: 1.2,
    tail: 1.0,
    fore_sole: [-0.02, 0.16],
    hind_sole: [-0.01, 0.16],
};

fn gait(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    PACE.pose(skeleton, phase)
}

const GALLOP: Walk = galloping(1.0, 0.24, 0.05, [-0.02, 0.16], [-0.01, 0.16]);

fn gallop(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    GALLOP.pose(skeleton, phase)
}
