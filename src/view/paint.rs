//! What colour each face has, which edges have a line, and what is marked: four words a face for the shaders.

use super::colormap::ColourMap;
use super::colour::Srgb;
use super::flow::spread;
use super::motion::Motion;
use super::palette::Palette;
use super::surface::Surface;
use super::vertex_paint::VertexPaint;

/// Unpainted clay.
pub const CLAY: Srgb = [214, 202, 188];
/// The two colours of a set: outside and inside.
pub const SET: [Srgb; 2] = [[206, 196, 184], [222, 138, 84]];
/// Number of styles that faces can be marked with.
pub const MARKS: usize = 4;

/// Colours, labels and marks of #F faces.
#[derive(Clone, Debug, Default)]
pub struct Paint {
    colours: Vec<Srgb>,
    /// What boundary lines are drawn between; empty for none.
    labels: Vec<u32>,
    /// A bit for each style.
    marks: Vec<u8>,
    /// When the paint arrives at each face while it flows in, 0 to 255; empty for everywhere at once.
    arrivals: Vec<u8>,
    /// Palette numbers of the parts, in their order.
    slots: Vec<usize>,
    /// What lies on the vertices instead of the faces' colours.
    vertices: Option<VertexPaint>,
    palette: Palette,
}

impl Paint {
    /// Bare clay for `faces` faces. The colours that parts had are remembered no longer.
    pub fn reset(&mut self, faces: usize) {
        self.slots.clear();
        self.arrivals.clear();
        self.marks = vec![0; faces];
        self.clay();
    }

    /// Bare clay.
    pub fn clay(&mut self) {
        self.colours = vec![CLAY; self.marks.len()];
        self.labels.clear();
        self.vertices = None;
    }

