//! Creatures made by code, each with its true parts.
//!
//! A creature's own file ([`horse`], [`elephant`], [`bird`], [`octopus`], …) describes its bones, the limbs around them
//! and how it moves. The rest is common: [`limb`]s are joined to a [`field`], the [`mesher`] makes a closed mesh of
//! it, [`weights`] tie the mesh to the bones of the [`skeleton`], and [`gait`]s move them; [`proportions`] change a body before that. The [`robot`] is
//! made of rigid [`pieces`] instead, and the [`cloth`] moves by itself.
//!
//! Creatures stand on the ground y = 0, y is up, and they face +z; their left is +x. Lengths are about metres.

pub mod bird;
pub mod body;
pub mod cactus;
pub mod camel;
pub mod cat;
pub mod cloth;
pub mod correspondence;
pub mod dinosaur;
pub mod dog;
pub mod elephant;
pub mod extract;
pub mod field;
pub mod gait;
pub mod giraffe;
pub mod hand;
pub mod horse;
pub mod landmarks;
pub mod limb;
pub mod lying;
pub mod mesher;
pub mod octopus;
pub mod person;
pub mod pieces;
pub mod proportions;
pub mod quadruped;
pub mod robot;
pub mod skeleton;
pub mod snake;
pub mod surface;
pub mod weights;

use crate::sequence::{Pose, Sequence};
pub use correspondence::correspondences;
pub use landmarks::{landmark_pairs, landmarks};

use body::{Body, Motion};
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
///
/// Proportions are 1 for the creature as it was designed and are brought into 0.5 to 2; what a creature does not have
/// is not changed.
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
    /// What it does: one of its [`motions`]; empty for the first of them.
    pub motion: String,
    /// Size of everything (0.01 to 100).
    pub size: f64,
    /// How thick body and limbs are.
    pub build: f64,
    /// Size of the head.
    pub head: f64,
    /// Length of the neck.
    pub neck: f64,
    /// Length of the legs.
    pub legs: f64,
    /// Length of arms or wings.
    pub arms: f64,
    /// Length of the tail.
    pub tail: f64,
}

impl Default for Recipe {
    fn default() -> Self {
        Self {
            name: "horse".into(),
            faces: 12_000,
            poses: 24,
            exact: false,
            motion: String::new(),
            size: 1.0,
            build: 1.0,
            head: 1.0,
            neck: 1.0,
            legs: 1.0,
            arms: 1.0,
            tail: 1.0,
        }
    }
}

/// The creatures there are.
pub const NAMES: &[&str] = &[
    "horse",
    "camel",
    "giraffe",
    "dog",
    "cat",
    "elephant",
    "person",
    "person-arms-out",
    "person-broad",
    "person-small",
    "dinosaur",
    "bird",
    "hand",
    "snake",
    "octopus",
    "cactus",
    "robot",
    "cloth",
];

/// What to call a creature in front of people.
pub fn title(name: &str) -> &str {
    match name {
        "horse" => "Horse",
        "camel" => "Camel",
        "giraffe" => "Giraffe",
        "dog" => "Dog",
        "cat" => "Cat",
        "elephant" => "Elephant",
        "person" => "Person",
        "person-arms-out" => "Person, arms out",
        "person-broad" => "Person, broad",
        "person-small" => "Person, small",
        "dinosaur" => "Dinosaur",
        "bird" => "Bird",
        "hand" => "Hand",
        "snake" => "Snake",
        "octopus" => "Octopus",
        "cactus" => "Cactus",
        "robot" => "Robot",
        "cloth" => "Cloth",
        other => other,
    }
}

/// The names of the motions of a creature, the usual one first; empty if there is no such creature.
pub fn motions(name: &str) -> Vec<&'static str> {
    if name == "cloth" {
        return cloth::MOTIONS.map(|motion| motion.0).to_vec();
    }
    body(name).map_or(Vec::new(), |(_, body)| body.motions.iter().map(|motion| motion.name).collect())
}

/// The body plan and the body of a creature.
fn body(name: &str) -> Option<(&'static str, Body)> {
    Some(match name {
        "horse" => ("quadruped", horse::horse()),
        "camel" => ("quadruped", camel::camel()),
        "giraffe" => ("quadruped", giraffe::giraffe()),
        "dog" => ("quadruped", dog::dog()),
        "cat" => ("quadruped", cat::cat()),
        "elephant" => ("quadruped", elephant::elephant()),
        "person" | "person-broad" | "person-small" => ("biped", person::person()),
        "person-arms-out" => ("biped", person::person_arms_out()),
        "dinosaur" => ("dinosaur", dinosaur::dinosaur()),
        "bird" => ("bird", bird::bird()),
        "hand" => ("hand", hand::hand()),
        "snake" => ("snake", snake::snake()),
        "octopus" => ("octopus", octopus::octopus()),
        "cactus" => ("cactus", cactus::cactus()),
        "robot" => ("biped", robot::robot()),
        _ => return None,
    })
}

