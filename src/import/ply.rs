//! Stanford PLY: text, little- and big-endian; any elements and properties in any order, those that are not needed
//! passed over.

use super::ImportError;
use super::polygons::PolygonMesh;
use super::text::{Lines, shown, words};
use glam::DVec3;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Encoding {
    Text,
    Little,
    Big,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Number {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

/// A property: one number, or a count and so many numbers.
#[derive(Debug)]
struct Property {
    name: String,
    count: Option<Number>,
    number: Number,
}

#[derive(Debug)]
struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
}

/// Reads a PLY file.
pub fn read(name: &str, bytes: &[u8]) -> Result<PolygonMesh, ImportError> {
    let mut lines = Lines::new(name, bytes);
    let (encoding, elements) = header(&mut lines)?;
    let mut body = Body { name, encoding, left: lines.rest() };
    let mut mesh = PolygonMesh::new(name);
    for element in &elements {
        check_count(name, element, encoding, body.left.len())?;
        match element.name.as_str() {
            "vertex" => vertices(&mut body, element, &mut mesh)?,
            "face" => faces(&mut body, element, &mut mesh)?,
            "tristrips" => strips(&mut body, element, &mut mesh)?,
            _ => body.each_row(element, |_, _| Ok(()))?,
        }
    }
    Ok(mesh)
}

fn header(lines: &mut Lines) -> Result<(Encoding, Vec<Element>), ImportError> {
    if lines.next_line().is_none_or(|line| line.trim_ascii() != b"ply") {
        return Err(lines.wrong("a PLY file begins with the line \"ply\""));
    }
    let mut encoding = None;
    let mut elements: Vec<Element> = Vec::new();
    loop {
        let Some(line) = lines.next_line() else {
            return Err(lines.wrong("the header has no end_header; the file is cut short"));
        };
        let row: Vec<&[u8]> = words(line).collect();
        match row.as_slice() {
            [b"format", format, ..] => {
                encoding = Some(match *format {
                    b"ascii" => Encoding::Text,
                    b"binary_little_endian" => Encoding::Little,
                    b"binary_big_endian" => Encoding::Big,
                    other => return Err(lines.wrong(format!("{} is not a PLY format", shown(other)))),
                });
            }
            [b"element", name, count, ..] => {
                let number = lines.integer(Some(count))?;
                let count = u64::try_from(number).map_err(|_| lines.wrong(format!("a count cannot be {number}")))?;
                let name = String::from_utf8_lossy(name).into_owned();
                elements.push(Element { name, count, properties: Vec::new() });
            }
            [b"property", b"list", count, kind, name, ..] => {
                let property = Property {
                    name: String::from_utf8_lossy(name).into_owned(),
                    count: Some(number_kind(lines, count)?),
                    number: number_kind(lines, kind)?,
                };
                add(lines, &mut elements, property)?;
            }
            [b"property", kind, name, ..] => {
                let name = String::from_utf8_lossy(name).into_owned();
                let property = Property { name, count: None, number: number_kind(lines, kind)? };
                add(lines, &mut elements, property)?;
            }
            [b"end_header", ..] => break,
            [b"comment" | b"obj_info", ..] | [] => {}
            [word, ..] => return Err(lines.wrong(format!("{} has no meaning in a PLY header", shown(word)))),
        }
    }
    let encoding = encoding.ok_or_else(|| lines.wrong("the header names no format"))?;
    Ok((encoding, elements))
}

fn add(lines: &Lines, elements: &mut [Element], property: Property) -> Result<(), ImportError> {
    let element = elements.last_mut().ok_or_else(|| lines.wrong("a property comes before any element"))?;
    element.properties.push(property);
    Ok(())
}

fn number_kind(lines: &Lines, word: &[u8]) -> Result<Number, ImportError> {
    Ok(match word {
        b"char" | b"int8" => Number::I8,
        b"uchar" | b"uint8" => Number::U8,
        b"short" | b"int16" => Number::I16,
        b"ushort" | b"uint16" => Number::U16,
        b"int" | b"int32" => Number::I32,
        b"uint" | b"uint32" => Number::U32,
        b"float" | b"float32" => Number::F32,
        b"double" | b"float64" => Number::F64,
        other => return Err(lines.wrong(format!("{} is not a PLY type", shown(other)))),
    })
}

/// Refuses counts that the bytes left cannot hold, before anything is read.
fn check_count(name: &str, element: &Element, encoding: Encoding, left: usize) -> Result<(), ImportError> {
    let smallest = |p: &Property| match encoding {
        // A digit; the last needs no space after it.
        Encoding::Text => 1,
        _ => p.count.unwrap_or(p.number).size() as u64,
    };
    let row: u64 = element.properties.iter().map(smallest).sum();
    if element.count.saturating_mul(row) <= left as u64 {
        return Ok(());
    }
    Err(ImportError(format!(
        "{name} announces {} elements \"{}\", but has only {left} bytes left for them; it is cut short or damaged",
        element.count, element.name
    )))
}

fn vertices(body: &mut Body, element: &Element, mesh: &mut PolygonMesh) -> Result<(), ImportError> {
    let axis = |axis: &str| element.properties.iter().position(|p| p.name == axis && p.count.is_none());
    let (Some(x), Some(y), Some(z)) = (axis("x"), axis("y"), axis("z")) else {
        return Err(ImportError(format!("the vertices of {} have no x, y and z", body.name)));
    };
    body.each_row(element, |row, at| {
        let coordinate =
            |k: usize| row.get(k).and_then(|values: &Vec<f64>| values.first()).copied().unwrap_or(f64::NAN);
        let position = DVec3::new(coordinate(x), coordinate(y), coordinate(z));
        if !position.is_finite() {
            return Err(at.wrong("has a coordinate that is not a finite number"));
        }
        mesh.vertex(position)
    })
}

fn faces(body: &mut Body, element: &Element, mesh: &mut PolygonMesh) -> Result<(), ImportError> {
    let list = |p: &Property| p.count.is_some() && matches!(p.name.as_str(), "vertex_indices" | "vertex_index");
    let Some(indices) = element.properties.iter().position(list) else {
        return Err(ImportError(format!("the faces of {} have no list vertex_indices", body.name)));
    };
    body.each_row(element, |row, at| {
        let vertex = |&value: &f64| {
            let whole = value.fract() == 0.0 && (0.0..f64::from(u32::MAX)).contains(&value);
            if whole { Ok(value as u32) } else { Err(at.wrong(&format!("names vertex {value}"))) }
        };
        let corners = row.get(indices).into_iter().flatten().map(vertex).collect::<Result<Vec<u32>, _>>()?;
        mesh.push(corners)
    })
}

/// Triangle strips, as scanned models have them: one list of vertices, a negative number between two strips.
fn strips(body: &mut Body, element: &Element, mesh: &mut PolygonMesh) -> Result<(), ImportError> {
    let Some(indices) = element.properties.iter().position(|p| p.name == "vertex_indices" && p.count.is_some()) else {
        return Err(ImportError(format!("the triangle strips of {} have no list vertex_indices", body.name)));
    };
    body.each_row(element, |row, at| {
        let values = row.get(indices).map(Vec::as_slice).unwrap_or_default();
        for strip in values.split(|&value| value < 0.0) {
            for (number, corners) in strip.windows(3).enumerate() {
                let [a, b, c] = [corners[0], corners[1], corners[2]];
                // Every other triangle of a strip turns the other way round.
                let turned = if number % 2 == 0 { [a, b, c] } else { [b, a, c] };
                if let Some(value) = turned.iter().find(|v| v.fract() != 0.0 || **v > f64::from(u32::MAX)) {
                    return Err(at.wrong(&format!("names vertex {value}")));
                }
                if a != b && b != c && c != a {
                    mesh.push(turned.map(|v| v as u32))?;
                }
            }
        }
        Ok(())
    })
}

/// The most entries of one list; those of a model that was scanned as one strip are fewer.
const LONGEST_LIST: f64 = (1 << 25) as f64;

/// What follows the header, read from the front.
struct Body<'a> {
    name: &'a str,
    encoding: Encoding,
    left: &'a [u8],
}

