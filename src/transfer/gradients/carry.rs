//! The motion of the source asked of the target's faces.

use super::operator::{deformations, gradients};
use super::solver::Solver;
use crate::linalg::cholesky::NotPositiveDefinite;
use crate::linalg::outer::outer;
use crate::linalg::polar::frobenius;
use crate::mesh::face;
use crate::transfer::alignment::Alignment;
use crate::transfer::correspondence::Correspondence;
use crate::transfer::surface::WeldedSurface;
use glam::{DMat3, DVec3};

/// Poses by which faces are judged that do not fit in with those around them.
const JUDGED: usize = 12;
/// The least weight of a face without a partner, over that of one with a partner; and of one without area, over the mean.
const LEAST: f64 = 1e-3;

/// A source in motion, a target, and which of their faces correspond.
pub struct Scene<'a> {
    /// The source.
    pub source: &'a WeldedSurface,
    /// For each of its poses #N positions in the unit ball of the reference.
    pub poses: &'a [Vec<DVec3>],
    /// The target.
    pub target: &'a WeldedSurface,
    /// How the target as a whole lies to the source.
    pub alignment: Alignment,
    /// Which faces correspond.
    pub correspondence: &'a Correspondence,
    /// #F rotations of the target's faces before they are moved, or none of them (Eq. 9 of Lee, Wang & Chen 2006).
    pub turns: &'a [DMat3],
    /// Where the target's vertices are after those rotations (#N).
    pub turned: &'a [DVec3],
    /// Places of the target that go exactly as far as their twins do, but for the size.
    pub pins: &'a [u32],
    /// A face that is off by so much from what is asked of it counts half; 0: all count in full.
    pub doubt: f64,
}

/// #F weights of the target's faces: area times the number of partners, so that neither a finer source nor a finer target
/// counts more where it is finer. (The paper: the number of partners alone.)
fn weights(scene: &Scene) -> Vec<f64> {
    let areas = face::areas(&scene.target.faces, &scene.target.positions);
    let mut weights = vec![0.0_f64; areas.len()];
    scene.correspondence.pairs.iter().for_each(|pair| weights[pair[0] as usize] += 1.0);
    let mean = (areas.iter().sum::<f64>() / areas.len().max(1) as f64).max(f64::MIN_POSITIVE);
    weights.iter().zip(&areas).map(|(w, area)| w.max(LEAST) * (area / mean).max(LEAST)).collect()
}

/// #F maps of the target's faces in a pose of the source: the mean of their partners', in the target's frame, after the
/// face's own rotation.
fn maps(scene: &Scene, of_source: &[Option<DMat3>]) -> Vec<DMat3> {
    let mut sums = vec![(DMat3::ZERO, 0.0); scene.target.faces.len()];
    for &[face, partner] in &scene.correspondence.pairs {
        if let Some(map) = of_source[partner as usize] {
            let sum = &mut sums[face as usize];
            sum.0 += map;
            sum.1 += 1.0;
        }
    }
    let turn = scene.alignment.turn;
    let mean = |(sum, n): (DMat3, f64)| {
        if n > 0.0 { turn * (sum * (1.0 / n)) * turn.transpose() } else { DMat3::IDENTITY }
    };
    let maps = sums.into_iter().map(mean);
    if scene.turns.is_empty() { maps.collect() } else { maps.zip(scene.turns).map(|(s, p)| s * *p).collect() }
}

/// The target's poses: for each, #N positions in its unit ball.
pub fn carry(scene: &Scene) -> Result<Vec<Vec<DVec3>>, NotPositiveDefinite> {
    let own = gradients(scene.source);
    let maps = |pose: usize| maps(scene, &deformations(scene.source, &own, &scene.poses[pose]));
    let weights = weights(scene);
    let mut solver = Solver::new(scene.target, &weights, scene.pins)?;
    let goals = pinned(scene);
    if scene.doubt > 0.0 {
        let every = scene.poses.len().div_ceil(JUDGED).max(1);
        let some: Vec<Vec<DMat3>> = (0..scene.poses.len()).step_by(every).map(maps).collect();
        let their: Vec<Vec<DVec3>> = goals.iter().step_by(every).cloned().collect();
        let off = misfits(scene.target, &some, &solver.solve(some.len(), &|i| some[i].clone(), &their));
        let trusted: Vec<f64> =
            weights.iter().zip(&off).map(|(w, off)| w / (1.0 + (off / scene.doubt).powi(2))).collect();
        solver = Solver::new(scene.target, &trusted, scene.pins)?;
    }
    let mut poses = solver.solve(scene.poses.len(), &maps, &goals);
    if goals.is_empty() {
        for (pose, of_source) in poses.iter_mut().zip(scene.poses) {
            settle(scene, of_source, pose);
        }
    }
    Ok(poses)
}

