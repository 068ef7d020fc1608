//! A closed triangle mesh that can be changed: a corner table with collapse and flip.
//!
//! Half-edge `h = 3 f + i` runs along face `f` from its corner `i` to its next corner; `opposite[h]` is the same
//! edge in the neighbouring face. The mesh is closed, so there is always a neighbour.

use glam::DVec3;

/// Marks what has been removed.
const GONE: u32 = u32::MAX;

/// A closed, orientable triangle mesh.
pub struct Surface {
    /// Positions; those of removed vertices stay.
    pub positions: Vec<DVec3>,
    /// Start of each half-edge; [`GONE`] in removed faces.
    start: Vec<u32>,
    opposite: Vec<u32>,
    /// A half-edge that leaves each vertex.
    leaving: Vec<u32>,
    faces: usize,
}

/// The next half-edge of the same face.
pub fn next(h: u32) -> u32 {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

/// The previous half-edge of the same face.
pub fn previous(h: u32) -> u32 {
    if h.is_multiple_of(3) { h + 2 } else { h - 1 }
}

impl Surface {
    /// From positions and faces; `None` unless every edge is used once in each direction.
    pub fn new(positions: Vec<DVec3>, faces: &[[u32; 3]]) -> Option<Self> {
        let start: Vec<u32> = faces.iter().flatten().copied().collect();
        let mut leaving = vec![GONE; positions.len()];
        let mut edges: Vec<(u64, u32)> = Vec::with_capacity(start.len());
        for h in 0..start.len() as u32 {
            let (a, b) = (start[h as usize], start[next(h) as usize]);
            *leaving.get_mut(a as usize)? = h;
            edges.push(((u64::from(a.min(b)) << 32) | u64::from(a.max(b)), h));
        }
        edges.sort_unstable();
        let mut opposite = vec![GONE; start.len()];
        for pair in edges.chunks(2) {
            let [(ka, a), (kb, b)] = pair else { return None };
            if ka != kb || start[*a as usize] == start[*b as usize] {
                return None;
            }
            opposite[*a as usize] = *b;
            opposite[*b as usize] = *a;
        }
        Some(Self { positions, start, opposite, leaving, faces: faces.len() })
    }

    /// The number of faces that are left.
    pub fn face_count(&self) -> usize {
        self.faces
    }

    /// Half-edges of faces that are left.
    pub fn half_edges(&self) -> impl Iterator<Item = u32> + '_ {
        (0..self.start.len() as u32).filter(|&h| self.exists(h))
    }

    /// Whether the face of a half-edge is left.
    pub fn exists(&self, h: u32) -> bool {
        self.start[h as usize] != GONE
    }

    /// Where a half-edge starts.
    pub fn from(&self, h: u32) -> u32 {
        self.start[h as usize]
    }

    /// Where a half-edge ends.
    pub fn to(&self, h: u32) -> u32 {
        self.start[next(h) as usize]
    }

    /// The same edge in the neighbouring face.
    pub fn opposite(&self, h: u32) -> u32 {
        self.opposite[h as usize]
    }

    /// A half-edge that leaves a vertex; `None` if the vertex was removed.
    pub fn leaving(&self, v: u32) -> Option<u32> {
        Some(self.leaving[v as usize]).filter(|&h| h != GONE)
    }

    /// Half-edges that leave the start of `h`, beginning with `h`.
    pub fn around(&self, h: u32) -> impl Iterator<Item = u32> + '_ {
        let mut current = Some(h);
        std::iter::from_fn(move || {
            let now = current?;
            let then = self.opposite(previous(now));
            current = (then != h).then_some(then);
            Some(now)
        })
    }

    /// The number of edges at the start of `h`.
    pub fn valence(&self, h: u32) -> usize {
        self.around(h).count()
    }

    /// The point of a vertex.
    pub fn at(&self, v: u32) -> DVec3 {
        self.positions[v as usize]
    }

    /// Normal of the face of `h`, of twice its area's length.
    pub fn normal(&self, h: u32) -> DVec3 {
        let [a, b, c] = [h, next(h), previous(h)].map(|h| self.at(self.from(h)));
        (b - a).cross(c - a)
    }

    /// Whether moving the end of `h` into its start keeps the mesh a manifold without folding it. Faces may turn by
    /// an angle with the cosine `straight`, and their height over their longest side be as low as `height`.
    pub fn can_collapse(&self, h: u32, straight: f64, height: f64) -> bool {
        let o = self.opposite(h);
        let (keep, gone) = (self.from(h), self.to(h));
        if self.valence(previous(h)) <= 3 || self.valence(previous(o)) <= 3 {
            return false;
        }
        // Link condition: the two ends have exactly two neighbours in common.
        let mut neighbours = [0u32; 24];
        let mut count = 0;
        for edge in self.around(h) {
            if count == neighbours.len() {
                return false;
            }
            neighbours[count] = self.to(edge);
            count += 1;
        }
        let common = self.around(o).filter(|&edge| neighbours[..count].contains(&self.to(edge))).count();
        if common != 2 || count + self.valence(o) > 14 {
            return false;
        }
        let to = self.at(keep);
        self.around(o).all(|edge| {
            let (b, c) = (self.to(edge), self.from(previous(edge)));
            if b == keep || c == keep {
                return true;
            }
            let (pb, pc) = (self.at(b), self.at(c));
            let (before, after) = (self.normal(edge), (pb - to).cross(pc - to));
            let longest = (pb - to).length_squared().max((pc - to).length_squared()).max((pc - pb).length_squared());
            let turns_little = before.dot(after) > straight * before.length() * after.length();
            debug_assert!(self.from(edge) == gone);
            turns_little && after.length() > height * longest
        })
    }

    /// Moves the end of `h` into its start.
    pub fn collapse(&mut self, h: u32) {
        let o = self.opposite(h);
        let (keep, gone) = (self.from(h), self.to(h));
        let spokes: Vec<u32> = self.around(o).collect();
        for edge in spokes {
            self.start[edge as usize] = keep;
        }
        for side in [h, o] {
            let (a, b) = (self.opposite(next(side)), self.opposite(previous(side)));
            let apex = self.from(previous(side));
            self.opposite[a as usize] = b;
            self.opposite[b as usize] = a;
            // `a` starts at the apex; `b` ends there and starts at the vertex that stays.
            self.leaving[apex as usize] = a;
            self.leaving[keep as usize] = b;
            for corner in [side, next(side), previous(side)] {
                self.start[corner as usize] = GONE;
            }
        }
        self.leaving[gone as usize] = GONE;
        self.faces -= 2;
    }

    /// Turns the edge `h` into the other diagonal of its two faces if that makes their smallest angle larger and
    /// keeps the mesh a manifold without folding it. Says whether it did.
    pub fn flip_if_better(&mut self, h: u32) -> bool {
        let o = self.opposite(h);
        let (a, b) = (self.from(h), self.to(h));
        let (c, d) = (self.from(previous(h)), self.from(previous(o)));
        let [pa, pb, pc, pd] = [a, b, c, d].map(|v| self.at(v));
        let now = smallest_angle(pa, pb, pc).min(smallest_angle(pb, pa, pd));
        let then = smallest_angle(pc, pd, pb).min(smallest_angle(pd, pc, pa));
        if then <= now + 1e-9 || self.valence(h) <= 3 || self.valence(o) <= 3 {
            return false;
        }
        let [n0, n1] = [self.normal(h), self.normal(o)];
        let [m0, m1] = [(pd - pc).cross(pb - pc), (pc - pd).cross(pa - pd)];
        let mean = (n0 + n1).normalize_or_zero();
        let flat = |n: DVec3, least: f64| n.dot(mean) > least * n.length();
        if !(flat(n0, 0.85) && flat(n1, 0.85) && flat(m0, 0.85) && flat(m1, 0.85)) {
            return false;
        }
        if self.around(previous(h)).any(|edge| self.to(edge) == d) {
            return false;
        }
        // Face of h: a b c, of o: b a d. They become c d b (h = c→d) and d c a (o = d→c).
        let (bc, ca, ad, db) = (next(h), previous(h), next(o), previous(o));
        let outer = [bc, ca, ad, db].map(|edge| self.opposite(edge));
        let place = |s: &mut Self, edge: u32, from: u32, across: u32| {
            s.start[edge as usize] = from;
            s.opposite[edge as usize] = across;
            s.opposite[across as usize] = edge;
            s.leaving[from as usize] = edge;
        };
        self.start[h as usize] = c;
        self.start[o as usize] = d;
        place(self, bc, d, outer[3]);
        place(self, ca, b, outer[0]);
        place(self, ad, c, outer[1]);
        place(self, db, a, outer[2]);
        true
    }

    /// Numbers of the pieces of the surface by vertex (removed vertices: [`u32::MAX`]), and the sizes of the pieces.
    fn pieces(&self) -> (Vec<u32>, Vec<usize>) {
        let mut piece = vec![GONE; self.positions.len()];
        let mut sizes = Vec::new();
        for seed in 0..piece.len() as u32 {
            if piece[seed as usize] != GONE || self.leaving(seed).is_none() {
                continue;
            }
            let number = sizes.len() as u32;
            piece[seed as usize] = number;
            let (mut stack, mut size) = (vec![seed], 0);
            while let Some(v) = stack.pop() {
                size += 1;
                for edge in self.leaving(v).into_iter().flat_map(|h| self.around(h)) {
                    let to = self.to(edge);
                    if piece[to as usize] == GONE {
                        piece[to as usize] = number;
                        stack.push(to);
                    }
                }
            }
            sizes.push(size);
        }
        (piece, sizes)
    }

    /// Removes everything but the piece with the most vertices.
    pub fn keep_largest(&mut self) {
        let (piece, sizes) = self.pieces();
        let Some(largest) = (0..sizes.len()).max_by_key(|&i| sizes[i]) else { return };
        for h in 0..self.start.len() {
            if self.exists(h as u32) && piece[self.start[h] as usize] != largest as u32 {
                self.start[h] = GONE;
                self.faces -= usize::from(h.is_multiple_of(3));
            }
        }
        for (leaving, &piece) in self.leaving.iter_mut().zip(&piece) {
            if piece != largest as u32 {
                *leaving = GONE;
            }
        }
    }

    /// What is left, renumbered: positions and faces.
    pub fn into_mesh(self) -> (Vec<DVec3>, Vec<[u32; 3]>) {
        let mut number = vec![GONE; self.positions.len()];
        let mut positions = Vec::new();
        let mut faces = Vec::with_capacity(self.faces);
        for corners in self.start.chunks_exact(3).filter(|c| c[0] != GONE) {
            faces.push([corners[0], corners[1], corners[2]].map(|v| {
                if number[v as usize] == GONE {
                    number[v as usize] = positions.len() as u32;
                    positions.push(self.positions[v as usize]);
                }
                number[v as usize]
            }));
        }
        (positions, faces)
    }
}

/// Sine of a triangle's smallest angle, about: twice its area over the product of its two longest sides.
fn smallest_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    let area = (b - a).cross(c - a).length();
    let mut sides = [(b - a).length(), (c - b).length(), (a - c).length()];
    sides.sort_by(f64::total_cmp);
    area / (sides[1] * sides[2]).max(1e-300)
}
