//! Affine maps as glTF nodes.
//!
//! A node of glTF shifts, turns and scales along its own axes; it cannot shear. Two nodes can: with the singular value
//! decomposition A = U Σ Vᵀ, the outer node shifts, turns by U and scales by Σ, and the inner one, its child, turns
//! by Vᵀ. Where U and Vᵀ are not unique (signs, order and repeated values of Σ), they are chosen near to those of the
//! key before, because players interpolate each of them by itself.
//!
//! | paper | here |
//! |---|---|
//! | A = R S, polar decomposition | `Polar` |
//! | S = Q Σ Qᵀ, so that U = R Q and V = Q | `Link` |
//!
//! A mirrored map has a negative scale. Between keys the polar factors R (along the shortest arc) and S (linearly) say
//! what is wanted (Shoemake and Duff, Matrix animation and polar decomposition, Graphics Interface 1992); where the
//! chain's own interpolation strays from that, more keys are put between.

use crate::linalg::jacobi;
use crate::linalg::polar::{frobenius, rotation};
use glam::{DAffine3, DMat3, DQuat, DVec3};

/// What lies off the diagonal of S below this share of its size is left out: less than 32-bit floats can hold.
const NEGLIGIBLE: f64 = 2e-8;
/// Into how many pieces the time between two keys is cut at most.
const PIECES: usize = 8;

/// A key of a chain of two nodes: x ↦ place + outer · scale · inner · (x − centre).
#[derive(Clone, Copy, Debug)]
pub struct Link {
    /// Seconds.
    pub time: f32,
    /// Shift of the outer node: where the centre goes.
    pub place: DVec3,
    /// Turn of the outer node, U.
    pub outer: DQuat,
    /// Scale of the outer node, Σ.
    pub scale: DVec3,
    /// Turn of the inner node, Vᵀ.
    pub inner: DQuat,
}

impl Link {
    /// The linear part.
    pub fn linear(&self) -> DMat3 {
        DMat3::from_quat(self.outer) * DMat3::from_diagonal(self.scale) * DMat3::from_quat(self.inner)
    }

    /// As a player reads it from 32-bit floats.
    pub fn single(&self) -> Self {
        let turn = |q: DQuat| q.as_quat().as_dquat().normalize();
        Self {
            place: self.place.as_vec3().as_dvec3(),
            outer: turn(self.outer),
            scale: self.scale.as_vec3().as_dvec3(),
            inner: turn(self.inner),
            ..*self
        }
    }

    /// What a player shows half-way to another key.
    fn half_way(&self, next: &Self) -> DMat3 {
        let outer = self.outer.slerp(next.outer, 0.5);
        let inner = self.inner.slerp(next.inner, 0.5);
        Self { outer, inner, scale: 0.5 * (self.scale + next.scale), ..*self }.linear()
    }
}

/// The factors of a linear map: first stretched, then turned.
#[derive(Clone, Copy)]
struct Polar {
    turn: DQuat,
    stretch: DMat3,
}

impl Polar {
    /// Where the turn is not unique, the one nearest to `before`.
    fn of(linear: DMat3, before: DQuat) -> Self {
        let size = frobenius(linear);
        if size == 0.0 {
            return Self { turn: before, stretch: DMat3::ZERO };
        }
        let turn = DQuat::from_mat3(&rotation(linear + DMat3::from_quat(before) * (1e-9 * size))).normalize();
        let stretch = DMat3::from_quat(turn).transpose() * linear;
        Self { turn, stretch: (stretch + stretch.transpose()) * 0.5 }
    }

    fn mix(&self, next: &Self, t: f64) -> Self {
        let stretch = self.stretch * (1.0 - t) + next.stretch * t;
        Self { turn: self.turn.slerp(next.turn, t), stretch }
    }

    /// As a chain whose axes of stretching are as near as can be to `axes`.
    fn link(&self, axes: DQuat, time: f32, place: DVec3) -> Link {
        let start = DMat3::from_quat(axes);
        let seen = start.transpose() * self.stretch * start;
        let (scale, v) = jacobi::eigen(seen.transpose().to_cols_array_2d(), NEGLIGIBLE);
        let axes = (axes * DQuat::from_mat3(&DMat3::from_cols_array_2d(&v).transpose())).normalize();
        Link { time, place, outer: (self.turn * axes).normalize(), scale: scale.into(), inner: axes.inverse() }
    }
}

/// The keys of a handle that goes through `maps` at `times` (which rise): one for each, and more between them where
/// the interpolation would otherwise stray by more than `tolerance` over a distance of `reach` from `centre`.
pub fn keys(maps: &[DAffine3], times: &[f32], centre: DVec3, reach: f64, tolerance: f64) -> Vec<Link> {
    let mut keys: Vec<Link> = Vec::with_capacity(maps.len());
    let mut before = Polar { turn: DQuat::IDENTITY, stretch: DMat3::IDENTITY };
    for (map, &time) in maps.iter().zip(times) {
        let polar = Polar::of(map.matrix3, before.turn);
        let place = map.transform_point3(centre);
        match keys.last().copied() {
            None => keys.push(polar.link(DQuat::IDENTITY, time, place)),
            Some(last) => keys.extend(way(&last, [&before, &polar], time, place, tolerance / reach.max(1e-300))),
        }
        before = polar;
    }
    for i in 1..keys.len() {
        // A quaternion and its negative are one turn; players that do not know take the long way round.
        let last = keys[i - 1];
        let near = |q: DQuat, to: DQuat| if q.dot(to) < 0.0 { -q } else { q };
        keys[i].outer = near(keys[i].outer, last.outer);
        keys[i].inner = near(keys[i].inner, last.inner);
    }
    keys
}

