//! Rows that sum to one for every vertex, those of pieces without a handle included.
//!
//! Such a piece follows what it lies next to. A small one (an eye, a button) takes one row, so that it keeps its shape; a
//! large one (a coat) takes at every vertex the row of the nearest vertex beneath, smoothed along the piece.

use super::box_problem::Column;
use super::surface::Surface;
use crate::mesh::kd_tree::KdTree;
use glam::DVec3;

/// Rows whose raw weights sum to less than this have no weights of their own.
const LEAST_SUM: f64 = 1e-6;

/// A piece is small if its box is not longer than this, in radii of the mesh.
const SMALL: f64 = 0.25;

/// Rounds of smoothing along large pieces.
const SMOOTHING: usize = 10;

/// Weights of all welded vertices, row by row, from the raw columns; there is one column at least.
pub fn rows(surface: &Surface, raw: &[Column]) -> Vec<f64> {
    let (n, count) = (surface.positions.len(), raw.len());
    let mut rows = vec![0.0; n * count];
    let mut known = vec![false; n];
    for (v, row) in rows.chunks_exact_mut(count).enumerate() {
        row.iter_mut().zip(raw).for_each(|(x, column)| *x = column.weights[v]);
        known[v] = normalise(row);
    }
    if known.iter().all(|k| *k) {
        return rows;
    }
    take_nearest(surface, &known, &mut rows, count);
    let mut unknown = vec![Vec::new(); surface.pieces];
    for v in (0..n).filter(|&v| !known[v]) {
        unknown[surface.piece[v] as usize].push(v as u32);
    }
    for vertices in unknown.iter().filter(|vertices| !vertices.is_empty()) {
        if extent(surface, vertices) <= SMALL * surface.radius {
            take_mean(vertices, &mut rows, count);
        } else {
            smooth(surface, vertices, &mut rows, count);
        }
    }
    rows
}

/// Divides a row by its sum; false where that is nothing.
fn normalise(row: &mut [f64]) -> bool {
    let sum: f64 = row.iter().sum();
    if sum <= LEAST_SUM {
        return false;
    }
    row.iter_mut().for_each(|x| *x /= sum);
    true
}

fn take_nearest(surface: &Surface, known: &[bool], rows: &mut [f64], count: usize) {
    let givers: Vec<u32> = (0..known.len() as u32).filter(|&v| known[v as usize]).collect();
    let places: Vec<DVec3> = givers.iter().map(|&v| surface.positions[v as usize]).collect();
    let tree = KdTree::of_points(&places);
    for v in (0..known.len()).filter(|&v| !known[v]) {
        if let Some(nearest) = tree.nearest(&surface.positions[v].to_array()) {
            let from = givers[nearest as usize] as usize * count;
            rows.copy_within(from..from + count, v * count);
        }
    }
}

/// The longest side of the box around vertices.
fn extent(surface: &Surface, vertices: &[u32]) -> f64 {
    let points = || vertices.iter().map(|&v| surface.positions[v as usize]);
    let high = points().fold(DVec3::NEG_INFINITY, DVec3::max);
    (high - points().fold(DVec3::INFINITY, DVec3::min)).max_element()
}

fn take_mean(vertices: &[u32], rows: &mut [f64], count: usize) {
    let mut mean = vec![0.0; count];
    for &v in vertices {
        let row = &rows[v as usize * count..(v as usize + 1) * count];
        mean.iter_mut().zip(row).for_each(|(sum, x)| *sum += x);
    }
    normalise(&mut mean);
    for &v in vertices {
        rows[v as usize * count..(v as usize + 1) * count].copy_from_slice(&mean);
    }
}

/// Every row becomes the mean of itself and its neighbours', some times over.
fn smooth(surface: &Surface, vertices: &[u32], rows: &mut [f64], count: usize) {
    for _ in 0..SMOOTHING {
        let mut next = Vec::with_capacity(vertices.len() * count);
        for &v in vertices {
            let mut sum = rows[v as usize * count..(v as usize + 1) * count].to_vec();
            for &u in surface.rings.of(v) {
                sum.iter_mut().zip(&rows[u as usize * count..]).for_each(|(sum, x)| *sum += x);
            }
            normalise(&mut sum);
            next.extend(sum);
        }
        for (&v, row) in vertices.iter().zip(next.chunks_exact(count)) {
            rows[v as usize * count..(v as usize + 1) * count].copy_from_slice(row);
        }
    }
}
