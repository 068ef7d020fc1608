//! Rigid pieces: boxes with rounded edges, each a closed surface of its own.
//!
//! A box whose rounding is half its width is a ball or a capsule, so one shape is enough.

use super::body::Body;
use glam::{DQuat, DVec3};

/// A box with rounded edges that follows one bone.
#[derive(Clone, Copy, Debug)]
pub struct Piece {
    /// The bone.
    pub bone: u32,
    centre: DVec3,
    turn: DQuat,
    half: DVec3,
    round: f64,
}

impl Piece {
    /// A piece of the named bone (of the first one, if there is none of that name).
    pub fn new(body: &Body, bone: &str, centre: [f64; 3], turn: DQuat, half: [f64; 3], round: f64) -> Self {
        let half = DVec3::from(half);
        let bone = body.skeleton.find(bone).unwrap_or(0);
        Self { bone, centre: centre.into(), turn, half, round: round.min(half.min_element()) }
    }

    /// The piece in another place, thicker by `girth` and `stretch` times as long along `axis`.
    pub fn moved(&self, at: DVec3, girth: f64, axis: DVec3, stretch: f64) -> Self {
        let longer = 1.0 + (stretch - 1.0) * (self.turn.inverse() * axis).abs();
        // Balls stay balls.
        let ball = self.half.max_element() - self.round < 1e-9;
        let half = girth * self.half * if ball { DVec3::ONE } else { longer };
        Self { centre: at, half, round: (girth * self.round).min(half.min_element()), ..*self }
    }

    /// Its centre.
    pub fn centre(&self) -> DVec3 {
        self.centre
    }

    /// Cells along each of its sides if they are about `cell` wide.
    fn cells(&self, cell: f64) -> [u32; 3] {
        (2.0 * self.half / cell).round().max(DVec3::ONE).as_uvec3().to_array()
    }

    fn face_count(&self, cell: f64) -> usize {
        let [x, y, z] = self.cells(cell).map(|n| n as usize);
        4 * (x * y + y * z + z * x)
    }

    /// The point of the rounded box that belongs to a point of the sharp one.
    fn rounded(&self, p: DVec3) -> DVec3 {
        let inner = p.clamp(self.round - self.half, self.half - self.round);
        self.centre + self.turn * (inner + self.round * (p - inner).normalize_or_zero())
    }

    /// Adds its surface to a mesh.
    fn add(&self, cell: f64, positions: &mut Vec<DVec3>, faces: &mut Vec<[u32; 3]>) {
        let n = self.cells(cell);
        // Numbers of the points on the surface of the grid, the others unused.
        let width = n.map(|n| n as usize + 1);
        let mut number = vec![u32::MAX; width[0] * width[1] * width[2]];
        let mut vertex = |at: [u32; 3]| {
            let slot = &mut number[at[0] as usize + width[0] * (at[1] as usize + width[1] * at[2] as usize)];
            if *slot == u32::MAX {
                *slot = positions.len() as u32;
                let share = DVec3::new(
                    f64::from(at[0]) / f64::from(n[0]),
                    f64::from(at[1]) / f64::from(n[1]),
                    f64::from(at[2]) / f64::from(n[2]),
                );
                positions.push(self.rounded((2.0 * share - 1.0) * self.half));
            }
            *slot
        };
        for axis in 0..3 {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            for end in [0, n[axis]] {
                for i in 0..n[u] {
                    for j in 0..n[v] {
                        let mut corner = |di: u32, dj: u32| {
                            let mut at = [0; 3];
                            (at[axis], at[u], at[v]) = (end, i + di, j + dj);
                            vertex(at)
                        };
                        let [a, b, c, d] = [corner(0, 0), corner(1, 0), corner(1, 1), corner(0, 1)];
                        // Diagonals run towards the corners of the box, so that none is cut off.
                        let along = (2 * i < n[u]) == (2 * j < n[v]);
                        let pair = if along { [[a, b, c], [a, c, d]] } else { [[a, b, d], [b, c, d]] };
                        let outwards = |[x, y, z]: [u32; 3]| if end == 0 { [x, z, y] } else { [x, y, z] };
                        faces.extend(pair.map(outwards));
                    }
                }
            }
        }
    }
}

/// The surfaces of all pieces with about `faces` triangles together: positions, faces, and the bone of each vertex.
pub fn mesh(pieces: &[Piece], faces: usize) -> (Vec<DVec3>, Vec<[u32; 3]>, Vec<u32>) {
    let count = |cell: f64| pieces.iter().map(|piece| piece.face_count(cell)).sum::<usize>();
    let largest = pieces.iter().map(|piece| piece.half.max_element()).fold(1e-9, f64::max);
    let (mut fine, mut coarse) = (1e-4 * largest, 2.0 * largest);
    for _ in 0..50 {
        let middle = (fine * coarse).sqrt();
        if count(middle) > faces { fine = middle } else { coarse = middle }
    }
    let (mut positions, mut triangles, mut bones) = (Vec::new(), Vec::new(), Vec::new());
    for piece in pieces {
        piece.add(coarse, &mut positions, &mut triangles);
        bones.resize(positions.len(), piece.bone);
    }
    (positions, triangles, bones)
}
