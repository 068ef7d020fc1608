//! A moving mesh as a rigid skin, in one GLB file: a joint for each near-rigid part, and every vertex on one of them.
//!
//! What the segmentation found, as what game engines play: a decomposition into rigid bones without a skeleton. What it
//! loses is measured against the sequence.
//!
//! Doug L. James, Christopher D. Twigg. Skinning mesh animations. ACM Transactions on Graphics 24(3), 2005.

use super::skin::{Influences, LightError, Skin, SkinPose, light};
use crate::linalg::rigid_fit::Moments;
use crate::look::Look;
use crate::mesh::face;
use crate::sequence::Sequence;
use glam::{DAffine3, DVec3};

/// Vertices times parts for which a table of weights is made.
const MOST: usize = 100_000_000;

/// A rigid skin as a file.
#[derive(Clone, Debug)]
pub struct Rigid {
    /// The GLB.
    pub bytes: Vec<u8>,
    /// Root mean square, over vertices and poses, of how far the skin puts a vertex from where the sequence has it, over
    /// the diagonal of the reference.
    pub rms: f64,
    /// The largest such distance, over the diagonal.
    pub largest: f64,
}

/// The sequence as a skin with a joint for each part; `labels` is #F part numbers (a face without one counts as part 0);
/// in one colour where it has no look that fits it.
///
/// A vertex follows the part that has the largest area around it, and each part moves in each pose by the rigid motion
/// that is best for its vertices.
pub fn rigid(sequence: &Sequence, labels: &[u32], look: Option<&Look>) -> Result<Rigid, LightError> {
    let reference = sequence.reference();
    let parts = labels.iter().max().map_or(1, |&most| most as usize + 1);
    if parts > usize::from(u16::MAX) || parts.saturating_mul(reference.len()) > MOST {
        return Err(LightError::TooMany(parts));
    }
    let owner = owners(sequence, labels);
    let poses: Vec<(&str, f64, Vec<DAffine3>)> = sequence
        .poses()
        .iter()
        .map(|pose| (pose.name.as_str(), pose.time, maps(reference, &pose.positions, &owner, parts)))
        .collect();
    let mut weights = vec![0.0; reference.len() * parts];
    for (row, &part) in weights.chunks_exact_mut(parts).zip(&owner) {
        row[part as usize] = 1.0;
    }
    let skin_poses: Vec<SkinPose> =
        poses.iter().map(|(name, time, maps)| SkinPose { name, time: *time, maps }).collect();
    let skin = Skin {
        name: sequence.name(),
        faces: sequence.faces(),
        reference,
        weights: &weights,
        handles: parts,
        poses: &skin_poses,
        look,
    };
    let file = light(&skin, Influences::Four)?;
    let (mut sum, mut largest) = (0.0, 0.0_f64);
    for (pose, (_, _, maps)) in sequence.poses().iter().zip(&poses) {
        for ((&p, &q), &part) in reference.iter().zip(&pose.positions).zip(&owner) {
            let away = maps[part as usize].transform_point3(p).distance_squared(q);
            sum += away;
            largest = largest.max(away);
        }
    }
    let number = (poses.len() * reference.len()).max(1) as f64;
    let share = |x: f64| if sequence.diagonal() > 0.0 && x.is_finite() { x / sequence.diagonal() } else { 0.0 };
    // What the numbers of the file round away comes on top.
    let rms = share((sum / number).sqrt()).hypot(file.rms);
    Ok(Rigid { bytes: file.bytes, rms, largest: share(largest.sqrt()) + file.largest })
}

/// #V: the part with the largest area around each vertex; 0 for a vertex without a face.
fn owners(sequence: &Sequence, labels: &[u32]) -> Vec<u32> {
    let mut shares: Vec<(u32, u32, f64)> = Vec::with_capacity(3 * sequence.faces().len());
    for (f, &corners) in sequence.faces().iter().enumerate() {
        let area = face::double_area_normal(face::corners(sequence.reference(), corners)).length();
        let label = labels.get(f).copied().unwrap_or(0);
        shares.extend(corners.map(|v| (v, label, area)));
    }
    shares.sort_by_key(|&(vertex, label, _)| (vertex, label));
    let mut owner = vec![0; sequence.reference().len()];
    let mut most = vec![-1.0; owner.len()];
    for chunk in shares.chunk_by(|a, b| (a.0, a.1) == (b.0, b.1)) {
        let (vertex, label, _) = chunk[0];
        let area: f64 = chunk.iter().map(|share| share.2).sum();
        if area > most[vertex as usize] {
            (owner[vertex as usize], most[vertex as usize]) = (label, area);
        }
    }
    owner
}

/// The best rigid motion of each part.
fn maps(reference: &[DVec3], pose: &[DVec3], owner: &[u32], parts: usize) -> Vec<DAffine3> {
    let mut moments = vec![Moments::default(); parts];
    for ((&p, &q), &part) in reference.iter().zip(pose).zip(owner) {
        moments[part as usize].add(1.0, p, q);
    }
    let map = |moments: &Moments| {
        let motion = moments.motion();
        DAffine3 { matrix3: motion.rotation, translation: motion.translation }
    };
    moments.iter().map(map).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::import::{File, Options, open};
    use crate::zoo::{Recipe, make};

    #[test]
    fn bones_come_back_as_joints() {
        let creature = make(&Recipe { faces: 1500, poses: 6, exact: true, ..Recipe::default() }).unwrap();
        let made = rigid(&creature.sequence, &creature.labels, None).unwrap();
        // Only vertices between two bones, which follow one of them, are off, and those not at all: each is on one bone.
        assert!(made.rms < 0.02 && made.rms <= made.largest, "{} {}", made.rms, made.largest);
        let gltf = gltf::Gltf::from_slice(&made.bytes).unwrap();
        assert_eq!(gltf.skins().count(), 1);
        // What a player would show is off by what was measured.
        let file = File { name: "rigid.glb".into(), bytes: made.bytes };
        let options = Options { weld: false, ..Options::default() };
        let back = open(&[file], &options).unwrap().sequence;
        assert_eq!(back.reference().len(), creature.sequence.reference().len());
        let nearest = |pose: &[DVec3]| {
            let apart = |other: &[DVec3]| pose.iter().zip(other).map(|(a, b)| a.distance_squared(*b)).sum::<f64>();
            creature.sequence.poses().iter().map(|p| apart(&p.positions)).fold(f64::INFINITY, f64::min)
        };
        let first = (nearest(&back.poses()[0].positions) / back.reference().len() as f64).sqrt();
        assert!(first <= 3.0 * made.rms * creature.sequence.diagonal(), "{first} {}", made.rms);
    }

    #[test]
    fn one_part_and_missing_labels_will_do() {
        let creature = make(&Recipe { faces: 1500, poses: 3, ..Recipe::default() }).unwrap();
        let made = rigid(&creature.sequence, &[], None).unwrap();
        assert!(made.rms > 0.0 && made.rms.is_finite() && made.largest >= made.rms);
        let parts = rigid(&creature.sequence, &creature.labels, None).unwrap();
        assert!(parts.rms < 0.5 * made.rms, "{} {}", parts.rms, made.rms);
    }
}
