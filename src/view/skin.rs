//! A figure moved by few handles: each vertex follows its handles' maps, mixed by weights (linear blend skinning).
//!
//! Between two poses the maps are mixed linearly, which moves every vertex just as if its positions in the two poses
//! were mixed. The shaders do the same with weights of 16 bits; here is what picking, framing and pins need.
//!
//! N. Magnenat-Thalmann, R. Laperrière, D. Thalmann, *Joint-dependent local deformations for hand animation and object
//! grasping*, Graphics Interface 1988.

use super::motion::{Extent, Moment};
use glam::{Vec3, Vec4};

/// The most handles that a vertex can follow.
pub const MOST: usize = 16;
/// Beyond this many vertices, boxes are taken around those that stand out.
const FEW: usize = 1500;
/// Rows of weights may miss 1 by this much.
const SLACK: f32 = 0.02;

/// An affine map: three rows of a 3×4 matrix.
pub type Map = [Vec4; 3];
/// The map that moves nothing.
pub const IDENTITY: Map = [Vec4::X, Vec4::Y, Vec4::Z];

/// Weights and maps, checked.
#[derive(Clone, Debug)]
pub struct Skin {
    handles: usize,
    /// Handles that a vertex follows.
    each: usize,
    /// #V × `each`.
    indices: Vec<u16>,
    /// #V × `each`, rows add up to 1.
    weights: Vec<f32>,
    /// T × `handles`.
    maps: Vec<Map>,
    /// Vertices around which a box holds all the others in almost any pose.
    outer: Vec<u32>,
}

