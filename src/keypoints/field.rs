//! Bounded biharmonic fields on a coarse mesh, one at a time and from a good start: what selection asks for by the
//! thousand.
//!
//! The same problem as [`crate::weights`] solves with care: least `wᵀ L M⁻¹ L w`, 1 at one vertex, 0 at others, nowhere
//! negative. Here an active set is guessed (the vertices that the last, similar problem had at 0), solved, and mended a
//! few times; vertices are numbered so that the factor is a narrow band.
//!
//! Elizabeth Cuthill, James McKee. Reducing the bandwidth of sparse symmetric matrices. ACM '69. Active sets: Michael
//! Hintermüller, Kazufumi Ito, Karl Kunisch. The primal-dual active set strategy as a semismooth Newton method. SIAM
//! Journal on Optimization 13(3), 2002.

use crate::linalg::envelope::Envelope;
use crate::mesh::laplacian::Laplacian;
use serde::{Deserialize, Serialize};

/// Rounds of mending, for a field and for an estimate of one; vertices are set free only in the first half of them, so that
/// no cycle lasts.
const ROUNDS: usize = 8;
const ROUNDS_OF_ESTIMATE: usize = 3;

/// Vertices are held if they are below minus this, and let go if they alone would rise by this share of it.
const SLACK: f64 = 1e-3;
const RISE: f64 = 0.1;

/// A vertex with less area than this share of the mean is taken to have as much.
const LEAST_AREA: f64 = 1e-4;

/// Fields below this count as 0.
pub const NOTHING: f64 = 1e-6;

/// The energy of a mesh.
pub struct Energy {
    start: Vec<u32>,
    column: Vec<u32>,
    value: Vec<f64>,
    diagonal: Vec<f64>,
    /// #V piece numbers.
    piece: Vec<u32>,
}

/// A field and the vertices at which it is held at 0 by its bound.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
pub struct Field {
    /// #V values, not negative.
    pub value: Vec<f64>,
    held: Vec<bool>,
}

impl Field {
    /// The field plus `share` of another, kept between 0 and 1: what becomes of it, but for the bounds, when a point is
    /// added or taken away.
    pub fn plus(&self, share: f64, other: &Self) -> Self {
        let sum = self.value.iter().zip(&other.value).map(|(a, b)| (a + share * b).clamp(0.0, 1.0));
        let value: Vec<f64> = sum.map(|x| if x > NOTHING { x } else { 0.0 }).collect();
        let held = value.iter().map(|x| *x == 0.0).collect();
        Self { value, held }
    }

    /// Whether it is another one somewhere, by more than that.
    pub fn differs(&self, other: &Self, by: f64) -> bool {
        self.value.iter().zip(&other.value).any(|(a, b)| (a - b).abs() > by)
    }

    /// The field multiplied so as to be 1 at `one`.
    pub fn times(mut self, factor: f64, one: u32) -> Self {
        self.value.iter_mut().for_each(|x| *x = (*x * factor).min(1.0));
        self.value[one as usize] = 1.0;
        self
    }

    /// The field where another is 1 at `v`, and this one 0.
    pub fn lowered(&self, v: u32, other: &Self) -> Self {
        self.plus(-self.value[v as usize], other)
    }
}

/// Room to work in with one energy.
#[derive(Default)]
pub struct Scratch {
    place: Vec<u32>,
    free: Vec<u32>,
    /// What was free the last time.
    before: Vec<u32>,
    first: Vec<usize>,
    matrix: Envelope,
    x: Vec<f64>,
}

impl Energy {
    /// `L M⁻¹ L` of a mesh whose vertices are in a banded order ([`banded_order`]); `piece` is #V piece numbers.
    pub fn new(laplacian: &Laplacian, piece: Vec<u32>) -> Self {
        let n = laplacian.mass.len();
        let mut rows: Vec<Vec<(u32, f64)>> = (0..n).map(|v| vec![(v as u32, 0.0)]).collect();
        for (&[a, b], &c) in laplacian.edges.iter().zip(&laplacian.cotangents) {
            let (i, j) = (a as usize, b as usize);
            rows[i].push((b, -c));
            rows[j].push((a, -c));
            rows[i][0].1 += c;
            rows[j][0].1 += c;
        }
        let mean = laplacian.mass.iter().sum::<f64>() / n.max(1) as f64;
        let inverse: Vec<f64> =
            laplacian.mass.iter().map(|m| 1.0 / m.max(LEAST_AREA * mean).max(f64::MIN_POSITIVE)).collect();
        let mut energy = Self { start: vec![0], column: Vec::new(), value: Vec::new(), diagonal: vec![0.0; n], piece };
        let mut sum = vec![0.0; n];
        for v in 0..n {
            let mut touched = Vec::new();
            for &(middle, a) in &rows[v] {
                for &(w, b) in &rows[middle as usize] {
                    touched.push(w);
                    sum[w as usize] += a * inverse[middle as usize] * b;
                }
            }
            touched.sort_unstable();
            touched.dedup();
            for w in touched {
                energy.column.push(w);
                energy.value.push(sum[w as usize]);
                sum[w as usize] = 0.0;
            }
            energy.start.push(energy.column.len() as u32);
        }
        for v in 0..n {
            let diagonal = energy.row(v).find(|e| e.0 as usize == v).map_or(0.0, |e| e.1);
            energy.diagonal[v] = diagonal;
        }
        energy
    }

