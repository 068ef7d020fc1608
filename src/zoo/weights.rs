//! How much each vertex follows each bone.
//!
//! A vertex first asks which limb it lies on, by the field's own distances, and shares itself between limbs only
//! across the seam where they blend. Along a limb, it asks how far along the centre line it lies and shares
//! itself between two bones only near their joint. So legs cannot bleed into each other, nor the belly into a
//! leg, however close they are.

use super::limb::Limb;
use super::skeleton::Skeleton;
use glam::DVec3;

/// The bones that a vertex follows, with weights that sum to 1, the largest first.
pub type Weights = Vec<(u32, f64)>;

/// Assigns points of a body to its bones.
pub struct Binder<'a> {
    limbs: &'a [Limb],
    /// Per limb: its joints as arc lengths with half the length that is shared.
    joints: Vec<Vec<(f64, f64)>>,
}

impl<'a> Binder<'a> {
    /// Finds the joints along the limbs. `softness` is half the length of the stretch around a joint in which two
    /// bones share the skin, in radii of the limb.
    pub fn new(limbs: &'a [Limb], skeleton: &Skeleton, softness: f64) -> Self {
        let joints = limbs.iter().map(|limb| joints(limb, skeleton, softness)).collect();
        Self { limbs, joints }
    }

    /// A smooth blend of a few bones.
    pub fn smooth(&self, p: DVec3) -> Weights {
        let mut nearest = f64::INFINITY;
        let near: Vec<_> = self
            .limbs
            .iter()
            .map(|limb| {
                let near = limb.near(p, nearest + limb.blend)?;
                nearest = nearest.min(near.distance);
                Some(near)
            })
            .collect();
        let mut weights: Weights = Vec::new();
        for ((limb, joints), near) in self.limbs.iter().zip(&self.joints).zip(&near) {
            let Some(near) = near else { continue };
            let share = 1.0 - (near.distance - nearest) / (0.8 * limb.blend).max(1e-9);
            if share <= 0.0 {
                continue;
            }
            let mut rest = share * share;
            for (i, &bone) in limb.bones.iter().enumerate().rev() {
                // What lies before the joint of this bone is left to the bones before it.
                let beyond = match i.checked_sub(1).and_then(|j| joints.get(j)) {
                    Some(&(arc, half)) => smooth_step((near.arc - arc) / half),
                    None => 1.0,
                };
                give(&mut weights, bone, rest * beyond);
                rest *= 1.0 - beyond;
            }
        }
        tidy(weights)
    }

    /// The one bone that a point belongs to.
    pub fn exact(&self, p: DVec3) -> u32 {
        let mut nearest = None;
        let mut limit = f64::INFINITY;
        for (limb, joints) in self.limbs.iter().zip(&self.joints) {
            if let Some(near) = limb.near(p, limit) {
                limit = near.distance;
                nearest = Some((limb, joints, near));
            }
        }
        nearest.map_or(0, |(limb, joints, near)| {
            let passed = joints.iter().filter(|&&(arc, _)| near.arc > arc).count();
            limb.bones.get(passed).copied().unwrap_or(0)
        })
    }
}

fn joints(limb: &Limb, skeleton: &Skeleton, softness: f64) -> Vec<(f64, f64)> {
    let places: Vec<(f64, f64)> =
        limb.bones.iter().skip(1).map(|&bone| limb.project(skeleton.bones[bone as usize].joint)).collect();
    (0..places.len())
        .map(|i| {
            let (arc, radius) = places[i];
            // Neighbouring joints must not share the same skin.
            let gap = |other: Option<&(f64, f64)>| other.map_or(f64::INFINITY, |o| 0.45 * (o.0 - arc).abs());
            let before = gap(i.checked_sub(1).and_then(|j| places.get(j)));
            (arc, (softness * radius).min(before).min(gap(places.get(i + 1))).max(1e-6))
        })
        .collect()
}

fn smooth_step(x: f64) -> f64 {
    let t = (0.5 * (x + 1.0)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

fn give(weights: &mut Weights, bone: u32, weight: f64) {
    match weights.iter_mut().find(|w| w.0 == bone) {
        Some(found) => found.1 += weight,
        None => weights.push((bone, weight)),
    }
}

/// Keeps the four largest, normalises them.
fn tidy(mut weights: Weights) -> Weights {
    weights.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    weights.truncate(4);
    let most = weights.first().map_or(0.0, |w| w.1);
    weights.retain(|w| w.1 > 1e-4 * most);
    let sum: f64 = weights.iter().map(|w| w.1).sum();
    for weight in &mut weights {
        weight.1 /= sum;
    }
    weights
}
