//! Which pieces of a body belong together: a robot's shank hangs on its thigh, though no face joins them.

use super::surface::WeldedSurface;
use crate::mesh::kd_tree::KdTree;

/// Pieces farther apart than this, in radii, do not touch.
const FAR: f64 = 0.06;
/// Nor do those farther apart than so many times the mean distance of [`ASKED`] places from the nearest: a search that finds
/// nothing looks at all places within reach.
const SPACINGS: f64 = 12.0;
const ASKED: usize = 1000;
/// How near pieces lie where they touch, in radii: places farther apart count less and less for how much two touch, and
/// those farther apart than twice the nearest and this are not tied.
const TOUCH: f64 = 0.02;
/// Pieces are tied if this share of what one of them touches most is between them: thighs that brush against each other
/// hang on the hips.
const MOST: f64 = 0.5;

/// Pairs of places, one with the nearest of another piece, all along where pieces of a surface touch.
pub fn ties(surface: &WeldedSurface) -> Vec<(u32, u32)> {
    let pieces = surface.pieces();
    if pieces.len() < 2 {
        return Vec::new();
    }
    let piece = surface.numbered(&pieces);
    let contacts = contacts(surface, &pieces, &piece);
    let between = |(v, u): (u32, u32)| {
        let (a, b) = (piece[v as usize], piece[u as usize]);
        (a.min(b), a.max(b))
    };
    let mut pairs: Vec<(u32, u32)> = contacts.iter().map(|contact| between(contact.0)).collect();
    pairs.sort_unstable();
    pairs.dedup();
    let number = |places| pairs.partition_point(|&pair| pair < between(places));
    // For each pair of pieces the area that touches, and how near they come; for each piece the most that touches another.
    let (mut touch, mut most) = (vec![(0.0, f64::INFINITY); pairs.len()], vec![0.0_f64; pieces.len()]);
    for &(places, far) in &contacts {
        let (strength, least) = &mut touch[number(places)];
        *strength += surface.mass[places.0 as usize] * (-(far / TOUCH).powi(2)).exp();
        *least = far.min(*least);
    }
    for (&(a, b), &(strength, _)) in pairs.iter().zip(&touch) {
        [a, b].iter().for_each(|&p| most[p as usize] = most[p as usize].max(strength));
    }
    let tied = |&(places, far): &Contact| {
        let ((a, b), (strength, least)) = (between(places), touch[number(places)]);
        strength >= MOST * most[a as usize].min(most[b as usize]) && far <= 2.0 * least + TOUCH
    };
    contacts.iter().filter(|contact| tied(contact)).map(|contact| contact.0).collect()
}

/// Two places of different pieces, and how far they are apart.
type Contact = ((u32, u32), f64);

/// Each place, but for those of the largest piece, with the nearest of another piece, if that is within reach.
fn contacts(surface: &WeldedSurface, pieces: &[Vec<u32>], piece: &[u32]) -> Vec<Contact> {
    let tree = KdTree::of_points(&surface.positions);
    let nearest = |v: u32, reach: f64, wanted: &dyn Fn(u32) -> bool| {
        let (far, u) = tree.nearest_within(reach * reach, &surface.positions[v as usize].to_array(), wanted)?;
        Some(((v, u), far.sqrt()))
    };
    let some = (0..surface.len() as u32).step_by(surface.len().div_ceil(ASKED));
    let gaps: Vec<f64> = some.filter_map(|v| Some(nearest(v, f64::INFINITY, &|u| u != v)?.1)).collect();
    let reach = FAR.min(SPACINGS * gaps.iter().sum::<f64>() / gaps.len().max(1) as f64);
    let largest = (0..pieces.len()).max_by_key(|&p| pieces[p].len());
    let small = (0..surface.len() as u32).filter(|&v| Some(piece[v as usize] as usize) != largest);
    small.filter_map(|v| nearest(v, reach, &|u| piece[u as usize] != piece[v as usize])).collect()
}
