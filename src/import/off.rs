//! Geomview's OFF, as text: `OFF` with any of the prefixes `ST`, `C`, `N`, `4`, `n`, comments, counts on the header's
//! line or the next, or no header at all.
//!
//! The Geometry Center, *Geomview manual*, “OFF files”. Colours, normals and texture coordinates are passed over.
//! `off_binary` reads what follows `OFF BINARY`.

use super::ImportError;
use super::off_binary;
use super::polygons::PolygonMesh;
use super::text::{Lines, shown, words};
use glam::DVec3;

/// What the keyword says that a vertex has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Coordinates: 1 to 3, missing ones are 0.
    pub coordinates: usize,
    /// A fourth one, by which the others are to be divided.
    pub homogeneous: bool,
    /// A normal after them.
    pub normal: bool,
    /// A colour after that.
    pub colour: bool,
    /// Texture coordinates after that.
    pub texture: bool,
}

impl Layout {
    const PLAIN: Self = Self { coordinates: 3, homogeneous: false, normal: false, colour: false, texture: false };

    /// The point that a vertex's first numbers stand for; `next` hands them out.
    pub fn position(
        self,
        mut next: impl FnMut() -> Result<f64, ImportError>,
        wrong: impl Fn(&str) -> ImportError,
    ) -> Result<DVec3, ImportError> {
        let mut position = DVec3::ZERO;
        for k in 0..self.coordinates {
            position[k] = next()?;
        }
        if self.homogeneous {
            position /= next()?;
        }
        if position.is_finite() { Ok(position) } else { Err(wrong("a vertex lies at infinity")) }
    }
}

/// Reads an OFF file.
pub fn read(name: &str, bytes: &[u8]) -> Result<PolygonMesh, ImportError> {
    let mut lines = Lines::new(name, bytes);
    let (mut vertices, mut polygons) = (None, None);
    let mut mesh = PolygonMesh::new(name);
    let mut header = Header { layout: None, dimensions: false };
    while let Some(line) = lines.next_line() {
        let line = line.split(|&b| b == b'#').next().unwrap_or_default();
        let mut words = words(line).peekable();
        let Some(&first) = words.peek() else { continue };
        let mut glued: Option<&[u8]> = None;
        if header.layout.is_none() {
            let (found, rest) = Header::read(&lines, first)?;
            header = found;
            if rest.len() < first.len() {
                words.next();
                glued = Some(rest).filter(|rest| !rest.is_empty());
                if words.peek().is_some_and(|word| word.eq_ignore_ascii_case(b"BINARY")) {
                    let layout = header.layout.unwrap_or(Layout::PLAIN);
                    return off_binary::read(name, lines.rest(), layout, header.dimensions);
                }
            }
        }
        let mut words = glued.into_iter().chain(words).peekable();
        if header.dimensions && words.peek().is_some() {
            header.dimensions = false;
            let number = lines.integer(words.next())?;
            header.layout = Some(with_dimensions(header.layout.unwrap_or(Layout::PLAIN), number, |w| lines.wrong(w))?);
        }
        if words.peek().is_none() {
            continue;
        }
        let layout = header.layout.unwrap_or(Layout::PLAIN);
        match (vertices, polygons) {
            (None, _) => {
                vertices = Some(count(&lines, words.next(), bytes.len())?);
                polygons = Some(count(&lines, words.next(), bytes.len())?);
                if layout.homogeneous && words.count() > 1 {
                    return Err(lines.wrong("a figure of four dimensions has no surface that Sinew could show"));
                }
            }
            (Some(vertices), _) if mesh.positions.len() < vertices => {
                mesh.vertex(layout.position(|| lines.number(words.next()), |what| lines.wrong(what))?)?;
            }
            (_, Some(polygons)) if mesh.len() < polygons => {
                let size = count(&lines, words.next(), line.len())?;
                let corner = |word: Option<&[u8]>| {
                    let number = lines.integer(word)?;
                    u32::try_from(number).map_err(|_| lines.wrong(format!("a face names vertex {number}")))
                };
                let corners = (0..size).map(|_| corner(words.next())).collect::<Result<Vec<u32>, _>>()?;
                mesh.push(corners)?;
            }
            _ => break,
        }
    }
    let (Some(vertices), Some(polygons)) = (vertices, polygons) else {
        return Err(ImportError(format!("{name} has no counts of vertices and faces; it is not a readable OFF file")));
    };
    if mesh.positions.len() < vertices || mesh.len() < polygons {
        return Err(ImportError(format!(
            "{name} announces {vertices} vertices and {polygons} faces, but has only {} and {}; it is cut short",
            mesh.positions.len(),
            mesh.len()
        )));
    }
    Ok(mesh)
}

/// What was read of the keyword and what follows it.
struct Header {
    /// `None` before the first word of the file.
    layout: Option<Layout>,
    /// The number of dimensions is still to come.
    dimensions: bool,
}

