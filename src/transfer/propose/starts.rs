//! Where a set may begin: the source laid over the target, also pulled to given pairs and to tips.

use super::consensus::Point;
use super::orientations::Orientation;
use super::point_set::{CONSIDERED, Figures, PointSet};
use super::sampled::SampledSurface;
use super::tips;
use glam::{DMat3, DVec3};

/// What facing away costs when samples look for the nearest place.
const FACING: f64 = 0.02;

/// Within this distance of a pair, what it says counts about the same.
const PULL: f64 = 0.2;

/// What a squared distance between the places of tips costs, where one of distances along the surface costs one: so that
/// either settles which tip is which. A cat's tail has the length of a camel's neck, but is not where that is.
const TIPS_BY_PLACE: [f64; 2] = [0.2, 4.0];

/// From so many given pairs on, they tell how the figures stand.
pub const TELLING: usize = 2;

/// A point of the source and its place on the target, after a weight.
pub type WeightedPair = (f64, DVec3, DVec3);

/// Samples of the target, one for each point of a set; `None` for a point that has no place yet.
pub type Places = Vec<Option<u32>>;

/// By how much pairs move what is near them once `map` has laid the source over the target: without it, the legs
/// of a creature whose neck is much longer lie nearest to the other's neck.
///
/// Inverse distance weighting (D. Shepard, *A two-dimensional interpolation function for irregularly-spaced data*,
/// Proceedings of the 23rd ACM National Conference, 1968, pp. 517–524), softened.
fn pull(pairs: &[WeightedPair], map: DMat3, place: DVec3) -> DVec3 {
    let weight = |from: DVec3| (place.distance_squared(from) + PULL * PULL).powi(-2);
    let total: f64 = pairs.iter().map(|&(_, from, _)| weight(from)).sum();
    pairs.iter().map(|&(_, from, to)| weight(from) / total * (to - map * from)).sum()
}

/// Places (#points samples of the target) to begin with, in one orientation.
pub fn starts(figures: Figures, set: &PointSet, orientation: Orientation, given: &[WeightedPair]) -> Vec<Places> {
    let mut starts = Vec::new();
    let laid = |map: DMat3, pairs: &[WeightedPair]| laid(figures.target, set, &|p| map * p + pull(pairs, map, p), map);
    let by_place = if given.len() < TELLING { &TIPS_BY_PLACE[..] } else { &TIPS_BY_PLACE[..1] };
    for map in orientation.maps {
        starts.push(laid(map, &[]));
        if !given.is_empty() {
            starts.push(laid(map, given));
        }
        for &by_place in by_place {
            let tips = tips::assign(figures.source, figures.target, set, map, by_place);
            let mut at = vec![None; set.points.len()];
            tips.iter().for_each(|&(point, sample)| at[point as usize] = Some(sample));
            starts.push(at);
            if given.len() < TELLING {
                let tip = |&(point, sample): &(u32, u32)| {
                    (1.0, set.points[point as usize].place, figures.target.places[sample as usize])
                };
                starts.push(laid(map, &given.iter().copied().chain(tips.iter().map(tip)).collect::<Vec<_>>()));
            }
        }
    }
    starts
}

/// For each point, the considered sample of the target nearest to where a map puts it, that faces the same way.
pub fn laid(target: &SampledSurface, set: &PointSet, map: &dyn Fn(DVec3) -> DVec3, turn: DMat3) -> Places {
    let considered = CONSIDERED.min(target.len());
    let nearest = |point: &Point| {
        let (place, normal) = (map(point.place), (turn * point.normal).normalize_or_zero());
        let cost = |s: u32| {
            target.places[s as usize].distance_squared(place) + FACING * (1.0 - target.normals[s as usize].dot(normal))
        };
        let costs = (0..considered as u32).map(|s| (s, cost(s)));
        costs.min_by(|a, b| a.1.total_cmp(&b.1)).map(|best| best.0)
    };
    set.points.iter().map(nearest).collect()
}
