//! Bones by clustering of motions: vertices belong to the bone whose rigid motion explains their poses best.

use crate::linalg::rigid_fit::{Moments, RigidMotion};
use crate::poses::spread;
use crate::transfer::surface::WeldedSurface;
use glam::DVec3;

/// Poses that are looked at, the most different ones.
const POSES: usize = 16;
/// Vertices by which poses are compared.
const COMPARED: usize = 500;
/// Vertices that take part in the clustering, evenly thinned.
const SAMPLES: usize = 2500;
/// Bones are added until motions explain the vertices to this root mean square, in radii.
const PRECISION: f64 = 0.002;
/// Rounds of assignment and fit after each split.
const ROUNDS: usize = 5;
/// The share of a bone's vertices, nearest to the one that it explains worst, that founds the next bone.
const FOUNDERS: usize = 8;
/// The share of the area below which a patch of a bone that lies apart from the rest goes to its neighbours.
const PATCH: f64 = 0.004;

/// Vertices by bones.
#[derive(Clone, Debug)]
pub struct BoneClusters {
    /// The number of bones.
    pub count: usize,
    /// #N the bone of each vertex.
    pub of: Vec<u32>,
    /// For each pose looked at, the motion of each bone.
    pub motions: Vec<Vec<RigidMotion>>,
}

/// Up to `POSES` poses that differ most from the reference and from each other, in ascending order.
pub fn telling_poses(surface: &WeldedSurface, poses: &[Vec<DVec3>]) -> Vec<usize> {
    let step = surface.len().div_ceil(COMPARED).max(1);
    let compared: Vec<usize> = (0..surface.len()).step_by(step).collect();
    spread(&surface.positions, poses, &compared, POSES, 0.0)
}

/// Finds bones; at least one for a surface with vertices.
pub fn find(surface: &WeldedSurface, poses: &[&[DVec3]], most: usize) -> BoneClusters {
    let step = surface.len().div_ceil(SAMPLES).max(1);
    let samples: Vec<usize> = (0..surface.len()).step_by(step).collect();
    let mut of = vec![0; samples.len()];
    let mut motions = fit(surface, poses, &samples, &of, 1);
    loop {
        for _ in 0..ROUNDS {
            for (bone, &v) in of.iter_mut().zip(&samples) {
                *bone = best(surface, poses, &motions, v).0;
            }
            motions = fit(surface, poses, &samples, &of, motions.len());
        }
        let founders = founders(surface, poses, &samples, &of, &motions, most.saturating_sub(motions.len()));
        if founders.is_empty() {
            break;
        }
        motions.extend(founders.iter().map(|members| moved(surface, poses, members)));
    }
    let of: Vec<u32> = (0..surface.len()).map(|v| best(surface, poses, &motions, v).0).collect();
    let (of, count) = patches(surface, &of);
    let all: Vec<usize> = (0..surface.len()).collect();
    let by_bone = fit(surface, poses, &all, &of, count);
    let motions = (0..poses.len()).map(|p| by_bone.iter().map(|bone| bone[p]).collect()).collect();
    BoneClusters { count, of, motions }
}

/// For each bone its motion in each pose.
fn fit(
    surface: &WeldedSurface,
    poses: &[&[DVec3]],
    samples: &[usize],
    of: &[u32],
    count: usize,
) -> Vec<Vec<RigidMotion>> {
    let mut moments = vec![vec![Moments::default(); poses.len()]; count];
    for (&v, &bone) in samples.iter().zip(of) {
        for (moments, pose) in moments[bone as usize].iter_mut().zip(poses) {
            moments.add(surface.mass[v], surface.positions[v], pose[v]);
        }
    }
    moments.iter().map(|bone| bone.iter().map(Moments::motion).collect()).collect()
}

/// The motion of some vertices in each pose.
fn moved(surface: &WeldedSurface, poses: &[&[DVec3]], members: &[usize]) -> Vec<RigidMotion> {
    let moments = |pose: &&[DVec3]| {
        let mut moments = Moments::default();
        members.iter().for_each(|&v| moments.add(surface.mass[v], surface.positions[v], pose[v]));
        moments.motion()
    };
    poses.iter().map(moments).collect()
}

/// Sum over the poses of the squared distance of a vertex from where a bone puts it.
fn unlike(surface: &WeldedSurface, poses: &[&[DVec3]], bone: &[RigidMotion], v: usize) -> f64 {
    let p = surface.positions[v];
    bone.iter().zip(poses).map(|(motion, pose)| motion.apply(p).distance_squared(pose[v])).sum()
}

/// The bone that explains a vertex best, and how badly.
fn best(surface: &WeldedSurface, poses: &[&[DVec3]], motions: &[Vec<RigidMotion>], v: usize) -> (u32, f64) {
    let all = motions.iter().zip(0_u32..).map(|(bone, i)| (i, unlike(surface, poses, bone, v)));
    all.reduce(|best, next| if next.1 < best.1 { next } else { best }).unwrap_or((0, 0.0))
}

