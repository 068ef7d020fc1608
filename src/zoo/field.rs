//! The body as a signed distance: limbs joined by smooth unions, standing on flat soles.
//!
//! The smooth union is the cubic polynomial minimum of Inigo Quilez ("Smooth minimum", 2013): it has a second
//! derivative everywhere and leaves everything farther than its width from the seam as it was. Limbs of a pair
//! (left and right) are joined to each other first, so that the field is exactly symmetric.

use super::limb::{Cone, Limb};
use glam::DVec3;

/// How fast a field may change at most, per unit of length: tapering and flattened cones are a little steeper than
/// a true distance.
pub const STEEPNESS: f64 = 1.3;

/// Width of the rounding where soles are cut off at the ground.
const SOLE: f64 = 0.012;

/// A field made of the limbs of a body.
#[derive(Clone, Debug)]
pub struct Field {
    cones: Vec<Owned>,
    /// Blend width of each limb, with one for left and right.
    limbs: Vec<(u32, f64)>,
    widest: f64,
    grounded: bool,
}

#[derive(Clone, Debug)]
struct Owned {
    cone: Cone,
    limb: u32,
}

/// The value of a field at a point.
#[derive(Clone, Copy, Debug)]
pub struct Value {
    /// Signed distance, about; negative inside.
    pub distance: f64,
    /// Its gradient, about.
    pub gradient: DVec3,
    /// Thickness of the limb nearby (its smaller radius).
    pub radius: f64,
}

impl Field {
    /// The smooth union of limbs in the given order; what is below y = 0 is cut off if `grounded`.
    pub fn new(limbs: &[Limb], grounded: bool) -> Self {
        let cones = limbs
            .iter()
            .zip(0..)
            .flat_map(|(limb, number)| limb.cones().iter().map(move |&cone| Owned { cone, limb: number }))
            .collect();
        let widest = limbs.iter().map(|limb| limb.blend).fold(0.0, f64::max);
        Self { cones, limbs: limbs.iter().map(|l| (l.pair, l.blend)).collect(), widest, grounded }
    }

    /// The numbers of all cones, to be narrowed by [`Field::narrow`].
    pub fn all(&self) -> Vec<u32> {
        (0..self.cones.len() as u32).collect()
    }

    /// A box that holds the body: its lowest and highest corner.
    pub fn bounds(&self) -> (DVec3, DVec3) {
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for owned in &self.cones {
            let (centre, radius) = owned.cone.ball();
            low = low.min(centre - radius);
            high = high.max(centre + radius);
        }
        (low, high)
    }

    /// Those of the cones in `among` that matter within `reach` of `centre`, and the value at the centre.
    pub fn narrow(&self, among: &[u32], centre: DVec3, reach: f64) -> (Vec<u32>, f64) {
        let spread = 2.0 * STEEPNESS * reach;
        let limb_of = |cone: u32| self.cones[cone as usize].limb as usize;
        let distances: Vec<f64> =
            among.iter().map(|&cone| self.cones[cone as usize].cone.near(centre).distance).collect();
        let mut by_limb = vec![f64::INFINITY; self.limbs.len()];
        for (&cone, &distance) in among.iter().zip(&distances) {
            let nearest = &mut by_limb[limb_of(cone)];
            *nearest = nearest.min(distance);
        }
        let nearest = by_limb.iter().copied().fold(f64::INFINITY, f64::min);
        // Only limbs that come near are blended with; within a limb nothing is blended.
        let near = by_limb.iter().zip(&self.limbs).filter(|&(&d, _)| d <= nearest + spread + self.widest);
        let blend = near.map(|(_, limb)| limb.1).fold(0.0, f64::max);
        let limit = nearest + spread + 1.1 * blend;
        let matters = |cone: u32, d: f64| d <= limit.min(by_limb[limb_of(cone)] + spread);
        let mut kept: Vec<(usize, f64, u32)> =
            among.iter().zip(&distances).filter(|&(&c, &d)| matters(c, d)).map(|(&c, &d)| (limb_of(c), d, c)).collect();
        // The nearest cone of a limb first: most others are then beyond it at a glance.
        kept.sort_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1)).then(a.2.cmp(&b.2)));
        (kept.into_iter().map(|k| k.2).collect(), self.value(among, centre).distance)
    }

    /// The field at a point, from the given cones (limb by limb, as [`Field::narrow`] gives them).
    pub fn value(&self, among: &[u32], p: DVec3) -> Value {
        let far = Value { distance: f64::INFINITY, gradient: DVec3::Y, radius: 1.0 };
        let (mut body, mut pair, mut limb) = (far, far, far);
        let mut current: Option<u32> = None;
        for &number in among {
            let owned = &self.cones[number as usize];
            if current != Some(owned.limb) {
                if let Some(last) = current {
                    let (last_pair, blend) = self.limbs[last as usize];
                    pair = smooth_union(pair, limb, 0.5 * blend);
                    if self.limbs[owned.limb as usize].0 != last_pair {
                        body = smooth_union(body, pair, blend);
                        pair = far;
                    }
                }
                limb = far;
                current = Some(owned.limb);
            }
            // What is much farther away than the body so far changes nothing.
            let relevant = limb.distance.min(body.distance + 1.5 * self.limbs[owned.limb as usize].1);
            if owned.cone.is_beyond(p, relevant) {
                continue;
            }
            let near = owned.cone.near(p);
            if near.distance < limb.distance {
                limb = Value { distance: near.distance, gradient: near.gradient, radius: near.radius };
            }
        }
        if let Some(last) = current {
            let blend = self.limbs[last as usize].1;
            body = smooth_union(body, smooth_union(pair, limb, 0.5 * blend), blend);
        }
        if self.grounded { above_ground(body, p) } else { body }
    }
}

/// The cubic smooth minimum of two fields.
fn smooth_union(a: Value, b: Value, width: f64) -> Value {
    let (near, far) = if a.distance <= b.distance { (a, b) } else { (b, a) };
    let gap = far.distance - near.distance;
    // The gap between two that are infinitely far is not a number.
    if gap.is_nan() || gap >= width {
        return near;
    }
    let h = 1.0 - gap / width;
    let share = 0.5 * h * h;
    Value {
        distance: near.distance - h * h * h * width / 6.0,
        gradient: near.gradient * (1.0 - share) + far.gradient * share,
        radius: near.radius * (1.0 - share) + far.radius * share,
    }
}

/// Cuts off what lies below the ground, with a small rounding.
fn above_ground(body: Value, p: DVec3) -> Value {
    let flip = |v: Value| Value { distance: -v.distance, gradient: -v.gradient, radius: v.radius };
    let ground = Value { distance: p.y, gradient: DVec3::Y, radius: body.radius };
    flip(smooth_union(flip(body), ground, SOLE))
}