/// Where reading is, for sentences.
struct Place<'a> {
    name: &'a str,
    element: &'a str,
    row: u64,
}

impl Place<'_> {
    fn wrong(&self, what: &str) -> ImportError {
        ImportError(format!("{} {} of {} (counted from 1) {what}", self.element, self.row + 1, self.name))
    }
}

impl Body<'_> {
    /// Reads the rows of an element; `take` gets the values of each property, a list's or a single one.
    fn each_row(
        &mut self,
        element: &Element,
        mut take: impl FnMut(&[Vec<f64>], &Place) -> Result<(), ImportError>,
    ) -> Result<(), ImportError> {
        if element.properties.is_empty() {
            return Ok(());
        }
        let mut row: Vec<Vec<f64>> = vec![Vec::new(); element.properties.len()];
        for number in 0..element.count {
            let place = Place { name: self.name, element: &element.name, row: number };
            for (property, values) in element.properties.iter().zip(&mut row) {
                values.clear();
                let length = match property.count {
                    Some(kind) => self.length(kind, property.number, &place)?,
                    None => 1,
                };
                for _ in 0..length {
                    values.push(self.number(property.number, &place)?);
                }
            }
            take(&row, &place)?;
        }
        Ok(())
    }

    /// The length of a list, refused where the bytes left cannot hold it.
    fn length(&mut self, kind: Number, each: Number, place: &Place) -> Result<usize, ImportError> {
        let length = self.number(kind, place)?;
        let each = if self.encoding == Encoding::Text { 1 } else { each.size() };
        let fits = length.fract() == 0.0
            && (0.0..=LONGEST_LIST).contains(&length)
            && length * each as f64 <= self.left.len() as f64;
        if fits { Ok(length as usize) } else { Err(place.wrong(&format!("claims a list of {length} entries"))) }
    }

    fn number(&mut self, kind: Number, place: &Place) -> Result<f64, ImportError> {
        let cut_short = || place.wrong("is not all there; the file is cut short");
        if self.encoding == Encoding::Text {
            self.left = self.left.trim_ascii_start();
            let end = self.left.iter().position(u8::is_ascii_whitespace).unwrap_or(self.left.len());
            let (word, rest) = self.left.split_at(end);
            if word.is_empty() {
                return Err(cut_short());
            }
            self.left = rest;
            let value = std::str::from_utf8(word).ok().and_then(|text| text.parse().ok());
            return value.ok_or_else(|| place.wrong(&format!("has {} where a number is needed", shown(word))));
        }
        let (bytes, rest) = self.left.split_at_checked(kind.size()).ok_or_else(cut_short)?;
        self.left = rest;
        let mut eight = [0; 8];
        for (k, byte) in bytes.iter().enumerate() {
            let at = if self.encoding == Encoding::Big { bytes.len() - 1 - k } else { k };
            eight[at] = *byte;
        }
        Ok(kind.value(eight))
    }
}

