//! Named places on creatures, as an anatomist would point at them, and which of them belong together.
//!
//! A place is found from the skeleton: a ray from a point of a bone outwards, or along the bone beyond its tip, meets the
//! surface there. So it is the same place whatever the size of the mesh.

use super::Creature;
use super::correspondence::crossed;
use glam::DVec3;

/// A named place: on which bone, and where.
#[derive(Clone, Copy)]
struct Place {
    name: &'static str,
    bone: &'static str,
    at: At,
}

#[derive(Clone, Copy)]
enum At {
    /// Where the bone points to.
    Tip,
    /// So far along the bone (0 at its joint, 1 at its end), in a direction (on the left side, where there are two).
    Side(f64, [f64; 3]),
    /// On a flat cloth: along from the pole, up.
    Cloth(f64, f64),
}

const fn tip(name: &'static str, bone: &'static str) -> Place {
    Place { name, bone, at: At::Tip }
}

const fn side(name: &'static str, bone: &'static str, along: f64, direction: [f64; 3]) -> Place {
    Place { name, bone, at: At::Side(along, direction) }
}

const fn cloth(name: &'static str, along: f64, up: f64) -> Place {
    Place { name, bone: "cloth", at: At::Cloth(along, up) }
}

const UP: [f64; 3] = [0.0, 1.0, 0.0];
const DOWN: [f64; 3] = [0.0, -1.0, 0.0];
const FRONT: [f64; 3] = [0.0, 0.0, 1.0];
const BACK: [f64; 3] = [0.0, 0.0, -1.0];
const LEFT: [f64; 3] = [1.0, 0.0, 0.0];
const RIGHT: [f64; 3] = [-1.0, 0.0, 0.0];

/// Of everything on four legs.
const QUADRUPED: &[Place] = &[
    tip("muzzle", "head"),
    side("poll", "head", 0.0, [0.0, 1.0, -0.3]),
    side("crest", "upper neck", 0.1, [0.0, 1.0, -0.6]),
    side("throat", "upper neck", 0.1, [0.0, -0.6, 1.0]),
    side("breast", "lower neck", 0.1, [0.0, -0.6, 1.0]),
    side("back", "trunk", 0.5, UP),
    side("belly", "trunk", 0.5, DOWN),
    side("croup", "tail root", 0.1, UP),
    tip("tail tip", "tail tip"),
    side("left shoulder", "left upper arm", 0.2, LEFT),
    side("right shoulder", "right upper arm", 0.2, LEFT),
    side("left elbow", "left forearm", 0.1, BACK),
    side("right elbow", "right forearm", 0.1, BACK),
    side("left carpus", "left fore cannon", 0.05, FRONT),
    side("right carpus", "right fore cannon", 0.05, FRONT),
    side("left fore foot", "left fore foot", 0.6, FRONT),
    side("right fore foot", "right fore foot", 0.6, FRONT),
    side("left hip", "left thigh", 0.2, LEFT),
    side("right hip", "right thigh", 0.2, LEFT),
    side("left stifle", "left gaskin", 0.05, FRONT),
    side("right stifle", "right gaskin", 0.05, FRONT),
    side("left hock", "left hind cannon", 0.05, BACK),
    side("right hock", "right hind cannon", 0.05, BACK),
    side("left hind foot", "left hind foot", 0.6, FRONT),
    side("right hind foot", "right hind foot", 0.6, FRONT),
];

/// Of everybody with two arms and two legs.
const LIMBS: &[Place] = &[
    side("left shoulder", "left upper arm", 0.25, [1.0, 0.5, 0.0]),
    side("right shoulder", "right upper arm", 0.25, [1.0, 0.5, 0.0]),
    side("left elbow", "left forearm", 0.1, [0.3, 0.0, -1.0]),
    side("right elbow", "right forearm", 0.1, [0.3, 0.0, -1.0]),
    tip("left hand", "left hand"),
    tip("right hand", "right hand"),
    side("left hip", "left thigh", 0.2, LEFT),
    side("right hip", "right thigh", 0.2, LEFT),
    side("left knee", "left shank", 0.05, FRONT),
    side("right knee", "right shank", 0.05, FRONT),
];