impl Header {
    /// Reads the first word of a file; also returns what of it belongs to what follows (all, without a keyword).
    fn read<'w>(lines: &Lines, word: &'w [u8]) -> Result<(Self, &'w [u8]), ImportError> {
        let plain = Self { layout: Some(Layout::PLAIN), dimensions: false };
        let Some(end) = word.windows(3).position(|three| three.eq_ignore_ascii_case(b"OFF")) else {
            return match word.first() {
                Some(first) if first.is_ascii_alphabetic() => {
                    Err(lines.wrong(format!("an OFF file begins with OFF, not with {}", shown(word))))
                }
                _ => Ok((plain, word)),
            };
        };
        let (prefix, rest) = (&word[..end], &word[end + 3..]);
        let unknown = || lines.wrong(format!("{} is a kind of OFF that is not read", shown(word)));
        let mut left = prefix;
        let mut skip = |part: &[u8]| match left.get(..part.len()) {
            Some(start) if start.eq_ignore_ascii_case(part) => {
                left = &left[part.len()..];
                true
            }
            _ => false,
        };
        let (texture, colour) = (skip(b"ST"), skip(b"C"));
        // Only the capital N means normals; a small one before a capital OFF means another number of dimensions.
        let small = word.iter().all(|b| !b.is_ascii_uppercase());
        let normal = (prefix.contains(&b'N') || small) && skip(b"N");
        let (homogeneous, dimensions) = (skip(b"4"), skip(b"n"));
        if !left.is_empty() || homogeneous && dimensions || !rest.iter().all(u8::is_ascii_digit) {
            return Err(unknown());
        }
        let layout = Layout { coordinates: 3, homogeneous, normal, colour, texture };
        Ok((Self { layout: Some(layout), dimensions }, rest))
    }
}

/// The layout with another number of coordinates.
pub fn with_dimensions(
    layout: Layout,
    number: i64,
    wrong: impl Fn(String) -> ImportError,
) -> Result<Layout, ImportError> {
    match usize::try_from(number) {
        Ok(coordinates) if (1..=3).contains(&coordinates) => Ok(Layout { coordinates, ..layout }),
        _ => Err(wrong(format!("its vertices have {number} dimensions; Sinew shows up to three"))),
    }
}

/// A count, refused where the file (or line) of `bytes` bytes cannot hold so many things.
fn count(lines: &Lines, word: Option<&[u8]>, bytes: usize) -> Result<usize, ImportError> {
    let number = lines.integer(word)?;
    usize::try_from(number)
        .ok()
        .filter(|&n| n <= bytes)
        .ok_or_else(|| lines.wrong(format!("a count of {number} does not fit what is there; the file is damaged")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_the_variants() {
        let plain = read("a.off", b"OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").unwrap();
        assert_eq!((plain.positions.len(), plain.polygon(0)), (3, &[0, 1, 2][..]));
        for text in [
            "\u{feff}off 3 1 0\r\n0 0 0\r\n1 0 0\r\n0 1 0\r\n3 0 1 2 0.5 0.5 0.5",
            "# hello\nCOFF\n# there\n3 1 3\n\n0 0 0 255 0 0 255\n1 0 0 0 0 0 255\n0 1 0 1 1 1 1\n3 0 1 2",
            "STCNOFF\n3 1 0\n0 0 0 1 1 1\n1 0 0 # x\n0 1 0\n3 0 1 2\ntrailing words\n",
            "3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2",
            "OFF3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2",
            "NOFF\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2",
            "noff\n3 1 0\n0 0 0 0 0 1\n1 0 0 0 0 1\n0 1 0 0 0 1\n3 0 1 2",
            "STOFF\n3 1 0\n0 0 0 1 1\n1 0 0 1 1\n0 1 0 1 1\n3 0 1 2",
            "4OFF\n3 1 0\n0 0 0 1\n2 0 0 2\n0 .5 0 .5\n3 0 1 2",
            "CN4OFF\n3 1 0\n0 0 0 1 0 0 1\n2 0 0 2 0 0 1\n0 .5 0 .5 0 0 1\n3 0 1 2",
            "nOFF\n2\n3 1 0\n0 0\n1 0\n0 1\n3 0 1 2",
            "nOFF 3 3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2",
            "CnOFF 2\n3 1 0\n0 0 1 1 1 1\n1 0 1 1 1 1\n0 1 1 1 1 1\n3 0 1 2",
        ] {
            assert_eq!(read("a.off", text.as_bytes()).as_ref(), Ok(&plain), "{text}");
        }
    }

    #[test]
    fn refuses_in_words() {
        for (text, part) in [
            ("", "no counts"),
            ("PLY\n1 1 1", "begins with OFF"),
            ("4OFF\n5 10 10 5\n", "four dimensions"),
            ("4OFF\n1 1 1\n1 1 1 0\n", "at infinity"),
            ("4nOFF 3\n1 1 1", "not read"),
            ("HOFF\n1 1 1", "not read"),
            ("OFFLINE\n1 1 1", "not read"),
            ("nOFF 4\n1 1 1", "have 4 dimensions"),
            ("nOFF -4\n1 1 1", "have -4 dimensions"),
            ("OFF\n4000000000 1 0\n", "4000000000"),
            ("OFF\n-3 1 0\n", "-3"),
            ("OFF\n3 1 0\n0 0 0\n", "cut short"),
            ("OFF\n1 1 0\n0 0 0\n900 0 0 0", "900"),
            ("OFF\n1 1 0\n0 0 0\n3 0 -1 0", "names vertex -1"),
            ("OFF\n1 1 0\n0 inf 0\n", "not a finite number"),
        ] {
            let why = read("a.off", text.as_bytes()).unwrap_err().0;
            assert!(why.contains(part), "{text:?}: {why}");
        }
    }
}
