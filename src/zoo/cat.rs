//! The cat: four times its true size, facing +z, its tail trailing with the tip up.

use super::body::{Body, airborne, motion};
use super::gait::{Curve, Step};
use super::limb::{Station, station};
use super::lying::collapse_ahead;
use super::quadruped::{Joints, Walk, galloping, mid, quadruped_bones};
use super::skeleton::{Rigid, Skeleton};
use glam::DVec3;

/// What is written below in metres is made this much larger.
const SCALE: f64 = 4.0;

const JOINTS: Joints = Joints {
    trunk: [[0.0, 0.232, -0.130], [0.0, 0.224, 0.100]],
    neck: [[0.0, 0.242, 0.128], [0.0, 0.268, 0.162], [0.0, 0.292, 0.192]],
    muzzle: [0.0, 0.276, 0.285],
    tail: [[0.0, 0.240, -0.195], [0.0, 0.205, -0.280], [0.0, 0.200, -0.370], [0.0, 0.265, -0.445]],
    fore: [
        [0.034, 0.215, 0.115],
        [0.038, 0.148, 0.086],
        [0.034, 0.050, 0.100],
        [0.034, 0.021, 0.106],
        [0.034, 0.0, 0.124],
    ],
    hind: [
        [0.030, 0.222, -0.140],
        [0.042, 0.150, -0.098],
        [0.036, 0.076, -0.175],
        [0.034, 0.021, -0.160],
        [0.034, 0.0, -0.140],
    ],
};

const FORE: &[Station] = &[
    station(0.024, 0.236, 0.092, 0.037, 0.50),
    station(0.030, 0.200, 0.108, 0.034, 0.56),
    station(0.036, 0.153, 0.091, 0.0245, 0.72),
    station(0.037, 0.120, 0.088, 0.0185, 0.86),
    station(0.035, 0.080, 0.094, 0.0150, 0.95),
    station(0.034, 0.051, 0.0995, 0.0145, 1.0),
    station(0.034, 0.032, 0.103, 0.0135, 1.0),
    station(0.034, 0.017, 0.111, 0.0158, 1.05),
    station(0.034, 0.009, 0.121, 0.0158, 1.12),
    station(0.034, 0.005, 0.128, 0.0125, 1.12),
];
const HIND: &[Station] = &[
    station(0.022, 0.222, -0.138, 0.042, 0.60),
    station(0.030, 0.190, -0.140, 0.046, 0.58),
    station(0.039, 0.155, -0.114, 0.033, 0.66),
    station(0.039, 0.125, -0.130, 0.0230, 0.76),
    station(0.037, 0.096, -0.157, 0.0160, 0.85),
    station(0.036, 0.075, -0.174, 0.0142, 0.90),
    station(0.035, 0.047, -0.169, 0.0125, 1.0),
    station(0.034, 0.021, -0.158, 0.0148, 1.05),
    station(0.034, 0.010, -0.147, 0.0158, 1.12),
    station(0.034, 0.005, -0.139, 0.0125, 1.12),
];

/// The cat's bones, limbs and motions.
pub fn cat() -> Body {
    let motions =
        [motion("walk", 0.85, walk), airborne("gallop", 0.42, gallop), motion("collapse", 2.8, collapse_ahead)];
    let mut body = Body::new(0.0085, &motions);
    quadruped_bones(&mut body, &JOINTS);
    body.limb(
        &["trunk"],
        0.025,
        &[
            mid(0.226, -0.172, 0.034, 0.95),
            mid(0.230, -0.120, 0.045, 0.92),
            mid(0.222, -0.030, 0.050, 0.92),
            mid(0.216, 0.045, 0.051, 0.88),
            mid(0.216, 0.095, 0.049, 0.82),
            mid(0.222, 0.130, 0.037, 0.88),
        ],
    );
    body.limbs(&["* upper arm", "* forearm", "* fore cannon", "* fore foot"], 0.025, FORE);
    body.limbs(&["* thigh", "* gaskin", "* hind cannon", "* hind foot"], 0.025, HIND);
    body.limb(
        &["trunk", "lower neck", "upper neck"],
        0.03,
        &[
            mid(0.220, 0.100, 0.043, 0.84),
            mid(0.243, 0.136, 0.037, 0.90),
            mid(0.268, 0.167, 0.033, 0.95),
            mid(0.290, 0.197, 0.032, 0.98),
        ],
    );
    head(&mut body);
    body.limb(
        &["trunk", "tail root", "tail", "tail tip"],
        0.02,
        &[
            mid(0.236, -0.165, 0.022, 0.9),
            mid(0.238, -0.200, 0.0155, 1.0),
            mid(0.206, -0.280, 0.0130, 1.0),
            mid(0.194, -0.335, 0.0128, 1.0),
            mid(0.203, -0.378, 0.0126, 1.0),
            mid(0.232, -0.415, 0.0122, 1.0),
            mid(0.268, -0.442, 0.0095, 1.0),
        ],
    );
    body.enlarge(SCALE);
    body
}