/// The recipe of a variant in terms of the creature that it is a variant of.
fn of_variant(recipe: &Recipe) -> Recipe {
    let Recipe { size, build, head, neck, legs, arms, .. } = *recipe;
    match recipe.name.as_str() {
        "person-broad" => {
            Recipe { build: 1.34 * build, head: 1.06 * head, legs: 0.95 * legs, arms: 0.98 * arms, ..recipe.clone() }
        }
        // A child of about four years.
        "person-small" => Recipe {
            size: 0.64 * size,
            build: 1.04 * build,
            head: 1.38 * head,
            neck: 0.9 * neck,
            legs: 0.86 * legs,
            arms: 0.88 * arms,
            ..recipe.clone()
        },
        _ => recipe.clone(),
    }
}

/// Makes a creature; `None` if there is none of that name or if it has no such motion.
///
/// The number of faces is brought into 1,000 to 1,000,000 and the number of poses into 1 to 240.
pub fn make(recipe: &Recipe) -> Option<Creature> {
    if recipe.name == "cloth" {
        return build_cloth(recipe);
    }
    let recipe = &of_variant(recipe);
    let (plan, mut body) = body(&recipe.name)?;
    proportions::reshape(&mut body, recipe);
    let motion = match recipe.motion.as_str() {
        "" => *body.motions.first()?,
        name => *body.motions.iter().find(|motion| motion.name == name)?,
    };
    build(recipe, plan, &body, &motion)
}

/// A mesh and which bones each of its vertices follows.
type Tied = (Vec<DVec3>, Vec<[u32; 3]>, Vec<Weights>);

/// One skin around all limbs.
fn grown(recipe: &Recipe, body: &Body) -> Option<Tied> {
    let field = field::Field::new(&body.limbs, body.grounded);
    let (made, faces) = mesher::mesh(&field, recipe.faces.clamp(1_000, 1_000_000), body.thinnest)?;
    let binder = Binder::new(&body.limbs, &body.skeleton, body.softness);
    let weights =
        made.iter().map(|&p| if recipe.exact { vec![(binder.exact(p), 1.0)] } else { binder.smooth(p) }).collect();
    Some((made, faces, weights))
}

/// Rigid pieces.
fn assembled(recipe: &Recipe, body: &Body) -> Tied {
    let (made, faces, bones) = pieces::mesh(&body.pieces, recipe.faces.clamp(1_000, 1_000_000));
    (made, faces, bones.into_iter().map(|bone| vec![(bone, 1.0)]).collect())
}

/// The cloth has one part and no bones to speak of; it moves by itself.
fn build_cloth(recipe: &Recipe) -> Option<Creature> {
    let wanted = |motion: &&(&str, f64)| recipe.motion.is_empty() || recipe.motion == motion.0;
    let &(motion, period) = cloth::MOTIONS.iter().find(wanted)?;
    let cloth = cloth::cloth(recipe);
    let scale = proportions::size(recipe);
    let flat: Vec<DVec3> = cloth.flat().into_iter().map(|p| scale * p).collect();
    let poses = poses(recipe, period, |phase| cloth.pose(motion, phase));
    let mut skeleton = Skeleton::default();
    let end = |t: f64| scale * DVec3::new(0.0, 1.4, t);
    skeleton.add("cloth", None, end(0.9), end(-0.9));
    Some(Creature {
        labels: vec![0; cloth.faces.len()],
        parts: vec!["cloth".into()],
        weights: vec![vec![(0, 1.0)]; flat.len()],
        plan: "cloth",
        made: flat.clone(),
        skeleton,
        sequence: Sequence::new(recipe.name.clone(), cloth.faces, flat, poses).ok()?,
    })
}

fn build(recipe: &Recipe, plan: &'static str, body: &Body, motion: &Motion) -> Option<Creature> {
    let (made, faces, weights) = if body.pieces.is_empty() { grown(recipe, body)? } else { assembled(recipe, body) };
    let labels = faces.iter().map(|corners| label(corners.map(|v| &weights[v as usize]))).collect();
    let reference = skin(&made, &weights, &(body.stance)(&body.skeleton));
    let pose = |phase: f64| {
        let posed = skin(&made, &weights, &(motion.gait)(&body.skeleton, phase));
        if motion.grounded { grounded(posed) } else { posed }
    };
    let poses = poses(recipe, motion.period, pose);
    let scale = proportions::size(recipe);
    let larger = |points: Vec<DVec3>| points.into_iter().map(|p| scale * p).collect();
    let mut skeleton = body.skeleton.clone();
    for bone in &mut skeleton.bones {
        bone.joint *= scale;
        bone.end *= scale;
        bone.radius *= scale;
    }
    skeleton.belly *= scale;
    Some(Creature {
        sequence: Sequence::new(recipe.name.clone(), faces, larger(reference), poses).ok()?,
        labels,
        parts: skeleton.bones.iter().map(|bone| bone.name.clone()).collect(),
        skeleton,
        weights,
        plan,
        made: larger(made),
    })
}

/// The poses of a loop of so many seconds; `pose` gives the positions at a phase, before they are enlarged.
fn poses(recipe: &Recipe, period: f64, pose: impl Fn(f64) -> Vec<DVec3>) -> Vec<Pose> {
    let (count, scale) = (recipe.poses.clamp(1, 240), proportions::size(recipe));
    let one = |i: usize| {
        let phase = i as f64 / count as f64;
        let time = phase * period;
        let positions = pose(phase).into_iter().map(|p| scale * p).collect();
        Pose { name: format!("{time:.3} s"), time, positions }
    };
    (0..count).map(one).collect()
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