impl Skin {
    /// A skin for a mesh with the positions `reference` (#V): each vertex follows `each` of `handles` handles, named
    /// by `indices` (#V × `each`), with `weights` (#V × `each`, rows add up to 1); `matrices` is T × `handles` × 12
    /// numbers, a 3×4 matrix row by row for each pose and handle. The error is a sentence.
    pub fn new(
        reference: &[Vec3],
        handles: usize,
        indices: &[u16],
        weights: &[f32],
        each: usize,
        matrices: &[f32],
    ) -> Result<Self, &'static str> {
        if handles == 0 || handles > usize::from(u16::MAX) || each == 0 || each > MOST {
            return Err("A vertex follows at least one handle and at most sixteen.");
        }
        let count = reference.len() * each;
        if indices.len() != count || weights.len() != count {
            return Err("The skin has another number of vertices than the mesh.");
        }
        if indices.iter().any(|&i| usize::from(i) >= handles) {
            return Err("The skin names a handle that does not exist.");
        }
        let weights = normalised(weights, each)?;
        let outer = outer(reference, indices, &weights, each, handles);
        let mut skin = Self { handles, each, indices: indices.to_vec(), weights, maps: Vec::new(), outer };
        skin.set_maps(matrices)?;
        Ok(skin)
    }

    /// Puts other maps in place of those there are: T × handles × 12 numbers. The error is a sentence.
    pub fn set_maps(&mut self, matrices: &[f32]) -> Result<(), &'static str> {
        if !matrices.len().is_multiple_of(12 * self.handles) {
            return Err("The skin needs a matrix for every pose and handle.");
        }
        if matrices.iter().any(|x| x.is_nan() || x.abs() >= 1e15) {
            return Err("A matrix of this skin is not of usable numbers.");
        }
        let row = |m: &[f32], r: usize| Vec4::from_slice(&m[4 * r..4 * r + 4]);
        self.maps = matrices.chunks_exact(12).map(|m| [row(m, 0), row(m, 1), row(m, 2)]).collect();
        Ok(())
    }

    /// Number of poses.
    pub fn poses(&self) -> usize {
        self.maps.len() / self.handles
    }

    /// Number of handles.
    pub fn handles(&self) -> usize {
        self.handles
    }

    /// How many handles a vertex follows.
    pub fn each(&self) -> usize {
        self.each
    }

    /// The handles' maps at a moment.
    pub fn maps(&self, moment: Moment) -> Vec<Map> {
        (0..self.handles)
            .map(|h| {
                let (a, b) = (self.map(moment.from, h), self.map(moment.to, h));
                [0, 1, 2].map(|r| a[r].lerp(b[r], moment.part))
            })
            .collect()
    }

    /// The map of a handle in a shape; shape 0 is the reference.
    fn map(&self, shape: usize, handle: usize) -> Map {
        let pose = shape.checked_sub(1).and_then(|k| self.maps.get(k * self.handles + handle));
        pose.copied().unwrap_or(IDENTITY)
    }

    /// Where `maps` take a vertex that stands at `p` in the reference.
    pub fn place(&self, vertex: usize, p: Vec3, maps: &[Map]) -> Vec3 {
        let row = vertex * self.each..(vertex + 1) * self.each;
        let mut m = [Vec4::ZERO; 3];
        let (Some(indices), Some(weights)) = (self.indices.get(row.clone()), self.weights.get(row)) else { return p };
        for (&i, &w) in indices.iter().zip(weights) {
            if let Some(map) = maps.get(usize::from(i)) {
                m = [m[0] + map[0] * w, m[1] + map[1] * w, m[2] + map[2] * w];
            }
        }
        let p = p.extend(1.0);
        Vec3::new(m[0].dot(p), m[1].dot(p), m[2].dot(p))
    }

    /// Where `maps` take all vertices, into `out`.
    pub fn positions(&self, reference: &[Vec3], maps: &[Map], out: &mut Vec<Vec3>) {
        out.clear();
        out.extend(reference.iter().enumerate().map(|(v, &p)| self.place(v, p, maps)));
    }

    /// The box around a shape, or very nearly.
    pub fn extent(&self, reference: &[Vec3], shape: usize) -> Extent {
        let points = self.outline(reference, shape);
        Extent::of(points.iter())
    }

    /// The vertices that stand out, in a shape.
    pub fn outline(&self, reference: &[Vec3], shape: usize) -> Vec<Vec3> {
        let maps = self.maps(Moment { from: shape, to: shape, part: 0.0 });
        let placed = |&v: &u32| reference.get(v as usize).map(|&p| self.place(v as usize, p, &maps));
        self.outer.iter().filter_map(placed).collect()
    }

    /// What a vertex follows, as the shaders take it: `each` words, the handle in the low half and the weight, of
    /// 65535, in the high one. Weights add up to exactly 65535.
    pub fn words(&self, vertex: usize) -> impl Iterator<Item = u32> {
        let row = vertex * self.each..(vertex + 1) * self.each;
        let weights = self.weights.get(row.clone()).unwrap_or(&[]);
        let mut parts = [0_i32; MOST];
        for (part, &w) in parts.iter_mut().zip(weights) {
            *part = (w * 65535.0).round() as i32;
        }
        let rest = 65535 - parts.iter().sum::<i32>();
        if let Some(most) = parts.iter_mut().max() {
            *most += rest;
        }
        let indices = self.indices.get(row).unwrap_or(&[]);
        indices.iter().zip(parts).map(|(&i, part)| u32::from(i) | (part.clamp(0, 65535) as u32) << 16)
    }
}

/// Rows that add up to 1 exactly enough; an error if they did not nearly.
fn normalised(weights: &[f32], each: usize) -> Result<Vec<f32>, &'static str> {
    let mut out = weights.to_vec();
    for row in out.chunks_exact_mut(each) {
        let sum: f32 = row.iter().map(|w| w.max(0.0)).sum();
        if row.iter().any(|&w| w.is_nan() || w < -SLACK) || !((1.0 - SLACK)..=(1.0 + SLACK)).contains(&sum) {
            return Err("The weights of a vertex must be positive and add up to 1.");
        }
        row.iter_mut().for_each(|w| *w = w.max(0.0) / sum);
    }
    Ok(out)
}

