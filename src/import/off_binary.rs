//! What follows the line `OFF BINARY`: whole numbers and floats of 32 bits, highest byte first.

use super::ImportError;
use super::off::{Layout, with_dimensions};
use super::polygons::PolygonMesh;

/// Reads the bytes after the header's line; `dimensions` says that their number comes first.
pub fn read(name: &str, bytes: &[u8], layout: Layout, dimensions: bool) -> Result<PolygonMesh, ImportError> {
    let mut words = Words { name, left: bytes };
    let mut layout = layout;
    if dimensions {
        let number = i64::from(words.integer()?);
        layout = with_dimensions(layout, number, |what| ImportError(format!("{name}: {what}")))?;
    }
    // The third count, of edges, is not used.
    let (vertices, polygons, _) = (words.count()?, words.count()?, words.integer()?);
    let extra = 3 * usize::from(layout.normal) + 4 * usize::from(layout.colour) + 2 * usize::from(layout.texture);
    let each = layout.coordinates + usize::from(layout.homogeneous) + extra;
    words.announce(vertices, each, "vertices")?;
    let mut mesh = PolygonMesh::new(name);
    for number in 0..vertices {
        let wrong = |what: &str| ImportError(format!("vertex {} of {name} (counted from 1): {what}", number + 1));
        mesh.vertex(layout.position(|| words.float(), wrong)?)?;
        words.skip(extra)?;
    }
    // A face has its number of corners and its number of colour values at the least.
    words.announce(polygons, 2, "faces")?;
    for _ in 0..polygons {
        let corners = words.count()?;
        words.announce(corners, 1, "corners of a face")?;
        let corners = (0..corners).map(|_| words.count().map(|v| v as u32)).collect::<Result<Vec<u32>, _>>()?;
        mesh.push(corners)?;
        let colours = words.count()?;
        words.skip(colours)?;
    }
    Ok(mesh)
}

struct Words<'a> {
    name: &'a str,
    left: &'a [u8],
}

impl Words<'_> {
    fn integer(&mut self) -> Result<i32, ImportError> {
        self.four().map(i32::from_be_bytes)
    }

    fn float(&mut self) -> Result<f64, ImportError> {
        self.four().map(|bytes| f64::from(f32::from_be_bytes(bytes)))
    }

    /// A number that is not negative.
    fn count(&mut self) -> Result<usize, ImportError> {
        let number = self.integer()?;
        let wrong = || ImportError(format!("{} has {number} where a count or a vertex is needed", self.name));
        usize::try_from(number).map_err(|_| wrong())
    }

    fn four(&mut self) -> Result<[u8; 4], ImportError> {
        let (bytes, rest) = self.left.split_first_chunk().ok_or_else(|| self.cut_short())?;
        self.left = rest;
        Ok(*bytes)
    }

    fn skip(&mut self, words: usize) -> Result<(), ImportError> {
        let rest = words.checked_mul(4).and_then(|bytes| self.left.get(bytes..));
        self.left = rest.ok_or_else(|| self.cut_short())?;
        Ok(())
    }

    /// Refuses a count of things, `each` words at the least, that the bytes left cannot hold.
    fn announce(&self, count: usize, each: usize, what: &str) -> Result<(), ImportError> {
        if count.saturating_mul(4 * each) <= self.left.len() {
            return Ok(());
        }
        Err(ImportError(format!(
            "{} announces {count} {what}, but has only {} bytes left for them; it is cut short or damaged",
            self.name,
            self.left.len()
        )))
    }

    fn cut_short(&self) -> ImportError {
        ImportError(format!("{} is cut short", self.name))
    }
}

#[cfg(test)]
mod tests {
    use super::super::off;
    use glam::DVec3;

    fn file(header: &str, coordinates: &[f32], counts: [i32; 3], faces: &[i32]) -> Vec<u8> {
        let mut bytes = format!("{header} BINARY\n").into_bytes();
        counts.iter().for_each(|n| bytes.extend(n.to_be_bytes()));
        coordinates.iter().for_each(|x| bytes.extend(x.to_be_bytes()));
        faces.iter().for_each(|n| bytes.extend(n.to_be_bytes()));
        bytes
    }

    #[test]
    fn reads_and_skips() {
        let triangle = [0., 0., 0., 1., 0., 0., 0., 1., 0.];
        // A face with a colour of one number, whatever its bits.
        let whole = file("OFF", &triangle, [3, 1, 0], &[3, 0, 1, 2, 1, -1]);
        let mesh = off::read("a.off", &whole).unwrap();
        assert_eq!((mesh.positions[1], mesh.polygon(0)), (DVec3::X, &[0, 1, 2][..]));
        let rich: Vec<f32> = triangle.chunks(3).flat_map(|p| [p, &[9.; 7]].concat()).collect();
        let rich = off::read("a.off", &file("CNOFF", &rich, [3, 1, 0], &[3, 0, 1, 2, 0])).unwrap();
        assert_eq!(rich.positions, mesh.positions);
        for length in 11..whole.len() {
            assert!(off::read("a.off", &whole[..length]).is_err(), "{length}");
        }
    }

    #[test]
    fn refuses_in_words() {
        for (bytes, part) in [
            (file("OFF", &[], [i32::MAX, 1, 0], &[]), "announces 2147483647 vertices"),
            (file("OFF", &[], [0, i32::MAX, 0], &[]), "announces 2147483647 faces"),
            (file("OFF", &[], [0, 1, 0], &[70, 0, 0]), "announces 70 corners"),
            (file("OFF", &[], [-1, 1, 0], &[]), "has -1 where"),
            (file("OFF", &[f32::NAN; 3], [1, 0, 0], &[]), "at infinity"),
        ] {
            let why = off::read("a.off", &bytes).unwrap_err().0;
            assert!(why.contains(part), "{part}: {why}");
        }
    }
}
