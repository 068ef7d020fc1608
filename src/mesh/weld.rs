//! Welding: joining vertices that are one point of the surface stored more than once.
//!
//! Files split vertices along seams of texture coordinates and normals. Two vertices are one when they agree in
//! the reference *and* in every pose; agreeing in one pose alone (a closed mouth) is not enough.

use glam::DVec3;

/// Poses that take part in the sorting key; every pose takes part in the comparison.
const KEY_POSES: usize = 8;

/// Finds vertices that agree within `tolerance` (a length, per coordinate) in all the given poses.
///
/// `poses` are P slices of #V points (at least one). Returns, for each vertex, the vertex that stands for it: the
/// lowest-numbered of its group, itself for one that agrees with no other. A group is everything that agrees with
/// one and the same vertex, so groups do not creep along a chain of nearly equal points. Non-finite coordinates
/// agree with nothing.
///
/// Vertices are sorted by one number, a weighted mean of their coordinates over some poses; those that agree are
/// then neighbours in that order, whatever the shape of the mesh.
pub fn weld(poses: &[&[DVec3]], tolerance: f64) -> Vec<u32> {
    let vertices = poses.iter().map(|p| p.len()).min().unwrap_or(0);
    let mut stands: Vec<u32> = (0..vertices as u32).collect();
    let keys = sorting_keys(poses, vertices);
    let mut order: Vec<u32> = (0..vertices as u32).collect();
    order.sort_by(|&a, &b| keys[a as usize].total_cmp(&keys[b as usize]).then(a.cmp(&b)));
    // Representatives whose key is still within reach of the vertex at hand, in the order of their keys.
    let mut near: std::collections::VecDeque<u32> = std::collections::VecDeque::new();
    for v in order {
        while near.front().is_some_and(|&r| keys[r as usize] < keys[v as usize] - tolerance) {
            near.pop_front();
        }
        match near.iter().find(|&&r| agree(poses, r as usize, v as usize, tolerance)) {
            Some(&r) => stands[v as usize] = r,
            None => near.push_back(v),
        }
    }
    lowest_of_each_group(&mut stands);
    stands
}

/// Renumbers after [`weld`] (or any map from vertices to the vertices that stand for them).
///
/// `stands` is #V. Returns the kept vertices in ascending order, and for each vertex its new number.
pub fn compact(stands: &[u32]) -> (Vec<u32>, Vec<u32>) {
    let kept: Vec<u32> = (0..stands.len() as u32).filter(|&v| stands[v as usize] == v).collect();
    let mut number = vec![0; stands.len()];
    for (new, &old) in kept.iter().enumerate() {
        number[old as usize] = new as u32;
    }
    let numbers = stands.iter().map(|&s| number[s as usize]).collect();
    (kept, numbers)
}

/// A mean of each vertex's coordinates with weights that add up to one, so that vertices which agree within a
/// tolerance have keys within the same tolerance. The weights are irregular lest symmetric meshes share keys.
fn sorting_keys(poses: &[&[DVec3]], vertices: usize) -> Vec<f64> {
    let used = poses.len().min(KEY_POSES);
    let mut keys = vec![0.0; vertices];
    let mut total = 0.0;
    for k in 0..used {
        let pose = poses[k * poses.len() / used];
        let weight = |i: usize| 0.5 + ((3 * k + i + 1) as f64 * 0.618_033_988_749_894_9).fract();
        let weights = DVec3::new(weight(0), weight(1), weight(2));
        total += weights.element_sum();
        for (key, p) in keys.iter_mut().zip(pose) {
            *key += weights.dot(*p);
        }
    }
    keys.iter_mut().for_each(|key| *key /= total.max(f64::MIN_POSITIVE));
    keys
}

fn agree(poses: &[&[DVec3]], a: usize, b: usize, tolerance: f64) -> bool {
    poses.iter().all(|pose| (pose[a] - pose[b]).abs().max_element() <= tolerance)
}

fn lowest_of_each_group(stands: &mut [u32]) {
    let mut lowest: Vec<u32> = (0..stands.len() as u32).collect();
    for (v, &s) in stands.iter().enumerate() {
        lowest[s as usize] = lowest[s as usize].min(v as u32);
    }
    stands.iter_mut().for_each(|s| *s = lowest[*s as usize]);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn joins_only_what_agrees_in_every_pose() {
        let rest = [DVec3::X, DVec3::Y, DVec3::X, DVec3::X];
        let bent = [DVec3::Z, DVec3::Y, DVec3::Z, DVec3::ZERO];
        assert_eq!(weld(&[&rest, &bent], 1e-9), [0, 1, 0, 3]);
        assert_eq!(weld(&[&rest], 1e-9), [0, 1, 0, 0]);
    }

    #[test]
    fn tolerance_does_not_creep_along_a_chain() {
        let chain: Vec<DVec3> = (0..10).map(|i| DVec3::X * (0.6 * f64::from(i))).collect();
        let stands = weld(&[&chain], 1.0);
        for (v, &s) in stands.iter().enumerate() {
            assert!((chain[v] - chain[s as usize]).length() <= 2.0, "{v} stands {s}");
        }
        assert!(stands.iter().any(|&s| s > 0));
    }

    #[test]
    fn agrees_with_comparing_all_pairs() {
        // A small pseudo-random cloud on a coarse grid, so that many points coincide.
        let mut state = 1_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((state >> 60) % 3) as f64
        };
        let mut cloud = || (0..200).map(|_| DVec3::new(next(), next(), next())).collect::<Vec<_>>();
        let (a, b) = (cloud(), cloud());
        let stands = weld(&[&a, &b], 1e-6);
        for v in 0..200 {
            let first = (0..200).find(|&u| a[u] == a[v] && b[u] == b[v]);
            assert_eq!(Some(stands[v] as usize), first);
        }
    }

    #[test]
    fn compacts() {
        assert_eq!(compact(&[0, 1, 0, 3, 1]), (vec![0, 1, 3], vec![0, 1, 0, 2, 1]));
    }

    #[test]
    fn nothing_to_weld() {
        assert!(weld(&[&[]], 1.0).is_empty());
        assert!(weld(&[], 1.0).is_empty());
    }
}
