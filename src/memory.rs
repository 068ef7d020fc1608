//! How much memory a step will take, estimated from sizes before it runs.
//!
//! A wasm32 module ends at 4 GiB, in one blow and without a word; so a step that would get near is refused, with numbers
//! and with what helps. The bytes below are largest resident sets of the native engine on meshes of 20,000 to 200,000
//! faces in 15 to 56 poses, what was there before taken off, and a quarter more; wasm takes less, its pointers being half
//! as long.

use crate::sequence::{Sequence, Sizes};

/// Bytes that the meshes and the step may take together in a wasm32 module: three of its four GiB. Memory is handed out in
/// blocks of many sizes and never given back, so not all of it can be used.
pub const LIMIT: u64 = 3 << 30;

/// What takes memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step {
    /// [`crate::segmentation`].
    Segmentation,
    /// [`crate::keypoints`], with so many points at most.
    KeyPoints(usize),
    /// [`crate::weights`] of so many handles.
    Weights(usize),
    /// [`crate::transfer`]: the sizes are those of the source, and of the target here.
    Transfer(Sizes),
    /// [`crate::transfer::gradients`], posed or not: the sizes are those of the source, and of the target here.
    Faces(Sizes),
}

/// A step that would not fit.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("{name} would take about {} of memory, beside {} for what is open; a browser allows about {}. {advice}", size(*needed), size(*held), size(LIMIT))]
pub struct TooLarge {
    /// What the step is called.
    pub name: &'static str,
    /// Bytes that it would take.
    pub needed: u64,
    /// Bytes of what is open.
    pub held: u64,
    /// What helps.
    pub advice: String,
}

impl Step {
    /// Bytes that the step takes for a mesh of these sizes, beside the mesh itself.
    pub fn bytes(self, sizes: Sizes) -> u64 {
        let (vertices, faces, poses) = (sizes.vertices as u64, sizes.faces as u64, sizes.poses as u64);
        match self {
            Self::Segmentation => faces.saturating_mul(420 + 14 * poses),
            Self::KeyPoints(points) => vertices.saturating_mul(6000 + 32 * poses + 20 * points as u64),
            Self::Weights(handles) => vertices.saturating_mul(4500 + 20 * handles as u64),
            Self::Transfer(target) => {
                let source = vertices.saturating_mul(1500 + 60 * poses);
                source.saturating_add((target.vertices as u64).saturating_mul(3500))
            }
            Self::Faces(target) => {
                let source = vertices.saturating_mul(2500 + 60 * poses);
                source.saturating_add((target.vertices as u64).saturating_mul(9000 + 60 * poses))
            }
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Segmentation => "Finding the parts",
            Self::KeyPoints(_) => "Finding the key points",
            Self::Weights(_) => "Computing the weights",
            Self::Transfer(_) | Self::Faces(_) => "Moving the target",
        }
    }
}

/// Bytes that a sequence takes while it is open.
pub fn held(sequence: &Sequence) -> u64 {
    let sizes = sequence.sizes();
    (sizes.vertices as u64).saturating_mul(24 * (sizes.poses as u64 + 1)).saturating_add(12 * sizes.faces as u64)
}

/// Refuses a step for `of`, the mesh that it works on, if it does not fit beside all that is `open`.
pub fn check<'a>(
    step: Step,
    of: &Sequence,
    open: impl IntoIterator<Item = &'a Sequence>,
    limit: u64,
) -> Result<(), TooLarge> {
    let needed = step.bytes(of.sizes());
    let held = open.into_iter().map(held).fold(0, u64::saturating_add);
    if needed.saturating_add(held) <= limit {
        return Ok(());
    }
    Err(TooLarge { name: step.name(), needed, held, advice: advice(step, of.sizes(), limit) })
}

/// How many times a step for `of`, and that mesh itself, fit.
pub fn side_by_side(step: Step, of: &Sequence, limit: u64) -> usize {
    let each = step.bytes(of.sizes()).saturating_add(held(of));
    usize::try_from(limit / each.max(1)).unwrap_or(usize::MAX)
}

