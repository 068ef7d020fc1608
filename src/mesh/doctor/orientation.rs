//! Which faces look the same way: faces joined across edges of two faces, each with the parity of its winding.

use super::chart::Side;

/// How the faces of a mesh are wound against each other.
#[derive(Clone, Debug, Default)]
pub struct Orientation {
    /// #F: the lowest face of the sheet, the faces that hang together by edges of two faces.
    pub sheet: Vec<u32>,
    /// #F: whether most of its sheet is wound the other way round.
    pub turned: Vec<bool>,
    /// #F: whether, for the face that numbers its sheet, no way of winding agrees everywhere.
    pub one_sided: Vec<bool>,
}

impl Orientation {
    /// `sides` are those of `count` faces, edge by edge.
    pub fn new(count: usize, sides: &[Side]) -> Self {
        let mut sheets = Sheets { parent: (0..count as u32).collect(), against: vec![false; count] };
        let mut one_sided = vec![false; count];
        for edge in sides.chunk_by(|a, b| a.edge == b.edge) {
            let &[a, b] = edge else { continue };
            // Two faces that agree run along their edge in opposite directions.
            let against = a.forward() == b.forward();
            let ((p, to_p), (q, to_q)) = (sheets.root(a.face()), sheets.root(b.face()));
            if p == q {
                one_sided[p as usize] |= (to_p != to_q) != against;
            } else {
                let (low, high) = (p.min(q), p.max(q));
                sheets.parent[high as usize] = low;
                sheets.against[high as usize] = (to_p != to_q) != against;
                one_sided[low as usize] |= one_sided[high as usize];
            }
        }
        let placed: Vec<(u32, bool)> = (0..count as u32).map(|f| sheets.root(f)).collect();
        let mut balance = vec![0i64; count];
        placed.iter().for_each(|&(root, against)| balance[root as usize] += if against { 1 } else { -1 });
        let minority = |&(root, against): &(u32, bool)| against != (balance[root as usize] > 0);
        Self {
            turned: placed.iter().map(|place| minority(place) && !one_sided[place.0 as usize]).collect(),
            sheet: placed.iter().map(|place| place.0).collect(),
            one_sided,
        }
    }
}

/// Disjoint sets of faces; each face knows whether it is wound against the one above it.
struct Sheets {
    parent: Vec<u32>,
    against: Vec<bool>,
}

impl Sheets {
    /// The lowest face of the sheet, and whether a face is wound against it. Shortens the way there.
    fn root(&mut self, face: u32) -> (u32, bool) {
        let (mut root, mut against) = (face, false);
        while self.parent[root as usize] != root {
            against ^= self.against[root as usize];
            root = self.parent[root as usize];
        }
        let (mut at, mut left) = (face, against);
        while self.parent[at as usize] != root && at != root {
            let (next, step) = (self.parent[at as usize], self.against[at as usize]);
            self.parent[at as usize] = root;
            self.against[at as usize] = left;
            left ^= step;
            at = next;
        }
        (root, against)
    }
}
