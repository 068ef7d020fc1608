//! Tips of limbs, and which tip of one figure is which of another.
//!
//! A tip is farther from the rest of the surface than all around it (hands, feet, head, tail). Between figures of one
//! build, tips keep their distances along the surface however the limbs are held; what these leave open (left and right)
//! the places decide. That gives places to begin with ([`assign`]). In the end, the tips that have come to lie nearest to
//! each other are partners ([`met`]).

use super::point_set::PointSet;
use super::sampled::SampledSurface;
use glam::{DMat3, DVec3};

/// Within this distance (a share of the diagonal) a tip is the farthest.
const AROUND: f32 = 0.2;

/// Tips that lie farther from each other have not met.
const MEETING: f32 = 0.25;

/// Tips that take part.
const MOST: usize = 12;

/// Partial assignments that are followed.
const BEAM: usize = 64;

/// What it costs to leave a tip without a partner.
const ALONE: f64 = 0.03;

/// Samples among the first `among` that are tips, in the order of the samples.
pub fn tips(surface: &SampledSurface, among: usize) -> Vec<u32> {
    let among = among.min(surface.len());
    let far = |s: u32| surface.row(s)[..among].iter().sum::<f32>();
    let far: Vec<f32> = (0..among as u32).map(far).collect();
    let typical = far.iter().sum::<f32>() / among.max(1) as f32;
    let tip = |&s: &u32| {
        let own = far[s as usize];
        let row = surface.row(s);
        own > typical && (0..among).all(|o| o == s as usize || row[o] > AROUND || (far[o], o) < (own, s as usize))
    };
    (0..among as u32).filter(tip).take(MOST).collect()
}

/// Assigns tips of the set's spread (the first samples of `source`) to tips of the target.
///
/// `map` lays the source over the target; a squared distance between places costs `by_place`, where one of distances along
/// the surface costs one. Returns (member of the set, sample of the target).
pub fn assign(
    source: &SampledSurface,
    target: &SampledSurface,
    set: &PointSet,
    map: DMat3,
    by_place: f64,
) -> Vec<(u32, u32)> {
    let (own, others) = (tips(source, set.spread), tips(target, set.spread));
    let n = set.points.len();
    let row = |i: u32| &set.distances[i as usize * n..(i as usize + 1) * n];
    let fixed: Vec<(u32, &[f32])> = (0..)
        .zip(&set.points)
        .filter_map(|(i, p): (u32, _)| Some((i, p.given.as_ref()?.distances.as_slice())))
        .collect();
    let mut beam: Vec<(f64, Vec<Option<u32>>)> = vec![(0.0, Vec::new())];
    for &tip in &own {
        let mut next = Vec::new();
        for (cost, partners) in &beam {
            next.push((cost + ALONE, [partners.as_slice(), &[None]].concat()));
            for &other in others.iter().filter(|o| !partners.contains(&Some(**o))) {
                let before = own.iter().zip(partners).filter_map(|(&s, p)| Some((s, target.row((*p)?))));
                let pairs =
                    before.chain(fixed.iter().copied()).map(|(s, to)| (row(tip)[s as usize], to[other as usize]));
                let off = mean_square(pairs);
                let apart = apart(set.points[tip as usize].place, target.places[other as usize], map);
                next.push((cost + off + by_place * apart, [partners.as_slice(), &[Some(other)]].concat()));
            }
        }
        next.sort_by(|a, b| a.0.total_cmp(&b.0));
        next.truncate(BEAM);
        beam = next;
    }
    let best = beam.into_iter().next().map(|b| b.1).unwrap_or_default();
    own.iter().zip(best).filter_map(|(&tip, partner)| Some((tip, partner?))).collect()
}

/// Tips of both whose places have come to lie nearest to each other's, `at` (#set) being where the set is.
///
/// Returns (member of the set's spread, sample of the target).
pub fn met(source: &SampledSurface, target: &SampledSurface, spread: usize, at: &[Option<u32>]) -> Vec<(u32, u32)> {
    let own: Vec<(u32, u32)> =
        tips(source, spread).into_iter().filter_map(|tip| Some((tip, at[tip as usize]?))).collect();
    let others = tips(target, spread);
    let far = |place: u32, other: u32| target.row(place)[other as usize];
    let nearest_other = |place: u32| others.iter().copied().min_by(|&a, &b| far(place, a).total_cmp(&far(place, b)));
    let nearest_own = |other: u32| own.iter().min_by(|a, b| far(a.1, other).total_cmp(&far(b.1, other)));
    let pair = |&(tip, place): &(u32, u32)| {
        let other = nearest_other(place).filter(|&other| far(place, other) < MEETING)?;
        (nearest_own(other)?.0 == tip).then_some((tip, other))
    };
    own.iter().filter_map(pair).collect()
}

fn apart(from: DVec3, to: DVec3, map: DMat3) -> f64 {
    (map * from).distance_squared(to)
}

fn mean_square(pairs: impl Iterator<Item = (f32, f32)>) -> f64 {
    let (mut sum, mut count) = (0.0, 0.0_f64);
    for (here, there) in pairs {
        sum += f64::from(here - there).powi(2);
        count += 1.0;
    }
    sum / count.max(1.0)
}
