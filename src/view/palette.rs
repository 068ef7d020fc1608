//! Colours for parts: neighbours far apart for every eye, and the same part the same colour from one
//! segmentation to the next.
//!
//! The colours are fixed: equal chroma, hues spaced around the OKLCH circle, three near lightnesses, because hue
//! alone does not reach colour-blind eyes. Parts take them greedily by the distance from what their neighbours
//! have, seen by the eyes that tell them apart worst.

use super::colour::{Srgb, least_distance, oklch};
use crate::mesh::DualGraph;

/// Number of hues around the circle.
const HUES: usize = 12;
/// Lightnesses that the hues are offered in.
const LIGHTNESS: [f32; 3] = [0.75, 0.67, 0.83];
/// Chroma of every colour.
const CHROMA: f32 = 0.108;
/// Where the hues begin, degrees: a warm coral.
const FIRST_HUE: f32 = 32.0;
/// Two neighbours at least this far apart (OKLab) are told apart with ease.
const CLEAR: f32 = 0.12;
/// A part keeps its earlier colour as long as its neighbours are this far (OKLab).
const ENOUGH: f32 = 0.075;

/// The colours that parts can take.
#[derive(Clone, Debug)]
pub struct Palette {
    colours: Vec<Srgb>,
    /// Distance of each two, row by row.
    distance: Vec<f32>,
}

impl Default for Palette {
    fn default() -> Self {
        let colours: Vec<Srgb> = LIGHTNESS
            .iter()
            .enumerate()
            .flat_map(|(row, &light)| {
                (0..HUES).map(move |i| {
                    // Each lightness begins a third of a step later, so that no hue comes twice.
                    let hue = FIRST_HUE + 360.0 * (i as f32 + row as f32 / 3.0) / HUES as f32;
                    oklch(light, CHROMA, hue)
                })
            })
            .collect();
        let distance = colours.iter().flat_map(|&a| colours.iter().map(move |&b| least_distance(a, b))).collect();
        Self { colours, distance }
    }
}

impl Palette {
    /// Number of colours.
    pub fn len(&self) -> usize {
        self.colours.len()
    }

    /// Whether there is no colour (there always is one).
    pub fn is_empty(&self) -> bool {
        self.colours.is_empty()
    }

    /// The colour with the number `slot`.
    pub fn colour(&self, slot: usize) -> Srgb {
        self.colours.get(slot).copied().unwrap_or([160; 3])
    }

    /// A colour number for each part.
    ///
    /// `neighbours[p]` are the parts that touch part `p`; `wish[p]`, where it is given, is the colour that the part
    /// had before, and is kept unless a neighbour is too near in colour. Parts with wishes come first, in the
    /// order of their numbers.
    pub fn assign(&self, neighbours: &[Vec<usize>], wish: &[Option<usize>]) -> Vec<usize> {
        let parts = neighbours.len();
        let mut slots: Vec<Option<usize>> = vec![None; parts];
        let mut used = vec![0_usize; self.len()];
        let wished = |p: &usize| wish.get(*p).copied().flatten().is_some();
        let order = (0..parts).filter(wished).chain((0..parts).filter(|p| !wished(p)));
        for part in order {
            let kept = wish.get(part).copied().flatten().filter(|&slot| {
                slot < self.len() && used[slot] == 0 && self.clearance(slot, &neighbours[part], &slots) >= ENOUGH
            });
            let slot = kept.unwrap_or_else(|| self.best(&neighbours[part], &slots, &used));
            slots[part] = Some(slot);
            used[slot] += 1;
        }
        slots.into_iter().map(|s| s.unwrap_or(0)).collect()
    }

    fn between(&self, a: usize, b: usize) -> f32 {
        self.distance[a * self.len() + b]
    }

    /// How far `slot` is from the nearest colour of a neighbour.
    fn clearance(&self, slot: usize, neighbours: &[usize], slots: &[Option<usize>]) -> f32 {
        let taken = neighbours.iter().filter_map(|&n| slots.get(n).copied().flatten());
        taken.map(|other| self.between(slot, other)).fold(1.0, f32::min)
    }

    /// The colour that is best for a part beside `neighbours`: clear of them, seldom used, far from the others,
    /// and of the first lightness if it can be.
    fn best(&self, neighbours: &[usize], slots: &[Option<usize>], used: &[usize]) -> usize {
        let score = |slot: usize| {
            let clear = self.clearance(slot, neighbours, slots).min(CLEAR) / CLEAR;
            let others = slots.iter().flatten().map(|&o| self.between(slot, o)).fold(0.25, f32::min);
            let again = used[slot] as f32;
            4.0 * clear + 1.5 * others.min(0.25) / 0.25 - 0.5 * again - 0.3 * (slot / HUES) as f32
        };
        let mut best = (0, f32::NEG_INFINITY);
        for slot in 0..self.len() {
            let s = score(slot);
            if s > best.1 + 1e-6 {
                best = (slot, s);
            }
        }
        best.0
    }
}

