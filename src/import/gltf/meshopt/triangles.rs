//! Mode 1: a list of triangles, most of them in one byte, by the edges and vertices that came shortly before.

use super::varint::{read, unfolded};
use super::{Broken, CUT_SHORT, TOO_LONG};

const HEADER: u8 = 0xe1;
/// Entries of the table at the end.
const TABLE: usize = 16;

const UNWRITTEN: Broken = "refers to an edge or vertex before the first";

/// Decodes `count` indices, three a triangle.
pub fn decode(data: &[u8], count: usize) -> Result<Vec<u32>, Broken> {
    let Some((&HEADER, body)) = data.split_first() else { return Err("does not begin as coded triangles do") };
    if !count.is_multiple_of(3) {
        return Err("claims a number of indices that is not a multiple of three");
    }
    let triangles = count / 3;
    let end = body.len().checked_sub(TABLE).filter(|&end| end >= triangles).ok_or(CUT_SHORT)?;
    let (codes, data) = body[..end].split_at(triangles);
    let table = &body[end..];
    if table[14..] != [0, 0] || table.iter().any(|b| b >> 4 == 0xf || b & 0xf == 0xf) {
        return Err("ends in a table that is not valid");
    }
    let mut state = State { data, next: 0, last: 0, edges: Recent::default(), vertices: Recent::default() };
    let mut indices = Vec::with_capacity(count);
    for &code in codes {
        indices.extend(state.triangle(code, table)?);
    }
    if state.data.is_empty() { Ok(indices) } else { Err(TOO_LONG) }
}

struct State<'a> {
    data: &'a [u8],
    /// The vertex that is new next.
    next: u32,
    /// The vertex that was written out last.
    last: u32,
    edges: Recent<(u32, u32)>,
    vertices: Recent<u32>,
}

impl State<'_> {
    fn triangle(&mut self, code: u8, table: &[u8]) -> Result<[u32; 3], Broken> {
        let (high, low) = (code >> 4, code & 0xf);
        if high < 0xf {
            let (a, b) = self.edges.back(high)?;
            let c = self.third(low)?;
            self.edges.push((c, b));
            self.edges.push((a, c));
            return Ok([a, b, c]);
        }
        let spelled = low >= 0xe;
        let pair = if spelled { self.byte()? } else { table[usize::from(low)] };
        if spelled && pair == 0 {
            self.next = 0;
        }
        let a = if low == 0xf { self.spelled()? } else { self.new_vertex() };
        let b = self.corner(pair >> 4)?;
        let c = self.corner(pair & 0xf)?;
        self.edges.push((b, a));
        self.edges.push((c, b));
        self.edges.push((a, c));
        self.vertices.push(a);
        for (part, vertex) in [(pair >> 4, b), (pair & 0xf, c)] {
            if part == 0 || part == 0xf {
                self.vertices.push(vertex);
            }
        }
        Ok([a, b, c])
    }

    /// The vertex across a known edge.
    fn third(&mut self, code: u8) -> Result<u32, Broken> {
        let vertex = match code {
            0 => self.new_vertex(),
            1..=0xc => return self.vertices.back(code),
            0xd => self.step(u32::MAX),
            0xe => self.step(1),
            _ => self.spelled()?,
        };
        self.vertices.push(vertex);
        Ok(vertex)
    }

    /// The second or third vertex of a triangle that shares no known edge.
    fn corner(&mut self, code: u8) -> Result<u32, Broken> {
        match code {
            0 => Ok(self.new_vertex()),
            0xf => self.spelled(),
            _ => self.vertices.back(code - 1),
        }
    }

    fn new_vertex(&mut self) -> u32 {
        let vertex = self.next;
        self.next = self.next.wrapping_add(1);
        vertex
    }

    fn step(&mut self, by: u32) -> u32 {
        self.last = self.last.wrapping_add(by);
        self.last
    }

    fn spelled(&mut self) -> Result<u32, Broken> {
        let by = unfolded(read(&mut self.data)?);
        Ok(self.step(by))
    }

    fn byte(&mut self) -> Result<u8, Broken> {
        let (&byte, rest) = self.data.split_first().ok_or(CUT_SHORT)?;
        self.data = rest;
        Ok(byte)
    }
}

/// The sixteen entries that were pushed last.
#[derive(Default)]
struct Recent<T> {
    entries: [Option<T>; 16],
    pushed: usize,
}

impl<T: Copy> Recent<T> {
    fn push(&mut self, entry: T) {
        self.entries[self.pushed % 16] = Some(entry);
        self.pushed = (self.pushed + 1) % 16;
    }

    /// The entry pushed `age` entries before the last one; `age` is below 16.
    fn back(&self, age: u8) -> Result<T, Broken> {
        self.entries[(self.pushed + 31 - usize::from(age)) % 16].ok_or(UNWRITTEN)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A table whose first entry stands for three new vertices.
    fn coded(codes: &[u8], data: &[u8]) -> Vec<u8> {
        [&[HEADER], codes, data, &[0; 16]].concat()
    }

    #[test]
    fn one_case_of_each_kind() {
        // New triangle 0 1 2; across (0, 2) a new vertex; across (0, 3) vertex 1 again.
        assert_eq!(decode(&coded(&[0xf0, 0x00, 0x03], &[]), 9), Ok(vec![0, 1, 2, 0, 2, 3, 0, 3, 0]));
        // Three spelled: +7, then +1, then −1.
        assert_eq!(decode(&coded(&[0xff], &[0xff, 14, 2, 1]), 3), Ok(vec![7, 8, 7]));
        // 0xfe with a zero byte begins to count anew.
        assert_eq!(decode(&coded(&[0xf0, 0xfe], &[0]), 6), Ok(vec![0, 1, 2, 0, 1, 2]));
    }

    #[test]
    fn refuses_what_is_not_there() {
        assert_eq!(decode(&coded(&[0x00], &[]), 3), Err(UNWRITTEN));
        assert_eq!(decode(&coded(&[0xf0], &[0]), 3), Err(TOO_LONG));
        assert!(decode(&coded(&[0xff], &[0xff, 14, 2]), 3).is_err());
        assert!(decode(&coded(&[0xf0], &[]), 4).is_err());
        assert!(decode(&[HEADER], 3).is_err());
        assert!(decode(&[], 0).is_err());
    }
}
