//! A coarse mesh on some of the vertices of a fine one.
//!
//! Edges collapse onto one of their ends, cheapest first: Michael Garland, Paul S. Heckbert. *Surface simplification
//! using quadric error metrics*. SIGGRAPH 1997, with the link condition of Tamal K. Dey, Herbert Edelsbrunner, Sumanta
//! Guha, Dmitry V. Nekhayev. *Topology preserving edge contraction*. 1999. What cannot collapse without changing the
//! topology stays, so that thin limbs stay limbs; only where that is far more than wanted, holes and handles close.

use crate::linalg::outer::outer;
use glam::{DMat3, DVec3};
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Share of squared edge lengths times area in the price of a collapse: keeps triangles of one size where all is flat.
const EVEN: f64 = 1e-3;

/// With more than so many times the vertices that are wanted, holes and handles close.
const MUCH: usize = 2;

/// A vertex of more faces, the middle of a fan, does not collapse: every change around it would have it tried anew, with
/// each of its neighbours.
const MOST_VALENCE: usize = 64;

/// A coarse mesh.
pub struct Decimated {
    /// Triples of vertices of the *fine* mesh.
    pub faces: Vec<[u32; 3]>,
    /// For each vertex of the fine mesh, the vertex that it collapsed onto: itself if it stayed.
    pub onto: Vec<u32>,
}

/// Sum of squared distances to planes, `x·A x − 2 b·x + c`.
#[derive(Clone, Copy)]
struct Quadric {
    a: DMat3,
    b: DVec3,
    c: f64,
    area: f64,
}

impl Quadric {
    const NONE: Self = Self { a: DMat3::ZERO, b: DVec3::ZERO, c: 0.0, area: 0.0 };

    fn plane(normal: DVec3, point: DVec3, weight: f64) -> Self {
        let (n, d) = (normal, normal.dot(point));
        let a = outer(n, n) * weight;
        Self { a, b: n * (d * weight), c: d * d * weight, area: 0.0 }
    }

    fn add(&mut self, other: &Self) {
        self.a += other.a;
        self.b += other.b;
        self.c += other.c;
        self.area += other.area;
    }

    fn at(&self, x: DVec3) -> f64 {
        (x.dot(self.a * x) - 2.0 * self.b.dot(x) + self.c).max(0.0)
    }
}

struct Mesh<'a> {
    points: &'a [DVec3],
    faces: Vec<[u32; 3]>,
    alive: Vec<bool>,
    /// Faces of each vertex, as many dead ones among them as `dead` says: half of them at most.
    around: Vec<Vec<u32>>,
    dead: Vec<u32>,
    quadrics: Vec<Quadric>,
    stamp: Vec<u32>,
    /// Whether holes and handles may close.
    closing: bool,
}

/// The cheapest first: price, what collapses, onto what, and the stamp of the former then.
type Heap = BinaryHeap<Reverse<(u64, u32, u32, u32)>>;

/// Collapses until about `target` vertices with faces are left. `keep` is #V: what must stay. Of faces between the same
/// vertices, as in two-sided leaves, one is taken.
pub fn decimate(faces: &[[u32; 3]], points: &[DVec3], keep: &[bool], target: usize) -> Decimated {
    let mut mesh = Mesh::new(faces, points);
    let mut onto: Vec<u32> = (0..points.len() as u32).collect();
    let left = mesh.around.iter().filter(|f| !f.is_empty()).count();
    let left = mesh.thin_out(left, target, keep, &mut onto);
    mesh.closing = true;
    mesh.thin_out(left, MUCH * target, keep, &mut onto);
    for v in 0..onto.len() {
        let mut end = v as u32;
        while onto[end as usize] != end {
            end = onto[end as usize];
        }
        onto[v] = end;
    }
    let faces = mesh.faces.iter().zip(&mesh.alive).filter(|(_, alive)| **alive).map(|(face, _)| *face).collect();
    Decimated { faces, onto }
}