const PERSON: &[Place] = &[
    tip("crown", "head"),
    side("nose", "head", 0.6, FRONT),
    side("nape", "head", 0.15, BACK),
    side("breast", "chest", 0.7, FRONT),
    side("back", "chest", 0.5, BACK),
    side("belly", "pelvis", 0.5, FRONT),
    side("chin", "head", 0.28, FRONT),
    side("seat", "pelvis", 0.0, [0.0, -0.3, -1.0]),
    side("sacrum", "pelvis", 0.5, BACK),
    side("loin", "pelvis", 1.0, BACK),
    side("left heel", "left foot", 0.05, BACK),
    side("right heel", "right foot", 0.05, BACK),
    tip("left toes", "left foot"),
    tip("right toes", "right foot"),
];

const DINOSAUR: &[Place] = &[
    side("crown", "head", 0.25, UP),
    tip("nose", "head"),
    side("nape", "upper neck", 0.4, [0.0, 0.4, -1.0]),
    side("breast", "chest", 0.8, [0.0, -1.0, 0.5]),
    side("back", "chest", 0.4, UP),
    side("belly", "pelvis", 0.6, DOWN),
    side("seat", "tail 1", 0.3, UP),
    side("left heel", "left metatarsus", 0.05, BACK),
    side("right heel", "right metatarsus", 0.05, BACK),
    tip("left toes", "left toes"),
    tip("right toes", "right toes"),
    tip("jaw", "jaw"),
    side("sacrum", "pelvis", 0.5, UP),
    side("loin", "pelvis", 1.0, UP),
    tip("tail tip", "tail 5"),
];

/// Places of person and dinosaur that go together under different names.
const ALIKE: (&str, &str) = ("chin", "jaw");

const SNAKE: &[Place] = &[
    tip("snout", "head"),
    side("crown", "head", 0.4, UP),
    side("chin", "head", 0.4, DOWN),
    side("left cheek", "head", 0.4, LEFT),
    side("neck, top", "neck", 0.5, UP),
    side("neck, left", "neck", 0.5, LEFT),
    side("neck, right", "neck", 0.5, RIGHT),
    side("neck, bottom", "neck", 0.5, DOWN),
    side("chest, top", "chest", 0.5, UP),
    side("chest, right", "chest", 0.5, RIGHT),
    side("chest, bottom", "chest", 0.5, DOWN),
    side("trunk 2, left", "trunk 2", 0.5, LEFT),
    side("trunk 2, right", "trunk 2", 0.5, RIGHT),
    side("trunk 4, top", "trunk 4", 0.5, UP),
    side("trunk 4, bottom", "trunk 4", 0.5, DOWN),
    side("trunk 6, left", "trunk 6", 0.5, LEFT),
    side("trunk 6, right", "trunk 6", 0.5, RIGHT),
    tip("tail tip", "tail tip"),
];

const HAND: &[Place] = &[
    tip("middle fingertip", "middle 3"),
    tip("index fingertip", "index 3"),
    tip("little fingertip", "little 3"),
    tip("ring fingertip", "ring 3"),
    side("index joint", "index 2", 0.1, LEFT),
    side("middle joint", "middle 2", 0.1, LEFT),
    side("ring joint", "ring 2", 0.1, LEFT),
    side("little joint", "little 2", 0.1, LEFT),
    side("index knuckle", "index 1", 0.05, [0.3, 1.0, 0.0]),
    tip("thumb tip", "thumb 3"),
    side("little knuckle", "little 1", 0.05, [0.3, -1.0, 0.0]),
    side("back of the hand", "palm", 0.5, LEFT),
    side("palm", "palm", 0.5, RIGHT),
    side("wrist, thumb side", "forearm", 0.95, UP),
    side("wrist, little side", "forearm", 0.95, DOWN),
    side("forearm, outside", "forearm", 0.5, LEFT),
    side("forearm, inside", "forearm", 0.5, RIGHT),
    side("elbow", "forearm", 0.1, BACK),
];

