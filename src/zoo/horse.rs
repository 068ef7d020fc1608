//! The horse: 1.6 tall at the withers, as long as it is tall, facing +z.

use super::body::{Body, airborne, motion};
use super::gait::{Curve, Step};
use super::limb::{Station, station};
use super::lying::collapse_folded;
use super::quadruped::{Joints, Walk, galloping, mid, quadruped_bones};
use super::skeleton::{Rigid, Skeleton};
use glam::DVec3;

/// Where the joints are, left side.
const JOINTS: Joints = Joints {
    trunk: [[0.0, 1.28, -0.45], [0.0, 1.25, 0.45]],
    neck: [[0.0, 1.33, 0.56], [0.0, 1.66, 0.83], [0.0, 1.92, 1.00]],
    muzzle: [0.0, 1.50, 1.46],
    tail: [[0.0, 1.42, -0.80], [0.0, 1.22, -0.99], [0.0, 0.90, -1.06], [0.0, 0.52, -1.07]],
    fore: [[0.17, 1.27, 0.55], [0.17, 0.93, 0.42], [0.15, 0.53, 0.47], [0.145, 0.215, 0.465], [0.145, 0.0, 0.53]],
    hind: [[0.15, 1.27, -0.48], [0.19, 0.97, -0.36], [0.155, 0.615, -0.70], [0.15, 0.235, -0.67], [0.15, 0.0, -0.60]],
};

/// Stations of the left legs, top to bottom.
const FORE: &[Station] = &[
    station(0.14, 1.32, 0.46, 0.17, 0.52),
    station(0.155, 1.12, 0.54, 0.165, 0.56),
    station(0.165, 0.96, 0.47, 0.118, 0.72),
    station(0.160, 0.82, 0.455, 0.088, 0.80),
    station(0.152, 0.64, 0.465, 0.056, 0.88),
    station(0.150, 0.53, 0.472, 0.056, 0.95),
    station(0.148, 0.44, 0.468, 0.041, 0.92),
    station(0.146, 0.31, 0.462, 0.037, 0.92),
    station(0.145, 0.215, 0.465, 0.049, 0.95),
    station(0.145, 0.135, 0.500, 0.039, 1.0),
    station(0.145, 0.085, 0.522, 0.050, 1.0),
    station(0.145, 0.000, 0.545, 0.068, 0.98),
];
const HIND: &[Station] = &[
    station(0.13, 1.27, -0.47, 0.20, 0.60),
    station(0.15, 1.12, -0.50, 0.220, 0.56),
    station(0.18, 0.96, -0.42, 0.155, 0.64),
    station(0.178, 0.84, -0.50, 0.108, 0.74),
    station(0.165, 0.72, -0.615, 0.072, 0.78),
    station(0.155, 0.615, -0.695, 0.066, 0.80),
    station(0.152, 0.53, -0.705, 0.050, 0.85),
    station(0.150, 0.37, -0.690, 0.040, 0.92),
    station(0.150, 0.235, -0.675, 0.050, 0.95),
    station(0.150, 0.150, -0.635, 0.040, 1.0),
    station(0.150, 0.090, -0.610, 0.050, 1.0),
    station(0.150, 0.000, -0.585, 0.066, 0.98),
];

/// The horse's bones, limbs and motion.
pub fn horse() -> Body {
    let mut body = Body::new(
        0.030,
        &[motion("walk", 1.15, gait), airborne("gallop", 0.52, gallop), motion("collapse", 3.2, collapse_folded)],
    );
    quadruped_bones(&mut body, &JOINTS);
    body.limb(
        &["trunk"],
        0.1,
        &[
            mid(1.265, -0.62, 0.165, 0.95),
            mid(1.29, -0.50, 0.240, 0.92),
            mid(1.265, -0.28, 0.265, 0.92),
            mid(1.205, 0.00, 0.300, 0.90),
            mid(1.185, 0.25, 0.325, 0.80),
            mid(1.195, 0.46, 0.285, 0.74),
            mid(1.200, 0.60, 0.200, 0.80),
        ],
    );
    // Withers.
    body.limb(
        &["trunk"],
        0.16,
        &[mid(1.40, 0.02, 0.08, 0.6), mid(1.455, 0.26, 0.115, 0.5), mid(1.44, 0.46, 0.14, 0.6)],
    );
    body.limbs(&["* upper arm", "* forearm", "* fore cannon", "* fore foot"], 0.10, FORE);
    body.limbs(&["* thigh", "* gaskin", "* hind cannon", "* hind foot"], 0.10, HIND);
    // Point of the hock, and the tendon above it.
    body.limbs(
        &["* gaskin", "* hind cannon"],
        0.05,
        &[
            station(0.165, 0.80, -0.63, 0.02, 1.0),
            station(0.156, 0.67, -0.745, 0.03, 0.8),
            station(0.153, 0.55, -0.735, 0.022, 0.9),
        ],
    );
    body.limb(
        &["trunk", "lower neck", "upper neck"],
        0.14,
        &[
            mid(1.24, 0.42, 0.25, 0.66),
            mid(1.36, 0.60, 0.240, 0.60),
            mid(1.53, 0.75, 0.185, 0.58),
            mid(1.70, 0.87, 0.145, 0.60),
            mid(1.85, 0.97, 0.118, 0.64),
            mid(1.93, 1.04, 0.105, 0.68),
        ],
    );
    head(&mut body);
    mane(&mut body);
    body.limb(
        &["trunk", "tail root", "tail", "tail tip"],
        0.07,
        &[
            mid(1.43, -0.64, 0.07, 0.9),
            mid(1.445, -0.80, 0.05, 0.9),
            mid(1.37, -0.92, 0.052, 0.95),
            mid(1.20, -1.00, 0.066, 0.95),
            mid(0.98, -1.05, 0.080, 0.90),
            mid(0.76, -1.07, 0.075, 0.85),
            mid(0.58, -1.07, 0.050, 0.80),
            mid(0.47, -1.065, 0.018, 0.80),
        ],
    );
    body
}

