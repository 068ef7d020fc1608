//! True correspondences between creatures of one body plan.
//!
//! A place on the surface is named by a bone, how far along it, and in which direction around it. A ray from that
//! place on the bone's axis outwards meets the surface of either creature at corresponding points.

use super::Creature;
use super::skeleton::Bone;
use glam::DVec3;
use std::f64::consts::TAU;

/// Places along a bone and directions around it.
const ALONG: [f64; 4] = [0.2, 0.4, 0.6, 0.8];
const AROUND: usize = 8;

/// Up to `count` pairs of corresponding vertices (of `a`, of `b`), far apart from each other, the farthest first.
///
/// Empty if the creatures have different body plans. Both vertices of a pair follow the same bone most.
pub fn correspondences(a: &Creature, b: &Creature, count: usize) -> Vec<(u32, u32)> {
    if a.plan != b.plan {
        return Vec::new();
    }
    let rays = rays(a, b);
    let hits = [hits(a, rays.iter().map(|r| r.0)), hits(b, rays.iter().map(|r| r.1))];
    let pairs: Vec<(u32, u32)> = hits[0].iter().zip(&hits[1]).filter_map(|(x, y)| Some(((*x)?, (*y)?))).collect();
    far_apart(a, pairs, count)
}

/// A ray from the axis of a bone outwards.
#[derive(Clone, Copy)]
struct Ray {
    bone: u32,
    from: DVec3,
    direction: DVec3,
}

/// Corresponding rays of all bones that both have, in the poses of the meshes.
fn rays(a: &Creature, b: &Creature) -> Vec<(Ray, Ray)> {
    let mut rays = Vec::new();
    for (number, bone) in (0..).zip(&a.skeleton.bones) {
        let Some(other) = b.skeleton.find(&bone.name) else { continue };
        let Some(twin) = b.skeleton.bones.get(other as usize) else { continue };
        for t in ALONG {
            for step in 0..AROUND {
                let angle = TAU * (step as f64 + 0.5) / AROUND as f64;
                rays.push((ray(number, bone, t, angle), ray(other, twin, t, angle)));
            }
        }
    }
    rays
}

fn ray(number: u32, bone: &Bone, t: f64, angle: f64) -> Ray {
    let axis = (bone.end - bone.joint).normalize_or(DVec3::Y);
    // Sideways is the same for all bones: none of them points sideways alone.
    let ahead = axis.cross(DVec3::X).normalize_or(DVec3::Z);
    let side = ahead.cross(axis);
    Ray {
        bone: number,
        from: bone.joint + t * (bone.end - bone.joint),
        direction: side * angle.cos() + ahead * angle.sin(),
    }
}

/// For each ray, the vertex nearest to where it leaves the body, if that follows the ray's bone.
fn hits(creature: &Creature, rays: impl Iterator<Item = Ray>) -> Vec<Option<u32>> {
    let points = &creature.made;
    // Faces by the bone they follow: a ray can only leave through its own.
    let mut by_bone = vec![Vec::new(); creature.skeleton.bones.len()];
    for (face, &label) in creature.sequence.faces().iter().zip(&creature.labels) {
        if let Some(list) = by_bone.get_mut(label as usize) {
            list.push(face.map(|v| (v, points[v as usize])));
        }
    }
    rays.map(|ray| {
        let faces = by_bone.get(ray.bone as usize)?;
        let crossing = |corners: &[(u32, DVec3); 3]| {
            let t = crossed(ray.from, ray.direction, corners.map(|c| c.1))?;
            let at = ray.from + t * ray.direction;
            let nearest = corners.iter().min_by(|p, q| at.distance(p.1).total_cmp(&at.distance(q.1)))?;
            Some((t, nearest.0))
        };
        let first = faces.iter().filter_map(crossing).min_by(|p, q| p.0.total_cmp(&q.0))?;
        let follows = creature.weights.get(first.1 as usize)?.first()?.0;
        (follows == ray.bone).then_some(first.1)
    })
    .collect()
}

/// Where a ray crosses a triangle from within (Möller and Trumbore, 1997).
pub(super) fn crossed(from: DVec3, direction: DVec3, [a, b, c]: [DVec3; 3]) -> Option<f64> {
    let (e1, e2) = (b - a, c - a);
    let p = direction.cross(e2);
    let determinant = e1.dot(p);
    // Counter-clockwise seen from outside: a ray from within sees the back.
    if determinant > -1e-14 {
        return None;
    }
    let s = from - a;
    let u = s.dot(p) / determinant;
    let q = s.cross(e1);
    let v = direction.dot(q) / determinant;
    let t = e2.dot(q) / determinant;
    (u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0).then_some(t)
}

/// Farthest point sampling on `a`, starting with the point farthest from the middle.
fn far_apart(a: &Creature, pairs: Vec<(u32, u32)>, count: usize) -> Vec<(u32, u32)> {
    let at = |pair: &(u32, u32)| a.made[pair.0 as usize];
    let middle = a.made.iter().sum::<DVec3>() / a.made.len().max(1) as f64;
    let mut distance: Vec<f64> = pairs.iter().map(|pair| at(pair).distance(middle)).collect();
    let mut chosen: Vec<(u32, u32)> = Vec::new();
    while chosen.len() < count.min(pairs.len()) {
        let farthest = (0..pairs.len()).max_by(|&i, &j| distance[i].total_cmp(&distance[j]).then(j.cmp(&i)));
        let Some(next) = farthest.filter(|&i| distance[i] > 0.0).map(|i| pairs[i]) else { break };
        let first = chosen.is_empty();
        chosen.push(next);
        for (pair, distance) in pairs.iter().zip(&mut distance) {
            let to = at(pair).distance(at(&next));
            // The same vertex of b must not come twice either.
            let to = if pair.1 == next.1 { 0.0 } else { to };
            *distance = if first { to } else { distance.min(to) };
        }
    }
    chosen
}