fn head(body: &mut Body) {
    body.limb(
        &["head"],
        0.02,
        &[mid(0.299, 0.205, 0.039, 1.04), mid(0.300, 0.226, 0.041, 1.06), mid(0.291, 0.248, 0.030, 1.08)],
    );
    // Cheeks, muzzle, chin, brows.
    body.limbs(&["head"], 0.02, &[station(0.020, 0.284, 0.226, 0.023, 1.0), station(0.018, 0.280, 0.244, 0.019, 1.0)]);
    body.limbs(
        &["head"],
        0.008,
        &[station(0.0075, 0.280, 0.264, 0.0125, 1.0), station(0.0070, 0.277, 0.273, 0.0105, 1.0)],
    );
    body.limb(&["head"], 0.008, &[mid(0.268, 0.252, 0.012, 1.1), mid(0.267, 0.266, 0.009, 1.1)]);
    body.limb(&["head"], 0.008, &[mid(0.300, 0.258, 0.010, 1.0), mid(0.288, 0.280, 0.0065, 1.2)]);
    body.limbs(
        &["head"],
        0.01,
        &[station(0.020, 0.313, 0.244, 0.0105, 1.0), station(0.021, 0.307, 0.250, 0.0100, 1.0)],
    );
    // Ears, upright.
    body.limbs_facing(
        &["head"],
        0.012,
        DVec3::new(0.35, -0.1, 1.0),
        &[
            station(0.024, 0.326, 0.212, 0.0175, 0.50),
            station(0.029, 0.346, 0.209, 0.0140, 0.45),
            station(0.033, 0.362, 0.208, 0.0095, 0.52),
            station(0.035, 0.373, 0.208, 0.0055, 0.80),
        ],
    );
}

/// A walk of four beats on soft paws.
const WALK: Walk = Walk {
    hind: [0.0, 0.5],
    fore: [0.20, 0.70],
    fore_step: Step {
        duty: 0.62,
        stride: 0.42,
        ahead: 0.0,
        lift: 0.09,
        bend: Curve(&[(0.0, 0.0), (0.50, -8.0), (0.62, 15.0), (0.76, 60.0), (0.90, 20.0), (0.97, 0.0)]),
        foot: Curve(&[(0.0, -6.0), (0.06, 0.0), (0.44, 0.0), (0.60, 40.0), (0.74, 86.0), (0.88, 30.0), (0.96, -8.0)]),
    },
    hind_step: Step {
        duty: 0.62,
        stride: 0.42,
        ahead: 0.02,
        lift: 0.075,
        bend: Curve(&[(0.0, 0.0), (0.15, -6.0), (0.5, 10.0), (0.62, 0.0), (0.78, -24.0), (0.94, -5.0)]),
        foot: Curve(&[(0.0, -6.0), (0.06, 0.0), (0.44, 0.0), (0.60, 40.0), (0.72, 56.0), (0.88, 12.0), (0.96, -8.0)]),
    },
    drop: 0.035,
    beats: 2.0,
    rise: 0.007,
    pitch: 0.8,
    roll: 1.6,
    nod: 1.05,
    tail: 1.3,
    fore_sole: [-0.01, 0.10],
    hind_sole: [-0.01, 0.10],
};

const GALLOP: Walk = galloping(0.76, 0.20, 0.08, WALK.fore_sole, WALK.hind_sole);

fn walk(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    WALK.pose(skeleton, phase)
}

fn gallop(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    GALLOP.pose(skeleton, phase)
}
