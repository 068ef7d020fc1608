//! Four-legged creatures that collapse: the trunk sinks until it lies, the legs fold beside it, and neck and tail are
//! laid on the ground.
//!
//! How far a bone is turned follows from how high its end comes to lie: as high as the limb is thick there. So no
//! creature hovers or sinks in, whatever its proportions.

use super::body::Turns;
use super::gait::{Curve, pitch, roll, yaw};
use super::quadruped::{FORE, HIND, PROBOSCIS};
use super::skeleton::{Rigid, Skeleton};
use glam::{DQuat, DVec3};

/// How far down a creature is that collapses, rests and stands up again.
const DOWN: Curve = Curve(&[(0.0, 0.0), (0.06, 0.05), (0.30, 1.0), (0.64, 1.0), (0.92, 0.0)]);

/// How far the trunk leans to a side when it lies, in degrees.
const LEAN: f64 = 3.0;
/// How far upper legs lean outwards, so that the rest of the leg lies beside the trunk, in degrees.
const ASIDE: f64 = 24.0;
/// The same of cannon bones, which lie beside the bone above them, in degrees.
const CANNON_ASIDE: f64 = 16.0;
/// Bones of the neck and the head lie this many times as high as they are thick: manes and jaws need room.
const ROOM: f64 = 1.25;
/// How steep the neck, the tail and an elephant's trunk may hang at most, in degrees from straight down.
const STEEPEST: [f64; 3] = [52.0, 30.0, 8.0];
/// How much earlier an elephant's trunk moves than its body, as a share of the loop.
const NOSE_AHEAD: f64 = 0.06;
/// Halvings of the interval in which the folding of a leg is sought.
const HALVINGS: usize = 30;

/// Which way a bone of a leg lies.
#[derive(Clone, Copy, PartialEq)]
enum Way {
    Ahead,
    Back,
    /// As it stands: a foot on its sole.
    Flat,
}

use Way::{Ahead, Back, Flat};

/// Fore legs folded under the breast, as hoofed animals lie; and the hind legs with them.
const FOLDED: [[Way; 4]; 2] = [[Back, Ahead, Back, Back], [Ahead, Back, Ahead, Ahead]];
/// Fore legs ahead, paws on their soles, as dogs lie.
const PAWS_AHEAD: [[Way; 4]; 2] = [[Back, Ahead, Ahead, Flat], [Ahead, Back, Ahead, Flat]];

/// The legs give way, the body sinks to the ground, the neck follows; then it stands up again. The fore feet are folded
/// under the breast.
pub fn collapse_folded(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    collapse(skeleton, phase, &FOLDED)
}

/// The same with the fore feet ahead.
pub fn collapse_ahead(skeleton: &Skeleton, phase: f64) -> Vec<Rigid> {
    collapse(skeleton, phase, &PAWS_AHEAD)
}

fn collapse(skeleton: &Skeleton, phase: f64, ways: &[[Way; 4]; 2]) -> Vec<Rigid> {
    let mut turns = Turns::new(skeleton);
    let (down, limp) = (DOWN.at(phase), DOWN.at(phase - 0.03));
    let shift = DVec3::new(0.0, -skeleton.belly * down, 0.0);
    turns.set("trunk", roll(LEAN * down));
    for (side, sign) in [("left", 1.0), ("right", -1.0)] {
        for (names, ways) in [FORE, HIND].into_iter().zip(ways) {
            fold(&mut turns, skeleton, shift, names.map(|name| name.replace('*', side)), ways, sign);
        }
        turns.set(&format!("{side} ear"), yaw(-12.0 * sign * limp));
    }
    let nose = skeleton.find(PROBOSCIS[0]).is_some();
    // An elephant keeps its head up: the tusks are in the way.
    if nose {
        turns.set("upper neck", yaw(8.0 * limp));
    } else {
        lay(&mut turns, skeleton, shift, &["lower neck", "upper neck", "head"], [1.0, STEEPEST[0], ROOM], limp);
    }
    // What touches the ground already gives way first.
    lay(&mut turns, skeleton, shift, &PROBOSCIS, [1.0, STEEPEST[2], 1.0], DOWN.at(phase + NOSE_AHEAD).max(down));
    lay(&mut turns, skeleton, shift, &["tail root", "tail", "tail tip"], [-1.0, STEEPEST[1], 1.0], limp);
    turns.pose(shift)
}

/// A bone in the upright plane: its length, and how many degrees before straight down it points at rest.
fn measure(skeleton: &Skeleton, bone: u32) -> (f64, f64) {
    let bone = &skeleton.bones[bone as usize];
    let along = bone.end - bone.joint;
    (along.z.hypot(along.y), along.z.atan2(-along.y).to_degrees())
}

/// How high the end of a bone lies: the thickness at the joint of the next, or its own.
fn thickness(skeleton: &Skeleton, chain: &[u32], i: usize) -> f64 {
    let bone = chain.get(i + 1).unwrap_or(&chain[i]);
    skeleton.bones[*bone as usize].radius
}

/// How many degrees from straight down a bone points that leads from one height to another, and where it ends.
fn slope(from: f64, to: f64, length: f64, steepest: f64) -> (f64, f64) {
    let cosine = ((from - to) / length.max(1e-9)).clamp(-1.0, steepest.to_radians().cos());
    (cosine.acos().to_degrees(), from - length * cosine)
}

