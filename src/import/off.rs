//! Geomview's OFF: `OFF` with any of the prefixes `ST`, `C`, `N` (their values are passed over), comments, counts
//! on the header's line or the next. The binary, four-dimensional and n-dimensional variants are refused.

use super::ImportError;
use super::polygons::PolygonMesh;
use super::text::{Lines, shown, words};
use glam::DVec3;

/// Reads an OFF file.
pub fn read(name: &str, bytes: &[u8]) -> Result<PolygonMesh, ImportError> {
    let mut lines = Lines::new(name, bytes);
    let (mut vertices, mut polygons) = (None, None);
    let mut mesh = PolygonMesh::default();
    let mut header_seen = false;
    while let Some(line) = lines.next_line() {
        let line = line.split(|&b| b == b'#').next().unwrap_or_default();
        let mut words = words(line).peekable();
        let Some(&first) = words.peek() else { continue };
        if !header_seen {
            header_seen = true;
            if first.first().is_some_and(u8::is_ascii_alphabetic) {
                check_header(&lines, first)?;
                words.next();
                match words.peek() {
                    Some(word) if word.eq_ignore_ascii_case(b"BINARY") => {
                        return Err(lines.wrong("binary OFF is not read; save it as text, or as PLY"));
                    }
                    Some(_) => {}
                    None => continue,
                }
            }
        }
        match (vertices, polygons) {
            (None, _) => {
                vertices = Some(count(&lines, words.next(), bytes.len())?);
                polygons = Some(count(&lines, words.next(), bytes.len())?);
            }
            (Some(vertices), _) if mesh.positions.len() < vertices => {
                let mut coordinate = || lines.number(words.next());
                mesh.positions.push(DVec3::new(coordinate()?, coordinate()?, coordinate()?));
            }
            (_, Some(polygons)) if mesh.len() < polygons => {
                let size = count(&lines, words.next(), line.len())?;
                let corner = |word: Option<&[u8]>| {
                    let number = lines.integer(word)?;
                    u32::try_from(number).map_err(|_| lines.wrong(format!("a face names vertex {number}")))
                };
                let corners = (0..size).map(|_| corner(words.next())).collect::<Result<Vec<u32>, _>>()?;
                mesh.push(corners);
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

fn check_header(lines: &Lines, word: &[u8]) -> Result<(), ImportError> {
    // Only the capital N means normals; a small one means another number of dimensions.
    if word.starts_with(b"n") {
        return Err(lines.wrong(format!("{} is a kind of OFF that is not read", shown(word))));
    }
    let upper = word.to_ascii_uppercase();
    let prefix = upper
        .strip_suffix(b"OFF")
        .ok_or_else(|| lines.wrong(format!("an OFF file begins with OFF, not with {}", shown(word))))?;
    let prefix = prefix.strip_prefix(b"ST").unwrap_or(prefix);
    let prefix = prefix.strip_prefix(b"C").unwrap_or(prefix);
    let prefix = prefix.strip_prefix(b"N").unwrap_or(prefix);
    if prefix.is_empty() {
        Ok(())
    } else {
        Err(lines.wrong(format!("{} is a kind of OFF that is not read", shown(word))))
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
        ] {
            assert_eq!(read("a.off", text.as_bytes()).as_ref(), Ok(&plain), "{text}");
        }
    }

    #[test]
    fn refuses_in_words() {
        for (text, part) in [
            ("", "no counts"),
            ("PLY\n1 1 1", "begins with OFF"),
            ("4OFF\n1 1 1", "not a whole number"),
            ("4nOFF\n1 1 1", "not a whole number"),
            ("HOFF\n1 1 1", "not read"),
            ("nOFF 4\n1 1 1", "not read"),
            ("OFF BINARY\n", "binary OFF"),
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
