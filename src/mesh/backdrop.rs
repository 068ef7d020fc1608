//! What stands still around a character: a floor, a backdrop.
//!
//! Lengths are measured against the size of the mesh. A floor that is many times as large as the character on it would
//! make all that the character does look small.

use super::pieces::pieces;
use glam::DVec3;
use std::borrow::Cow;

/// A piece stands still if its vertices stay within this share of the diagonal.
const STILL: f64 = 1e-6;
/// What stands still is a backdrop if the mesh is more than so many times as large with it.
const LARGER: f64 = 2.0;

/// The faces without the pieces that stand still in all `poses`, where these make the mesh more than twice as large; all
/// faces otherwise.
///
/// `faces` is #F triples of vertex numbers, `reference` and each pose #V points.
pub fn without_backdrop<'f>(faces: &'f [[u32; 3]], reference: &[DVec3], poses: &[&[DVec3]]) -> Cow<'f, [[u32; 3]]> {
    let whole = extent(faces, reference);
    let moves = |v: u32| {
        let rest = reference[v as usize];
        poses.iter().any(|pose| (pose[v as usize] - rest).abs().max_element() > STILL * whole)
    };
    let pieces = pieces(faces, reference.len());
    if pieces.count < 2 {
        return Cow::Borrowed(faces);
    }
    let mut moving = vec![false; pieces.count];
    for (face, &piece) in faces.iter().zip(&pieces.face) {
        moving[piece as usize] = moving[piece as usize] || face.iter().any(|&v| moves(v));
    }
    if moving.iter().all(|&moves| moves) {
        return Cow::Borrowed(faces);
    }
    let acting: Vec<[u32; 3]> =
        faces.iter().zip(&pieces.face).filter(|(_, piece)| moving[**piece as usize]).map(|(face, _)| *face).collect();
    let size = extent(&acting, reference);
    if size > 0.0 && whole > LARGER * size { Cow::Owned(acting) } else { Cow::Borrowed(faces) }
}

/// The longest side of the box around the vertices of faces.
fn extent(faces: &[[u32; 3]], positions: &[DVec3]) -> f64 {
    let points = || faces.iter().flatten().map(|&v| positions[v as usize]);
    let low = points().fold(DVec3::INFINITY, DVec3::min);
    let high = points().fold(DVec3::NEG_INFINITY, DVec3::max);
    (high - low).max_element().max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_large_floor_is_left_out_and_a_still_foot_is_not() {
        let corners = |at: DVec3, size: f64| [at, at + size * DVec3::X, at + size * DVec3::Y];
        let faces = [[0, 1, 2], [3, 4, 5]];
        for (size, left) in [(30.0, 1), (1.0, 2)] {
            let reference = [corners(DVec3::ZERO, 1.0), corners(DVec3::Z, size)].concat();
            let mut pose = reference.clone();
            assert_eq!(without_backdrop(&faces, &reference, &[&pose]).len(), 2, "nothing moves");
            pose[1] += DVec3::Y;
            assert_eq!(without_backdrop(&faces, &reference, &[&reference, &pose]).len(), left);
            pose[3] += DVec3::Y;
            assert_eq!(without_backdrop(&faces, &reference, &[&pose]).len(), 2, "everything moves");
        }
        assert!(without_backdrop(&[], &[], &[]).is_empty());
    }
}
