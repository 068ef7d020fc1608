//! Groups of vertices that move alike: k-means on rotation-augmented weights (Eq. 15).
//!
//! Stuart P. Lloyd. Least squares quantization in PCM. IEEE Transactions on Information Theory 28(2), 1982.

/// Rounds at most; groups are settled long before.
const ROUNDS: usize = 30;

/// Groups vertices by their rows `[W, features]`: #V group numbers below the number of handles.
///
/// `weights` is #V × #H row-major, `features` #V rows of any width ([`super::features`]), `mass` #V. There are as many
/// groups as handles (§3.3), and each starts from its handle's own row, so that nothing is left to chance: `handles` are
/// the seeds. A group may end up empty.
pub fn clusters(weights: &[f64], features: &[f64], handles: &[u32], mass: &[f64]) -> Vec<u32> {
    let (n, h) = (mass.len(), handles.len());
    if h < 2 || n == 0 {
        return vec![0; n];
    }
    let width = features.len() / n;
    let row = |v: usize| (&weights[v * h..(v + 1) * h], &features[v * width..(v + 1) * width]);
    let start = |&v: &u32| [row(v as usize).0, row(v as usize).1].concat();
    let mut centres: Vec<Vec<f64>> = handles.iter().map(start).collect();
    let mut groups = vec![u32::MAX; n];
    for _ in 0..ROUNDS {
        let mut changed = false;
        for (v, group) in groups.iter_mut().enumerate() {
            let nearest = nearest(&centres, row(v), *group);
            changed |= nearest != *group;
            *group = nearest;
        }
        if !changed {
            break;
        }
        move_to_means(&mut centres, &groups, mass, row);
    }
    groups
}

/// The nearest centre, the one `before` if it is as near as any.
fn nearest(centres: &[Vec<f64>], row: (&[f64], &[f64]), before: u32) -> u32 {
    let h = row.0.len();
    let distance = |centre: &[f64], limit: f64| {
        let near = squared(&centre[..h], row.0);
        // Most centres are too far by their weights alone.
        if near > limit { near } else { near + squared(&centre[h..], row.1) }
    };
    let (mut best, mut least) = match centres.get(before as usize) {
        Some(centre) => (before, distance(centre, f64::INFINITY)),
        None => (0, f64::INFINITY),
    };
    for (k, centre) in centres.iter().enumerate() {
        let d = distance(centre, least);
        if d < least {
            (best, least) = (k as u32, d);
        }
    }
    best
}

fn squared(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(x, y)| (x - y) * (x - y)).sum()
}

fn move_to_means<'a>(
    centres: &mut [Vec<f64>],
    groups: &[u32],
    mass: &[f64],
    row: impl Fn(usize) -> (&'a [f64], &'a [f64]),
) {
    let width = centres.first().map_or(0, Vec::len);
    let mut sums = vec![(0.0, vec![0.0; width]); centres.len()];
    for (v, (&group, &m)) in groups.iter().zip(mass).enumerate() {
        let (total, sum) = &mut sums[group as usize];
        let (weights, features) = row(v);
        *total += m;
        sum.iter_mut().zip(weights.iter().chain(features)).for_each(|(s, x)| *s += m * x);
    }
    for (centre, (total, sum)) in centres.iter_mut().zip(sums) {
        if total > 0.0 {
            centre.iter_mut().zip(sum).for_each(|(c, s)| *c = s / total);
        }
    }
}
