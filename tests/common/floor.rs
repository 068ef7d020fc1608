//! A creature on a still floor.

use glam::DVec3;
use sinew::sequence::{Pose, Sequence};

/// The sequence with a square floor of 8 × 8 cells under it, `half` to each side.
pub fn on_a_floor(sequence: &Sequence, half: f64) -> Sequence {
    const CELLS: u32 = 8;
    let low = sequence.reference().iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let at = |i: u32| f64::from(i) * 2.0 * half / f64::from(CELLS) - half;
    let floor = (0..=CELLS).flat_map(|z| (0..=CELLS).map(move |x| DVec3::new(at(x), low, at(z))));
    let floor: Vec<DVec3> = floor.collect();
    let first = sequence.reference().len() as u32;
    let corner = |x: u32, z: u32| first + z * (CELLS + 1) + x;
    let mut faces = sequence.faces().to_vec();
    for (x, z) in (0..CELLS).flat_map(|z| (0..CELLS).map(move |x| (x, z))) {
        let [a, b, c, d] = [corner(x, z), corner(x, z + 1), corner(x + 1, z + 1), corner(x + 1, z)];
        faces.extend([[a, b, c], [a, c, d]]);
    }
    let with = |positions: &[DVec3]| [positions, &floor].concat();
    let pose = |p: &Pose| Pose { positions: with(&p.positions), ..p.clone() };
    let poses = sequence.poses().iter().map(pose).collect();
    Sequence::new("on a floor", faces, with(sequence.reference()), poses).expect("a mesh")
}
