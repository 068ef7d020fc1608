//! The cactus: ribbed, 1.9 high, in a pot, with two arms; it bends as if there were music.

use super::body::{Body, Turns, motion};
use super::gait::{Curve, pitch, roll, wave};
use super::limb::{Station, station};
use super::skeleton::{Rigid, Skeleton};
use glam::DVec3;
use std::f64::consts::TAU;

/// The bones of the stem, and where they begin and end.
const STEM: [&str; 5] = ["stem 1", "stem 2", "stem 3", "stem 4", "stem 5"];
const HEIGHTS: [f64; 6] = [0.40, 0.70, 1.00, 1.30, 1.60, 1.92];
/// Ribs of the stem and of the arms.
const STEM_RIBS: usize = 11;
const ARM_RIBS: usize = 8;

/// An arm: on which bone of the stem it grows, the side (1: left), and its joints (aside, up).
struct Arm {
    name: &'static str,
    on: &'static str,
    side: f64,
    joints: [[f64; 2]; 4],
}

const ARMS: [Arm; 2] = [
    Arm { name: "long arm", on: "stem 2", side: 1.0, joints: [[0.16, 0.86], [0.40, 0.92], [0.44, 1.20], [0.44, 1.50]] },
    Arm {
        name: "short arm",
        on: "stem 3",
        side: -1.0,
        joints: [[0.15, 1.12], [0.36, 1.17], [0.40, 1.38], [0.40, 1.58]],
    },
];

/// A section of a ribbed limb: its centre, how far out the ribs are, how thick they are.
struct Section {
    at: DVec3,
    out: f64,
    rib: f64,
}

/// The cactus's bones, limbs and motions.
pub fn cactus() -> Body {
    let motions = [motion("bend", 2.4, bend), motion("wave", 2.0, greet), motion("collapse", 4.0, wilt)];
    let mut body = Body::new(0.030, &motions);
    body.softness = 1.6;
    body.bone("pot", None, [0.0, 0.0, 0.0], [0.0, 0.36, 0.0]);
    let mut parent = "pot";
    for (name, ends) in STEM.into_iter().zip(HEIGHTS.windows(2)) {
        body.bone(name, Some(parent), [0.0, ends[0], 0.0], [0.0, ends[1], 0.0]);
        parent = name;
    }
    for arm in &ARMS {
        let mut parent = arm.on.to_owned();
        for (i, ends) in arm.joints.windows(2).enumerate() {
            let name = format!("{} {}", arm.name, i + 1);
            let at = |[aside, up]: [f64; 2]| [arm.side * aside, up, 0.0];
            body.bone(&name, Some(&parent), at(ends[0]), at(ends[1]));
            parent = name;
        }
    }
    pot(&mut body);
    let section = |y: f64, out: f64, rib: f64| Section { at: DVec3::new(0.0, y, 0.0), out, rib };
    let sections = [
        section(0.34, 0.110, 0.042),
        section(0.55, 0.122, 0.046),
        section(0.95, 0.132, 0.050),
        section(1.40, 0.124, 0.048),
        section(1.70, 0.100, 0.042),
        section(1.84, 0.066, 0.036),
        section(1.91, 0.022, 0.030),
    ];
    let stem: Vec<&str> = std::iter::once("pot").chain(STEM).collect();
    ribbed(&mut body, &stem, &sections, STEM_RIBS);
    for arm in &ARMS {
        arm.grow(&mut body);
    }
    flower(&mut body);
    body
}

/// A pot with a rim, flat below and above.
fn pot(body: &mut Body) {
    let at = |y: f64, radius: f64| station(0.0, y, 0.0, radius, 0.08);
    body.limb_facing(&["pot"], 0.02, DVec3::Y, &[at(0.02, 0.200), at(0.16, 0.232), at(0.30, 0.262)]);
    body.limb_facing(&["pot"], 0.015, DVec3::Y, &[at(0.300, 0.292), at(0.345, 0.300)]);
}

/// A limb made of a core and ribs around it.
fn ribbed(body: &mut Body, bones: &[&str], sections: &[Section], ribs: usize) {
    let core: Vec<Station> = sections.iter().map(|s| Station { at: s.at, radius: s.out, flat: 1.0 }).collect();
    body.limb(bones, 0.03, &core);
    let ahead = |i: usize| {
        let (before, after) = (i.saturating_sub(1), (i + 1).min(sections.len() - 1));
        (sections[after].at - sections[before].at).normalize_or(DVec3::Y)
    };
    for rib in 0..ribs {
        let (sine, cosine) = (TAU * (rib as f64 + 0.5) / ribs as f64).sin_cos();
        let stations: Vec<Station> = sections
            .iter()
            .enumerate()
            .map(|(i, s)| {
                // Everything lies in the plane z = 0.
                let out = cosine * DVec3::Z + sine * DVec3::Z.cross(ahead(i));
                Station { at: s.at + s.out * out, radius: s.rib, flat: 1.0 }
            })
            .collect();
        body.limb(bones, 0.022, &stations);
    }
}