/// The keys after `last` up to `time`: as few as keep the way between them within the tolerance.
fn way(last: &Link, [from, to]: [&Polar; 2], time: f32, place: DVec3, tolerance: f64) -> Vec<Link> {
    let mut pieces = 1;
    loop {
        let mut keys: Vec<Link> = Vec::with_capacity(pieces);
        let mut strays = 0.0_f64;
        for piece in 0..pieces {
            let end = (piece + 1) as f64 / pieces as f64;
            let (here, at) = if piece + 1 == pieces {
                (place, time)
            } else {
                (last.place.lerp(place, end), last.time + (time - last.time) * end as f32)
            };
            let previous = *keys.last().unwrap_or(last);
            let mixed = if piece + 1 == pieces { *to } else { from.mix(to, end) };
            let key = mixed.link(previous.inner.inverse(), at, here);
            let wanted = from.mix(to, (piece as f64 + 0.5) / pieces as f64);
            let wanted = DMat3::from_quat(wanted.turn) * wanted.stretch;
            strays = strays.max(frobenius(previous.half_way(&key) - wanted));
            keys.push(key);
        }
        let rise = std::iter::once(last).chain(&keys).zip(&keys).all(|(a, b)| a.time < b.time);
        if pieces == PIECES || (strays <= tolerance && rise) {
            if rise {
                return keys;
            }
            // Times too near each other for 32-bit floats.
            return keys.pop().into_iter().collect();
        }
        pieces *= 2;
    }
}

/// Whether the inner node never turns, so that there need not be one.
pub fn is_single(keys: &[Link]) -> bool {
    keys.iter().all(|key| key.inner.xyz().length() < 1e-9)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn matrix() -> impl Strategy<Value = DMat3> {
        prop::array::uniform9(-1.5..1.5f64).prop_map(|m| DMat3::from_cols_array(&m))
    }

    proptest! {
        #[test]
        fn every_affine_map_is_reached_mirrored_and_flat_ones_too(
            maps in prop::collection::vec((matrix(), prop::array::uniform3(-2.0..2.0f64), 0..4usize), 1..6),
        ) {
            let centre = DVec3::new(0.3, -0.2, 0.5);
            let maps: Vec<DAffine3> = maps.into_iter().map(|(m, shift, kind)| {
                let flat = DMat3::from_diagonal(DVec3::new(1.0, 1.0, 0.0));
                let linear = [m, m * flat, flat * m * (flat * 0.5), DMat3::ZERO][kind];
                DAffine3 { matrix3: linear, translation: shift.into() }
            }).collect();
            let times: Vec<f32> = (0..maps.len()).map(|i| i as f32).collect();
            let keys = keys(&maps, &times, centre, 1.0, 1e-3);
            for (map, time) in maps.iter().zip(&times) {
                let key = keys.iter().find(|key| key.time == *time).unwrap();
                prop_assert!(frobenius(key.linear() - map.matrix3) < 1e-6, "{} is not {}", key.linear(), map.matrix3);
                prop_assert!(key.place.distance(map.transform_point3(centre)) < 1e-12);
                prop_assert!(key.outer.is_normalized() && key.inner.is_normalized());
            }
            prop_assert!(keys.windows(2).all(|k| k[0].time < k[1].time && k[0].outer.dot(k[1].outer) >= 0.0));
        }

        #[test]
        fn a_turning_shear_stays_near_the_way_between_its_keys(
            shear in -0.8..0.8f64, axis in prop::array::uniform3(-1.0..1.0f64), angle in 0.1..2.5f64,
        ) {
            let axis = DVec3::from_array(axis);
            prop_assume!(axis.length() > 0.1);
            let turn = DMat3::from_axis_angle(axis.normalize(), angle);
            let sheared = |s: f64| DMat3::from_cols(DVec3::X, DVec3::new(s, 1.0, 0.0), DVec3::new(0.0, 0.5 * s, 1.0));
            let maps = [sheared(shear), turn * sheared(-shear)].map(DAffine3::from_mat3);
            let keys = keys(&maps, &[0.0, 1.0], DVec3::ZERO, 1.0, 0.01);
            let polar = maps.map(|map| Polar::of(map.matrix3, DQuat::IDENTITY));
            for pair in keys.windows(2) {
                let wanted = polar[0].mix(&polar[1], 0.5 * f64::from(pair[0].time + pair[1].time));
                let strays = frobenius(pair[0].half_way(&pair[1]) - DMat3::from_quat(wanted.turn) * wanted.stretch);
                prop_assert!(strays < 0.01 || keys.len() == PIECES + 1, "{strays}");
                prop_assert!(strays < 0.1, "{strays}");
            }
        }
    }

    #[test]
    fn rigid_maps_need_one_node() {
        let maps: Vec<DAffine3> = (0..9)
            .map(|i| {
                let turn = DQuat::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), f64::from(i) * 0.7);
                DAffine3::from_scale_rotation_translation(DVec3::splat(1.0 + 0.1 * f64::from(i)), turn, DVec3::X)
            })
            .collect();
        let times: Vec<f32> = (0..9u8).map(f32::from).collect();
        let keys = keys(&maps, &times, DVec3::ONE, 1.0, 1e-3);
        assert!(is_single(&keys));
        assert_eq!(keys.len(), 9);
    }
}