fn head(body: &mut Body) {
    body.limb(
        &["head"],
        0.07,
        &[
            mid(1.94, 1.05, 0.088, 0.80),
            mid(1.895, 1.12, 0.105, 0.80),
            mid(1.815, 1.19, 0.102, 0.76),
            mid(1.72, 1.265, 0.084, 0.74),
            mid(1.63, 1.34, 0.069, 0.74),
            mid(1.555, 1.405, 0.063, 0.82),
            mid(1.52, 1.435, 0.055, 0.86),
        ],
    );
    // The round of the jaw.
    body.limbs(&["head"], 0.05, &[station(0.030, 1.82, 1.10, 0.085, 0.5), station(0.032, 1.79, 1.145, 0.08, 0.5)]);
    // Brow and eye.
    body.limbs(&["head"], 0.03, &[station(0.066, 1.875, 1.19, 0.022, 1.0), station(0.068, 1.855, 1.205, 0.022, 1.0)]);
    // Nostrils, lower lip.
    body.limbs(&["head"], 0.03, &[station(0.036, 1.545, 1.445, 0.024, 1.0), station(0.034, 1.525, 1.455, 0.022, 1.0)]);
    body.limb(&["head"], 0.03, &[mid(1.54, 1.36, 0.03, 1.1), mid(1.495, 1.395, 0.032, 1.2)]);
    // Ears, turned a little outwards.
    body.limbs_facing(
        &["head"],
        0.03,
        DVec3::new(0.45, 0.0, 1.0),
        &[
            station(0.045, 1.965, 1.055, 0.030, 0.75),
            station(0.055, 2.035, 1.065, 0.036, 0.62),
            station(0.062, 2.095, 1.08, 0.030, 0.60),
            station(0.062, 2.145, 1.10, 0.017, 0.80),
        ],
    );
}

fn mane(body: &mut Body) {
    body.limb(
        &["trunk", "lower neck", "upper neck", "head"],
        0.05,
        &[
            mid(1.545, 0.46, 0.035, 0.7),
            mid(1.668, 0.59, 0.068, 0.5),
            mid(1.80, 0.72, 0.078, 0.45),
            mid(1.922, 0.83, 0.078, 0.45),
            mid(2.01, 0.945, 0.066, 0.45),
            mid(2.035, 1.03, 0.045, 0.5),
        ],
    );
    body.limb(
        &["head"],
        0.04,
        &[mid(2.03, 1.04, 0.04, 0.7), mid(2.00, 1.12, 0.036, 0.8), mid(1.93, 1.185, 0.022, 0.9)],
    );
}

/// A walk: four beats, each hind foot followed by the fore foot of its side.
const WALK: Walk = Walk {
    // Left hind, left fore, right hind, right fore.
    hind: [0.0, 0.5],
    fore: [0.25, 0.75],
    fore_step: Step {
        duty: 0.62,
        stride: 0.56,
        ahead: 0.0,
        lift: 0.10,
        bend: Curve(&[(0.0, 0.0), (0.55, 0.0), (0.66, 20.0), (0.78, 62.0), (0.90, 22.0), (0.97, 0.0)]),
        foot: Curve(&[(0.0, -4.0), (0.06, 0.0), (0.46, 0.0), (0.62, 34.0), (0.74, 92.0), (0.88, 30.0), (0.96, -6.0)]),
    },
    hind_step: Step {
        duty: 0.62,
        stride: 0.56,
        ahead: 0.02,
        lift: 0.075,
        bend: Curve(&[(0.0, 0.0), (0.15, -5.0), (0.5, 6.0), (0.62, -4.0), (0.78, -22.0), (0.94, -5.0)]),
        foot: Curve(&[(0.0, -4.0), (0.06, 0.0), (0.46, 0.0), (0.62, 28.0), (0.72, 46.0), (0.88, 10.0), (0.96, -6.0)]),
    },
    drop: 0.022,
    beats: 2.0,
    rise: 0.008,
    pitch: 0.8,
    roll: 1.6,
    nod: 1.0,
    tail: 1.0,
    fore_sole: [0.015, 0.135],
    hind_sole: [0.02, 0.14],
};

fn gait(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    WALK.pose(skeleton, phase)
}

const GALLOP: Walk = galloping(0.95, 0.24, 0.05, [0.015, 0.135], [0.02, 0.14]);

fn gallop(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    GALLOP.pose(skeleton, phase)
}
