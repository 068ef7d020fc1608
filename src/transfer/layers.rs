//! Clothes: pieces of the target that lie over a body.
//!
//! A skirt or a coat has no pair and often no twin on the source: bent onto it, it would stick to whatever is near, to the
//! hands that hang beside it for one. It follows what lies beneath it on the target itself, as one garment and evened out.

use super::fill::fill;
use super::mend::{SHORT, SMALL};
use super::rig::weights::{Averager, Row, main_bone};
use super::surface::{SurfacePoint, WeldedSurface};
use crate::mesh::groups::Groups;
use crate::mesh::kd_tree::KdTree;
use glam::DVec3;
use std::collections::BTreeMap;

/// A piece lies over others that are no farther on average than this, over the diagonal of its box. (A hand that was cut
/// off is near the arm at its end only.) So does any small piece, such as a button.
const NEAR: f64 = 0.2;
/// Half of a layer is over something: the way there is along its normal, by this cosine.
const OVER: f64 = 0.5;
/// How far along a layer what it follows is evened out, over that diagonal: two legs move one skirt.
const EVEN: f64 = 0.1;
/// Rounds of averaging for that, the most.
const MOST_ROUNDS: u32 = 100;

/// The connected pieces of a surface, those with a mark among them.
pub struct Pieces {
    places: Vec<Vec<u32>>,
    /// #N whether the piece has a marked place.
    marked: Vec<bool>,
}

impl Pieces {
    /// Of a surface with some marked places.
    pub fn new(surface: &WeldedSurface, marks: impl Iterator<Item = u32>) -> Self {
        let places = surface.pieces();
        let number = surface.numbered(&places);
        let mut held = vec![false; places.len()];
        marks.for_each(|v| held[number[v as usize] as usize] = true);
        Self { marked: number.iter().map(|&piece| held[piece as usize]).collect(), places }
    }

    /// #N shares of the area, those of pieces with a mark: together, they are 1.
    pub fn areas(&self, surface: &WeldedSurface) -> Vec<f64> {
        let mut areas: Vec<f64> = surface.mass.clone();
        areas.iter_mut().zip(&self.marked).filter(|(_, marked)| !**marked).for_each(|(area, _)| *area = 0.0);
        let sum: f64 = areas.iter().sum();
        areas.iter_mut().for_each(|area| *area /= sum.max(f64::MIN_POSITIVE));
        areas
    }

    /// The places of each piece without a mark.
    fn unmarked(&self) -> Vec<Vec<u32>> {
        self.places.iter().filter(|piece| piece.iter().any(|&v| !self.marked[v as usize])).cloned().collect()
    }
}

/// Gives layers of the target rows of at most `most` entries from what lies beneath them. `pieces` are those of the source
/// and of the target, marked where there is a pair; `lying` tells where the target lies on the source (#N).
pub fn lay(
    (source, target): (&WeldedSurface, &WeldedSurface),
    pieces: (&Pieces, &Pieces),
    lying: &[Option<SurfacePoint>],
    rows: &mut [Row],
    most: usize,
) {
    let twinless =
        |&v: &u32| lying[v as usize].is_some_and(|on| pieces.0.marked[source.faces[on.face as usize][0] as usize]);
    let mut unmarked = pieces.1.unmarked();
    unmarked.retain(|piece| 2 * piece.iter().filter(|&v| twinless(v)).count() >= piece.len());
    if unmarked.is_empty() {
        return;
    }
    let body = Body::of_layers(target, &pieces.1.marked, &mut unmarked, rows);
    for piece in &unmarked {
        let beneath = body.beneath(piece);
        beneath.iter().flatten().zip(piece).for_each(|(&u, &v)| rows[v as usize] = rows[u as usize].clone());
    }
    fill(target, rows, &body.strays(&unmarked, rows));
    unmarked.iter().for_each(|piece| even(target, piece, rows, most));
}

/// What layers lie on.
struct Body<'a> {
    surface: &'a WeldedSurface,
    places: Vec<u32>,
    tree: KdTree<3>,
    /// For each bone and each other, whether they are one or meet somewhere on it.
    joined: Vec<Vec<bool>>,
}

impl<'a> Body<'a> {
    /// The marked places of a surface, and the pieces that are no layers on these: a body may be in pieces itself. Of
    /// `pieces`, layers remain.
    fn of_layers(surface: &'a WeldedSurface, marked: &[bool], pieces: &mut Vec<Vec<u32>>, rows: &[Row]) -> Self {
        let held = Self::new(surface, marked, rows);
        let mut all = marked.to_vec();
        pieces.retain(|piece| {
            let layer = surface.sides(piece).max_element() <= SMALL || held.lies_under(piece);
            piece.iter().for_each(|&v| all[v as usize] |= !layer);
            layer
        });
        Self::new(surface, &all, rows)
    }