const BIRD: &[Place] = &[
    tip("beak", "head"),
    side("crown", "head", 0.25, UP),
    side("nape", "neck", 0.5, [0.0, 1.0, -0.4]),
    side("throat", "neck", 0.5, [0.0, -1.0, 0.4]),
    side("back", "trunk", 0.5, UP),
    side("breast", "trunk", 0.85, DOWN),
    side("belly", "trunk", 0.2, DOWN),
    tip("tail tip", "tail"),
    side("left shoulder", "left inner wing", 0.25, UP),
    side("left elbow", "left middle wing", 0.15, FRONT),
    side("left wrist", "left outer wing", 0.15, FRONT),
    side("left wing, below", "left middle wing", 0.5, DOWN),
    tip("left wing tip", "left outer wing"),
    tip("left claws", "left foot"),
    side("right shoulder", "right inner wing", 0.25, UP),
    side("right elbow", "right middle wing", 0.15, FRONT),
    side("right wrist", "right outer wing", 0.15, FRONT),
    side("right wing, below", "right middle wing", 0.5, DOWN),
    tip("right wing tip", "right outer wing"),
    tip("right claws", "right foot"),
];

const OCTOPUS: &[Place] = &[
    tip("mantle tip", "mantle"),
    side("mantle, front", "mantle", 0.4, FRONT),
    side("mantle, back", "mantle", 0.4, BACK),
    side("mantle, left", "mantle", 0.4, LEFT),
    side("mantle, right", "mantle", 0.4, RIGHT),
    side("brow", "head", 0.8, FRONT),
    side("left first arm, root", "left first arm 2", 0.1, UP),
    tip("left first arm, tip", "left first arm 4"),
    side("left second arm, root", "left second arm 2", 0.1, UP),
    tip("left second arm, tip", "left second arm 4"),
    side("left third arm, root", "left third arm 2", 0.1, UP),
    tip("left third arm, tip", "left third arm 4"),
    side("left fourth arm, root", "left fourth arm 2", 0.1, UP),
    tip("left fourth arm, tip", "left fourth arm 4"),
    side("right first arm, root", "right first arm 2", 0.1, UP),
    tip("right first arm, tip", "right first arm 4"),
    side("right second arm, root", "right second arm 2", 0.1, UP),
    tip("right second arm, tip", "right second arm 4"),
    side("right third arm, root", "right third arm 2", 0.1, UP),
    tip("right third arm, tip", "right third arm 4"),
    side("right fourth arm, root", "right fourth arm 2", 0.1, UP),
    tip("right fourth arm, tip", "right fourth arm 4"),
];

const CACTUS: &[Place] = &[
    side("pot, front", "pot", 0.4, FRONT),
    side("pot, back", "pot", 0.4, BACK),
    side("pot, left", "pot", 0.4, LEFT),
    side("pot, right", "pot", 0.4, RIGHT),
    side("stem 1, front", "stem 1", 0.5, FRONT),
    side("stem 1, back", "stem 1", 0.5, BACK),
    side("stem 2, front", "stem 2", 0.5, FRONT),
    side("stem 2, back", "stem 2", 0.5, BACK),
    side("stem 3, front", "stem 3", 0.5, FRONT),
    side("stem 3, back", "stem 3", 0.5, BACK),
    side("stem 4, front", "stem 4", 0.5, FRONT),
    side("stem 4, back", "stem 4", 0.5, BACK),
    side("stem 5, front", "stem 5", 0.5, FRONT),
    side("stem 5, back", "stem 5", 0.5, BACK),
    tip("flower", "stem 5"),
    side("long arm, elbow", "long arm 1", 0.6, DOWN),
    side("long arm, front", "long arm 2", 0.5, FRONT),
    tip("long arm, tip", "long arm 3"),
    side("short arm, elbow", "short arm 1", 0.6, DOWN),
    side("short arm, front", "short arm 2", 0.5, FRONT),
    tip("short arm, tip", "short arm 3"),
];

/// A mesh of places on the cloth: letters from the pole on, numbers upwards.
const CLOTH: &[Place] = &[
    cloth("A1", 0.0, 0.0),
    cloth("A2", 0.0, 0.5),
    cloth("A3", 0.0, 1.0),
    cloth("B1", 0.2, 0.0),
    cloth("B2", 0.2, 0.5),
    cloth("B3", 0.2, 1.0),
    cloth("C1", 0.4, 0.0),
    cloth("C2", 0.4, 0.5),
    cloth("C3", 0.4, 1.0),
    cloth("D1", 0.6, 0.0),
    cloth("D2", 0.6, 0.5),
    cloth("D3", 0.6, 1.0),
    cloth("E1", 0.8, 0.0),
    cloth("E2", 0.8, 0.5),
    cloth("E3", 0.8, 1.0),
    cloth("F1", 1.0, 0.0),
    cloth("F2", 1.0, 0.5),
    cloth("F3", 1.0, 1.0),
];

