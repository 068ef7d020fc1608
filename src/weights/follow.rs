//! Rows that sum to one for every vertex, those of pieces without a handle included.

use super::box_problem::Column;
use super::surface::Surface;

/// Rows whose raw weights sum to less than this have no weights of their own.
const LEAST_SUM: f64 = 1e-6;

/// Weights of all welded vertices, row by row, from the raw columns.
pub fn rows(surface: &Surface, places: &[u32], raw: &[Column]) -> Vec<f64> {
    let (n, count) = (surface.positions.len(), raw.len());
    let mut rows = vec![0.0; n * count];
    let mut known = Vec::with_capacity(n);
    for (v, row) in rows.chunks_exact_mut(count).enumerate() {
        row.iter_mut().zip(raw).for_each(|(x, column)| *x = column.weights[v]);
        if normalise(row) {
            known.push(v as u32);
        }
    }
    let unknown: Vec<u32> = (0..n as u32).filter(|v| known.binary_search(v).is_err()).collect();
    for v in unknown {
        let here = surface.positions[v as usize];
        let distance = |u: u32| surface.positions[u as usize].distance_squared(here);
        let nearest = known.iter().chain(places).copied().min_by(|&a, &b| distance(a).total_cmp(&distance(b)));
        let Some(nearest) = nearest else { continue };
        rows.copy_within(nearest as usize * count..(nearest as usize + 1) * count, v as usize * count);
    }
    rows
}

/// Divides a row by its sum, so exactly that the rest of rounding goes to its largest share; false where there is none.
fn normalise(row: &mut [f64]) -> bool {
    let sum: f64 = row.iter().sum();
    if sum <= LEAST_SUM {
        return false;
    }
    row.iter_mut().for_each(|x| *x /= sum);
    true
}