/// Vertices on which to found new bones: in the bones that are worst off, around the vertex that is worst off.
fn founders(
    surface: &WeldedSurface,
    poses: &[&[DVec3]],
    samples: &[usize],
    of: &[u32],
    motions: &[Vec<RigidMotion>],
    room: usize,
) -> Vec<Vec<usize>> {
    let count = motions.len();
    let mut members = vec![Vec::new(); count];
    let mut cost = vec![0.0; count];
    let mut worst = vec![(0, -1.0); count];
    let (mut total, mut area) = (0.0, 0.0);
    for (&v, &bone) in samples.iter().zip(of) {
        let bone = bone as usize;
        let unlike = unlike(surface, poses, &motions[bone], v);
        members[bone].push(v);
        cost[bone] += surface.mass[v] * unlike;
        total += surface.mass[v] * unlike;
        area += surface.mass[v];
        if unlike > worst[bone].1 {
            worst[bone] = (v, unlike);
        }
    }
    let allowed = PRECISION * PRECISION * poses.len() as f64 * area;
    if total <= allowed || room == 0 {
        return Vec::new();
    }
    let mut order: Vec<usize> = (0..count).filter(|&b| members[b].len() >= 2 * FOUNDERS).collect();
    order.sort_by(|&a, &b| cost[b].total_cmp(&cost[a]).then(a.cmp(&b)));
    // The worse half, and never more than double: bones that are split in one round do not see each other.
    order.truncate(count.div_ceil(2).min(room));
    let around = |bone: usize| {
        let centre = surface.positions[worst[bone].0];
        let mut near = members[bone].clone();
        near.sort_by(|&a, &b| {
            let distance = |v: usize| surface.positions[v].distance_squared(centre);
            distance(a).total_cmp(&distance(b)).then(a.cmp(&b))
        });
        near.truncate((near.len() / FOUNDERS).max(FOUNDERS));
        near
    };
    order.into_iter().filter(|&bone| cost[bone] > 0.0).map(around).collect()
}

/// Makes every bone one patch of the surface: a patch apart from the rest becomes a bone of its own, or goes to the bone
/// around it if it is small. What lies on several connected pieces of the mesh stays one bone.
fn patches(surface: &WeldedSurface, of: &[u32]) -> (Vec<u32>, usize) {
    let mut of = of.to_vec();
    for _ in 0..10 {
        let (patch, count) = components(surface, |a, b| of[a] == of[b]);
        let mut area = vec![0.0; count];
        patch.iter().zip(&surface.mass).for_each(|(&p, m)| area[p as usize] += m);
        let mut votes: Vec<std::collections::BTreeMap<u32, usize>> = vec![Default::default(); count];
        for v in 0..surface.len() {
            if area[patch[v] as usize] < PATCH {
                for &u in surface.neighbours(v) {
                    if of[u as usize] != of[v] {
                        *votes[patch[v] as usize].entry(of[u as usize]).or_default() += 1;
                    }
                }
            }
        }
        let to: Vec<Option<u32>> = votes
            .iter()
            .map(|v| v.iter().max_by_key(|(bone, n)| (**n, std::cmp::Reverse(**bone))).map(|b| *b.0))
            .collect();
        let mut changed = false;
        for (bone, &p) in of.iter_mut().zip(&patch) {
            if let Some(to) = to[p as usize] {
                *bone = to;
                changed = true;
            }
        }
        if !changed {
            break;
        }
    }
    apart(surface, &of)
}

/// Gives the patches of a bone that lie on one piece of the mesh numbers of their own.
fn apart(surface: &WeldedSurface, of: &[u32]) -> (Vec<u32>, usize) {
    let (patch, _) = components(surface, |a, b| of[a] == of[b]);
    let (piece, _) = components(surface, |_, _| true);
    // The patches of each bone and piece, by area; the largest of each piece are the bone itself.
    let mut largest: std::collections::BTreeMap<(u32, u32), std::collections::BTreeMap<u32, f64>> = Default::default();
    for v in 0..surface.len() {
        *largest.entry((of[v], piece[v])).or_default().entry(patch[v]).or_default() += surface.mass[v];
    }
    let mut number: std::collections::BTreeMap<(u32, Option<u32>), u32> = Default::default();
    let mut of_patch: std::collections::BTreeMap<u32, u32> = Default::default();
    for ((bone, _), patches) in &largest {
        let main = patches.iter().max_by(|a, b| a.1.total_cmp(b.1).then(b.0.cmp(a.0))).map(|p| *p.0);
        for &patch in patches.keys() {
            let own = (Some(patch) != main).then_some(patch);
            let next = number.len() as u32;
            of_patch.insert(patch, *number.entry((*bone, own)).or_insert(next));
        }
    }
    (patch.iter().map(|p| of_patch.get(p).copied().unwrap_or(0)).collect(), number.len().max(1))
}

/// Connected components of the vertices over edges that join, and their number.
fn components(surface: &WeldedSurface, joined: impl Fn(usize, usize) -> bool) -> (Vec<u32>, usize) {
    let mut component = vec![u32::MAX; surface.len()];
    let mut count = 0;
    let mut stack = Vec::new();
    for v in 0..surface.len() {
        if component[v] != u32::MAX {
            continue;
        }
        component[v] = count;
        stack.push(v);
        while let Some(a) = stack.pop() {
            for &b in surface.neighbours(a) {
                if component[b as usize] == u32::MAX && joined(a, b as usize) {
                    component[b as usize] = count;
                    stack.push(b as usize);
                }
            }
        }
        count += 1;
    }
    (component, count as usize)
}
