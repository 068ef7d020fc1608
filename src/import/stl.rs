//! STL, binary and text: triangles without a common list of vertices, so that each corner is a vertex of its own
//! until [welding](crate::mesh::weld). Normals, attributes and colours are passed over.

use super::ImportError;
use super::polygons::PolygonMesh;
use super::text::{Lines, words};
use glam::DVec3;

/// Bytes before the number of triangles of a binary file.
const HEADER: usize = 80;
/// Bytes of a triangle: a normal, three corners, two bytes for whatever.
const TRIANGLE: usize = 50;

/// Reads an STL file.
pub fn read(name: &str, bytes: &[u8]) -> Result<PolygonMesh, ImportError> {
    if is_binary(bytes) { binary(name, bytes) } else { text(name, bytes) }
}

/// Binary files may begin with `solid`, too; their length tells, and that text has no zero bytes.
fn is_binary(bytes: &[u8]) -> bool {
    let announced = announced(bytes).map(|count| count.saturating_mul(TRIANGLE as u64) + HEADER as u64 + 4);
    announced == Some(bytes.len() as u64)
        || !bytes.trim_ascii_start().get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"))
        || bytes.iter().take(1024).any(|&byte| byte == 0)
}

fn announced(bytes: &[u8]) -> Option<u64> {
    let count = bytes.get(HEADER..HEADER + 4)?;
    Some(u64::from(u32::from_le_bytes(count.try_into().ok()?)))
}

fn binary(name: &str, bytes: &[u8]) -> Result<PolygonMesh, ImportError> {
    let Some(count) = announced(bytes) else {
        return Err(ImportError(format!("{name} is no STL file: it is too short for one")));
    };
    let body = &bytes[HEADER + 4..];
    if count.saturating_mul(TRIANGLE as u64) > body.len() as u64 {
        return Err(ImportError(format!(
            "{name} announces {count} triangles, but has only {} bytes for them; it is cut short or no STL file",
            body.len()
        )));
    }
    let mut mesh = PolygonMesh::new(name);
    for (number, triangle) in body.chunks_exact(TRIANGLE).take(count as usize).enumerate() {
        let value = |k: usize| {
            let at = 12 + 4 * k;
            f64::from(f32::from_le_bytes([triangle[at], triangle[at + 1], triangle[at + 2], triangle[at + 3]]))
        };
        for corner in 0..3 {
            let position = DVec3::new(value(3 * corner), value(3 * corner + 1), value(3 * corner + 2));
            if !position.is_finite() {
                return Err(ImportError(format!(
                    "triangle {} of {name} (counted from 1) has a coordinate that is not a finite number",
                    number + 1
                )));
            }
            mesh.vertex(position)?;
        }
        let first = 3 * number as u32;
        mesh.push([first, first + 1, first + 2])?;
    }
    Ok(mesh)
}

fn text(name: &str, bytes: &[u8]) -> Result<PolygonMesh, ImportError> {
    let mut lines = Lines::new(name, bytes);
    let mut mesh = PolygonMesh::new(name);
    let mut begun = 0;
    while let Some(line) = lines.next_line() {
        let mut words = words(line);
        let Some(first) = words.next() else { continue };
        if first.eq_ignore_ascii_case(b"vertex") {
            let mut coordinate = || lines.number(words.next());
            mesh.vertex(DVec3::new(coordinate()?, coordinate()?, coordinate()?))?;
        } else if first.eq_ignore_ascii_case(b"endloop") {
            let end = mesh.positions.len() as u32;
            if end - begun != 3 {
                return Err(lines.wrong(format!("a triangle has {} corners", end - begun)));
            }
            mesh.push(begun..end)?;
            begun = end;
        }
    }
    if mesh.positions.len() as u32 != begun {
        return Err(ImportError(format!("{name} ends within a triangle; it is cut short")));
    }
    Ok(mesh)
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "solid made by hand\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   \
        vertex 0 1e0 0\n  endloop\n endfacet\nendsolid made by hand\n";

    fn binary(header: &[u8], triangles: u32) -> Vec<u8> {
        let mut bytes = header.to_vec();
        bytes.resize(HEADER, b' ');
        bytes.extend(triangles.to_le_bytes());
        for k in [0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 0.] {
            bytes.extend(f32::to_le_bytes(k));
        }
        bytes.extend([7, 7]);
        bytes
    }

    #[test]
    fn text_and_binary_agree() {
        let text = read("a.stl", TEXT.as_bytes()).unwrap();
        assert_eq!((text.len(), text.polygon(0)), (1, &[0, 1, 2][..]));
        assert_eq!(text.positions, [DVec3::ZERO, DVec3::X, DVec3::Y]);
        for header in [&b"exported"[..], b"solid but binary"] {
            let mesh = read("a.stl", &binary(header, 1)).unwrap();
            assert_eq!((mesh.positions, mesh.starts), (text.positions.clone(), text.starts.clone()));
        }
    }

    #[test]
    fn refuses_in_words() {
        for (bytes, part) in [
            (Vec::new(), "too short"),
            (binary(b"x", 2), "announces 2 triangles, but has only 50 bytes"),
            (binary(b"x", u32::MAX), "announces 4294967295"),
            (TEXT.replace("vertex 1 0 0", "vertex 1 0").into_bytes(), "line 5: a number is missing"),
            (TEXT.replace("vertex 1 0 0", "vertex 1 0 nan").into_bytes(), "not a finite number"),
            (TEXT.replace("   vertex 1 0 0\n", "").into_bytes(), "has 2 corners"),
            (TEXT[..90].into(), "within a triangle"),
        ] {
            let why = read("a.stl", &bytes).unwrap_err().0;
            assert!(why.contains(part), "{part}: {why}");
        }
        let mut infinite = binary(b"x", 1);
        infinite[96..100].copy_from_slice(&f32::INFINITY.to_le_bytes());
        assert!(read("a.stl", &infinite).unwrap_err().0.contains("triangle 1 of a.stl"));
    }
}
