//! How far two labellings of a mesh agree.

use sinew::mesh::face;
use sinew::sequence::Sequence;

/// Share of the area on which two labellings agree after the best one-to-one matching of their labels.
pub fn agreement(sequence: &Sequence, a: &[u32], b: &[u32]) -> f64 {
    let areas = face::areas(sequence.faces(), sequence.reference());
    let count = |labels: &[u32]| labels.iter().max().map_or(0, |&m| m as usize + 1);
    let n = count(a).max(count(b));
    let mut common = vec![vec![0.0; n]; n];
    for ((&i, &j), area) in a.iter().zip(b).zip(&areas) {
        common[i as usize][j as usize] += area;
    }
    best_matching(&common) / areas.iter().sum::<f64>()
}

/// The largest sum of entries of a square matrix, one in each row and column: the Hungarian method with potentials.
fn best_matching(gain: &[Vec<f64>]) -> f64 {
    let n = gain.len();
    let (mut u, mut v) = (vec![0.0; n + 1], vec![0.0; n + 1]);
    let (mut row_of, mut way) = (vec![0; n + 1], vec![0; n + 1]);
    for row in 1..=n {
        row_of[0] = row;
        let mut column = 0;
        let mut slack = vec![f64::INFINITY; n + 1];
        let mut used = vec![false; n + 1];
        while row_of[column] != 0 {
            used[column] = true;
            let i = row_of[column];
            let (mut delta, mut next) = (f64::INFINITY, 0);
            for j in (1..=n).filter(|&j| !used[j]) {
                let cost = -gain[i - 1][j - 1] - u[i] - v[j];
                if cost < slack[j] {
                    slack[j] = cost;
                    way[j] = column;
                }
                if slack[j] < delta {
                    delta = slack[j];
                    next = j;
                }
            }
            for j in 0..=n {
                if used[j] {
                    u[row_of[j]] += delta;
                    v[j] -= delta;
                } else {
                    slack[j] -= delta;
                }
            }
            column = next;
        }
        while column != 0 {
            row_of[column] = row_of[way[column]];
            column = way[column];
        }
    }
    (1..=n).map(|j| gain[row_of[j] - 1][j - 1]).sum()
}
