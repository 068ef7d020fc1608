//! Weights of the bones: for each vertex the blend of nearby bones that explains its poses best, held close to its
//! neighbours' where the poses say little.

use super::bones::BoneClusters;
use crate::transfer::surface::WeldedSurface;
use glam::DVec3;

/// Bones and their shares at a vertex.
pub type Row = Vec<(u32, f64)>;

/// Bones that may take part at a vertex.
const CANDIDATES: usize = 5;
/// A difference of a whole share from the neighbours' weights costs as much as this distance in every pose, in radii.
const HOLD: f64 = 0.01;
/// Rounds, each holding weights to the neighbours' of the round before.
const ROUNDS: usize = 3;
/// Rounds of averaging that turn the hard bones into the first weights.
const SOFTEN: f64 = 4.0;
/// What share the neighbours have in an average.
const BESIDE: f64 = 0.5;
/// Shares below this are dropped.
pub const LEAST: f64 = 1e-4;

/// #N rows of bones and their shares.
pub fn bind(surface: &WeldedSurface, poses: &[&[DVec3]], bones: &BoneClusters) -> Vec<Row> {
    let hard = bones.of.iter().map(|&bone| vec![(bone, 1.0)]).collect();
    let mut rows = averaged(surface, hard, CANDIDATES, SOFTEN);
    let reach = reach(surface, bones);
    for _ in 0..ROUNDS {
        let held = averaged(surface, rows, 2 * CANDIDATES, 1.0);
        rows = (0..surface.len()).map(|v| vertex(surface, poses, bones, &reach, v, &held[v])).collect();
    }
    rows
}

/// For each bone itself and the bones that it borders on.
fn reach(surface: &WeldedSurface, bones: &BoneClusters) -> Vec<Vec<u32>> {
    let mut reach: Vec<std::collections::BTreeSet<u32>> = (0..bones.count as u32).map(|b| [b].into()).collect();
    for v in 0..surface.len() {
        for &u in surface.neighbours(v) {
            reach[bones.of[v] as usize].insert(bones.of[u as usize]);
        }
    }
    reach.into_iter().map(|set| set.into_iter().collect()).collect()
}

fn vertex(
    surface: &WeldedSurface,
    poses: &[&[DVec3]],
    bones: &BoneClusters,
    reach: &[Vec<u32>],
    v: usize,
    held: &[(u32, f64)],
) -> Row {
    let p = surface.positions[v];
    let off = |bone: u32| -> Vec<DVec3> {
        let motions = bones.motions.iter().zip(poses);
        motions.map(|(motions, pose)| motions[bone as usize].apply(p) - pose[v]).collect()
    };
    let hold = HOLD * HOLD * poses.len().max(1) as f64;
    let share = |bone: u32| held.iter().find(|h| h.0 == bone).map_or(0.0, |h| h.1);
    let mut candidates: Vec<(u32, f64, Vec<DVec3>)> = reach[bones.of[v] as usize]
        .iter()
        .map(|&bone| {
            let off = off(bone);
            let cost = off.iter().map(|d| d.length_squared()).sum::<f64>() - hold * share(bone);
            (bone, cost, off)
        })
        .collect();
    candidates.sort_by(|a, b| a.1.total_cmp(&b.1).then(a.0.cmp(&b.0)));
    candidates.truncate(CANDIDATES);
    let n = candidates.len();
    let mut gram = vec![[0.0; CANDIDATES]; n];
    let mut pull = [0.0; CANDIDATES];
    for i in 0..n {
        for j in 0..n {
            let (a, b) = (&candidates[i].2, &candidates[j].2);
            gram[i][j] = a.iter().zip(b).map(|(x, y)| x.dot(*y)).sum::<f64>() + if i == j { hold } else { 0.0 };
        }
        pull[i] = hold * share(candidates[i].0);
    }
    let shares = simplex(&gram, &pull[..n]);
    normalised(candidates.iter().zip(shares).map(|(c, share)| (c.0, share)).filter(|c| c.1 > LEAST).collect())
}

