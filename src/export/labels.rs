//! Labels as text: one whole number a line for each face of the input, in the input's order.

use crate::mesh::face;
use crate::sequence::Sequence;
use std::collections::BTreeMap;

/// Labels of the input's faces from labels of a sequence's triangles.
///
/// `labels` is #F; `input_faces` the number of faces of the input. Where polygons were cut into triangles, a
/// polygon takes the label of the larger share of its area in the reference pose (the lower label of two equal
/// ones); an input face without any triangle takes that of the face before it.
pub fn of_input_faces(sequence: &Sequence, labels: &[u32], input_faces: usize) -> Vec<u32> {
    let Some(polygons) = sequence.polygons() else { return labels.to_vec() };
    let mut votes: Vec<BTreeMap<u32, f64>> = vec![BTreeMap::new(); input_faces];
    for ((face, &polygon), &label) in sequence.faces().iter().zip(polygons).zip(labels) {
        if let Some(votes) = votes.get_mut(polygon as usize) {
            let normal = face::double_area_normal(face::corners(sequence.reference(), *face));
            *votes.entry(label).or_default() += normal.length();
        }
    }
    let mut last = labels.first().copied().unwrap_or(0);
    votes
        .iter()
        .map(|votes| {
            let most = votes.values().copied().fold(0.0, f64::max);
            if let Some((&label, _)) = votes.iter().find(|(_, area)| **area >= most) {
                last = label;
            }
            last
        })
        .collect()
}

/// Labels as text, one a line.
pub fn text(labels: &[u32]) -> String {
    labels.iter().map(|label| format!("{label}\n")).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn polygons_take_the_label_of_most_of_their_area() {
        let points = [(0., 0.), (1., 0.), (4., 1.), (0., 1.), (9., 9.)].map(|(x, y)| DVec3::new(x, y, 0.0)).to_vec();
        let faces = vec![[0, 1, 2], [0, 2, 3], [0, 1, 4]];
        let sequence = Sequence::new("a", faces, points, Vec::new()).unwrap().with_polygons(vec![1, 1, 2]).unwrap();
        assert_eq!(of_input_faces(&sequence, &[7, 5, 9], 5), [7, 5, 9, 9, 9]);
        assert_eq!(text(&[3, 0]), "3\n0\n");
    }

    #[test]
    fn triangles_keep_their_labels() {
        let sequence = Sequence::new("a", vec![[0, 1, 2]; 2], vec![DVec3::ZERO; 3], Vec::new()).unwrap();
        assert_eq!(of_input_faces(&sequence, &[4, 2], 2), [4, 2]);
    }
}