impl Arm {
    fn grow(&self, body: &mut Body) {
        let [root, elbow, middle, tip] = self.joints;
        let section = |[aside, up]: [f64; 2], out: f64, rib: f64| Section {
            at: DVec3::new(self.side * aside, up, 0.0),
            out,
            rib,
        };
        let between = |a: [f64; 2], b: [f64; 2], t: f64| [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
        let sections = [
            section([root[0] - 0.08, root[1] - 0.015], 0.062, 0.030),
            section(between(root, elbow, 0.35), 0.070, 0.032),
            section(between(root, elbow, 0.85), 0.074, 0.033),
            section(between(elbow, middle, 0.28), 0.076, 0.034),
            section(between(elbow, middle, 0.9), 0.076, 0.034),
            section(between(middle, tip, 0.6), 0.066, 0.032),
            section(between(middle, tip, 0.88), 0.042, 0.029),
            section(tip, 0.014, 0.024),
        ];
        let names: Vec<String> = (1..4).map(|i| format!("{} {i}", self.name)).collect();
        let bones: Vec<&str> = std::iter::once(self.on).chain(names.iter().map(String::as_str)).collect();
        ribbed(body, &bones, &sections, ARM_RIBS);
    }
}

/// A flower of six petals on top.
fn flower(body: &mut Body) {
    for petal in 0..6 {
        let (sine, cosine) = (TAU * f64::from(petal) / 6.0).sin_cos();
        let at = |out: f64, y: f64, radius: f64, flat: f64| station(out * sine, y, out * cosine, radius, flat);
        let facing = DVec3::new(-0.6 * sine, 1.0, -0.6 * cosine);
        body.limb_facing(
            &["stem 5"],
            0.012,
            facing,
            &[
                at(0.015, 1.925, 0.030, 0.8),
                at(0.055, 1.965, 0.038, 0.50),
                at(0.095, 2.00, 0.034, 0.48),
                at(0.122, 2.015, 0.018, 0.8),
            ],
        );
    }
}

/// Bones of the arms by name.
fn arms(turns: &mut Turns, bend: impl Fn(f64, usize) -> glam::DQuat) {
    for arm in &ARMS {
        for bone in 0..3 {
            turns.set(&format!("{} {}", arm.name, bone + 1), bend(arm.side, bone));
        }
    }
}

/// Sways from side to side in a curve that runs upwards.
fn bend(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    for (i, name) in STEM.into_iter().enumerate() {
        let own = phase - 0.085 * i as f64;
        turns.set(name, roll((12.0 + 2.0 * i as f64) * wave(own)) * pitch(5.0 * wave(2.0 * own + 0.1)));
    }
    arms(&mut turns, |side, bone| {
        let own = phase - 0.2 - 0.1 * bone as f64;
        roll([14.0, 16.0, 18.0][bone] * wave(own)) * pitch(side * 8.0 * wave(own + 0.25))
    });
    turns.pose(DVec3::ZERO)
}

/// Waves with its long arm.
fn greet(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    for (i, name) in STEM.into_iter().enumerate() {
        turns.set(name, roll(2.5 + 6.0 * wave(phase - 0.06 * i as f64)) * pitch(3.0 * wave(2.0 * phase)));
    }
    arms(&mut turns, |side, bone| {
        if side > 0.0 {
            roll([12.0, -6.0, -8.0][bone] + [8.0, 22.0, 26.0][bone] * wave(2.0 * phase - 0.12 * bone as f64))
        } else {
            roll([10.0, 9.0, 12.0][bone] * wave(phase - 0.1 * bone as f64))
        }
    });
    turns.pose(DVec3::ZERO)
}

/// How far it has wilted.
const WILTED: Curve =
    Curve(&[(0.0, 0.0), (0.08, 0.0), (0.42, 1.0), (0.50, 0.93), (0.60, 1.0), (0.66, 0.98), (0.92, 0.0)]);

/// Droops as if it had not been watered, and recovers.
fn wilt(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    for (i, name) in STEM.into_iter().enumerate() {
        let down = WILTED.at(phase - 0.015 * (4 - i) as f64);
        turns.set(name, pitch([10.0, 18.0, 27.0, 34.0, 36.0][i] * down) * roll(-5.0 * down + 2.0 * wave(phase)));
    }
    arms(&mut turns, |side, bone| {
        let down = WILTED.at(phase - 0.03 * (2 - bone) as f64);
        roll(-side * [20.0, 34.0, 30.0][bone] * down) * pitch([8.0, 6.0, 6.0][bone] * down)
    });
    turns.pose(DVec3::ZERO)
}
