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
    if count < faces.len() {
        // There are no vertices.
        return faces.to_vec();
    }
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
    let wound = |(f, &[a, b, c]): (usize, &[u32; 3])| {
        let first = chart.first[f] as usize;
        let along = is_even(chart.faces[f]) == is_even(chart.faces[first]);
        if turned(first) == along { [a, c, b] } else { [a, b, c] }
    };
    faces.iter().enumerate().map(wound).collect()
}

/// Which of the two ways round three points are named.
fn is_even([a, b, c]: [u32; 3]) -> bool {
    (a < b) == ((b < c) == (a < c))
}