/// #F: how far, at most over poses, a face is from what is asked of it (the Frobenius norm within its plane).
fn misfits(target: &WeldedSurface, maps: &[Vec<DMat3>], poses: &[Vec<DVec3>]) -> Vec<f64> {
    let mut worst = vec![0.0_f64; target.faces.len()];
    let gradients = gradients(target);
    for (maps, pose) in maps.iter().zip(poses) {
        for (f, gradient) in gradients.iter().enumerate() {
            let Some(gradient) = gradient else { continue };
            let found = gradient.map(face::corners(pose, target.faces[f]), DVec3::ZERO);
            let n = gradient.normal;
            let off = found - (maps[f] - outer(maps[f] * n, n));
            worst[f] = worst[f].max(frobenius(off));
        }
    }
    worst
}

/// For each pose, where the pins go: as far as the source does where it corresponds, but for the size. So a foot that stands
/// on the source stands on the target. Empty without pins.
fn pinned(scene: &Scene) -> Vec<Vec<DVec3>> {
    if scene.pins.is_empty() {
        return Vec::new();
    }
    let pairs = &scene.correspondence.pairs;
    let partners_of = |place: u32| -> Vec<u32> {
        let faces = scene.target.faces_around(place as usize).iter();
        let partners = |&f: &u32| {
            let from = pairs.partition_point(|pair| pair[0] < f);
            pairs[from..].iter().take_while(move |pair| pair[0] == f).map(|pair| pair[1])
        };
        faces.flat_map(partners).collect()
    };
    let partners: Vec<Vec<u32>> = scene.pins.iter().map(|&pin| partners_of(pin)).collect();
    let goal = |pose: &Vec<DVec3>, pin: u32, partners: &Vec<u32>| {
        let sum: DVec3 = partners.iter().map(|&f| shift(&scene.source.faces, &scene.source.positions, pose, f)).sum();
        let way = sum / partners.len().max(1) as f64;
        scene.turned[pin as usize] + scene.alignment.size * (scene.alignment.turn * way)
    };
    let of_pose = |pose| scene.pins.iter().zip(&partners).map(|(&pin, partners)| goal(pose, pin, partners)).collect();
    scene.poses.iter().map(of_pose).collect()
}

/// How far the middle of a face goes.
fn shift(faces: &[[u32; 3]], from: &[DVec3], to: &[DVec3], face: u32) -> DVec3 {
    faces[face as usize].iter().map(|&v| to[v as usize] - from[v as usize]).sum::<DVec3>() / 3.0
}

/// Moves a pose of the target to where the source's pose is: the mean shift of the faces that correspond, weighted by the
/// area on the target, is the same on both sides but for the size.
fn settle(scene: &Scene, of_source: &[DVec3], pose: &mut [DVec3]) {
    let Scene { source, target, alignment, .. } = *scene;
    let (mut off, mut total) = (DVec3::ZERO, 0.0);
    for of_face in scene.correspondence.pairs.chunk_by(|a, b| a[0] == b[0]) {
        let face = of_face[0][0];
        let sum: DVec3 = of_face.iter().map(|pair| shift(&source.faces, &source.positions, of_source, pair[1])).sum();
        let wanted = alignment.size * (alignment.turn * sum) / of_face.len() as f64;
        let area: f64 = target.faces[face as usize].iter().map(|&v| target.mass[v as usize]).sum();
        off += area * (wanted - shift(&target.faces, scene.turned, pose, face));
        total += area;
    }
    if total > 0.0 && off.is_finite() {
        pose.iter_mut().for_each(|p| *p += off / total);
    }
}
