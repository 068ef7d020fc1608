//! Faces that look outwards, for those who ask which way a surface looks.

use super::Mesh;
use super::chart::Chart;
use super::inside_out::volumes;
use glam::DVec3;

/// A sheet whose open borders are no longer than this, over the root of its area, still has an inside; a cloth has 4.
const OPEN: f64 = 0.5;

/// A volume (six times, over the area to the power of 3/2) below this says nothing: a ball has 0.56.
const FLAT: f64 = 0.01;

/// #F faces, those turned round that are wound against most of their sheet, or whose sheet, closed but for small holes, is
/// inside out; of faces that are there more than once, all as the first. `faces` are #F triples of vertex numbers, `positions`
/// #V points. Faces with vertices that do not exist, and surfaces with one side only, are as they were. The inner wall of a
/// hollow body is turned like any other sheet: what it lies in is not asked.
pub fn outward(faces: &[[u32; 3]], positions: &[DVec3]) -> Vec<[u32; 3]> {
    let chart = Chart::new(&Mesh { faces, reference: positions, poses: Vec::new() });
    let orientation = &chart.orientation;
    let count = chart.faces.len();
    let (mut open, mut area) = (vec![0.0; count], vec![0.0; count]);
    for edge in chart.edges() {
        let &[side] = edge else { continue };
        let [a, b] = side.points().map(|p| chart.reference[p as usize] * chart.scale);
        open[orientation.sheet[side.face() as usize] as usize] += a.distance(b);
    }
    for (normal, &sheet) in chart.normals.iter().zip(&orientation.sheet) {
        area[sheet as usize] += 0.5 * normal.length();
    }
    let volume = volumes(&chart);
    let inside_out =
        |sheet: usize| open[sheet] <= OPEN * area[sheet].sqrt() && volume[sheet] < -FLAT * area[sheet].powf(1.5);
    let turned = |f: usize| {
        let sheet = orientation.sheet[f] as usize;
        !orientation.one_sided[sheet] && orientation.turned[f] != inside_out(sheet)
    };
    let mut outward = faces.to_vec();
    let first = firsts(&chart);
    for f in 0..count {
        let along = is_even(chart.faces[f]) == is_even(chart.faces[first[f]]);
        if turned(first[f]) == along {
            outward[f].swap(1, 2);
        }
    }
    outward
}

/// #F: the first face with the same points.
fn firsts(chart: &Chart) -> Vec<usize> {
    let mut first: Vec<usize> = (0..chart.faces.len()).collect();
    if !chart.repeated.contains(&true) {
        return first;
    }
    let sorted = |f: usize| {
        let mut points = chart.faces[f];
        points.sort_unstable();
        points
    };
    let mut order: Vec<usize> = first.clone();
    order.sort_by_key(|&f| (sorted(f), f));
    for same in order.chunk_by(|&a, &b| sorted(a) == sorted(b)) {
        same.iter().for_each(|&f| first[f] = same[0]);
    }
    first
}

/// Which of the two ways round three points are named.
fn is_even([a, b, c]: [u32; 3]) -> bool {
    (a < b) == ((b < c) == (a < c))
}
