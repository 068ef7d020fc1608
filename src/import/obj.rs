//! Wavefront OBJ: vertices and polygons; materials, texture coordinates and normals where the look is asked for. Groups,
//! vertex colours, lines and points are passed over.

mod look;
mod mtl;

pub use look::{Said, needed};

use super::ImportError;
use super::polygons::PolygonMesh;
use super::text::{Lines, words};
use glam::DVec3;

/// Reads an OBJ file; what it says of its look is told to `said`.
pub fn read(name: &str, bytes: &[u8], mut said: Option<&mut Said>) -> Result<PolygonMesh, ImportError> {
    let mut lines = Lines::new(name, bytes);
    let mut mesh = PolygonMesh::new(name);
    let mut joined = Vec::new();
    while let Some(line) = lines.next_line() {
        // A line that ends in a backslash goes on in the next.
        if let Some(begun) = line.strip_suffix(b"\\") {
            joined.extend_from_slice(begun);
            joined.push(b' ');
            continue;
        }
        if joined.is_empty() {
            statement(&lines, line, &mut mesh, &mut said)?;
        } else {
            joined.extend_from_slice(line);
            statement(&lines, &std::mem::take(&mut joined), &mut mesh, &mut said)?;
        }
    }
    statement(&lines, &joined, &mut mesh, &mut said)?;
    Ok(mesh)
}

fn statement(
    lines: &Lines,
    line: &[u8],
    mesh: &mut PolygonMesh,
    said: &mut Option<&mut Said>,
) -> Result<(), ImportError> {
    let whole = line.trim_ascii();
    let line = line.split(|&b| b == b'#').next().unwrap_or_default();
    if let Some(said) = said {
        // Names may have a # in them.
        said.hear(if whole.starts_with(b"usemtl") || whole.starts_with(b"mtllib") { whole } else { line });
    }
    let mut words = words(line);
    match words.next() {
        Some(b"v") => {
            let mut coordinate = || lines.number(words.next());
            mesh.vertex(DVec3::new(coordinate()?, coordinate()?, coordinate()?))?;
        }
        Some(b"f" | b"fo") => {
            let corners = words.map(|word| corner(lines, word, mesh.positions.len()));
            let corners = corners.collect::<Result<Vec<u32>, _>>()?;
            mesh.push(corners)?;
        }
        _ => {}
    }
    Ok(())
}

/// The vertex of a corner `v`, `v/vt`, `v//vn` or `v/vt/vn`, counted from 1, or from the last vertex where negative.
fn corner(lines: &Lines, word: &[u8], vertices: usize) -> Result<u32, ImportError> {
    let number = lines.integer(word.split(|&b| b == b'/').next())?;
    let index = if number < 0 { number.saturating_add(vertices as i64) } else { number - 1 };
    u32::try_from(index).map_err(|_| {
        lines.wrong(format!(
            "a face names vertex {number}, but vertices are counted from 1 and {vertices} came before it"
        ))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reads_what_exporters_write() {
        let text = b"\xef\xbb\xbf# a comment\r\nmtllib x.mtl\r\no thing\r\nv 0 0 0 1 0 0\r\nv 1 0 0 # here\r\n\
            v 1 1 0 1.0\r\nvt 0 0\r\nv 0 1 0\r\ng side\r\nusemtl m\r\ns off\r\nf 1/1/1 2//1 \\\r\n 3/1 4\r\nf -4 -3 -2\r\nl 1 2\r\n";
        let mesh = read("a.obj", text, None).unwrap();
        assert_eq!(mesh.positions.len(), 4);
        assert_eq!(mesh.positions[2], DVec3::new(1.0, 1.0, 0.0));
        assert_eq!(mesh.len(), 2);
        assert_eq!((mesh.polygon(0), mesh.polygon(1)), (&[0, 1, 2, 3][..], &[0, 1, 2][..]));
    }

    #[test]
    fn says_where_it_is_wrong() {
        for (text, part) in [
            ("v 0 0 0\nv 1 NaN 0", "line 2: \"NaN\" is not a finite number"),
            ("v 0 0", "line 1: a number is missing"),
            ("v a b c", "\"a\" is not a number"),
            ("v 0 0 0\nf 1 x 2", "line 2: \"x\" is not a whole number"),
            ("v 0 0 0\nf 0 1 2", "vertex 0"),
            ("v 0 0 0\nf 1 -5 1", "vertex -5"),
            ("f 99999999999 1 2", "vertex 99999999999"),
        ] {
            let why = read("a.obj", text.as_bytes(), None).unwrap_err().0;
            assert!(why.starts_with("a.obj, line") && why.contains(part), "{why}");
        }
    }
}
