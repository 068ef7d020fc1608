//! The robot: separate rigid pieces with the bones and the motions of a person.

use super::body::Body;
use super::person;
use super::pieces::Piece;
use glam::{DQuat, DVec3};

/// The pieces of the robot around a person's bones, in the pose in which the person is meshed.
pub fn robot() -> Body {
    let mut body = person::person();
    let mut pieces = Vec::new();
    for (bone, centre, half, round) in MIDDLE {
        pieces.push(Piece::new(&body, bone, *centre, DQuat::IDENTITY, *half, *round));
    }
    for (side, sign) in [("left", 1.0), ("right", -1.0)] {
        let flip = |p: [f64; 3]| [sign * p[0], p[1], p[2]];
        for (bone, centre, half, round) in SIDES {
            pieces.push(Piece::new(&body, &format!("{side} {bone}"), flip(*centre), DQuat::IDENTITY, *half, *round));
        }
        // Along the arm, that is meshed half raised.
        let turn = DQuat::from_rotation_z(-sign * person::MESHED.to_radians());
        for (bone, along, half, round) in ARM {
            let at = flip(person::arm(*along, 0.0));
            pieces.push(Piece::new(&body, &format!("{side} {bone}"), at, turn, *half, *round));
        }
        // A thumb and two fingers like tongs.
        for (forward, across) in [(0.030, 0.0), (-0.030, 0.0)] {
            let mut at = DVec3::from(flip(person::arm(0.66, forward)));
            at.y += across;
            pieces.push(Piece::new(&body, &format!("{side} hand"), at.into(), turn, [0.045, 0.020, 0.012], 0.010));
        }
    }
    body.pieces = pieces;
    body
}

/// Bone, centre, half extents, rounding.
type Block = (&'static str, [f64; 3], [f64; 3], f64);

const MIDDLE: &[Block] = &[
    ("pelvis", [0.0, 0.955, 0.0], [0.125, 0.062, 0.085], 0.030),
    ("pelvis", [0.0, 1.045, 0.0], [0.072, 0.024, 0.060], 0.018),
    ("chest", [0.0, 1.260, 0.0], [0.165, 0.175, 0.105], 0.045),
    ("chest", [0.0, 1.290, 0.112], [0.075, 0.060, 0.012], 0.010),
    ("chest", [0.0, 1.270, -0.128], [0.110, 0.115, 0.030], 0.022),
    ("head", [0.0, 1.462, 0.0], [0.042, 0.022, 0.042], 0.018),
    ("head", [0.0, 1.590, 0.010], [0.115, 0.098, 0.105], 0.040),
    ("head", [0.0, 1.605, 0.118], [0.085, 0.030, 0.010], 0.009),
    ("head", [0.0, 1.725, 0.0], [0.008, 0.034, 0.008], 0.008),
    ("head", [0.0, 1.778, 0.0], [0.022, 0.022, 0.022], 0.022),
];

const SIDES: &[Block] = &[
    ("thigh", [0.095, 0.905, 0.0], [0.048, 0.048, 0.048], 0.048),
    ("thigh", [0.096, 0.700, 0.006], [0.058, 0.145, 0.062], 0.026),
    ("shank", [0.098, 0.500, 0.012], [0.046, 0.046, 0.046], 0.046),
    ("shank", [0.097, 0.300, -0.006], [0.062, 0.145, 0.066], 0.028),
    ("foot", [0.096, 0.105, -0.026], [0.036, 0.036, 0.036], 0.036),
    ("foot", [0.102, 0.034, 0.045], [0.062, 0.032, 0.132], 0.022),
];

/// Bone, how far along the arm, half extents (along the arm, across, forward), rounding.
const ARM: &[(&str, f64, [f64; 3], f64)] = &[
    ("upper arm", 0.030, [0.056, 0.056, 0.056], 0.056),
    ("upper arm", 0.160, [0.066, 0.042, 0.044], 0.020),
    ("forearm", 0.280, [0.042, 0.042, 0.042], 0.042),
    ("forearm", 0.415, [0.084, 0.047, 0.049], 0.022),
    ("hand", 0.535, [0.030, 0.030, 0.030], 0.030),
    ("hand", 0.590, [0.026, 0.040, 0.046], 0.016),
];