    /// The marked places of a surface, one at least.
    fn new(surface: &'a WeldedSurface, marked: &[bool], rows: &[Row]) -> Self {
        let places: Vec<u32> = (0..surface.len() as u32).filter(|&v| marked[v as usize]).collect();
        let points: Vec<[f64; 3]> = places.iter().map(|&v| surface.positions[v as usize].to_array()).collect();
        let bone: Vec<u32> = rows.iter().map(main_bone).collect();
        let beside = |&v: &u32| surface.neighbours(v as usize).iter().map(move |&u| (v, u));
        let bones = bone.iter().max().map_or(0, |&most| most as usize + 1);
        let mut joined: Vec<Vec<bool>> = (0..bones).map(|a| (0..bones).map(|b| a == b).collect()).collect();
        for (v, u) in places.iter().flat_map(beside) {
            joined[bone[v as usize] as usize][bone[u as usize] as usize] = true;
        }
        Self { surface, tree: KdTree::new(&points), places, joined }
    }

    /// For each place of a piece the place beneath it.
    fn beneath(&self, piece: &[u32]) -> Option<Vec<u32>> {
        let at = |v: u32| self.surface.positions[v as usize];
        piece.iter().map(|&v| Some(self.places[self.tree.nearest(&at(v).to_array())? as usize])).collect()
    }

    /// Whether a piece is a layer on this: near it, and over it rather than beside it as the next piece of a trunk is.
    fn lies_under(&self, piece: &[u32]) -> bool {
        let (mut sum, mut over, mut all) = (0.0, 0.0, 0.0);
        for (&v, &u) in piece.iter().zip(self.beneath(piece).iter().flatten()) {
            let WeldedSurface { positions, normals, mass, .. } = self.surface;
            let (at, mass) = (positions[v as usize], mass[v as usize]);
            let way = self.surface.nearest_around(u, at).map_or(DVec3::ZERO, |found| found.1 - at);
            sum += mass * way.length();
            all += mass;
            if way.length() < SHORT || way.dot(normals[v as usize]).abs() >= OVER * way.length() {
                over += mass;
            }
        }
        sum <= NEAR * self.surface.sides(piece).length() * all && over >= 0.5 * all
    }

    /// #N whether a place of a layer is on a stray patch of it: what lies beneath does not adjoin, on the body, what lies
    /// beneath the largest patch.
    fn strays(&self, layers: &[Vec<u32>], rows: &[Row]) -> Vec<bool> {
        let surface = self.surface;
        let mut patches = Groups::new(surface.len());
        for &v in layers.iter().flatten() {
            for &u in surface.neighbours(v as usize) {
                let [a, b] = [v, u].map(|v| main_bone(&rows[v as usize]) as usize);
                if self.joined[a][b] {
                    patches.join(v, u);
                }
            }
        }
        let mut stray = vec![false; surface.len()];
        for piece in layers {
            let mut area = BTreeMap::new();
            piece.iter().for_each(|&v| *area.entry(patches.root(v)).or_insert(0.0) += surface.mass[v as usize]);
            let largest = area.iter().max_by(|a, b| a.1.total_cmp(b.1).then(b.0.cmp(a.0))).map(|patch| *patch.0);
            piece.iter().for_each(|&v| stray[v as usize] = Some(patches.root(v)) != largest);
        }
        stray
    }
}

/// Averages the rows along a piece.
fn even(target: &WeldedSurface, piece: &[u32], rows: &mut [Row], most: usize) {
    let lengths = piece.iter().flat_map(|&v| {
        target
            .neighbours(v as usize)
            .iter()
            .map(move |&u| target.positions[v as usize].distance(target.positions[u as usize]))
    });
    let (count, sum) = lengths.fold((0, 0.0), |(count, sum), length| (count + 1, sum + length));
    // A step goes an edge at random, half of the time: so many go as far.
    let steps = EVEN * target.sides(piece).length() * f64::from(count) / f64::max(sum, f64::MIN_POSITIVE);
    let rounds = (2.0 * steps * steps).ceil().min(f64::from(MOST_ROUNDS)) as usize;
    let (mut averager, mut next) = (Averager::default(), vec![Row::new(); piece.len()]);
    for _ in 0..rounds {
        next.iter_mut().zip(piece).for_each(|(row, &v)| averager.average(target, rows, v as usize, most, row));
        next.iter_mut().zip(piece).for_each(|(row, &v)| std::mem::swap(row, &mut rows[v as usize]));
    }
}
