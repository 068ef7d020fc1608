//! Creatures made by code, each with its true parts.
//!
//! A creature's own file ([`horse`], [`camel`], [`person`], [`dinosaur`], [`snake`], [`hand`]) describes its bones, the
//! limbs around them and how it moves. The rest is common: [`limb`]s are joined to a [`field`], the [`mesher`] makes a closed mesh of
//! it, [`weights`] tie the mesh to the bones of the [`skeleton`], and [`gait`]s move them.
//!
//! Creatures stand on the ground y = 0, y is up, and they face +z; their left is +x. Lengths are about metres.

pub mod body;
pub mod camel;
pub mod correspondence;
pub mod dinosaur;
pub mod extract;
pub mod field;
pub mod gait;
pub mod hand;
pub mod horse;
pub mod landmarks;
pub mod limb;
pub mod mesher;
pub mod person;
pub mod quadruped;
pub mod skeleton;
pub mod snake;
pub mod surface;
pub mod weights;

use crate::sequence::{Pose, Sequence};
pub use correspondence::correspondences;
pub use landmarks::{landmark_pairs, landmarks};

use body::Body;
use glam::DVec3;
use skeleton::{Rigid, Skeleton};
use weights::{Binder, Weights};

/// A creature: a moving mesh whose parts are known.
#[derive(Clone, Debug)]
pub struct Creature {
    /// The mesh and one loop of its motion.
    pub sequence: Sequence,
    /// #F true part numbers: the bone that each face follows most. Where every vertex follows one bone, that of most
    /// of its corners (of its first corner if all three differ); else the one with the largest weight summed over its
    /// corners.
    pub labels: Vec<u32>,
    /// The name of each part: of the bone of that number.
    pub parts: Vec<String>,
    /// The bones, one a part.
    pub skeleton: Skeleton,
    /// #V: the bones that each vertex follows.
    pub weights: Vec<Weights>,
    /// The body plan: between creatures of one plan there are true [`correspondences`].
    pub plan: &'static str,
    /// #V positions in which the mesh was made and the skeleton is given; the reference pose itself, except for
    /// creatures that were made in another pose than they stand in.
    pub made: Vec<DVec3>,
}

/// What to make.
#[derive(Clone, Debug, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(default, rename_all = "kebab-case")]
pub struct Recipe {
    /// One of [`NAMES`].
    pub name: String,
    /// About how many faces (1,000 to 1,000,000).
    pub faces: usize,
    /// Number of poses in one loop of the motion.
    pub poses: usize,
    /// Every vertex follows exactly one bone, instead of a smooth blend.
    pub exact: bool,
}

impl Default for Recipe {
    fn default() -> Self {
        Self { name: "horse".into(), faces: 12_000, poses: 24, exact: false }
    }
}

/// The creatures there are.
pub const NAMES: &[&str] = &["horse", "camel", "person", "person-arms-out", "dinosaur", "snake", "hand"];

/// What to call a creature in front of people.
pub fn title(name: &str) -> &str {
    match name {
        "horse" => "Horse",
        "camel" => "Camel",
        "person" => "Person",
        "person-arms-out" => "Person, arms out",
        "dinosaur" => "Dinosaur",
        "snake" => "Snake",
        "hand" => "Hand",
        other => other,
    }
}

/// Makes a creature; `None` if there is none of that name.
///
/// The number of faces is brought into 1,000 to 1,000,000 and the number of poses into 1 to 240.
pub fn make(recipe: &Recipe) -> Option<Creature> {
    let (plan, body) = match recipe.name.as_str() {
        "horse" => ("quadruped", horse::horse()),
        "camel" => ("quadruped", camel::camel()),
        "person" => ("biped", person::person()),
        "person-arms-out" => ("biped", person::person_arms_out()),
        "dinosaur" => ("dinosaur", dinosaur::dinosaur()),
        "snake" => ("snake", snake::snake()),
        "hand" => ("hand", hand::hand()),
        _ => return None,
    };
    build(recipe, plan, &body)
}

fn build(recipe: &Recipe, plan: &'static str, body: &Body) -> Option<Creature> {
    let faces = recipe.faces.clamp(1_000, 1_000_000);
    let poses = recipe.poses.clamp(1, 240);
    let field = field::Field::new(&body.limbs, body.grounded);
    let (made, faces) = mesher::mesh(&field, faces, body.thinnest)?;
    let binder = Binder::new(&body.limbs, &body.skeleton, body.softness);
    let weights: Vec<Weights> =
        made.iter().map(|&p| if recipe.exact { vec![(binder.exact(p), 1.0)] } else { binder.smooth(p) }).collect();
    let labels = faces.iter().map(|corners| label(corners.map(|v| &weights[v as usize]))).collect();
    let motion = &body.motion;
    let reference = skin(&made, &weights, &(motion.stance)(&body.skeleton));
    let poses = (0..poses)
        .map(|i| {
            let phase = i as f64 / poses as f64;
            let time = phase * motion.period;
            let positions = grounded(skin(&made, &weights, &(motion.gait)(&body.skeleton, phase)));
            Pose { name: format!("{time:.3} s"), time, positions }
        })
        .collect();
    Some(Creature {
        sequence: Sequence::new(recipe.name.clone(), faces, reference, poses).ok()?,
        labels,
        parts: body.skeleton.bones.iter().map(|bone| bone.name.clone()).collect(),
        skeleton: body.skeleton.clone(),
        weights,
        plan,
        made,
    })
}

/// Linear blend skinning.
fn skin(points: &[DVec3], weights: &[Weights], motions: &[Rigid]) -> Vec<DVec3> {
    let follow = |p: DVec3, bone: u32| motions.get(bone as usize).map_or(p, |motion| motion.apply(p));
    points.iter().zip(weights).map(|(&p, w)| w.iter().map(|&(bone, weight)| weight * follow(p, bone)).sum()).collect()
}

/// Shifts points so that the lowest is at y = 0.
fn grounded(mut points: Vec<DVec3>) -> Vec<DVec3> {
    let lowest = points.iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    for p in &mut points {
        p.y -= lowest;
    }
    points
}

/// The bone with the largest sum over the corners; of equals, the one met first.
fn label(corners: [&Weights; 3]) -> u32 {
    let mut sums: Vec<(u32, f64)> = Vec::with_capacity(4);
    for &(bone, weight) in corners.into_iter().flatten() {
        match sums.iter_mut().find(|s| s.0 == bone) {
            Some(sum) => sum.1 += weight,
            None => sums.push((bone, weight)),
        }
    }
    sums.into_iter().reduce(|best, next| if next.1 > best.1 { next } else { best }).map_or(0, |best| best.0)
}

#[cfg(test)]
mod tests;
