//! Carries the motions of bones to a body of other proportions so that joints stay joints.
//!
//! Where two bones blend, their motions disagree by `Tᵢ x − Tⱼ x`: nothing at a joint's centre, more away from it. On the
//! target they are made to disagree by as much, at the same scale, in the middle of the same blend; linear parts are kept
//! and one small system per pose gives all translations. Everywhere a limb is as thick or as long as it is, it turns
//! about the centre of the corresponding blend.

use super::alignment::Alignment;
use super::rig::Rig;
use super::rig::blends::{Blend, blends};
use super::rig::weights::{Row, main_bone};
use super::surface::WeldedSurface;
use crate::mesh::kd_tree::KdTree;
use glam::{DAffine3, DVec3};
use nalgebra::{Cholesky, DMatrix, Dyn};
use std::collections::BTreeMap;

/// How much each bone is held to its own scaled displacement: it only decides where the whole goes.
const ANCHOR: f64 = 1e-6;
/// The weight of a link between bones that do not blend.
const LOOSE: f64 = 1e-3;
/// Vertices of a group of bones that look for the nearest other group.
const ASKED: usize = 300;

/// Where two bones meet.
#[derive(Clone, Copy, Debug)]
struct Link {
    bones: [usize; 2],
    weight: f64,
    source: DVec3,
    target: DVec3,
}

/// The links of a rig between a source and a target, and their factored system.
pub struct Joints {
    alignment: Alignment,
    links: Vec<Link>,
    /// Where each bone is on the source and on the target, and its share of the target.
    bones: Vec<(DVec3, DVec3, f64)>,
    system: Option<Cholesky<f64, Dyn>>,
}

impl Joints {
    /// Finds the links; `rows` are the weights of the same bones on the target.
    pub fn new(source: &WeldedSurface, rig: &Rig, target: &WeldedSurface, rows: &[Row], alignment: Alignment) -> Self {
        let there = blends(target, rows, rig.bones);
        let mut links: Vec<Link> = Vec::new();
        let mut bones = vec![(DVec3::ZERO, DVec3::ZERO, 0.0); rig.bones];
        for (&(i, j), a) in &rig.blends {
            let other = there.get(&(i, j));
            if i == j {
                let target = other.map_or(alignment.apply(a.middle()), Blend::middle);
                bones[i as usize] = (a.middle(), target, other.map_or(0.0, |b| b.weight));
            } else if let Some(b) = other {
                let weight = (a.weight * b.weight).sqrt();
                links.push(Link { bones: [i as usize, j as usize], weight, source: a.middle(), target: b.middle() });
            }
        }
        join_loose(source, rig, &bones, &mut links);
        let mut system = DMatrix::zeros(rig.bones, rig.bones);
        for link in &links {
            let [i, j] = link.bones;
            system[(i, i)] += link.weight;
            system[(j, j)] += link.weight;
            system[(i, j)] -= link.weight;
            system[(j, i)] -= link.weight;
        }
        for (i, bone) in bones.iter_mut().enumerate() {
            bone.2 = ANCHOR * (bone.2 + 1e-6);
            system[(i, i)] += bone.2;
        }
        Self { alignment, links, bones, system: system.cholesky() }
    }

    /// The motions of the bones on the target, of those on the source, both in unit balls.
    pub fn carry(&self, maps: &[DAffine3]) -> Vec<DAffine3> {
        let Alignment { turn, size, .. } = self.alignment;
        let linear = |map: &DAffine3| turn * map.matrix3 * turn.transpose();
        let mut side = DMatrix::zeros(self.bones.len(), 3);
        for link in &self.links {
            let [i, j] = link.bones;
            let (Some(a), Some(b)) = (maps.get(i), maps.get(j)) else { continue };
            let apart = a.transform_point3(link.source) - b.transform_point3(link.source);
            let apart = size * (turn * apart) - (linear(a) - linear(b)) * link.target;
            for k in 0..3 {
                side[(i, k)] += link.weight * apart[k];
                side[(j, k)] -= link.weight * apart[k];
            }
        }
        for (i, (map, &(source, target, hold))) in maps.iter().zip(&self.bones).enumerate() {
            let shift = size * (turn * (map.transform_point3(source) - source));
            let wanted = target + shift - linear(map) * target;
            (0..3).for_each(|k| side[(i, k)] += hold * wanted[k]);
        }
        if let Some(system) = &self.system {
            system.solve_mut(&mut side);
        }
        let translation = |i: usize| DVec3::new(side[(i, 0)], side[(i, 1)], side[(i, 2)]);
        maps.iter()
            .enumerate()
            .map(|(i, map)| DAffine3::from_mat3_translation(linear(map), translation(i)))
            .map(|map| if map.is_finite() { map } else { DAffine3::IDENTITY })
            .collect()
    }
}

/// Links groups of bones that blend with no other group (pieces of the mesh, such as eyes) to what is nearest on the
/// source: their middle then moves with that.
fn join_loose(source: &WeldedSurface, rig: &Rig, bones: &[(DVec3, DVec3, f64)], links: &mut Vec<Link>) {
    let strongest = links.iter().map(|link| link.weight).fold(0.0, f64::max);
    let weight = if strongest > 0.0 { LOOSE * strongest } else { LOOSE };
    let main: Vec<u32> = rig.rows.iter().map(main_bone).collect();
    let mut group: Vec<usize> = (0..rig.bones).collect();
    links.iter().for_each(|link| join(&mut group, link.bones));
    // Most rigs are joined already, and need no tree.
    let mut tree: Option<KdTree<3>> = None;
    loop {
        let mut members: BTreeMap<usize, Vec<u32>> = BTreeMap::new();
        for (v, &bone) in main.iter().enumerate() {
            members.entry(group[bone as usize]).or_default().push(v as u32);
        }
        if members.len() < 2 {
            return;
        }
        // The smallest group first: an eye joins the head, not the head the eye.
        let Some((own, vertices)) = members.iter().min_by_key(|(root, list)| (list.len(), **root)) else { return };
        let elsewhere = |u: u32| group[main[u as usize] as usize] != *own;
        let tree = tree.get_or_insert_with(|| KdTree::of_points(&source.positions));
        let found = vertices.iter().step_by(vertices.len().div_ceil(ASKED)).filter_map(|&v| {
            let u = tree.nearest_of(&source.positions[v as usize].to_array(), elsewhere)?;
            Some((source.positions[v as usize].distance_squared(source.positions[u as usize]), v, u))
        });
        let Some((_, v, u)) = found.min_by(|a, b| a.0.total_cmp(&b.0)) else { return };
        let [i, j] = [v, u].map(|v| main[v as usize]);
        let (at, there, _) = bones[i as usize];
        links.push(Link { bones: [i as usize, j as usize], weight, source: at, target: there });
        join(&mut group, [i as usize, j as usize]);
    }
}

/// Makes the groups of two bones one.
fn join(group: &mut [usize], [a, b]: [usize; 2]) {
    let (a, b) = (group[a].min(group[b]), group[a].max(group[b]));
    group.iter_mut().filter(|g| **g == b).for_each(|g| *g = a);
}