    /// Parts: `labels` is #F numbers below `count`. A part takes the colour that most of its faces had in the last
    /// parts, if it can. The error is a sentence.
    pub fn parts(&mut self, surface: &Surface, labels: &[u32], count: usize) -> Result<(), &'static str> {
        self.check(labels.len())?;
        if labels.iter().any(|&l| l as usize >= count) || count > labels.len().max(1) {
            return Err("A face has a part number that does not exist.");
        }
        let wish = self.inherited(labels, count);
        self.slots = self.palette.assign(&surface.label_neighbours(labels, count), &wish);
        let colours: Vec<Srgb> = self.slots.iter().map(|&s| self.palette.colour(s)).collect();
        self.colours = labels.iter().map(|&l| colours[l as usize]).collect();
        self.labels = labels.to_vec();
        self.vertices = None;
        Ok(())
    }

    /// A field: `values` is #F numbers, `low` and `high` are the ends of the map. The error is a sentence.
    pub fn scalar(&mut self, values: &[f32], low: f32, high: f32, map: ColourMap) -> Result<(), &'static str> {
        self.check(values.len())?;
        let scale = if high > low { 1.0 / (high - low) } else { 0.0 };
        let table = map.table();
        // The conversion to an integer saturates; what is not a number stands out as clay.
        let place = |v: f32| ((v - low) * scale * 255.0 + 0.5) as usize;
        let colour = |&v: &f32| if v.is_nan() { CLAY } else { table[place(v).min(255)] };
        self.colours = values.iter().map(colour).collect();
        self.labels.clear();
        self.vertices = None;
        Ok(())
    }

    /// A field on `vertices` vertices: `values` is as many numbers, `low` and `high` are the ends of the map. The
    /// error is a sentence.
    pub fn vertices(
        &mut self,
        vertices: usize,
        values: &[f32],
        low: f32,
        high: f32,
        map: ColourMap,
    ) -> Result<(), &'static str> {
        if values.len() != vertices {
            return Err("The paint has another number of vertices than the mesh.");
        }
        self.clay();
        self.vertices = Some(VertexPaint::field(values, low, high, map));
        Ok(())
    }

    /// Groups of the vertices of `motion`: `labels` is #V numbers below `count`. The error is a sentence.
    pub fn groups(&mut self, motion: &Motion, labels: &[u32], count: usize) -> Result<(), &'static str> {
        let paint = VertexPaint::groups(motion, labels, count, &self.palette)?;
        self.clay();
        self.vertices = Some(paint);
        Ok(())
    }

    /// The colours of the groups that are painted, in their order.
    pub fn group_colours(&self) -> &[Srgb] {
        self.vertices.as_ref().map_or(&[], VertexPaint::group_colours)
    }

    /// The colours of what lies on the vertices, where something does: see [`VertexPaint::table`].
    pub fn table(&self) -> Option<Vec<[u8; 4]>> {
        self.vertices.as_ref().map(VertexPaint::table)
    }

    /// Two colours: `mask` is #F numbers, not 0 for the faces of the set. The error is a sentence.
    pub fn set(&mut self, mask: &[u8]) -> Result<(), &'static str> {
        self.check(mask.len())?;
        self.colours = mask.iter().map(|&m| SET[usize::from(m != 0)]).collect();
        self.labels = mask.iter().map(|&m| u32::from(m != 0)).collect();
        self.vertices = None;
        Ok(())
    }

    /// Marks exactly `faces` with style `style` (from 0); with no faces, the style's marks go.
    pub fn mark(&mut self, faces: &[u32], style: usize) {
        let bit = 1_u8 << style.min(MARKS - 1);
        self.marks.iter_mut().for_each(|m| *m &= !bit);
        for &f in faces {
            if let Some(m) = self.marks.get_mut(f as usize) {
                *m |= bit;
            }
        }
    }

    /// Sets where paint that flows in comes from: see [`spread`].
    pub fn flow_from(&mut self, surface: &Surface, sources: &[u32]) {
        self.arrivals = spread(surface, self.marks.len(), sources);
    }

    /// The colours of the parts, in their order.
    pub fn part_colours(&self) -> Vec<Srgb> {
        self.slots.iter().map(|&s| self.palette.colour(s)).collect()
    }

    /// The label of a face, where labels are painted.
    pub fn label(&self, face: usize) -> Option<u32> {
        self.labels.get(face).copied()
    }

    /// Four words a face: red, green, blue and mark (0 none, else style + 1) in a byte each, lowest first; boundary
    /// bits in the low byte, the label plus one (0 for none) in the two above, when the paint arrives in the top one; two words of what lies
    /// on the vertices (see [`VertexPaint::words`]), else 0.
    pub fn words(&self, surface: &Surface, faces: &[[u32; 3]]) -> Vec<[u32; 4]> {
        let bits = if self.labels.is_empty() { Vec::new() } else { surface.boundary_bits(faces, &self.labels) };
        let word = |(f, colour): (usize, &Srgb)| {
            let mark = 8 - self.marks.get(f).copied().unwrap_or(0).leading_zeros();
            let low = u32::from_le_bytes([colour[0], colour[1], colour[2], mark as u8]);
            let label = self.labels.get(f).map_or(0, |&l| l.saturating_add(1).min(0xFFFF));
            let arrival = u32::from(self.arrivals.get(f).copied().unwrap_or(0));
            [low, u32::from(bits.get(f).copied().unwrap_or(0)) | label << 8 | arrival << 24, 0, 0]
        };
        let mut words: Vec<[u32; 4]> = self.colours.iter().enumerate().map(word).collect();
        if let Some(vertices) = &self.vertices {
            for (word, [z, w]) in words.iter_mut().zip(vertices.words(faces)) {
                (word[2], word[3]) = (z, w);
            }
        }
        words
    }

    fn check(&self, found: usize) -> Result<(), &'static str> {
        if found == self.marks.len() { Ok(()) } else { Err("The paint has another number of faces than the mesh.") }
    }

    /// For each new part the palette number that most of its faces have.
    fn inherited(&self, labels: &[u32], count: usize) -> Vec<Option<usize>> {
        if self.slots.is_empty() || self.labels.len() != labels.len() {
            return Vec::new();
        }
        let mut pairs: Vec<(u32, u32)> = labels.iter().copied().zip(self.labels.iter().copied()).collect();
        pairs.sort_unstable();
        let mut best: Vec<(usize, Option<usize>)> = vec![(0, None); count];
        for run in pairs.chunk_by(|a, b| a == b) {
            let (new, old) = (run[0].0 as usize, run[0].1 as usize);
            if run.len() > best[new].0 {
                best[new] = (run.len(), self.slots.get(old).copied());
            }
        }
        // Where an old part fell into several, the one that keeps most of it keeps its colour.
        let mut wish: Vec<Option<usize>> = best.iter().map(|b| b.1).collect();
        for part in 0..count {
            let rival = |&other: &usize| {
                other != part && best[other].1 == best[part].1 && (best[other].0, part) > (best[part].0, other)
            };
            if wish[part].is_some() && (0..count).any(|o| rival(&o)) {
                wish[part] = None;
            }
        }
        wish
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::view::motion::Motion;

    /// A strip of eight triangles.
    fn strip() -> (Motion, Surface) {
        let points: Vec<f32> = (0..10).flat_map(|i| [(i / 2) as f32, (i % 2) as f32, 0.0]).collect();
        let faces: Vec<u32> =
            (0..8).flat_map(|i| if i % 2 == 0 { [i, i + 2, i + 1] } else { [i, i + 1, i + 2] }).collect();
        let motion = Motion::new(&faces, &points).unwrap();
        let surface = Surface::new(&motion);
        (motion, surface)
    }

    fn painted() -> (Motion, Surface, Paint) {
        let (motion, surface) = strip();
        let mut paint = Paint::default();
        paint.reset(8);
        (motion, surface, paint)
    }

    #[test]
    fn parts_have_lines_between_them() {
        let (motion, surface, mut paint) = painted();
        paint.parts(&surface, &[0, 0, 0, 1, 1, 1, 2, 2], 3).unwrap();
        let words = paint.words(&surface, motion.faces());
        let lines = |f: usize| words[f][1] & 7;
        assert_eq!((0..8).map(|f| lines(f).count_ones()).collect::<Vec<_>>(), [0, 0, 1, 1, 0, 1, 1, 0]);
        assert_eq!(words[7][1] >> 8, 3);
        assert_eq!(paint.part_colours().len(), 3);
        assert_eq!(words[0][0].to_le_bytes()[..3], paint.part_colours()[0]);
    }

    #[test]
    fn a_split_changes_only_the_smaller_half() {
        let (_, surface, mut paint) = painted();
        paint.parts(&surface, &[0, 0, 0, 0, 0, 1, 1, 1], 2).unwrap();
        let before = paint.part_colours();
        paint.parts(&surface, &[2, 2, 0, 0, 0, 1, 1, 1], 3).unwrap();
        let after = paint.part_colours();
        assert_eq!(after[..2], before[..]);
        assert!(!before.contains(&after[2]));
        paint.parts(&surface, &[0, 0, 0, 0, 0, 1, 1, 1], 2).unwrap();
        assert_eq!(paint.part_colours(), before);
    }

    #[test]
    fn wrong_lengths_and_numbers_are_refused() {
        let (_, surface, mut paint) = painted();
        assert!(paint.parts(&surface, &[0; 7], 1).is_err());
        assert!(paint.parts(&surface, &[1; 8], 1).is_err());
        assert!(paint.parts(&surface, &[0; 8], usize::MAX).is_err());
        assert!(paint.scalar(&[0.0; 9], 0.0, 1.0, ColourMap::Viridis).is_err());
        assert!(paint.set(&[]).is_err());
    }

    #[test]
    fn fields_and_marks() {
        let (motion, surface, mut paint) = painted();
        let values = [0.0, 1.0, 2.0, -5.0, 9.0, f32::NAN, f32::INFINITY, 1.0];
        paint.scalar(&values, 0.0, 2.0, ColourMap::Viridis).unwrap();
        paint.mark(&[1, 99], 0);
        paint.mark(&[1, 2], 2);
        let words = paint.words(&surface, motion.faces());
        let colour = |f: usize| [words[f][0] as u8, (words[f][0] >> 8) as u8, (words[f][0] >> 16) as u8];
        assert_eq!(colour(0), ColourMap::Viridis.at(0.0));
        assert_eq!(colour(3), ColourMap::Viridis.at(0.0));
        assert_eq!(colour(4), ColourMap::Viridis.at(1.0));
        assert_eq!(colour(5), CLAY);
        assert_eq!(colour(6), ColourMap::Viridis.at(1.0));
        assert_eq!([0, 1, 2].map(|f| words[f][0] >> 24), [0, 3, 3]);
        paint.mark(&[], 2);
        assert_eq!(paint.words(&surface, motion.faces())[1][0] >> 24, 1);
        paint.scalar(&values, f32::NAN, f32::NAN, ColourMap::Diverging).unwrap();
    }

    #[test]
    fn what_lies_on_vertices_goes_with_the_next_paint() {
        let (motion, surface, mut paint) = painted();
        paint.parts(&surface, &[0; 8], 1).unwrap();
        paint.vertices(10, &[0.5; 10], 0.0, 1.0, ColourMap::Viridis).unwrap();
        let words = paint.words(&surface, motion.faces());
        assert!(words.iter().all(|w| w[3] >> 16 == 1 && w[1] & 63 == 0));
        assert!(paint.table().is_some() && paint.group_colours().is_empty());
        paint.groups(&motion, &[0, 0, 0, 0, 0, 0, 1, 1, 1, 1], 2).unwrap();
        assert_eq!(paint.group_colours().len(), 2);
        assert!(
            paint.groups(&motion, &[0; 9], 2).is_err()
                && paint.vertices(10, &[], 0.0, 1.0, ColourMap::Viridis).is_err()
        );
        assert_eq!(paint.group_colours().len(), 2, "what cannot be painted changes nothing");
        paint.set(&[1; 8]).unwrap();
        assert!(paint.table().is_none());
        assert!(paint.words(&surface, motion.faces()).iter().all(|w| w[2] == 0 && w[3] == 0));
    }
}
