//! Motion: periodic curves, and legs that reach for the ground.
//!
//! A foot on the ground moves back evenly, then swings forward through the air. From where the foot is and how it
//! is pitched, the two upper joints of the leg follow by the law of cosines, in the upright plane of the leg; the
//! bend of the joint between (carpus or hock of a quadruped) is given by a curve. Angles are in degrees and turn
//! about the x axis, positive ones nose down.

use super::skeleton::{Rigid, Skeleton};
use glam::{DQuat, DVec2, DVec3};
use std::f64::consts::TAU;

/// A periodic curve through (phase, value) keys with rising phases in 0..1.
#[derive(Clone, Copy, Debug)]
pub struct Curve(pub &'static [(f64, f64)]);

impl Curve {
    /// The value at a phase (any real number; only its fraction counts).
    pub fn at(&self, phase: f64) -> f64 {
        let keys = self.0;
        let count = keys.len() as i64;
        if count == 0 {
            return 0.0;
        }
        let phase = phase.rem_euclid(1.0);
        let after = keys.iter().take_while(|key| key.0 <= phase).count() as i64;
        let key = |i: i64| {
            let (p, v) = keys[i.rem_euclid(count) as usize];
            (p + i.div_euclid(count) as f64, v)
        };
        let slope = |i: i64| {
            let (before, here, next) = (key(i - 1), key(i), key(i + 1));
            // Level at peaks, so that the curve never leaves the range of its keys.
            if (here.1 - before.1) * (next.1 - here.1) <= 0.0 {
                return 0.0;
            }
            let (a, b) = ((here.1 - before.1) / (here.0 - before.0), (next.1 - here.1) / (next.0 - here.0));
            2.0 * a * b / (a + b)
        };
        let ((p0, v0), (p1, v1)) = (key(after - 1), key(after));
        let width = p1 - p0;
        let t = (phase - p0) / width;
        let (t2, t3) = (t * t, t * t * t);
        (2.0 * t3 - 3.0 * t2 + 1.0) * v0
            + (t3 - 2.0 * t2 + t) * width * slope(after - 1)
            + (3.0 * t2 - 2.0 * t3) * v1
            + (t3 - t2) * width * slope(after)
    }
}

/// A sine wave with one period a loop: `wave(phase)` is highest at 0.25.
pub fn wave(phase: f64) -> f64 {
    (TAU * phase).sin()
}

/// A turn about x in degrees.
pub fn pitch(degrees: f64) -> DQuat {
    DQuat::from_rotation_x(degrees.to_radians())
}

/// A turn about y in degrees; positive ones to the creature's left.
pub fn yaw(degrees: f64) -> DQuat {
    DQuat::from_rotation_y(degrees.to_radians())
}

/// A turn about z in degrees.
pub fn roll(degrees: f64) -> DQuat {
    DQuat::from_rotation_z(degrees.to_radians())
}

/// How a leg walks.
#[derive(Clone, Copy, Debug)]
pub struct Step {
    /// Share of the loop during which the foot is on the ground.
    pub duty: f64,
    /// How far the foot moves back meanwhile.
    pub stride: f64,
    /// How far in front of its place in the mesh the foot is in the middle of that.
    pub ahead: f64,
    /// How high the foot is lifted.
    pub lift: f64,
    /// Bend of the joint between the lower leg and the foot's bone (0 where a leg has none), by the leg's phase: 0 is
    /// when the foot meets the ground.
    pub bend: Curve,
    /// Pitch of the foot by the leg's phase; 0 is flat on the ground.
    pub foot: Curve,
}

/// The bones of a leg from the body down.
#[derive(Clone, Copy, Debug)]
pub struct Leg {
    /// Thigh, or shoulder and upper arm of a quadruped.
    pub upper: u32,
    /// Shank or forearm.
    pub lower: u32,
    /// The cannon bone of a quadruped.
    pub middle: Option<u32>,
    /// Foot or hoof.
    pub foot: u32,
    /// The places of the sole about which the foot tips: how far its back and its front end are before the joint (z).
    pub sole: [f64; 2],
}

impl Step {
    /// Where the sole is, relative to its place in the mesh: (up, forward).
    fn sole(&self, phase: f64) -> (f64, f64) {
        let phase = phase.rem_euclid(1.0);
        let half = 0.5 * self.stride;
        if phase < self.duty {
            return (0.0, self.ahead + half - self.stride * phase / self.duty);
        }
        let t = (phase - self.duty) / (1.0 - self.duty);
        // Leaves and meets the ground at the speed of the ground.
        let speed = -self.stride / self.duty * (1.0 - self.duty);
        let (t2, t3) = (t * t, t * t * t);
        let forward = (2.0 * t3 - 3.0 * t2 + 1.0) * -half
            + (t3 - 2.0 * t2 + t) * speed
            + (3.0 * t2 - 2.0 * t3) * half
            + (t3 - t2) * speed;
        // Highest a little before the middle.
        let up = (std::f64::consts::PI * t.powf(0.85)).sin().powi(2);
        (self.lift * up, self.ahead + forward)
    }

    /// Turns the bones of a leg so that its foot is where the step wants it. `turns` holds the turns of all bones
    /// relative to their parents; the parents of the leg must be set already.
    pub fn place(&self, leg: &Leg, phase: f64, skeleton: &Skeleton, shift: DVec3, turns: &mut [DQuat]) {
        let joint = |bone: u32| plane(skeleton.bones[bone as usize].joint);
        let (hip, knee, ankle) = (joint(leg.upper), joint(leg.lower), joint(leg.foot));
        let middle = leg.middle.map_or(ankle, joint);
        let carried: Rigid = skeleton.pose(turns, shift)[leg.upper as usize];
        let carrier = carried.turn * turns[leg.upper as usize].inverse();
        let from = plane(carried.apply(skeleton.bones[leg.upper as usize].joint));

        let foot = self.foot.at(phase).to_radians();
        let (up, forward) = self.sole(phase);
        let (up, forward) = (skeleton.stride * up, skeleton.stride * forward);
        // The foot tips about its toe when the heel rises, about its heel when the toe rises.
        let pivot = DVec2::new(0.0, ankle.y + leg.sole[usize::from(foot > 0.0)]);
        let target = pivot + DVec2::new(up, forward) + turned(foot, ankle - pivot);

        let bend = self.bend.at(phase).to_radians();
        let (thigh, shank) = (knee - hip, (middle - knee) + turned(bend, ankle - middle));
        let (u, v) = (thigh.length(), shank.length());
        let straight = target - from;
        let reach = straight.length().clamp((u - v).abs() * 1.001 + 1e-9, 0.9995 * (u + v));
        let cosine = (u * u + reach * reach - v * v) / (2.0 * u * reach);
        let side = (ankle - hip).perp_dot(thigh).signum();
        let towards = turned(side * cosine.clamp(-1.0, 1.0).acos(), straight.normalize_or_zero());
        let upper = angle(thigh, towards);
        let lower = angle(shank, straight.normalize_or_zero() * reach - towards * u);

        let world = |angle: f64| DQuat::from_rotation_x(angle);
        turns[leg.upper as usize] = carrier.inverse() * world(upper);
        turns[leg.lower as usize] = world(lower - upper);
        let above = match leg.middle {
            Some(middle) => {
                turns[middle as usize] = world(bend);
                lower + bend
            }
            None => lower,
        };
        turns[leg.foot as usize] = world(foot - above);
    }
}

/// The upright plane of a leg as (up, forward): a turn about x is a turn of this plane.
fn plane(p: DVec3) -> DVec2 {
    DVec2::new(p.y, p.z)
}

fn turned(angle: f64, v: DVec2) -> DVec2 {
    DVec2::from_angle(angle).rotate(v)
}

/// The angle that turns the direction of `a` to that of `b`.
fn angle(a: DVec2, b: DVec2) -> f64 {
    a.perp_dot(b).atan2(a.dot(b))
}