/// A colour for each of the parts `labels` (#F part numbers) of a mesh with these faces.
pub fn part_colours(faces: &[[u32; 3]], labels: &[u32]) -> Vec<Srgb> {
    let parts = labels.iter().max().map_or(0, |&last| last as usize + 1);
    let mut neighbours = vec![Vec::new(); parts];
    for (a, b) in DualGraph::new(faces).touching(labels) {
        neighbours[a as usize].push(b as usize);
        neighbours[b as usize].push(a as usize);
    }
    let palette = Palette::default();
    palette.assign(&neighbours, &[]).into_iter().map(|slot| palette.colour(slot)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The worst distance between two neighbours' colours.
    fn worst(palette: &Palette, neighbours: &[Vec<usize>], slots: &[usize]) -> f32 {
        let pairs = neighbours.iter().enumerate().flat_map(|(p, ns)| ns.iter().map(move |&n| (p, n)));
        pairs
            .map(|(p, n)| least_distance(palette.colour(slots[p]), palette.colour(slots[n])))
            .fold(f32::INFINITY, f32::min)
    }

    /// A creature: trunk, neck, head, tail in pieces, four legs in three pieces.
    fn creature() -> Vec<Vec<usize>> {
        let edges = [
            (0, 1),
            (1, 2),
            (0, 3),
            (3, 4),
            (4, 5),
            (0, 6),
            (6, 7),
            (7, 8),
            (0, 9),
            (9, 10),
            (10, 11),
            (0, 12),
            (12, 13),
            (13, 14),
            (0, 15),
            (15, 16),
            (16, 17),
            (6, 9),
            (12, 15),
        ];
        graph(18, &edges)
    }

    fn graph(parts: usize, edges: &[(usize, usize)]) -> Vec<Vec<usize>> {
        let mut out = vec![Vec::new(); parts];
        for &(a, b) in edges {
            out[a].push(b);
            out[b].push(a);
        }
        out
    }

    /// A triangulated board, as crowded as patches on a surface get.
    fn board(side: usize) -> Vec<Vec<usize>> {
        let mut edges = Vec::new();
        for y in 0..side {
            for x in 0..side {
                let p = y * side + x;
                edges.extend((x + 1 < side).then_some((p, p + 1)));
                edges.extend((y + 1 < side).then_some((p, p + side)));
                edges.extend((x + 1 < side && y + 1 < side).then_some((p, p + side + 1)));
            }
        }
        graph(side * side, &edges)
    }

    #[test]
    fn neighbours_differ_for_every_eye() {
        let palette = Palette::default();
        for neighbours in [creature(), board(4), board(8)] {
            let slots = palette.assign(&neighbours, &[]);
            let worst = worst(&palette, &neighbours, &slots);
            assert!(worst > 0.07, "{} parts: {worst}", neighbours.len());
        }
    }

    #[test]
    fn few_parts_have_colours_of_their_own() {
        let palette = Palette::default();
        let mut slots = palette.assign(&creature(), &[]);
        slots.sort_unstable();
        slots.dedup();
        assert_eq!(slots.len(), 18);
    }

    #[test]
    fn a_part_keeps_its_colour() {
        let palette = Palette::default();
        let before = palette.assign(&creature(), &[]);
        let wish: Vec<_> = before.iter().map(|&s| Some(s)).collect();
        assert_eq!(palette.assign(&creature(), &wish), before);
        // A new last part changes nobody else.
        let mut more = creature();
        more.push(vec![0]);
        more[0].push(18);
        assert_eq!(palette.assign(&more, &wish)[..18], before[..]);
    }

    #[test]
    fn a_wish_too_near_a_neighbour_is_not_granted() {
        let palette = Palette::default();
        let slots = palette.assign(&[vec![1], vec![0]], &[Some(3), Some(3)]);
        assert_eq!(slots[0], 3);
        assert!(palette.between(slots[0], slots[1]) > ENOUGH);
    }

    #[test]
    fn chroma_is_even() {
        use super::super::colour::{linear_to_oklab, srgb_to_linear};
        for &c in &Palette::default().colours {
            let lab = linear_to_oklab(srgb_to_linear(c));
            let chroma = lab.y.hypot(lab.z);
            assert!((chroma - CHROMA).abs() < 0.03, "{c:?} has chroma {chroma}");
        }
    }
}