/// The places of a creature by its name.
fn places(name: &str) -> Vec<Place> {
    match name {
        "horse" | "camel" | "giraffe" | "dog" | "cat" | "elephant" => QUADRUPED.to_vec(),
        "person" | "person-arms-out" | "person-broad" | "person-small" | "robot" => [PERSON, LIMBS].concat(),
        "dinosaur" => [DINOSAUR, LIMBS].concat(),
        "snake" => SNAKE.to_vec(),
        "hand" => HAND.to_vec(),
        "bird" => BIRD.to_vec(),
        "octopus" => OCTOPUS.to_vec(),
        "cactus" => CACTUS.to_vec(),
        "cloth" => CLOTH.to_vec(),
        _ => Vec::new(),
    }
}

/// The named places of a creature and the vertex at each.
pub fn landmarks(creature: &Creature) -> Vec<(&'static str, u32)> {
    let mut by_bone = vec![Vec::new(); creature.skeleton.bones.len()];
    for (face, &label) in creature.sequence.faces().iter().zip(&creature.labels) {
        if let Some(faces) = by_bone.get_mut(label as usize) {
            faces.push(*face);
        }
    }
    let places = places(creature.sequence.name());
    let found = places.iter().filter_map(|place| Some((place.name, vertex(creature, place, &by_bone)?)));
    found.collect()
}

/// The places that two creatures have in common, with their names on `a`, the vertex of `a` and that of `b`: those of
/// one name or alike, and for snake and hand those in the order of their lists (the fingers are the head, the
/// forearm is the tail).
pub fn landmark_pairs(a: &Creature, b: &Creature) -> Vec<(&'static str, u32, u32)> {
    let (here, there) = (landmarks(a), landmarks(b));
    let strangers = |a: &str, b: &str| a == "snake" && b == "hand";
    let (from, to) = (a.sequence.name(), b.sequence.name());
    if strangers(from, to) || strangers(to, from) {
        return here.iter().zip(&there).map(|(&(name, v), &(_, w))| (name, v, w)).collect();
    }
    let alike = |a: &str, b: &str| a == b || ALIKE == (a, b) || ALIKE == (b, a);
    let twin = |name: &str| there.iter().find(|(other, _)| alike(name, other));
    here.iter().filter_map(|&(name, v)| Some((name, v, twin(name)?.1))).collect()
}

/// The vertex nearest to where the place's ray leaves the creature through faces of its bone.
fn vertex(creature: &Creature, place: &Place, by_bone: &[Vec<[u32; 3]>]) -> Option<u32> {
    let number = creature.skeleton.find(place.bone)?;
    let bone = creature.skeleton.bones.get(number as usize)?;
    let (along, direction) = match place.at {
        At::Cloth(along, up) => return on_cloth(creature, along, up),
        At::Tip => (0.5, bone.end - bone.joint),
        At::Side(along, [x, y, z]) => (along, DVec3::new(if place.bone.starts_with("right") { -x } else { x }, y, z)),
    };
    let direction = direction.normalize_or(DVec3::Y);
    let from = bone.joint.lerp(bone.end, along);
    let point = |v: u32| creature.made[v as usize];
    let faces = by_bone.get(number as usize)?;
    let crossings = faces.iter().filter_map(|face| Some((crossed(from, direction, face.map(point))?, face)));
    let hit = match place.at {
        At::Tip => crossings.max_by(|a, b| a.0.total_cmp(&b.0)),
        At::Side(..) | At::Cloth(..) => crossings.min_by(|a, b| a.0.total_cmp(&b.0)),
    };
    let nearest = |to: DVec3, among: &mut dyn Iterator<Item = u32>| {
        among.min_by(|&v, &w| to.distance_squared(point(v)).total_cmp(&to.distance_squared(point(w))))
    };
    match hit {
        Some((t, face)) => nearest(from + t * direction, &mut face.iter().copied()),
        // A coarse mesh may have no face of the bone there: its vertex that lies farthest that way.
        None => faces
            .iter()
            .flatten()
            .copied()
            .max_by(|&v, &w| direction.dot(point(v)).total_cmp(&direction.dot(point(w))).then(w.cmp(&v))),
    }
}

