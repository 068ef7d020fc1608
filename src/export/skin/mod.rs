//! A moving mesh as a skin, in one GLB file: small, whatever the number of vertices and poses.
//!
//! The joints are handles. Every vertex is where the weighted mean of the handles' affine maps puts it; a file holds
//! at most four joints a vertex (eight where asked for), so weights are fitted anew, and an affine map
//! becomes a chain of two nodes where one node does not do. What that costs is measured on the numbers of the
//! file and handed back with it.

mod chain;
mod document;
mod influences;

use super::timing;
use crate::look::Look;
use chain::Link;
use glam::{DAffine3, DVec3};
use influences::Joints;

/// How far the way between two keys may stray, over the diagonal.
const STRAY: f64 = 5e-4;

/// A mesh that follows handles.
#[derive(Clone, Copy, Debug)]
pub struct Skin<'a> {
    /// What to call it.
    pub name: &'a str,
    /// #F triples of vertex numbers.
    pub faces: &'a [[u32; 3]],
    /// #V positions at rest.
    pub reference: &'a [DVec3],
    /// #V rows × `handles`, row-major; rows sum to 1.
    pub weights: &'a [f64],
    /// The number of handles.
    pub handles: usize,
    /// The poses in the order of time.
    pub poses: &'a [SkinPose<'a>],
    /// What the mesh looks like; in one colour where there is no look that fits it.
    pub look: Option<&'a Look>,
}

/// Where the handles are in a pose.
#[derive(Clone, Copy, Debug)]
pub struct SkinPose<'a> {
    /// What to call it.
    pub name: &'a str,
    /// Seconds.
    pub time: f64,
    /// #handles maps from the reference to the pose.
    pub maps: &'a [DAffine3],
}

/// How many joints a vertex may follow.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Influences {
    /// Four: what every player can do.
    #[default]
    Four,
    /// Eight, in two sets: nearer to the original where handles are many, but many players on the web (three.js among
    /// them) leave out the second set.
    Eight,
}

/// A skin as a file.
#[derive(Clone, Debug)]
pub struct Light {
    /// The GLB.
    pub bytes: Vec<u8>,
    /// Root mean square, over vertices and poses, of how far the file's vertices are from where the whole weights put
    /// them, over the diagonal of the reference.
    pub rms: f64,
    /// The largest such distance, over the diagonal.
    pub largest: f64,
    /// The same root mean square for the same number of joints a vertex, chosen by weight alone and rescaled.
    pub plain_rms: f64,
}

/// Why there is no file.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum LightError {
    /// Arrays do not fit together.
    #[error("{what}: {found} where {expected} are needed")]
    Count {
        /// What was counted.
        what: &'static str,
        /// How many there are.
        found: usize,
        /// How many there should be.
        expected: usize,
    },
    /// More handles than a file can number.
    #[error("{0} handles are more than a skin can have")]
    TooMany(usize),
    /// A face names a vertex that does not exist.
    #[error("face {0} names a vertex that does not exist")]
    Face(usize),
    /// A number is NaN or infinite, or a map takes the mesh out of the range of numbers.
    #[error("{0} has a number that is not finite")]
    NotFinite(&'static str),
}

/// The skin as a GLB file: a key at the time of every pose (and one more that closes the loop, if it is one), linear
/// interpolation between.
pub fn light(skin: &Skin, influences: Influences) -> Result<Light, LightError> {
    check(skin)?;
    let scale = Scale::of(skin);
    let tracks = tracks(skin, &scale);
    let count = match influences {
        Influences::Four => 4,
        Influences::Eight => 8,
    };
    let maps: Vec<&[DAffine3]> = skin.poses.iter().map(|pose| pose.maps).collect();
    let rows = skin.weights.chunks_exact(skin.handles.max(1));
    let joints: Vec<Joints> =
        rows.zip(skin.reference).map(|(row, &x)| influences::choose(x, row, &maps, scale.diagonal, count)).collect();
    let [fitted, plain] = errors(skin, &scale, &tracks, &joints, count);
    Ok(Light {
        bytes: document::write(skin, &tracks, &scale.centres, &joints),
        rms: fitted.0,
        largest: fitted.1,
        plain_rms: plain.0,
    })
}

fn check(skin: &Skin) -> Result<(), LightError> {
    let count = |what, found, expected| {
        if found == expected { Ok(()) } else { Err(LightError::Count { what, found, expected }) }
    };
    if skin.handles > usize::from(u16::MAX) {
        return Err(LightError::TooMany(skin.handles));
    }
    if skin.handles == 0 {
        return Err(LightError::Count { what: "handles", found: 0, expected: 1 });
    }
    count("weights", skin.weights.len(), skin.reference.len() * skin.handles)?;
    let vertices = skin.reference.len();
    if let Some(face) = skin.faces.iter().position(|corners| corners.iter().any(|&v| v as usize >= vertices)) {
        return Err(LightError::Face(face));
    }
    if !skin.reference.iter().all(|p| p.abs().max_element() < 1e30) {
        return Err(LightError::NotFinite("the reference"));
    }
    if !skin.weights.iter().all(|w| w.is_finite()) {
        return Err(LightError::NotFinite("the weights"));
    }
    for pose in skin.poses {
        count("maps of a pose", pose.maps.len(), skin.handles)?;
        if !pose.maps.iter().all(|map| map.to_cols_array().iter().all(|x| x.abs() < 1e30)) {
            return Err(LightError::NotFinite("a map"));
        }
    }
    Ok(())
}

