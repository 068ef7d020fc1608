//! Other proportions for a body: thicker, with longer legs or a larger head.
//!
//! Every bone is stretched along itself, or as a whole; the bones that it carries move along, and so do the stations of
//! the limbs around it. Then the body is put back on its feet.

use super::Recipe;
use super::body::Body;
use super::limb::{Limb, Station};
use super::skeleton::{Bone, Skeleton};
use glam::DVec3;

/// What a proportion may be at least and at most.
const RANGE: [f64; 2] = [0.5, 2.0];
/// The same for the size of everything.
const SIZES: [f64; 2] = [0.01, 100.0];

/// A proportion as it is used: brought into range, 1 if it is no number.
fn proportion(wanted: f64) -> f64 {
    if wanted.is_finite() { wanted.clamp(RANGE[0], RANGE[1]) } else { 1.0 }
}

/// The size of everything, brought into range; 1 if it is no number.
pub fn size(recipe: &Recipe) -> f64 {
    if recipe.size.is_finite() { recipe.size.clamp(SIZES[0], SIZES[1]) } else { 1.0 }
}

/// How the surroundings of a bone change.
#[derive(Clone, Copy)]
struct Change {
    /// Along the bone.
    stretch: f64,
    /// In all directions.
    whole: f64,
    /// Across the middle plane.
    broad: f64,
    /// Of the thickness of limbs.
    girth: f64,
    axis: DVec3,
}

impl Change {
    fn apply(&self, v: DVec3) -> DVec3 {
        let long = v + (self.stretch - 1.0) * v.dot(self.axis) * self.axis;
        self.whole * DVec3::new(self.broad * long.x, long.y, long.z)
    }
}

/// Gives a body the proportions of a recipe (all of them but its size).
pub fn reshape(body: &mut Body, recipe: &Recipe) {
    let old = &body.skeleton;
    let four_legs = old.find("left fore foot").is_some();
    let changes: Vec<Change> = old.bones.iter().map(|bone| change(bone, four_legs, recipe)).collect();
    let mut bones: Vec<Bone> = Vec::with_capacity(old.bones.len());
    for (bone, change) in old.bones.iter().zip(&changes) {
        let joint = bone.parent.map_or(bone.joint, |p| {
            let parent = p as usize;
            bones[parent].joint + changes[parent].apply(bone.joint - old.bones[parent].joint)
        });
        bones.push(Bone { joint, end: joint + change.apply(bone.end - bone.joint), ..bone.clone() });
    }
    let lowest = |bones: &[Bone]| bones.iter().map(|b| b.end.y).fold(f64::INFINITY, f64::min);
    let up = if body.grounded { lowest(&old.bones) - lowest(&bones) } else { 0.0 };
    let up = DVec3::new(0.0, if up.is_finite() { up } else { 0.0 }, 0.0);
    let move_station = |station: &Station, bone: usize| {
        let at = bones[bone].joint + changes[bone].apply(station.at - old.bones[bone].joint) + up;
        Station { at, radius: station.radius * changes[bone].girth, flat: station.flat }
    };
    let limbs = body.limbs.iter().map(|limb| {
        let stations = limb.stations.iter().map(|s| move_station(s, owner(limb, old, s.at))).collect();
        Limb::new(limb.bones.clone(), limb.blend, limb.pair, limb.direction, stations)
    });
    let limbs: Vec<Limb> = limbs.collect();
    let stride = old.stride;
    for bone in &mut bones {
        bone.joint += up;
        bone.end += up;
    }
    body.thinnest *= proportion(recipe.build).min(1.0) * proportion(recipe.head).min(1.0);
    body.pieces = body
        .pieces
        .iter()
        .map(|piece| {
            let (bone, change) = (piece.bone as usize, &changes[piece.bone as usize]);
            let at = bones[bone].joint + change.apply(piece.centre() - old.bones[bone].joint);
            piece.moved(at, change.girth, change.axis, change.stretch)
        })
        .collect();
    body.skeleton = Skeleton { bones, stride: stride * proportion(recipe.legs), belly: 0.0 };
    measure(&mut body.skeleton, &limbs);
    body.limbs = limbs;
}

/// Tells bones how thick the limbs around them are, and the skeleton how high its trunk is.
fn measure(skeleton: &mut Skeleton, limbs: &[Limb]) {
    for (bone, number) in skeleton.bones.iter_mut().zip(0..) {
        let around = limbs.iter().filter(|limb| limb.bones.contains(&number));
        bone.radius = around.map(|limb| limb.project(bone.joint).1).fold(0.0, f64::max);
    }
    let trunk = limbs.iter().filter(|limb| limb.bones == [0]).flat_map(|limb| &limb.stations);
    let lowest = trunk.map(|station| station.at.y - station.radius).fold(f64::INFINITY, f64::min);
    skeleton.belly = if lowest.is_finite() { lowest } else { 0.0 };
}

/// The bone of a limb that a point beside it belongs to.
fn owner(limb: &Limb, skeleton: &Skeleton, p: DVec3) -> usize {
    let arc = limb.project(p).0;
    let before = |bone: &&u32| limb.project(skeleton.bones[**bone as usize].joint).0 < arc;
    let passed = limb.bones.iter().skip(1).take_while(before).count();
    limb.bones.get(passed).map_or(0, |&bone| bone as usize)
}

fn change(bone: &Bone, four_legs: bool, recipe: &Recipe) -> Change {
    let axis = (bone.end - bone.joint).normalize_or_zero();
    let build = proportion(recipe.build);
    let plain = Change { stretch: 1.0, whole: 1.0, broad: 1.0, girth: build, axis };
    let long = |amount: f64| Change { stretch: proportion(amount), ..plain };
    let has = |words: &[&str]| words.iter().any(|word| bone.name.contains(word));
    if has(&["head", "jaw", "beak", "proboscis"]) {
        let whole = proportion(recipe.head);
        Change { whole, girth: whole, ..plain }
    } else if has(&["foot", "toes", "metatarsus"]) {
        Change { girth: 1.0, ..plain }
    } else if has(&["neck"]) {
        long(recipe.neck)
    } else if has(&["tail"]) {
        long(recipe.tail)
    } else if has(&["thigh", "shank", "gaskin", "cannon"]) || four_legs && has(&["arm"]) {
        long(recipe.legs)
    } else if has(&["arm", "wing", "hand"]) {
        long(recipe.arms)
    } else {
        Change { broad: 0.5 * (1.0 + build), ..plain }
    }
}
