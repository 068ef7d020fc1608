//! Weights where they would tear the target: wherever two neighbours follow motions that lead far apart, more than anything
//! on the source comes apart, weights are averaged until they do not. What is small and loose, such as a button or an eye,
//! keeps its shape.

use super::rig::blend;
use super::rig::weights::{Averager, Row, normalised};
use super::surface::WeldedSurface;
use glam::{DAffine3, DVec3};
use std::collections::{BTreeMap, BinaryHeap};

/// Edges may become longer by this factor in any case,
const LEAST: f64 = 1.6;
/// and this much longer than those of the source, a thousandth of which are left out.
const MORE: f64 = 1.25;
const LEFT_OUT: f64 = 1e-3;
/// Rounds of averaging at most,
const ROUNDS: usize = 24;
/// averages in a round on surfaces of [`AVERAGED`] vertices, and the most on finer ones.
const AVERAGES: usize = 3;
const AVERAGED: usize = 4000;
const MOST_AVERAGES: usize = 12;
/// The half width of a strip over the least that it needs.
const WIDTH: f64 = 1.0;
/// A piece is small if its box is not longer than this, in radii.
pub const SMALL: f64 = 0.1;
/// Edges shorter than this, in radii, count as so long: slivers tell nothing.
pub const SHORT: f64 = 2e-3;

/// By how much edges of a moving surface may become longer on another that follows it.
pub fn allowed(surface: &WeldedSurface, poses: &[&[DVec3]]) -> f64 {
    let mut stretches: Vec<f64> =
        surface.links().map(|(a, b)| longest(surface, a, b, |v, pose| poses[pose][v], poses.len())).collect();
    if stretches.is_empty() {
        return LEAST;
    }
    let place = ((1.0 - LEFT_OUT) * (stretches.len() - 1) as f64) as usize;
    let usual = *stretches.select_nth_unstable_by(place, f64::total_cmp).1;
    LEAST.max(MORE * usual)
}

/// Averages rows of at most `most` entries where edges would become longer by more than the factor `allowed` in a pose;
/// `poses` are the maps of the handles.
///
/// What comes apart by some length needs a strip in proportion to it, where all edges become a little longer.
pub fn close(surface: &WeldedSurface, rows: &mut [Row], poses: &[&[DAffine3]], allowed: f64, most: usize) {
    let follow = |v: usize, row: &Row, moved: &mut [DVec3]| {
        moved.iter_mut().zip(poses).for_each(|(at, maps)| *at = blend(row, maps, surface.positions[v]));
    };
    // Vertex by vertex, each in all poses.
    let mut moved = vec![DVec3::ZERO; rows.len() * poses.len()];
    let of = |v: usize| v * poses.len()..(v + 1) * poses.len();
    rows.iter().enumerate().for_each(|(v, row)| follow(v, row, &mut moved[of(v)]));
    let mut suspects: Vec<(usize, usize)> = surface.links().collect();
    let averages = (AVERAGES * rows.len()).div_ceil(AVERAGED).clamp(AVERAGES, MOST_AVERAGES);
    let (mut averager, mut next) = (Averager::default(), Vec::new());
    for _ in 0..ROUNDS {
        let mut torn: Vec<(f64, u32)> = Vec::new();
        for &(a, b) in &suspects {
            let factor = longest(surface, a, b, |v, pose| moved[of(v).start + pose], poses.len());
            if factor > allowed {
                let rest = surface.positions[a].distance(surface.positions[b]).max(SHORT);
                let reach = WIDTH * factor * rest / (allowed - 1.0);
                torn.extend([(reach, a as u32), (reach, b as u32)]);
            }
        }
        if torn.is_empty() {
            break;
        }
        let region = within(surface, &torn);
        for _ in 0..averages {
            next.resize(region.len(), Row::new());
            for (row, &v) in next.iter_mut().zip(&region) {
                averager.average(surface, rows, v as usize, most, row);
            }
            next.iter_mut().zip(&region).for_each(|(row, &v)| std::mem::swap(row, &mut rows[v as usize]));
        }
        region.iter().for_each(|&v| follow(v as usize, &rows[v as usize], &mut moved[of(v as usize)]));
        let around =
            |&v: &u32| surface.neighbours(v as usize).iter().map(move |&u| (v.min(u) as usize, v.max(u) as usize));
        suspects = region.iter().flat_map(around).collect();
        suspects.sort_unstable();
        suspects.dedup();
    }
}

/// Gives all vertices of a small piece one row of at most `most` entries, where there is more than such pieces.
pub fn stiffen(surface: &WeldedSurface, rows: &mut [Row], most: usize) {
    let small = small_pieces(surface);
    if small.iter().map(Vec::len).sum::<usize>() == surface.len() {
        return;
    }
    for piece in small {
        let row = mean(surface, rows, &piece, most);
        piece.iter().for_each(|&v| rows[v as usize].clone_from(&row));
    }
}

/// The vertices of each small piece.
fn small_pieces(surface: &WeldedSurface) -> Vec<Vec<u32>> {
    let mut pieces = surface.pieces();
    pieces.retain(|piece| surface.sides(piece).max_element() <= SMALL);
    pieces
}

/// The mean of the rows of some vertices, by their shares of the area.
fn mean(surface: &WeldedSurface, rows: &[Row], vertices: &[u32], most: usize) -> Row {
    let mut sum = BTreeMap::new();
    for &v in vertices {
        for &(bone, share) in &rows[v as usize] {
            *sum.entry(bone).or_insert(0.0) += surface.mass[v as usize].max(f64::MIN_POSITIVE) * share;
        }
    }
    strongest(sum.into_iter().collect(), most)
}

/// The largest entries of a row, made to sum to 1.
fn strongest(mut row: Row, most: usize) -> Row {
    row.sort_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
    row.truncate(most);
    normalised(row)
}

/// Vertices that along edges are nearer to one of some vertices than that one's reach.
fn within(surface: &WeldedSurface, from: &[(f64, u32)]) -> Vec<u32> {
    let mut left: BTreeMap<u32, f64> = BTreeMap::new();
    let mut heap: BinaryHeap<(u64, u32)> = from.iter().map(|&(reach, v)| (reach.to_bits(), v)).collect();
    while let Some((bits, v)) = heap.pop() {
        let reach = f64::from_bits(bits);
        if left.contains_key(&v) {
            continue;
        }
        left.insert(v, reach);
        for &u in surface.neighbours(v as usize) {
            let rest = reach - surface.positions[v as usize].distance(surface.positions[u as usize]);
            if rest > 0.0 && !left.contains_key(&u) {
                heap.push((rest.to_bits(), u));
            }
        }
    }
    left.into_keys().collect()
}

/// The largest factor by which an edge becomes longer in any pose.
fn longest(surface: &WeldedSurface, a: usize, b: usize, at: impl Fn(usize, usize) -> DVec3, poses: usize) -> f64 {
    let rest = surface.positions[a].distance(surface.positions[b]).max(SHORT);
    (0..poses).map(|pose| at(a, pose).distance_squared(at(b, pose))).fold(0.0, f64::max).sqrt() / rest
}
