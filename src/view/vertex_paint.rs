//! Paint that lies on vertices: a smooth field, or groups of vertices with boundaries that run through the faces.
//!
//! The shaders mix the values of a face's corners and look the colour up, so that a field is smooth and its colours
//! are those of its map even where faces are large.

use super::colormap::ColourMap;
use super::colour::Srgb;
use super::motion::Motion;
use super::palette::Palette;

/// Entries of the table that the shaders look colours up in.
pub const TABLE: usize = 2048;
/// The value that stands for none.
const NONE: u16 = u16::MAX;

/// What the values mean; the shaders know these numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Field = 1,
    Groups = 2,
}

/// Values of #V vertices and what colours they have.
#[derive(Clone, Debug)]
pub struct VertexPaint {
    kind: Kind,
    /// For a field 0 to 65534 from the low to the high end of the map; for groups the number of the group.
    values: Vec<u16>,
    table: Vec<Srgb>,
}

impl VertexPaint {
    /// A field: `values` is #V numbers, `low` and `high` are the ends of the map. What is not a number is clay.
    pub fn field(values: &[f32], low: f32, high: f32, map: ColourMap) -> Self {
        let scale = if high > low { 1.0 / (high - low) } else { 0.0 };
        let place = |&v: &f32| {
            let share = (v - low) * scale;
            // The conversion to an integer saturates; infinity times nothing is no number.
            if v.is_nan() { NONE } else { ((share * 65534.0 + 0.5) as u16).min(NONE - 1) }
        };
        Self { kind: Kind::Field, values: values.iter().map(place).collect(), table: map.table() }
    }

    /// Groups: `labels` is #V numbers below `count`, with colours of the palette, neighbours far apart. The error is
    /// a sentence.
    pub fn groups(motion: &Motion, labels: &[u32], count: usize, palette: &Palette) -> Result<Self, &'static str> {
        if labels.len() != motion.vertices() {
            return Err("The groups have another number of vertices than the mesh.");
        }
        if count > TABLE {
            return Err("These are more groups than can be told apart.");
        }
        if labels.iter().any(|&l| l as usize >= count) {
            return Err("A vertex has a group number that does not exist.");
        }
        let slots = palette.assign(&neighbours(motion.faces(), labels, count), &[]);
        Ok(Self {
            kind: Kind::Groups,
            values: labels.iter().map(|&l| l as u16).collect(),
            table: slots.into_iter().map(|s| palette.colour(s)).collect(),
        })
    }

    /// The colours of groups, in their order; none for a field.
    pub fn group_colours(&self) -> &[Srgb] {
        if self.kind == Kind::Groups { &self.table } else { &[] }
    }

    /// Two words for each face: the corners' values in 16 bits each, and what they mean in the highest 16.
    pub fn words<'a>(&'a self, faces: &'a [[u32; 3]]) -> impl Iterator<Item = [u32; 2]> + 'a {
        let value = |v: u32| u32::from(self.values.get(v as usize).copied().unwrap_or(NONE));
        faces.iter().map(move |&[a, b, c]| [value(a) | value(b) << 16, value(c) | (self.kind as u32) << 16])
    }

    /// The table, [`TABLE`] times red, green, blue and nothing.
    pub fn table(&self) -> Vec<[u8; 4]> {
        let mut out: Vec<[u8; 4]> = self.table.iter().map(|&[r, g, b]| [r, g, b, 255]).collect();
        out.resize(TABLE, [0; 4]);
        out
    }
}

/// For each of `count` labels the other labels that it shares a face with, ascending.
fn neighbours(faces: &[[u32; 3]], labels: &[u32], count: usize) -> Vec<Vec<usize>> {
    let label = |v: u32| labels.get(v as usize).map_or(0, |&l| l as usize);
    let mut pairs: Vec<(usize, usize)> = Vec::new();
    for &[a, b, c] in faces {
        let [a, b, c] = [label(a), label(b), label(c)];
        pairs.extend([(a, b), (b, c), (c, a)].into_iter().filter(|(x, y)| x != y).flat_map(|(x, y)| [(x, y), (y, x)]));
    }
    pairs.sort_unstable();
    pairs.dedup();
    let mut out = vec![Vec::new(); count];
    for (a, b) in pairs {
        if let Some(list) = out.get_mut(a) {
            list.push(b);
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    fn motion() -> Motion {
        let points: Vec<f32> = (0..6).flat_map(|i| [(i / 2) as f32, (i % 2) as f32, 0.0]).collect();
        Motion::new(&[0, 2, 1, 1, 2, 3, 2, 4, 3, 3, 4, 5], &points).unwrap()
    }

    #[test]
    fn fields_fill_the_map() {
        let values = [0.0, 1.0, 2.0, f32::NAN, -9.0, f32::INFINITY];
        let paint = VertexPaint::field(&values, 0.0, 2.0, ColourMap::Viridis);
        assert_eq!(paint.values, [0, 32767, 65534, NONE, 0, 65534]);
        let words: Vec<[u32; 2]> = paint.words(motion().faces()).collect();
        assert_eq!(words[0], [65534 << 16, 32767 | 1 << 16]);
        assert_eq!(paint.table().len(), TABLE);
        assert_eq!(paint.table()[255][..3], ColourMap::Viridis.at(1.0));
        assert!(paint.group_colours().is_empty());
        let flat = VertexPaint::field(&values, 1.0, 1.0, ColourMap::Cividis);
        assert_eq!(flat.values[..3], [0, 0, 0]);
    }

    #[test]
    fn groups_have_clear_colours() {
        let (motion, palette) = (motion(), Palette::default());
        let paint = VertexPaint::groups(&motion, &[0, 0, 1, 1, 2, 2], 3, &palette).unwrap();
        let colours = paint.group_colours();
        assert_eq!(colours.len(), 3);
        assert!(colours[0] != colours[1] && colours[1] != colours[2]);
        assert_eq!(paint.words(motion.faces()).next(), Some([1 << 16, 2 << 16]));
        assert_eq!(neighbours(motion.faces(), &[0, 0, 1, 1, 2, 2], 3), [vec![1], vec![0, 2], vec![1]]);
        assert!(VertexPaint::groups(&motion, &[0; 5], 1, &palette).is_err());
        assert!(VertexPaint::groups(&motion, &[3; 6], 3, &palette).is_err());
        assert!(VertexPaint::groups(&motion, &[0; 6], 9999, &palette).is_err());
    }
}