    fn row(&self, v: usize) -> impl Iterator<Item = (u32, f64)> + '_ {
        let range = self.start[v] as usize..self.start[v + 1] as usize;
        self.column[range.clone()].iter().copied().zip(self.value[range].iter().copied())
    }

    /// The number of vertices.
    pub fn len(&self) -> usize {
        self.diagonal.len()
    }

    /// The piece of a vertex.
    pub fn piece(&self, v: u32) -> u32 {
        self.piece[v as usize]
    }

    /// How much of `bump`, a field that is 1 at `v`, is to be added to a field that is 0 there when nothing fixes it at
    /// `v` any more: the force at `v` is gone then. 0 where it would sink, 1 at most.
    pub fn share(&self, field: &Field, v: u32, bump: &Field) -> f64 {
        let share = -self.force(&field.value, v as usize) / self.force(&bump.value, v as usize);
        if share.is_finite() { share.clamp(0.0, 1.0) } else { 0.0 }
    }

    fn force(&self, value: &[f64], v: usize) -> f64 {
        self.row(v).map(|(w, q)| q * value[w as usize]).sum()
    }

    /// The field that is 1 at `one` and 0 at `zeros` and on other pieces; `before` is a similar one to start from.
    pub fn field(&self, one: u32, zeros: &[u32], before: Option<&Field>, scratch: &mut Scratch) -> Field {
        self.mended(one, zeros, before, ROUNDS, scratch)
    }

    /// An estimate of the same field, in less time.
    pub fn estimate(&self, one: u32, zeros: &[u32], scratch: &mut Scratch) -> Field {
        self.mended(one, zeros, None, ROUNDS_OF_ESTIMATE, scratch)
    }

    fn mended(&self, one: u32, zeros: &[u32], before: Option<&Field>, rounds: usize, scratch: &mut Scratch) -> Field {
        let n = self.len();
        let mut field = match before {
            Some(before) => before.clone(),
            None => Field { value: vec![0.0; n], held: vec![false; n] },
        };
        // Fixed vertices are neither free nor held.
        scratch.place.clear();
        scratch.place.resize(n, FREE);
        let own = self.piece(one);
        for v in 0..n {
            if self.piece[v] != own {
                scratch.place[v] = FIXED;
                field.value[v] = 0.0;
            }
        }
        for &z in zeros {
            scratch.place[z as usize] = FIXED;
            field.value[z as usize] = 0.0;
        }
        scratch.place[one as usize] = FIXED;
        field.value[one as usize] = 1.0;
        for round in 0..rounds {
            self.solve(&mut field, scratch);
            let changed = self.mend(&mut field, scratch, 2 * round < rounds);
            if !changed {
                break;
            }
        }
        field.value.iter_mut().for_each(|x| *x = if *x > NOTHING { x.min(1.0) } else { 0.0 });
        field
    }

    /// Holds what is negative, lets go what is drawn upwards; whether anything changed.
    fn mend(&self, field: &mut Field, scratch: &Scratch, free: bool) -> bool {
        let mut changed = false;
        for v in 0..self.len() {
            if scratch.place[v] == FIXED {
                continue;
            }
            if field.held[v] {
                if free && self.force(&field.value, v) < -RISE * SLACK * self.diagonal[v] {
                    field.held[v] = false;
                    changed = true;
                }
            } else if field.value[v] < -SLACK {
                field.held[v] = true;
                changed = true;
            }
        }
        changed
    }

    /// The least energy over the free vertices.
    fn solve(&self, field: &mut Field, scratch: &mut Scratch) {
        self.assemble(field, scratch);
        scratch.matrix.factor();
        scratch.matrix.solve(&mut scratch.x);
        for (&v, &x) in scratch.free.iter().zip(&scratch.x) {
            field.value[v as usize] = if x.is_finite() { x } else { 0.0 };
        }
    }

    /// The system over the free vertices.
    #[allow(clippy::needless_range_loop, reason = "v walks several arrays at once")]
    fn assemble(&self, field: &mut Field, scratch: &mut Scratch) {
        let Scratch { place, free, before, first, matrix, x } = scratch;
        std::mem::swap(free, before);
        free.clear();
        for v in 0..self.len() {
            if place[v] == FIXED {
                continue;
            }
            if field.held[v] {
                field.value[v] = 0.0;
                place[v] = FREE;
            } else {
                place[v] = free.len() as u32;
                free.push(v as u32);
            }
        }
        first.clear();
        x.clear();
        for (i, &v) in free.iter().enumerate() {
            let mut b = 0.0;
            let mut begin = i;
            for (w, q) in self.row(v as usize) {
                match place[w as usize] {
                    FREE => {}
                    FIXED => b -= q * field.value[w as usize],
                    j => begin = begin.min(j as usize),
                }
            }
            first.push(begin);
            x.push(b);
        }
        // Rows depend on nothing but what is free.
        let same = free.iter().zip(&*before).take_while(|(a, b)| a == b).count();
        let from = matrix.reset(first, same);
        for (i, &v) in free.iter().enumerate().skip(from) {
            for (w, q) in self.row(v as usize) {
                let j = place[w as usize];
                if j != FREE && j != FIXED && j as usize <= i {
                    matrix.set(i, j as usize, q);
                }
            }
        }
    }

    /// Estimates of the fields that are 1 at each of `ones` and 0 at `zeros`, by one factor for all: `like` is 0 at the same
    /// `zeros` and near, and tells where they are held at 0. A field of no values where nothing can be said.
    pub fn fields_like(&self, ones: &[u32], zeros: &[u32], like: &Field, scratch: &mut Scratch) -> Vec<Field> {
        let n = self.len();
        scratch.place.clear();
        scratch.place.resize(n, FREE);
        let mut field = Field { value: vec![0.0; n], held: like.held.clone() };
        field.held.resize(n, false);
        zeros.iter().for_each(|&z| scratch.place[z as usize] = FIXED);
        for (place, piece) in scratch.place.iter_mut().zip(&self.piece) {
            if ones.first().is_none_or(|&one| *piece != self.piece(one)) {
                *place = FIXED;
            }
        }
        self.assemble(&mut field, scratch);
        scratch.matrix.factor();
        let one = |&one: &u32| {
            let at = scratch.place[one as usize] as usize;
            if at >= scratch.free.len() {
                return Field::default();
            }
            scratch.x.fill(0.0);
            scratch.x[at] = 1.0;
            scratch.matrix.solve(&mut scratch.x);
            let top = scratch.x[at];
            let mut field = Field { value: vec![0.0; n], held: vec![true; n] };
            for (&v, x) in scratch.free.iter().zip(&scratch.x) {
                let x = (x / top).clamp(0.0, 1.0);
                if x > NOTHING {
                    (field.value[v as usize], field.held[v as usize]) = (x, false);
                }
            }
            field
        };
        ones.iter().map(one).collect()
    }
}