/// Of the vertices that follow a handle more than any other, those farthest out in 26 directions; for each handle.
/// Maps that turn a handle's part turn its farthest points with it, so few are missed.
fn outer(reference: &[Vec3], indices: &[u16], weights: &[f32], each: usize, handles: usize) -> Vec<u32> {
    if reference.len() <= FEW {
        return (0..reference.len() as u32).collect();
    }
    let steps = || [-1.0, 0.0, 1.0].into_iter();
    let directions: Vec<Vec3> = steps()
        .flat_map(|x| steps().flat_map(move |y| steps().map(move |z| Vec3::new(x, y, z))))
        .filter(|d| *d != Vec3::ZERO)
        .collect();
    let mut best = vec![(f32::NEG_INFINITY, 0_u32); handles * directions.len()];
    for (v, (&p, (row, of))) in
        reference.iter().zip(weights.chunks_exact(each).zip(indices.chunks_exact(each))).enumerate()
    {
        let (_, first) = row.iter().zip(of).fold((-1.0, 0), |best, (&w, &i)| if w > best.0 { (w, i) } else { best });
        for (k, d) in directions.iter().enumerate() {
            let place = &mut best[usize::from(first) * directions.len() + k];
            let far = d.dot(p);
            if far > place.0 {
                *place = (far, v as u32);
            }
        }
    }
    let mut out: Vec<u32> = best.into_iter().filter(|b| b.0 > f32::NEG_INFINITY).map(|b| b.1).collect();
    out.sort_unstable();
    out.dedup();
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DMat3, DVec3, Mat3};

    /// Numbers between 0 and 1 that look like chance.
    fn noise(seed: &mut u32) -> f32 {
        *seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (*seed >> 8) as f32 / 16_777_216.0
    }

    struct Made {
        reference: Vec<Vec3>,
        indices: Vec<u16>,
        weights: Vec<f32>,
        matrices: Vec<f32>,
        skin: Skin,
    }

    fn made(vertices: usize, handles: usize, each: usize, poses: usize) -> Made {
        let seed = &mut 7;
        let reference: Vec<Vec3> =
            (0..vertices).map(|_| Vec3::new(noise(seed), noise(seed), noise(seed)) * 2.0 - 1.0).collect();
        let indices: Vec<u16> = (0..vertices * each).map(|_| (noise(seed) * handles as f32) as u16).collect();
        let mut weights: Vec<f32> = (0..vertices * each).map(|_| noise(seed) + 1e-3).collect();
        for row in weights.chunks_exact_mut(each) {
            let sum: f32 = row.iter().sum();
            row.iter_mut().for_each(|w| *w /= sum);
        }
        let matrices: Vec<f32> = (0..poses * handles * 12)
            .map(|i| f32::from(u8::from([0, 5, 10].contains(&(i % 12)))) + 0.6 * noise(seed) - 0.3)
            .collect();
        let skin = Skin::new(&reference, handles, &indices, &weights, each, &matrices).unwrap();
        Made { reference, indices, weights, matrices, skin }
    }

    /// Linear blend skinning by its definition, in double precision: the mixed images of a point.
    fn direct(m: &Made, handles: usize, each: usize, vertex: usize, pose: usize) -> DVec3 {
        let p = m.reference[vertex].as_dvec3();
        let image = |h: usize| {
            let n: Vec<f64> = m.matrices[(pose * handles + h) * 12..][..12].iter().map(|&x| f64::from(x)).collect();
            let linear = DMat3::from_cols(
                DVec3::new(n[0], n[4], n[8]),
                DVec3::new(n[1], n[5], n[9]),
                DVec3::new(n[2], n[6], n[10]),
            );
            linear * p + DVec3::new(n[3], n[7], n[11])
        };
        (0..each).map(|k| image(m.indices[vertex * each + k].into()) * f64::from(m.weights[vertex * each + k])).sum()
    }

    #[test]
    fn is_linear_blend_skinning_and_mixes_poses() {
        let (handles, each) = (9, 5);
        let m = made(60, handles, each, 3);
        let mut out = Vec::new();
        let maps = m.skin.maps(Moment { from: 2, to: 3, part: 0.25 });
        m.skin.positions(&m.reference, &maps, &mut out);
        for (v, p) in out.iter().enumerate() {
            let expected = direct(&m, handles, each, v, 1).lerp(direct(&m, handles, each, v, 2), 0.25);
            assert!(p.as_dvec3().distance(expected) < 1e-5);
        }
        m.skin.positions(&m.reference, &m.skin.maps(Moment { from: 0, to: 0, part: 0.0 }), &mut out);
        assert!(out.iter().zip(&m.reference).all(|(a, b)| a.distance(*b) < 1e-5), "shape 0 is the reference");
    }

    #[test]
    fn sixteen_bits_of_weight_are_enough() {
        let (handles, each) = (12, MOST);
        let m = made(200, handles, each, 1);
        let maps = m.skin.maps(Moment { from: 1, to: 1, part: 0.0 });
        for (v, p) in m.reference.iter().enumerate() {
            let words: Vec<u32> = m.skin.words(v).collect();
            assert_eq!(words.iter().map(|w| w >> 16).sum::<u32>(), 65535);
            let mut sum = [Vec4::ZERO; 3];
            for w in words {
                let (map, part) = (maps[(w & 0xFFFF) as usize], (w >> 16) as f32 / 65535.0);
                sum = [0, 1, 2].map(|r| sum[r] + map[r] * part);
            }
            let at = Vec3::from_array(sum.map(|r| r.dot(p.extend(1.0))));
            assert!(at.distance(m.skin.place(v, *p, &maps)) < 1e-4);
        }
    }

    #[test]
    fn cofactors_turn_normals() {
        // The shader takes the cross products of the rows: these turn area vectors as the linear part turns sides.
        let a = Mat3::from_cols_array(&[0.9, -0.4, 0.2, 0.1, 1.3, -0.5, 0.3, 0.2, -0.7]);
        let rows = [0, 1, 2].map(|i| a.row(i));
        let cofactors = [rows[1].cross(rows[2]), rows[2].cross(rows[0]), rows[0].cross(rows[1])];
        let (u, v) = (Vec3::new(0.3, -1.0, 0.2), Vec3::new(0.7, 0.4, -0.9));
        let n = u.cross(v);
        let turned = Vec3::from_array(cofactors.map(|r| r.dot(n)));
        assert!(turned.distance((a * u).cross(a * v)) < 1e-5);
    }

    #[test]
    fn a_few_vertices_give_the_box() {
        let (handles, each) = (6, 3);
        let m = made(5000, handles, each, 4);
        assert!(m.skin.outer.len() <= 26 * handles);
        let mut all = Vec::new();
        for shape in 0..=4 {
            m.skin.positions(&m.reference, &m.skin.maps(Moment { from: shape, to: shape, part: 0.0 }), &mut all);
            let (whole, found) = (Extent::of(all.iter()), m.skin.extent(&m.reference, shape));
            let size = whole.low.distance(whole.high);
            assert!(whole.low.distance(found.low) < 0.1 * size && whole.high.distance(found.high) < 0.1 * size);
        }
    }

    #[test]
    fn bad_arrays_are_refused() {
        let p = [Vec3::ZERO, Vec3::X];
        let good = Skin::new(&p, 2, &[0, 1, 1, 0], &[0.5, 0.5, 1.0, 0.0], 2, &[0.0; 48]).unwrap();
        assert_eq!((good.poses(), good.handles(), good.each()), (2, 2, 2));
        assert!(Skin::new(&p, 2, &[0, 2, 1, 0], &[0.5; 4], 2, &[]).is_err(), "no such handle");
        assert!(Skin::new(&p, 2, &[0, 1], &[1.0; 2], 2, &[]).is_err(), "too few");
        assert!(Skin::new(&p, 2, &[0; 2], &[0.5; 2], 1, &[]).is_err(), "rows of one half");
        assert!(Skin::new(&p, 2, &[0; 2], &[f32::NAN; 2], 1, &[]).is_err());
        assert!(Skin::new(&p, 2, &[0; 2], &[1.0; 2], 1, &[0.0; 12]).is_err(), "half a pose");
        assert!(Skin::new(&p, 2, &[0; 2], &[1.0; 2], 1, &[f32::INFINITY; 24]).is_err());
        assert!(Skin::new(&p, 0, &[], &[], 0, &[]).is_err());
    }
}