/// The vertex nearest to a place of the flat cloth.
fn on_cloth(creature: &Creature, along: f64, up: f64) -> Option<u32> {
    let span = |a: (DVec3, DVec3), &p: &DVec3| (a.0.min(p), a.1.max(p));
    let (low, high) = creature.made.iter().fold((DVec3::INFINITY, DVec3::NEG_INFINITY), span);
    let at = low + (high - low) * DVec3::new(0.0, up, 1.0 - along);
    let away = |p: &DVec3| p.distance_squared(at);
    (0..).zip(&creature.made).min_by(|a, b| away(a.1).total_cmp(&away(b.1))).map(|(vertex, _)| vertex)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::zoo::tests::creature;
    use std::collections::BTreeSet;

    const MEASURED: [&str; 10] =
        ["horse", "camel", "giraffe", "dog", "cat", "person", "person-arms-out", "dinosaur", "snake", "hand"];

    #[test]
    fn every_creature_has_its_places_at_every_size() {
        for name in MEASURED {
            let fine = creature(name, 40_000);
            let there = landmarks(fine);
            assert!(there.len() >= 18 && there.len() == places(name).len(), "{name}: {}", there.len());
            for faces in [2_000, 12_000] {
                let coarse = creature(name, faces);
                let here = landmarks(coarse);
                let distinct: BTreeSet<u32> = here.iter().map(|place| place.1).collect();
                assert_eq!(distinct.len(), there.len(), "{name}, {faces} faces: every place has a vertex of its own");
                let diagonal = fine.sequence.diagonal();
                let bound = if faces < 10_000 { 0.06 } else { 0.03 };
                for (&(label, v), &(_, w)) in here.iter().zip(&there) {
                    let apart = coarse.made[v as usize].distance(fine.made[w as usize]) / diagonal;
                    assert!(apart < bound, "{name}, {faces} faces: {label} is {apart:.3} away");
                }
            }
        }
    }

    #[test]
    fn left_is_left_and_mirrored() {
        for name in ["horse", "camel", "giraffe", "dog", "cat", "person", "dinosaur"] {
            let creature = creature(name, 12_000);
            let places = landmarks(creature);
            for &(label, v) in places.iter().filter(|place| place.0.starts_with("left")) {
                let other = places.iter().find(|place| place.0 == label.replace("left", "right")).unwrap();
                let (left, right) = (creature.made[v as usize], creature.made[other.1 as usize]);
                assert!(left.x > 0.0, "{name}: {label}");
                let apart = left.distance(right * DVec3::new(-1.0, 1.0, 1.0)) / creature.sequence.diagonal();
                assert!(apart < 0.02, "{name}: {label} and its image are {apart:.3} apart");
            }
        }
    }

    #[test]
    fn pairs_are_one_to_one() {
        for (from, to, number) in
            [("horse", "camel", 25), ("person", "dinosaur", 24), ("snake", "hand", 18), ("hand", "snake", 18)]
        {
            let (a, b) = (creature(from, 12_000), creature(to, 9_000));
            let pairs = landmark_pairs(a, b);
            assert_eq!(pairs.len(), number, "{from} to {to}");
            for ends in [pairs.iter().map(|p| p.1).collect::<BTreeSet<_>>(), pairs.iter().map(|p| p.2).collect()] {
                assert_eq!(ends.len(), number, "{from} to {to}: no vertex twice");
            }
        }
        assert!(landmark_pairs(creature("horse", 1_000), creature("hand", 1_000)).is_empty());
    }

    #[test]
    fn extremes_are_where_they_must_be() {
        let [dinosaur, hand, snake] = ["dinosaur", "hand", "snake"].map(|name| creature(name, 12_000));
        let at = |c: &Creature, name: &str| {
            let found = landmarks(c).into_iter().find(|place| place.0 == name).unwrap();
            c.made[found.1 as usize]
        };
        let extent = |c: &Creature| c.made.iter().fold((1e9_f64, -1e9_f64), |(l, h), p| (l.min(p.z), h.max(p.z)));
        for (c, front, back) in
            [(dinosaur, "nose", "tail tip"), (hand, "middle fingertip", "elbow"), (snake, "snout", "tail tip")]
        {
            let (low, high) = extent(c);
            let slack = 0.02 * (high - low);
            assert!((at(c, front).z - high).abs() < slack && (at(c, back).z - low).abs() < slack);
        }
        assert!(at(hand, "palm").x < 0.0 && at(hand, "thumb tip").y > at(hand, "index fingertip").y);
    }
}
