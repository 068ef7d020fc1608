//! How new paint flows over the surface: outwards from some faces, neighbour after neighbour.

use super::surface::Surface;

/// When paint that starts at `sources` arrives at each of `faces` faces: 0 for the sources, 255 for the faces that
/// are the most steps from edge to edge away from them, and for those that cannot be reached. Without a source it
/// is everywhere at once.
pub fn spread(surface: &Surface, faces: usize, sources: &[u32]) -> Vec<u8> {
    let mut steps = vec![u32::MAX; faces];
    let mut front: Vec<usize> = Vec::new();
    for &source in sources {
        if let Some(step) = steps.get_mut(source as usize)
            && *step != 0
        {
            *step = 0;
            front.push(source as usize);
        }
    }
    if front.is_empty() {
        return vec![0; faces];
    }
    let (first, neighbours) = neighbours(surface, faces);
    let mut far = 0;
    while !front.is_empty() {
        let mut next = Vec::new();
        for face in front {
            for &other in &neighbours[first[face]..first[face + 1]] {
                if steps[other as usize] == u32::MAX {
                    steps[other as usize] = far + 1;
                    next.push(other as usize);
                }
            }
        }
        far += u32::from(!next.is_empty());
        front = next;
    }
    let arrival = |step: u32| (255 * u64::from(step.min(far)) / u64::from(far.max(1))) as u8;
    steps.into_iter().map(|step| if step == u32::MAX { 255 } else { arrival(step) }).collect()
}

/// The faces across each face's edges, one face after the other, and where each begins (#F + 1).
fn neighbours(surface: &Surface, faces: usize) -> (Vec<usize>, Vec<u32>) {
    let pairs = || {
        let of = |half: u32| half as usize / 3;
        surface.edges().flat_map(move |edge| edge.windows(2).map(move |w| (of(w[0]), of(w[1]))))
    };
    let mut first = vec![0; faces + 1];
    for (a, b) in pairs() {
        first[a] += 1;
        first[b] += 1;
    }
    let mut end = 0;
    for entry in &mut first {
        end += *entry;
        *entry = end;
    }
    let mut list = vec![0; end];
    for (a, b) in pairs() {
        for (from, to) in [(a, b), (b, a)] {
            first[from] -= 1;
            list[first[from]] = to as u32;
        }
    }
    (first, list)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::motion::Motion;

    /// A strip of eight triangles and, away from it, one more.
    fn surface() -> Surface {
        let mut points: Vec<f32> = (0..10).flat_map(|i| [(i / 2) as f32, (i % 2) as f32, 0.0]).collect();
        points.extend([0.0, 0.0, 5.0, 1.0, 0.0, 5.0, 0.0, 1.0, 5.0]);
        let strip = (0..8).flat_map(|i| if i % 2 == 0 { [i, i + 2, i + 1] } else { [i, i + 1, i + 2] });
        let faces: Vec<u32> = strip.chain([10, 11, 12]).collect();
        Surface::new(&Motion::new(&faces, &points).unwrap())
    }

    #[test]
    fn paint_goes_from_face_to_face() {
        let surface = surface();
        assert_eq!(spread(&surface, 9, &[0]), [0, 36, 72, 109, 145, 182, 218, 255, 255]);
        assert_eq!(spread(&surface, 9, &[3, 7, 3]), [255, 170, 85, 0, 85, 170, 85, 0, 255]);
    }

    #[test]
    fn without_a_source_it_is_everywhere() {
        let surface = surface();
        assert_eq!(spread(&surface, 9, &[]), [0; 9]);
        assert_eq!(spread(&surface, 9, &[99]), [0; 9]);
        assert_eq!(spread(&surface, 9, &[0, 1, 2, 3, 4, 5, 6, 7, 8]), [0; 9]);
    }
}
