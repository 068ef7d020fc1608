//! Least squares over points: the normal equations of many small terms.

use crate::linalg::cholesky::{Cholesky, NotPositiveDefinite, Ordering, Upper};
use crate::linalg::outer::outer;
use glam::{DMat3, DVec3};

/// The sum of |Σᵤ xᵤ dᵤᵀ − R|² over terms, as a function of #U points x.
///
/// Some points may be given: they leave the unknowns, and what they contribute is moved to the right side.
#[derive(Clone, Debug)]
pub struct Terms {
    /// For each point its number among the unknowns, or where it is.
    places: Vec<Place>,
    unknowns: usize,
    entries: Vec<(u32, u32, f64)>,
    side: Vec<DVec3>,
}

#[derive(Clone, Copy, Debug)]
enum Place {
    Unknown(u32),
    Given(DVec3),
}

impl Terms {
    /// No terms yet over `count` points, of which some are `given`.
    pub fn new(count: usize, given: &[(u32, DVec3)]) -> Self {
        let mut places = vec![Place::Unknown(0); count];
        for &(point, at) in given {
            places[point as usize] = Place::Given(at);
        }
        let mut unknowns = 0;
        for place in &mut places {
            if let Place::Unknown(number) = place {
                *number = unknowns;
                unknowns += 1;
            }
        }
        let unknowns = unknowns as usize;
        Self { places, unknowns, entries: Vec::new(), side: vec![DVec3::ZERO; unknowns] }
    }

    /// Adds a term with its weight: `parts` are points and their d, `wanted` is R. A point may be named repeatedly.
    pub fn add(&mut self, parts: &[(u32, DVec3)], wanted: DMat3, weight: f64) {
        let mut wanted = wanted;
        for &(point, d) in parts {
            if let Place::Given(at) = self.places[point as usize] {
                wanted -= outer(at, d);
            }
        }
        for (k, &(point, d)) in parts.iter().enumerate() {
            let Place::Unknown(u) = self.places[point as usize] else { continue };
            self.side[u as usize] += weight * (wanted * d);
            for (j, &(other, e)) in parts[..=k].iter().enumerate() {
                let Place::Unknown(v) = self.places[other as usize] else { continue };
                // The same point named twice counts for both of the mirrored places.
                let twice = if u == v && j < k { 2.0 } else { 1.0 };
                self.entries.push((u.max(v), u.min(v), twice * weight * d.dot(e)));
            }
        }
    }

    /// Adds |Σᵤ cᵤ xᵤ − r|² with its weight.
    pub fn tie(&mut self, parts: &[(u32, f64)], wanted: DVec3, weight: f64) {
        let parts: Vec<(u32, DVec3)> = parts.iter().map(|&(point, c)| (point, c * DVec3::X)).collect();
        self.add(&parts, outer(wanted, DVec3::X), weight);
    }

    /// The number of the unknown that a point is; `None` for one that is given.
    pub fn unknown(&self, point: usize) -> Option<usize> {
        match self.places.get(point) {
            Some(Place::Unknown(u)) => Some(*u as usize),
            _ => None,
        }
    }

    /// The matrix of the normal equations, of their right side the part that does not change, and what reads solutions.
    pub fn finish(mut self) -> Result<Equations, NotPositiveDefinite> {
        // Every unknown has a place on the diagonal.
        self.entries.extend((0..self.unknowns as u32).map(|u| (u, u, 0.0)));
        let matrix = Upper::new(self.unknowns, &self.entries)?;
        Ok(Equations { matrix, side: self.side, places: self.places })
    }
}

/// Normal equations.
#[derive(Clone, Debug)]
pub struct Equations {
    matrix: Upper,
    side: Vec<DVec3>,
    places: Vec<Place>,
}

impl Equations {
    /// The fixed part of the right side, by unknowns.
    pub fn side(&self) -> &[DVec3] {
        &self.side
    }

    /// The mean of the diagonal.
    pub fn mean_diagonal(&self) -> f64 {
        let sum: f64 =
            self.matrix.starts.iter().skip(1).filter_map(|&end| self.matrix.values.get(end as usize - 1)).sum();
        sum / self.side.len().max(1) as f64
    }

    /// Factors the matrix after something was added to the diagonal at some unknowns. `earlier` is a factor of this
    /// matrix with another diagonal: its order of elimination is used again.
    pub fn factor(&self, diagonal: &[f64], earlier: Option<Cholesky>) -> Result<Cholesky, NotPositiveDefinite> {
        let mut matrix = self.matrix.clone();
        for (&end, add) in matrix.starts[1..].iter().zip(diagonal) {
            // The diagonal is the last entry of its column.
            if let Some(value) = matrix.values.get_mut(end as usize - 1) {
                *value += add;
            }
        }
        match earlier {
            Some(mut factor) => factor.again(&matrix).map(|()| factor),
            None => Cholesky::of(&matrix, Ordering::MinimumDegree),
        }
    }

    /// All points, of the values of the unknowns as column `column` of three-column groups.
    pub fn points(&self, columns: &[f64], group: usize) -> Vec<DVec3> {
        let n = self.side.len();
        let at = |u: usize, k: usize| columns[(3 * group + k) * n + u];
        let point = |place: &Place| match *place {
            Place::Unknown(u) => DVec3::new(at(u as usize, 0), at(u as usize, 1), at(u as usize, 2)),
            Place::Given(point) => point,
        };
        self.places.iter().map(point).collect()
    }
}

/// Right sides as columns, three for each group of points.
pub fn columns(groups: &[Vec<DVec3>]) -> Vec<f64> {
    let mut columns = Vec::with_capacity(groups.iter().map(|group| 3 * group.len()).sum());
    for group in groups {
        for k in 0..3 {
            columns.extend(group.iter().map(|p| p[k]));
        }
    }
    columns
}