impl Number {
    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The number whose bytes, lowest first, are the first of `bytes`.
    fn value(self, bytes: [u8; 8]) -> f64 {
        let [a, b, c, d, ..] = bytes;
        match self {
            Self::I8 => f64::from(a as i8),
            Self::U8 => f64::from(a),
            Self::I16 => f64::from(i16::from_le_bytes([a, b])),
            Self::U16 => f64::from(u16::from_le_bytes([a, b])),
            Self::I32 => f64::from(i32::from_le_bytes([a, b, c, d])),
            Self::U32 => f64::from(u32::from_le_bytes([a, b, c, d])),
            Self::F32 => f64::from(f32::from_le_bytes([a, b, c, d])),
            Self::F64 => f64::from_le_bytes(bytes),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nelement extra 2\r\nproperty list uchar int k\r\n\
        element vertex 4\r\nproperty uchar red\r\nproperty float z\r\nproperty float y\r\nproperty double x\r\n\
        element face 2\r\nproperty list uchar int vertex_indices\r\nproperty float quality\r\nend_header\r\n\
        2 7 8\r\n0\r\n9 0 0 0\r\n9 0 0 1\r\n9 0 1 1\r\n9 0.5 1 0\r\n4 0 1 2 3 0.1\r\n3 0 1 2 0.2\r\n";

    fn binary(big: bool) -> Vec<u8> {
        let format = if big { "binary_big_endian" } else { "binary_little_endian" };
        let mut bytes = format!(
            "ply\nformat {format} 1.0\nelement vertex 4\nproperty double x\nproperty float y\nproperty float z\n\
             element empty 4000000000\nelement face 2\nproperty short flag\nproperty list ushort uint vertex_index\n\
             end_header\n"
        )
        .into_bytes();
        let mut put = |le: &[u8]| {
            if big { bytes.extend(le.iter().rev()) } else { bytes.extend(le) }
        };
        for (x, y, z) in [(0.0_f64, 0.0_f32, 0.0_f32), (1.0, 0.0, 0.0), (1.0, 1.0, 0.0), (0.0, 1.0, 0.5)] {
            put(&x.to_le_bytes());
            put(&y.to_le_bytes());
            put(&z.to_le_bytes());
        }
        for polygon in [&[0_u32, 1, 2, 3][..], &[0, 1, 2]] {
            put(&(-1_i16).to_le_bytes());
            put(&(polygon.len() as u16).to_le_bytes());
            polygon.iter().for_each(|v| put(&v.to_le_bytes()));
        }
        bytes
    }

    #[test]
    fn all_three_encodings_agree() {
        let text = read("a.ply", TEXT.as_bytes()).unwrap();
        assert_eq!(text.positions[3], DVec3::new(0.0, 1.0, 0.5));
        assert_eq!((text.len(), text.polygon(0), text.polygon(1)), (2, &[0, 1, 2, 3][..], &[0, 1, 2][..]));
        assert_eq!(read("a.ply", &binary(false)).as_ref(), Ok(&text));
        assert_eq!(read("a.ply", &binary(true)).as_ref(), Ok(&text));
    }

    #[test]
    fn strips_are_cut_into_triangles() {
        let text = "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\nproperty float z\n\
            element tristrips 1\nproperty list int int vertex_indices\nend_header\n\
            0 0 0\n1 0 0\n0 1 0\n1 1 0\n0 2 0\n9 0 1 2 3 3 -1 2 3 4\n";
        let mesh = read("a.ply", text.as_bytes()).unwrap();
        let all: Vec<_> = (0..mesh.len()).map(|p| mesh.polygon(p).to_vec()).collect();
        assert_eq!(all, [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
    }

    #[test]
    fn refuses_in_words() {
        let little = binary(false);
        for (bytes, part) in [
            (b"".to_vec(), "begins with"),
            (little[..36].to_vec(), "no end_header"),
            (little[..little.len() - 1].to_vec(), "list of 3 entries"),
            (TEXT[..TEXT.len() - 6].into(), "cut short"),
            (TEXT.replace("vertex 4", "vertex 4000000000").into_bytes(), "announces 4000000000"),
            (TEXT.replace("9 0 0 1", "9 0 nan 1").into_bytes(), "vertex 2 of a.ply"),
            (TEXT.replace("3 0 1 2", "3 0 -1 2").into_bytes(), "names vertex -1"),
            (TEXT.replace("3 0 1 2", "900 0 1 2").into_bytes(), "list of 900"),
            (TEXT.replace("property double x", "property double w").into_bytes(), "no x, y and z"),
            (TEXT.replace("vertex_indices", "corners").into_bytes(), "no list vertex_indices"),
            (TEXT.replace("float quality", "quaternion quality").into_bytes(), "not a PLY type"),
            (TEXT.replace("ascii", "klingon").into_bytes(), "not a PLY format"),
        ] {
            let why = read("a.ply", &bytes).unwrap_err().0;
            assert!(why.contains(part), "{part}: {why}");
        }
    }
}