/// Lengths by which to judge.
struct Scale {
    /// Of the bounding box of the reference.
    diagonal: f64,
    /// #handles: the middle of what each handle moves.
    centres: Vec<DVec3>,
    /// #handles: how far from there it reaches (root mean square).
    reaches: Vec<f64>,
    /// #handles: the sum of its weights.
    sums: Vec<f64>,
}

impl Scale {
    fn of(skin: &Skin) -> Self {
        let used = || skin.faces.iter().flatten().map(|&v| skin.reference[v as usize]);
        let low = used().fold(DVec3::INFINITY, DVec3::min);
        let high = used().fold(DVec3::NEG_INFINITY, DVec3::max);
        let (diagonal, middle) =
            if low.x <= high.x { (low.distance(high), 0.5 * (low + high)) } else { (0.0, DVec3::ZERO) };
        let rows = || skin.weights.chunks_exact(skin.handles).zip(skin.reference);
        let (mut centres, mut squares) = (vec![DVec3::ZERO; skin.handles], vec![0.0; skin.handles]);
        for (row, &x) in rows() {
            for (h, w) in row.iter().enumerate() {
                centres[h] += w * w * x;
                squares[h] += w * w;
            }
        }
        for (centre, square) in centres.iter_mut().zip(&squares) {
            // As the file has it.
            *centre = if *square > 0.0 { (*centre / square).as_vec3().as_dvec3() } else { middle };
        }
        let (mut spread, mut sums) = (vec![0.0; skin.handles], vec![0.0; skin.handles]);
        for (row, &x) in rows() {
            for (h, w) in row.iter().enumerate() {
                spread[h] += w.abs() * x.distance_squared(centres[h]);
                sums[h] += w.abs();
            }
        }
        let reach = |(spread, sum): (&f64, &f64)| if *sum > 0.0 { (spread / sum).sqrt() } else { 0.0 };
        let reaches = spread.iter().zip(&sums).map(reach).collect();
        Self { diagonal, centres, reaches, sums }
    }
}

/// #handles lists of keys.
fn tracks(skin: &Skin, scale: &Scale) -> Vec<Vec<Link>> {
    let mut times = timing::from_zero(skin.poses.iter().map(|pose| pose.time));
    let step = |a: usize, b: usize| {
        let steps = (0..skin.handles).map(|h| {
            let [from, to] = [a, b].map(|pose| skin.poses[pose].maps[h]);
            let shift = from.transform_point3(scale.centres[h]).distance(to.transform_point3(scale.centres[h]));
            let turn = crate::linalg::polar::frobenius(from.matrix3 - to.matrix3);
            scale.sums[h] * (shift + scale.reaches[h] * turn)
        });
        steps.sum()
    };
    let looped = timing::closes(skin.poses.len(), step);
    if looped {
        timing::close(&mut times);
    }
    let track = |h: usize| {
        let first = skin.poses.first().filter(|_| looped);
        let maps: Vec<DAffine3> = skin.poses.iter().chain(first).map(|pose| pose.maps[h]).collect();
        chain::keys(&maps, &times, scale.centres[h], scale.reaches[h], STRAY * scale.diagonal)
    };
    (0..skin.handles).map(track).collect()
}

/// Root mean square and largest distance over the diagonal: of the joints as chosen, and of the largest weights alone.
fn errors(skin: &Skin, scale: &Scale, tracks: &[Vec<Link>], joints: &[Joints], count: usize) -> [(f64, f64); 2] {
    let times = timing::from_zero(skin.poses.iter().map(|pose| pose.time));
    let mut sums = [(0.0_f64, 0.0_f64); 2];
    let mut order: Vec<usize> = Vec::with_capacity(skin.handles);
    for (pose, time) in skin.poses.iter().zip(&times) {
        // What a player reads.
        let played: Vec<DAffine3> = (0..skin.handles)
            .map(|h| {
                let Some(key) = tracks[h].iter().find(|key| key.time == *time) else { return pose.maps[h] };
                let key = key.single();
                let linear = key.linear();
                DAffine3::from_mat3_translation(linear, key.place - linear * scale.centres[h])
            })
            .collect();
        let rows = skin.weights.chunks_exact(skin.handles);
        for ((&x, row), joints) in skin.reference.iter().zip(rows).zip(joints) {
            let x = x.as_vec3().as_dvec3();
            let place: DVec3 = row.iter().zip(pose.maps).map(|(&w, map)| w * map.transform_point3(x)).sum();
            let shown = |joints: &mut dyn Iterator<Item = (usize, f64)>| -> DVec3 {
                joints.map(|(h, w)| w * played[h].transform_point3(x)).sum()
            };
            let fitted = shown(&mut joints.iter().map(|&(h, w)| (usize::from(h), f64::from(w))));
            order.clear();
            order.extend((0..row.len()).filter(|&h| row[h] > 0.0));
            if order.len() > count {
                order.select_nth_unstable_by(count, |&a, &b| row[b].total_cmp(&row[a]));
                order.truncate(count);
            }
            let kept: f64 = order.iter().map(|&h| row[h]).sum();
            let plain = shown(&mut order.iter().map(|&h| (h, row[h] / kept)));
            for (sum, shown) in sums.iter_mut().zip([fitted, plain]) {
                let away = place.distance(shown);
                *sum = (sum.0 + away * away, sum.1.max(away));
            }
        }
    }
    let share = |x: f64| if scale.diagonal > 0.0 && x.is_finite() { x / scale.diagonal } else { 0.0 };
    let number = (skin.poses.len() * skin.reference.len()).max(1) as f64;
    sums.map(|(sum, largest)| (share((sum / number).sqrt()), share(largest)))
}