const FREE: u32 = u32::MAX;
const FIXED: u32 = u32::MAX - 1;

/// An order of the vertices in which neighbours are close together: breadth first, from an end of each piece, reversed.
/// `links` are the neighbours of each vertex.
pub fn banded_order(links: &[Vec<u32>]) -> Vec<u32> {
    let n = links.len();
    let mut order = Vec::with_capacity(n);
    let mut seen = vec![false; n];
    let sweep = |from: u32, seen: &mut [bool]| {
        let mut found = vec![from];
        seen[from as usize] = true;
        let mut next = 0;
        while let Some(&v) = found.get(next) {
            next += 1;
            let mut near: Vec<u32> = links[v as usize].iter().copied().filter(|&w| !seen[w as usize]).collect();
            near.sort_by_key(|&w| (links[w as usize].len(), w));
            near.dedup();
            near.iter().for_each(|&w| seen[w as usize] = true);
            found.extend(near);
        }
        found
    };
    for v in 0..n as u32 {
        if !seen[v as usize] {
            let mut end = v;
            for _ in 0..2 {
                let found = sweep(end, &mut seen);
                end = found.last().copied().unwrap_or(v);
                found.iter().for_each(|&w| seen[w as usize] = false);
            }
            order.extend(sweep(end, &mut seen));
        }
    }
    order.reverse();
    order
}