impl<'a> Mesh<'a> {
    fn new(faces: &[[u32; 3]], points: &'a [DVec3]) -> Self {
        let mut around: Vec<Vec<u32>> = vec![Vec::new(); points.len()];
        let mut quadrics = vec![Quadric::NONE; points.len()];
        let mut sides = Vec::with_capacity(3 * faces.len());
        let mut alive = vec![true; faces.len()];
        for (f, face) in faces.iter().enumerate() {
            let same = |other: &u32| face.iter().all(|v| faces[*other as usize].contains(v));
            // At the corner with the fewest: a fan has thousands of faces around its middle.
            let few = face.iter().map(|&v| &around[v as usize]).min_by_key(|faces| faces.len());
            if few.is_some_and(|faces| faces.iter().any(same)) {
                alive[f] = false;
                continue;
            }
            let [a, b, c] = face.map(|v| points[v as usize]);
            let normal = (b - a).cross(c - a);
            let area = 0.5 * normal.length();
            let quadric = Quadric { area, ..Quadric::plane(normal.normalize_or_zero(), a, area) };
            for i in 0..3 {
                around[face[i] as usize].push(f as u32);
                quadrics[face[i] as usize].add(&quadric);
                let (u, v) = (face[i], face[(i + 1) % 3]);
                sides.push((u.min(v), u.max(v), normal));
            }
        }
        sides.sort_by_key(|side| (side.0, side.1));
        for same in sides.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
            if let &[(u, v, normal)] = same {
                // Boundaries are held by planes that stand on them.
                let edge = points[v as usize] - points[u as usize];
                let wall = edge.cross(normal).normalize_or_zero();
                let quadric = Quadric::plane(wall, points[u as usize], edge.length_squared());
                [u, v].iter().for_each(|&v| quadrics[v as usize].add(&quadric));
            }
        }
        let stamp = vec![0; points.len()];
        let dead = vec![0; points.len()];
        Self { points, faces: faces.to_vec(), alive, around, dead, quadrics, stamp, closing: false }
    }

    /// Collapses until `target` of the `left` vertices are left, or nothing can collapse; how many are.
    fn thin_out(&mut self, mut left: usize, target: usize, keep: &[bool], onto: &mut [u32]) -> usize {
        let mut heap = BinaryHeap::new();
        if left > target {
            (0..keep.len() as u32).for_each(|v| self.offer(v, keep, &mut heap));
        }
        while left > target {
            let Some(Reverse((_, v, u, stamp))) = heap.pop() else { break };
            if stamp != self.stamp[v as usize] || !self.may_collapse(v, u, &self.neighbours(v)) {
                continue;
            }
            self.collapse(v, u);
            onto[v as usize] = u;
            left -= 1;
            let mut near = self.neighbours(u);
            near.push(u);
            for w in near {
                self.stamp[w as usize] += 1;
                self.offer(w, keep, &mut heap);
            }
        }
        left
    }

    fn faces_of(&self, v: u32) -> impl Iterator<Item = u32> + '_ {
        self.around[v as usize].iter().copied().filter(|&f| self.alive[f as usize])
    }

    /// How many faces a vertex has.
    fn valence(&self, v: u32) -> usize {
        self.around[v as usize].len() - self.dead[v as usize] as usize
    }

    /// Whether two vertices share a face.
    fn adjacent(&self, a: u32, b: u32) -> bool {
        let [few, other] = if self.around[a as usize].len() <= self.around[b as usize].len() { [a, b] } else { [b, a] };
        self.faces_of(few).any(|f| self.faces[f as usize].contains(&other))
    }

    fn neighbours(&self, v: u32) -> Vec<u32> {
        let mut near: Vec<u32> = self.faces_of(v).flat_map(|f| self.faces[f as usize]).filter(|&w| w != v).collect();
        near.sort_unstable();
        near.dedup();
        near
    }

    /// Puts the cheapest collapse of `v` into the heap.
    fn offer(&self, v: u32, keep: &[bool], heap: &mut Heap) {
        if keep[v as usize] || self.valence(v) > MOST_VALENCE {
            return;
        }
        let near = self.neighbours(v);
        let mut offers: Vec<(f64, u32)> = near.iter().map(|&u| (self.price(v, u), u)).collect();
        offers.sort_by(|a, b| a.0.total_cmp(&b.0).then(a.1.cmp(&b.1)));
        if let Some(&(price, u)) = offers.iter().find(|offer| self.may_collapse(v, offer.1, &near)) {
            heap.push(Reverse((price.to_bits(), v, u, self.stamp[v as usize])));
        }
    }

    fn price(&self, v: u32, u: u32) -> f64 {
        let (p, q) = (self.points[v as usize], self.points[u as usize]);
        let mut quadric = self.quadrics[v as usize];
        quadric.add(&self.quadrics[u as usize]);
        let price = quadric.at(q) + EVEN * quadric.area * p.distance_squared(q);
        if price.is_finite() { price } else { f64::MAX }
    }

    /// Whether `v`, whose neighbours are `near`, can move onto `u` without turning a face over or, unless holes and
    /// handles may close, changing the topology.
    fn may_collapse(&self, v: u32, u: u32, near: &[u32]) -> bool {
        let opposite: Vec<u32> = (self.faces_of(v).map(|f| self.faces[f as usize]))
            .filter(|face| face.contains(&u))
            .flat_map(|face| face.into_iter().filter(|&w| w != u && w != v))
            .collect();
        // Nobody may be left without a face.
        let last = self.valence(v) == opposite.len() || opposite.iter().any(|&w| self.valence(w) < 2);
        if opposite.is_empty() || last || !(self.closing || self.keeps_topology(v, u, near, &opposite)) {
            return false;
        }
        self.faces_of(v).map(|f| self.faces[f as usize]).filter(|face| !face.contains(&u)).all(|face| {
            let moved = face.map(|w| if w == v { u } else { w });
            self.keeps_its_side(face, moved) && !self.exists(moved)
        })
    }

    /// The link condition: `opposite` the edge is who is beside both of its ends, and no edge inside joins two vertices
    /// of the boundary, which would pinch the surface.
    fn keeps_topology(&self, v: u32, u: u32, near: &[u32], opposite: &[u32]) -> bool {
        let common = near.iter().filter(|&&w| w != u && self.adjacent(w, u)).count();
        common == opposite.len() && !(opposite.len() == 2 && self.on_boundary(v))
    }

    /// Whether some edge of `v` has other than two faces.
    fn on_boundary(&self, v: u32) -> bool {
        let mut ends: Vec<u32> = self.faces_of(v).flat_map(|f| self.faces[f as usize]).filter(|&w| w != v).collect();
        ends.sort_unstable();
        ends.chunk_by(|a, b| a == b).any(|faces| faces.len() != 2)
    }

    fn keeps_its_side(&self, before: [u32; 3], after: [u32; 3]) -> bool {
        let normal = |face: [u32; 3]| {
            let [a, b, c] = face.map(|v| self.points[v as usize]);
            let size = a.distance_squared(b) + b.distance_squared(c) + c.distance_squared(a);
            ((b - a).cross(c - a), size)
        };
        let ((old, _), (new, size)) = (normal(before), normal(after));
        // No needles: area over squared sides is 0.29 for an equilateral triangle.
        let slim = new.length() < 0.02 * size && new.length() < 0.5 * old.length();
        !slim && old.dot(new) >= 0.2 * old.length() * new.length()
    }

    fn exists(&self, face: [u32; 3]) -> bool {
        let few = face.into_iter().min_by_key(|&v| self.around[v as usize].len());
        few.is_some_and(|v| self.faces_of(v).any(|f| self.faces[f as usize].iter().all(|w| face.contains(w))))
    }

    fn collapse(&mut self, v: u32, u: u32) {
        for f in std::mem::take(&mut self.around[v as usize]) {
            if !self.alive[f as usize] {
                continue;
            }
            if self.faces[f as usize].contains(&u) {
                self.alive[f as usize] = false;
                self.faces[f as usize].into_iter().for_each(|w| self.bury(w));
            } else {
                self.faces[f as usize].iter_mut().filter(|w| **w == v).for_each(|w| *w = u);
                self.around[u as usize].push(f);
            }
        }
        let quadric = self.quadrics[v as usize];
        self.quadrics[u as usize].add(&quadric);
        self.stamp[v as usize] += 1;
    }

    /// One more face of a vertex is dead; they are forgotten once they are many.
    fn bury(&mut self, v: u32) {
        self.dead[v as usize] += 1;
        let (alive, around) = (&self.alive, &mut self.around[v as usize]);
        if 2 * self.dead[v as usize] as usize > around.len() {
            around.retain(|&f| alive[f as usize]);
            self.dead[v as usize] = 0;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of `n` × `n` squares in the plane, and its points.
    fn sheet(n: u32) -> (Vec<[u32; 3]>, Vec<DVec3>) {
        let at = |i: u32, j: u32| i * (n + 1) + j;
        let points = (0..=n).flat_map(|i| (0..=n).map(move |j| DVec3::new(f64::from(i), f64::from(j), 0.0))).collect();
        let square = |i, j| [[at(i, j), at(i + 1, j), at(i + 1, j + 1)], [at(i, j), at(i + 1, j + 1), at(i, j + 1)]];
        ((0..n).flat_map(|i| (0..n).flat_map(move |j| square(i, j))).collect(), points)
    }

    fn left(faces: &[[u32; 3]], points: &[DVec3], target: usize) -> usize {
        let mut kept = decimate(faces, points, &vec![false; points.len()], target).faces.concat();
        kept.sort_unstable();
        kept.dedup();
        kept.len()
    }

    #[test]
    fn two_sided_and_non_manifold_meshes_thin_out_as_well() {
        let (faces, points) = sheet(20);
        assert_eq!(left(&faces, &points, 50), 50);
        let back = faces.iter().map(|&[a, b, c]| [c, b, a]);
        let doubled: Vec<[u32; 3]> = faces.iter().copied().chain(back).collect();
        assert_eq!(left(&doubled, &points, 50), 50);
        // A second sheet stands on the middle line of the first: edges of four faces.
        let offset = points.len() as u32;
        let standing = points.iter().map(|p| DVec3::new(10.0, p.y, p.x - 10.0));
        let both: Vec<DVec3> = points.iter().copied().chain(standing).collect();
        let on_line = |v: u32| if both[v as usize].z == 0.0 && v >= offset { 10 * 21 + (v - offset) % 21 } else { v };
        let crossed = faces.iter().map(|face| face.map(|v| on_line(v + offset)));
        let crossed: Vec<[u32; 3]> = faces.iter().copied().chain(crossed).collect();
        assert!(left(&crossed, &both, 100) <= 110);
    }

    #[test]
    fn holes_close_only_where_far_too_much_would_be_left() {
        // Every other square of every other row is a hole.
        let (faces, points) = sheet(41);
        let is_hole = |square: usize| (square / 41) % 2 == 1 && (square % 41) % 2 == 1;
        let faces: Vec<[u32; 3]> =
            faces.into_iter().enumerate().filter(|(f, _)| !is_hole(f / 2)).map(|(_, face)| face).collect();
        assert!(left(&faces, &points, 1000) <= 1240);
        assert_eq!(left(&faces, &points, 100), 200);
    }

    #[test]
    fn fans_thin_out_in_no_time() {
        // A flat box of two fans and a narrow wall.
        let rim = 2_000;
        let angle = |i: u32| std::f64::consts::TAU * f64::from(i) / f64::from(rim);
        let circle = |y: f64| (0..rim).map(move |i| DVec3::new(angle(i).cos(), y, angle(i).sin()));
        let points: Vec<DVec3> =
            circle(0.0).chain(circle(0.1)).chain([DVec3::ZERO, DVec3::new(0.0, 0.1, 0.0)]).collect();
        let sides = (0..rim).flat_map(|i| {
            let [a, b] = [i, (i + 1) % rim];
            let [c, d] = [a, b].map(|v| v + rim);
            [[a, c, b], [b, c, d], [2 * rim, a, b], [2 * rim + 1, d, c]]
        });
        assert_eq!(left(&sides.collect::<Vec<_>>(), &points, 60), 60);
    }
}