/// How many faces, or poses, would fit, to one digit or two.
fn advice(step: Step, sizes: Sizes, limit: u64) -> String {
    let fits = |sizes: Sizes| {
        let mesh = sizes.vertices as u64 * 24 * (sizes.poses as u64 + 1) + 12 * sizes.faces as u64;
        step.bytes(sizes).saturating_add(mesh) <= limit
    };
    let few = Sizes { poses: sizes.poses.min(2), ..sizes };
    if sizes.poses > 2 && fits(few) {
        let poses =
            (2..sizes.poses).rev().step_by((sizes.poses / 200).max(1)).find(|&poses| fits(Sizes { poses, ..sizes }));
        return format!("Take {} poses at most of its {}, or a simpler mesh.", poses.unwrap_or(2), sizes.poses);
    }
    let share = (1..20).rev().map(|k| f64::from(k) / 20.0).find(|share| {
        let part = |n: usize| (n as f64 * share) as usize;
        fits(Sizes { vertices: part(sizes.vertices), faces: part(sizes.faces), ..sizes })
    });
    match share {
        Some(share) => {
            let faces = sizes.faces as f64 * share;
            let round = 10_f64.powi((faces.max(1.0).log10() as i32 - 1).max(0));
            format!(
                "Take a simpler mesh: about {} faces at most, instead of {}.",
                (faces / round).floor() * round,
                sizes.faces
            )
        }
        // However simple the source, there would be no room.
        None if matches!(step, Step::Transfer(_) | Step::Faces(_)) => "Take a much simpler target.".into(),
        None => "Take a much simpler mesh.".into(),
    }
}

fn size(bytes: u64) -> String {
    let bytes = bytes as f64;
    if bytes >= 9.95e8 { format!("{:.1} GB", bytes / 1e9) } else { format!("{:.0} MB", (bytes / 1e6).ceil()) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sequence::Pose;
    use glam::DVec3;

    fn sizes(vertices: usize, faces: usize, poses: usize) -> Sizes {
        Sizes { vertices, faces, poses }
    }

    fn sequence(poses: usize) -> Sequence {
        let points = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
        let pose = Pose { name: String::new(), time: 0.0, positions: points.clone() };
        Sequence::new("made", vec![[0, 1, 2]; 10], points, vec![pose; poses]).unwrap()
    }

    #[test]
    fn what_people_open_fits() {
        let target = sizes(100_000, 200_000, 0);
        for step in
            [Step::Segmentation, Step::KeyPoints(30), Step::Weights(30), Step::Transfer(target), Step::Faces(target)]
        {
            assert!(step.bytes(sizes(100_000, 200_000, 60)) < LIMIT, "{step:?}");
        }
        assert!(Step::Segmentation.bytes(sizes(750_000, 1_500_000, 30)) < LIMIT);
        assert!(Step::KeyPoints(30).bytes(sizes(1_000_000, 2_000_000, 24)) > LIMIT);
        let target = sizes(400_000, 800_000, 0);
        assert!(Step::Faces(target).bytes(sizes(400_000, 800_000, 24)) > LIMIT);
        assert!(Step::Segmentation.bytes(sizes(usize::MAX, usize::MAX, 24)) > LIMIT, "no overflow");
    }

    #[test]
    fn as_many_fit_as_each_leaves_room_for() {
        let still = sequence(0);
        let each = Step::Weights(2).bytes(still.sizes()) + held(&still);
        for (limit, count) in [(0, 0), (each - 1, 0), (each, 1), (5 * each + 1, 5)] {
            assert_eq!(side_by_side(Step::Weights(2), &still, limit), count);
        }
    }

    #[test]
    fn a_refusal_has_numbers_and_says_what_helps() {
        let (still, moving) = (sequence(0), sequence(400));
        assert_eq!(check(Step::Segmentation, &still, [&still], LIMIT), Ok(()));
        let refused = check(Step::Segmentation, &moving, [&moving], 40_000).unwrap_err();
        assert_eq!((refused.needed, refused.held), (10 * (420 + 14 * 400), 72 * 401 + 120));
        assert!(refused.advice.contains("poses at most of its 400"), "{}", refused.advice);
        let refused = check(Step::Segmentation, &still, [&still], 2_000).unwrap_err();
        assert!(refused.advice.contains("faces at most, instead of 10"), "{}", refused.advice);
        let target = check(Step::Faces(sizes(1_000, 2_000, 0)), &still, [&still], 2_000).unwrap_err();
        assert_eq!(target.advice, "Take a much simpler target.");
        let text = TooLarge { needed: 5_200_000_000, held: 310_000_000, ..refused }.to_string();
        assert!(text.starts_with("Finding the parts would take about 5.2 GB of memory, beside 310 MB for"), "{text}");
    }
}