/// Shares w ≥ 0 with Σ w = 1 that make ½ wᵀ G w − bᵀ w least, by moving share between the two entries that gain most.
fn simplex(gram: &[[f64; CANDIDATES]], pull: &[f64]) -> Vec<f64> {
    let n = gram.len();
    let mut w = vec![1.0 / n.max(1) as f64; n];
    for _ in 0..200 {
        let slope = |i: usize| (0..n).map(|j| gram[i][j] * w[j]).sum::<f64>() - pull[i];
        let slopes: Vec<f64> = (0..n).map(slope).collect();
        let up = (0..n).min_by(|&a, &b| slopes[a].total_cmp(&slopes[b]));
        let down = (0..n).filter(|&i| w[i] > 0.0).max_by(|&a, &b| slopes[a].total_cmp(&slopes[b]));
        let (Some(up), Some(down)) = (up, down) else { break };
        let gain = slopes[down] - slopes[up];
        let bend = gram[up][up] + gram[down][down] - 2.0 * gram[up][down];
        if up == down || gain <= 1e-9 * (gram[up][up] + gram[down][down]) || bend <= 0.0 {
            break;
        }
        let step = (gain / bend).min(w[down]);
        w[up] += step;
        w[down] -= step;
    }
    w
}

/// Rows half their own, half their neighbours' mean, some rounds over; at most `most` entries each. In a part of a round
/// neighbours have that part of their share.
pub fn averaged(surface: &WeldedSurface, rows: Vec<Row>, most: usize, rounds: f64) -> Vec<Row> {
    let (mut rows, mut next) = (rows, vec![Row::new(); surface.len()]);
    let mut left = rounds;
    while left > 0.0 {
        let mut averager = Averager { beside: BESIDE * left.min(1.0), ..Averager::default() };
        for (v, row) in next.iter_mut().enumerate() {
            averager.average(surface, &rows, v, most, row);
        }
        std::mem::swap(&mut rows, &mut next);
        left -= 1.0;
    }
    rows
}

/// Averages rows, one after another.
pub struct Averager {
    /// What share the neighbours have.
    beside: f64,
    sum: Row,
    /// Where each bone stands in the sum, if that bone stands there.
    places: Vec<usize>,
}

impl Default for Averager {
    fn default() -> Self {
        Self { beside: BESIDE, sum: Row::new(), places: Vec::new() }
    }
}

impl Averager {
    /// Makes `average` one of the rows of [`averaged`], after one round.
    pub fn average(&mut self, surface: &WeldedSurface, rows: &[Row], v: usize, most: usize, average: &mut Row) {
        let neighbours = surface.neighbours(v);
        self.sum.clear();
        self.add(&rows[v], if neighbours.is_empty() { 1.0 } else { 1.0 - self.beside });
        neighbours.iter().for_each(|&u| self.add(&rows[u as usize], self.beside / neighbours.len() as f64));
        self.sum.retain(|s| s.1 > LEAST);
        self.sum.sort_unstable_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));
        self.sum.truncate(most);
        average.clear();
        average.extend_from_slice(&self.sum);
        normalise(average);
    }

    fn add(&mut self, row: &[(u32, f64)], factor: f64) {
        for &(bone, share) in row {
            if self.places.len() <= bone as usize {
                self.places.resize(bone as usize + 1, 0);
            }
            let place = &mut self.places[bone as usize];
            match self.sum.get_mut(*place) {
                Some(s) if s.0 == bone => s.1 += factor * share,
                _ => {
                    *place = self.sum.len();
                    self.sum.push((bone, factor * share));
                }
            }
        }
    }
}

/// The bone with the largest share.
pub fn main_bone(row: &Row) -> u32 {
    row.iter().max_by(|a, b| a.1.total_cmp(&b.1).then(b.0.cmp(&a.0))).map_or(0, |entry| entry.0)
}

/// Shares that sum to 1.
pub fn normalised(mut row: Row) -> Row {
    normalise(&mut row);
    row
}

fn normalise(row: &mut Row) {
    let sum: f64 = row.iter().map(|s| s.1).sum();
    if sum > 0.0 {
        row.iter_mut().for_each(|s| s.1 /= sum);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn shares_of_a_point_between_others_are_barycentric() {
        // Offsets of three bones from the true position; the origin is 0.5, 0.3, 0.2 of them.
        let offs = [DVec3::new(1.0, 0.0, 0.0), DVec3::new(-1.0, 1.0, 0.0), DVec3::new(-1.0, -1.5, 0.0)];
        let mut gram = vec![[0.0; CANDIDATES]; 3];
        for i in 0..3 {
            for j in 0..3 {
                gram[i][j] = offs[i].dot(offs[j]);
            }
        }
        let w = simplex(&gram, &[0.0; 3]);
        for (found, expected) in w.iter().zip([0.5, 0.3, 0.2]) {
            assert!((found - expected).abs() < 1e-6, "{w:?}");
        }
    }
}