/// The turn of what carries a bone, and where its joint is.
fn carrier(turns: &Turns, skeleton: &Skeleton, shift: DVec3, bone: u32) -> (DQuat, DVec3) {
    let pose = turns.pose(shift);
    let bone = &skeleton.bones[bone as usize];
    let carrier = bone.parent.map_or(Rigid { turn: DQuat::IDENTITY, shift }, |parent| pose[parent as usize]);
    (carrier.turn, carrier.apply(bone.joint))
}

/// Lays a chain of bones on the ground, ahead or back (`way`: 1 or −1), no steeper than so many degrees; bones lie
/// `room` times as high as they are thick. `amount` is how far that is done already.
fn lay(turns: &mut Turns, skeleton: &Skeleton, shift: DVec3, names: &[&str], how: [f64; 3], amount: f64) {
    let [way, steepest, room] = how;
    let chain: Vec<u32> = names.iter().filter_map(|name| skeleton.find(name)).collect();
    let Some(&first) = chain.first() else { return };
    let (mut carried, joint) = carrier(turns, skeleton, shift, first);
    // Where the joint will be when everything lies: half way down, bones already turn to where they will lie.
    let mut height = joint.y - skeleton.belly - shift.y;
    for (i, &bone) in chain.iter().enumerate() {
        let (length, rest) = measure(skeleton, bone);
        let (angle, end) = slope(height, room * thickness(skeleton, &chain, i), length, steepest);
        let world = pitch(amount * nearest_turn(rest - way * angle));
        turns.turns[bone as usize] = carried.inverse() * world;
        (carried, height) = (world, end);
    }
}

/// The same turn between −180° and 180°.
fn nearest_turn(degrees: f64) -> f64 {
    (degrees + 180.0).rem_euclid(360.0) - 180.0
}

/// One bone of a leg in the upright plane.
struct Part {
    length: f64,
    /// Degrees before straight down, standing and lying.
    directions: [f64; 2],
    /// Degrees that it leans outwards when it lies.
    aside: f64,
    /// How high its end lies.
    clear: f64,
}

impl Part {
    /// How far the end is below the beginning.
    fn drop(&self, amount: f64) -> f64 {
        let direction = self.directions[0] + amount * (self.directions[1] - self.directions[0]);
        self.length * direction.to_radians().cos() * (amount * self.aside).to_radians().cos()
    }

    /// Its turn in space.
    fn turn(&self, amount: f64, sign: f64) -> DQuat {
        let direction = self.directions[0] + amount * (self.directions[1] - self.directions[0]);
        let (sine, cosine) = direction.to_radians().sin_cos();
        let outwards = DVec3::new(0.0, -cosine, sine).cross(sign * DVec3::X);
        DQuat::from_axis_angle(outwards, (amount * self.aside).to_radians())
            * pitch(amount * (self.directions[0] - self.directions[1]))
    }
}

/// Folds a leg as far as the height of the trunk demands, so that it touches the ground and does not sink in.
fn fold(turns: &mut Turns, skeleton: &Skeleton, shift: DVec3, names: [String; 4], ways: &[Way; 4], sign: f64) {
    let chain: Vec<u32> = names.iter().filter_map(|name| skeleton.find(name)).collect();
    let Some(&first) = chain.first() else { return };
    let (mut carried, joint) = carrier(turns, skeleton, shift, first);
    let rest = skeleton.bones[first as usize].joint.y;
    let parts = parts(skeleton, &chain, ways, rest - skeleton.belly);
    let lowest = |amount: f64| {
        let mut height = joint.y;
        let ends = parts.iter().map(|part| {
            height -= part.drop(amount);
            // Bones are as high as they are thick only when they lie; before that the sole bears the leg.
            height - amount.powi(3) * part.clear
        });
        ends.fold(f64::INFINITY, f64::min)
    };
    // The less a leg is folded, the deeper it reaches.
    let (mut low, mut high) = (0.0, 1.0);
    for _ in 0..HALVINGS {
        let middle = 0.5 * (low + high);
        if lowest(middle) < 0.0 { low = middle } else { high = middle }
    }
    let amount = if lowest(0.0) >= -1e-9 { 0.0 } else { high };
    for (&bone, part) in chain.iter().zip(&parts) {
        let world = part.turn(amount, sign);
        turns.turns[bone as usize] = carried.inverse() * world;
        carried = world;
    }
}

/// The bones of a leg, and how they lie when the upper joint is at `height`.
fn parts(skeleton: &Skeleton, chain: &[u32], ways: &[Way; 4], mut height: f64) -> Vec<Part> {
    let mut parts = Vec::with_capacity(chain.len());
    for (i, (&bone, &way)) in chain.iter().zip(ways).enumerate() {
        let (length, rest) = measure(skeleton, bone);
        let aside = [ASIDE, 0.0, CANNON_ASIDE, 0.0][i];
        // A foot on its sole begins as high as it does standing, and ends on the ground.
        let next_flat = ways.get(i + 1) == Some(&Flat);
        let wanted = match chain.get(i + 1) {
            Some(&foot) if next_flat => skeleton.bones[foot as usize].joint.y,
            _ => thickness(skeleton, chain, i),
        };
        let upright = length * aside.to_radians().cos();
        let (direction, end) = match way {
            Flat => (rest, height - upright * rest.to_radians().cos()),
            _ => {
                let (angle, end) = slope(height, wanted, upright, 0.0);
                (if way == Ahead { angle } else { -angle }, end)
            }
        };
        parts.push(Part { length, directions: [rest, direction], aside, clear: end.max(0.0) });
        height = end;
    }
    parts
}
