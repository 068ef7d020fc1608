//! Bones, and where they are in a pose.

use glam::{DQuat, DVec3};

/// A bone in the pose in which the mesh was made.
#[derive(Clone, Debug, PartialEq)]
pub struct Bone {
    /// What people call it; bones of one name correspond between creatures of one body plan.
    pub name: String,
    /// The bone that carries it: a smaller number; `None` for the first.
    pub parent: Option<u32>,
    /// The joint about which it turns.
    pub joint: DVec3,
    /// Its other end.
    pub end: DVec3,
    /// How thick the limb around it is at the joint (its radius; 0 where there is none).
    pub radius: f64,
}

/// The bones of a creature; parents come before their children.
#[derive(Clone, Debug, PartialEq)]
pub struct Skeleton {
    /// The bones.
    pub bones: Vec<Bone>,
    /// How much longer the legs are than those that its motions were made for.
    pub stride: f64,
    /// How high the underside of the first bone's body is.
    pub belly: f64,
}

impl Default for Skeleton {
    fn default() -> Self {
        Self { bones: Vec::new(), stride: 1.0, belly: 0.0 }
    }
}

/// A rigid motion: turn about the origin, then shift.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rigid {
    /// The turn.
    pub turn: DQuat,
    /// The shift.
    pub shift: DVec3,
}

impl Rigid {
    /// No motion.
    pub const REST: Self = Self { turn: DQuat::IDENTITY, shift: DVec3::ZERO };

    /// Where a point goes.
    pub fn apply(&self, p: DVec3) -> DVec3 {
        self.turn * p + self.shift
    }

    /// The turn about a point that also takes the point `from` to `to`.
    pub fn about(turn: DQuat, from: DVec3, to: DVec3) -> Self {
        Self { turn, shift: to - turn * from }
    }
}

impl Skeleton {
    /// Adds a bone with the given parent (by name) and returns its number.
    pub fn add(&mut self, name: &str, parent: Option<&str>, joint: DVec3, end: DVec3) -> u32 {
        let parent = parent.and_then(|p| self.find(p));
        self.bones.push(Bone { name: name.to_owned(), parent, joint, end, radius: 0.0 });
        self.bones.len() as u32 - 1
    }

    /// The number of the bone of that name.
    pub fn find(&self, name: &str) -> Option<u32> {
        self.bones.iter().position(|bone| bone.name == name).map(|i| i as u32)
    }

    /// The motion of every bone from the pose of the mesh, given the turn of every bone relative to its parent and
    /// the shift of the root.
    pub fn pose(&self, turns: &[DQuat], shift: DVec3) -> Vec<Rigid> {
        let mut motions: Vec<Rigid> = Vec::with_capacity(self.bones.len());
        for (bone, &turn) in self.bones.iter().zip(turns) {
            let carried = bone.parent.map_or(Rigid { turn: DQuat::IDENTITY, shift }, |p| motions[p as usize]);
            let turned = (carried.turn * turn).normalize();
            motions.push(Rigid::about(turned, bone.joint, carried.apply(bone.joint)));
        }
        motions
    }
}
