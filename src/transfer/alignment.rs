//! How the target as a whole lies to the source: turn, size and shift, from the pairs.
//!
//! Characters usually differ in their up-axis or not at all, so that one of the 24 turns that carry axes to axes is the
//! right one; a turn by a few degrees which proportions alone suggest would make the target walk askew.

use crate::linalg::polar::cosine;
use crate::linalg::rigid_fit::Moments;
use glam::{DMat3, DVec3};

/// A turn that is not along the axes is believed from this many pairs on,
const PAIRS: usize = 4;
/// from this angle on (cosine of 20°),
const ANGLE: f64 = 0.94;
/// and if without it pairs lie so much farther apart.
const WORSE: f64 = 1.5;
/// Pairs of which every two are compared in size; of more some are, evenly.
const COMPARED: usize = 300;

/// `x ↦ size · turn · x + shift`, from the source to the target.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alignment {
    /// A rotation.
    pub turn: DMat3,
    /// Size of the target over the size of the source, in the units of the points.
    pub size: f64,
    /// In the units of the target.
    pub shift: DVec3,
}

impl Alignment {
    /// Where a point of the source comes to lie.
    pub fn apply(&self, point: DVec3) -> DVec3 {
        self.size * (self.turn * point) + self.shift
    }

    /// The point of the source that comes to lie there.
    pub fn invert(&self, point: DVec3) -> DVec3 {
        self.turn.transpose() * (point - self.shift) / self.size
    }
}

/// Finds the similarity that carries the first points of the pairs to the second, both in unit balls.
pub fn align(pairs: &[(DVec3, DVec3)]) -> Alignment {
    let size = size(pairs);
    let count = pairs.len().max(1) as f64;
    let middle = pairs.iter().map(|p| p.0).sum::<DVec3>() / count;
    let other = pairs.iter().map(|p| p.1).sum::<DVec3>() / count;
    let centred: Vec<(DVec3, DVec3)> = pairs.iter().map(|p| (size * (p.0 - middle), p.1 - other)).collect();
    let turn = turn(&centred);
    Alignment { turn, size, shift: other - size * (turn * middle) }
}

/// The median ratio of distances. Few pairs say little of the size: then more is left to the unit balls.
fn size(pairs: &[(DVec3, DVec3)]) -> f64 {
    let pairs: Vec<(DVec3, DVec3)> = pairs.iter().copied().step_by(pairs.len().div_ceil(COMPARED).max(1)).collect();
    let mut ratios = Vec::new();
    for (i, a) in pairs.iter().enumerate() {
        for b in &pairs[i + 1..] {
            let (x, y) = (a.0.distance(b.0), a.1.distance(b.1));
            if x > 1e-6 && y > 1e-6 {
                ratios.push((y / x).ln());
            }
        }
    }
    if ratios.is_empty() {
        return 1.0;
    }
    ratios.sort_by(f64::total_cmp);
    let median = 0.5 * (ratios[(ratios.len() - 1) / 2] + ratios[ratios.len() / 2]);
    let trust = ratios.len() as f64 / (ratios.len() as f64 + 1.0);
    (trust * median).clamp(-2.0, 2.0).exp()
}

fn turn(centred: &[(DVec3, DVec3)]) -> DMat3 {
    if centred.len() < 2 {
        return DMat3::IDENTITY;
    }
    // Mean distance, not squared: one misplaced pair counts as one.
    let apart = |turn: DMat3| centred.iter().map(|p| (turn * p.0 - p.1).length()).sum::<f64>();
    let upright = apart(DMat3::IDENTITY);
    let (best, least) = axis_turns().map(|t| (t, apart(t))).fold(
        (DMat3::IDENTITY, upright),
        // Another turn than none must be clearly better: pairs in a plane fit several.
        |best, next| if next.1 < 0.999 * best.1 { next } else { best },
    );
    let along = if centred.len() >= 3 || least < 0.5 * upright { best } else { DMat3::IDENTITY };
    if centred.len() < PAIRS {
        return along;
    }
    let mut moments = Moments::default();
    centred.iter().for_each(|p| moments.add(1.0, p.0, p.1));
    let free = moments.motion().rotation;
    let cosine = cosine(along.transpose() * free);
    if cosine < ANGLE && apart(along) > WORSE * apart(free) { free } else { along }
}

/// The 24 rotations that carry axes to axes, the identity first.
pub fn axis_turns() -> impl Iterator<Item = DMat3> {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];
    let all = axes.into_iter().flat_map(move |x| axes.map(|y| (x, y)));
    all.filter(|(x, y)| x.dot(*y) == 0.0).map(|(x, y)| DMat3::from_cols(x, y, x.cross(y)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn cloud() -> Vec<DVec3> {
        let coordinate = |i: usize, k: usize| ((i * 7 + k * 5 + 3) as f64 * 0.618_034).fract() - 0.5;
        (0..8).map(|i| DVec3::new(coordinate(i, 0), 2.0 * coordinate(i, 1), coordinate(i, 2))).collect()
    }

    #[test]
    fn turns_of_the_axes_are_those_of_a_cube() {
        let turns: Vec<DMat3> = axis_turns().collect();
        assert_eq!((turns.len(), turns[0]), (24, DMat3::IDENTITY));
        assert!(turns.iter().all(|turn| turn.determinant() == 1.0));
        assert!((1..24).all(|i| !turns[..i].contains(&turns[i])));
    }

    #[test]
    fn finds_axes_and_size_under_noise() {
        let z_up = DMat3::from_cols(DVec3::X, DVec3::NEG_Z, DVec3::Y);
        let noise = |i: usize| 0.03 * DVec3::new((i as f64).sin(), (2.0 * i as f64).cos(), (3.0 * i as f64).sin());
        let pairs: Vec<_> =
            cloud().into_iter().enumerate().map(|(i, p)| (p, 1.3 * (z_up * p) + DVec3::ONE + noise(i))).collect();
        let found = align(&pairs);
        assert_eq!(found.turn, z_up);
        assert!((found.size / 1.3 - 1.0).abs() < 0.05, "{}", found.size);
        let p = DVec3::new(0.3, -0.2, 0.9);
        assert!(found.invert(found.apply(p)).distance(p) < 1e-12);
    }

    #[test]
    fn believes_an_odd_turn_that_fits_well() {
        let odd = DMat3::from_rotation_y(0.7);
        let pairs: Vec<_> = cloud().into_iter().map(|p| (p, odd * p)).collect();
        let turn = align(&pairs).turn;
        assert!((turn.x_axis - odd.x_axis).length() < 1e-6 && (turn.y_axis - odd.y_axis).length() < 1e-6);
    }

    #[test]
    fn few_pairs_turn_nothing() {
        assert_eq!(align(&[]).turn, DMat3::IDENTITY);
        let one = align(&[(DVec3::X, DVec3::Y)]);
        assert_eq!((one.turn, one.size, one.shift), (DMat3::IDENTITY, 1.0, DVec3::Y - DVec3::X));
        let twice = align(&[(DVec3::X, DVec3::Y), (DVec3::X, DVec3::Y)]);
        assert!(twice.shift.is_finite() && twice.size == 1.0);
    }
}
