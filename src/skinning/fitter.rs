//! The affine maps of a handle set that follow a pose: the alternation of §3.4, reduced.
//!
//! With `d` the displacements, `d = Φ X`: a vertex's row of Φ (#V × 4h) is `w_k [p − c_k, 1]` for each handle k at
//! `c_k`. Per group g of edges `e`, with `N_g = R_g − 1`,
//!
//! | formula | code |
//! |---|---|
//! | `A = λ Φᵀ L Φ + Φᵀ M Φ` (4h × 4h) | factored once |
//! | `K_g = λ Σ w̃ (φ_i − φ_j) eᵀ` (4h × 3), `P_g = λ Σ w̃ e eᵀ` | `Group` |
//! | global step, `A X = Σ K_g N_gᵀ + c`, `c = Φᵀ M d′` | `X = X_c + Σ Y_g N_gᵀ` |
//! | local step, `R_g` nearest to `Xᵀ K_g + P_g` | `coupling`: `K_gᵀ Y_g′`, so that rounds see only 3 × 3 blocks |
//!
//! A is singular where a handle sees a flat patch, and nearly so where handles crowd; maps would then run wild, which
//! the fit does not feel but another body would. So every handle carries a small cross of three edges, weighted by the
//! share `hold` of what the handle moves: its arms take part in the energy like edges of the handle's group, and its
//! centre is drawn to where the pose has it. The energy falls as before.

use super::assembly::{Assembly, Group};
use super::factor::Factor;
use super::functions::{Axes, Functions, as_axes, as_rows};
use super::rows::Rows;
use crate::linalg::outer::outer;
use crate::linalg::polar;
use crate::linalg::rigid_fit::{Moments, RigidMotion};
use glam::{DAffine3, DMat3, DVec3};
use serde::{Deserialize, Serialize};

/// What the fit weighs.
#[derive(Clone, Copy, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, rename_all = "kebab-case")]
pub struct FitParameters {
    /// λ of Eq. 5, the share of rigidity (paper: 0.5), for a mesh of `LIKE_VERTICES` vertices: E_diff is taken as a
    /// mean so that a finer mesh weighs no more.
    pub lambda: f64,
    /// How firmly maps are held near rotations where the pose does not say: the weight of a handle's cross over that
    /// of the vertices it moves.
    pub hold: f64,
    /// The rounds at most.
    pub rounds: usize,
    /// Rounds end when the energy falls by less than this share.
    pub tolerance: f64,
}

impl Default for FitParameters {
    fn default() -> Self {
        Self { lambda: 0.5, hold: 1e-3, rounds: 60, tolerance: 1e-7 }
    }
}

/// Energies below this (summed squares in the unit sphere) are rounding.
const NOTHING: f64 = 1e-20;

/// The number of vertices for which λ means what it means in the paper, whose meshes have 1,100 to 2,700.
pub const LIKE_VERTICES: f64 = 2500.0;

/// A mesh with handles, weights and groups.
#[derive(Clone, Copy, Debug)]
pub struct SkinnedMesh<'a> {
    /// #V points.
    pub reference: &'a [DVec3],
    /// Edges as pairs of vertices.
    pub edges: &'a [[u32; 2]],
    /// Their weights w̃ (cotangents); negative ones count as 0.
    pub stiffness: &'a [f64],
    /// #V: how much each vertex counts in E_diff and in the mean distance (0 for a vertex that does not count).
    pub mass: &'a [f64],
    /// The vertices that are handles.
    pub handles: &'a [u32],
    /// #V × #H.
    pub weights: &'a Rows,
    /// #V group numbers.
    pub groups: &'a [u32],
    /// Centre and radius of the unit sphere.
    pub ball: (DVec3, f64),
}

/// The maps that follow one pose best.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Fit {
    /// One map a handle, in mesh units, from the reference to the pose.
    pub maps: Vec<DAffine3>,
    /// The energy at first and after each round, in unit-sphere units; it never rises.
    pub energies: Vec<f64>,
    /// Mean vertex distance between blended vertices and the pose, in unit-sphere radii.
    pub error: f64,
}

/// A skinned mesh, ready to follow any pose.
pub struct Fitter {
    parameters: FitParameters,
    centre: DVec3,
    radius: f64,
    /// #V points in the unit sphere.
    points: Vec<DVec3>,
    mass: Vec<f64>,
    total: f64,
    functions: Functions,
    handles: Vec<u32>,
    at: Vec<DVec3>,
    /// Weight of each handle's cross.
    hold: Vec<f64>,
    factor: Factor,
    groups: Vec<Group>,
    /// `Y_g = A⁻¹ K_g` of every group, 4h × 3.
    answers: Vec<Vec<[f64; 3]>>,
    /// (3 #G)² row-major: `Kᵀ A⁻¹ K`.
    coupling: Vec<f64>,
}

/// A pose brought next to the reference: what does not depend on handles.
#[derive(Clone, Debug)]
pub struct Placed {
    /// The motion that was taken out; its shift in mesh units.
    motion: RigidMotion,
    /// #V displacements from the reference that are left, in the unit sphere.
    pub displacements: Vec<DVec3>,
}

impl Placed {
    /// Takes the best rigid motion out of a pose of #V points. `points` are those of the reference in the unit sphere, of
    /// `radius` in mesh units; `mass` says how much each counts.
    pub fn new(points: &[DVec3], mass: &[f64], radius: f64, pose: &[DVec3]) -> Self {
        let mean = mean(mass, pose);
        let place = |q: DVec3| (q - mean) / radius;
        let mut moments = Moments::default();
        for ((&m, &p), &q) in mass.iter().zip(points).zip(pose) {
            if m > 0.0 {
                moments.add(m, p, place(q));
            }
        }
        let mut motion = moments.motion();
        let back = motion.rotation.transpose();
        let displacement = |(&p, &q): (&DVec3, &DVec3)| back * (place(q) - motion.translation) - p;
        let displacements = points.iter().zip(pose).map(displacement).collect();
        motion.translation = motion.translation * radius + mean;
        Self { motion, displacements }
    }
}

fn mean(mass: &[f64], pose: &[DVec3]) -> DVec3 {
    let total: f64 = mass.iter().sum();
    let sum: DVec3 = mass.iter().zip(pose).map(|(&m, &q)| m / total.max(f64::MIN_POSITIVE) * q).sum();
    if sum.is_finite() { sum } else { DVec3::ZERO }
}

/// What a pose says to the handles.
struct Target {
    /// A⁻¹ c (4h × 3), Kᵀ A⁻¹ c (3 #G × 3), `Σ m |d′|²` less tr(cᵀ A⁻¹ c).
    x: Vec<[f64; 3]>,
    pull: Vec<DMat3>,
    constant: f64,
}

impl Fitter {
    /// Prepares a skinned mesh: everything that does not depend on the pose.
    pub fn new(mesh: &SkinnedMesh, parameters: &FitParameters) -> Self {
        let (centre, radius) = (mesh.ball.0, if mesh.ball.1 > 0.0 { mesh.ball.1 } else { 1.0 });
        let points: Vec<DVec3> = mesh.reference.iter().map(|&p| (p - centre) / radius).collect();
        let sum: f64 = mesh.mass.iter().sum();
        let scale = if sum > 0.0 { LIKE_VERTICES / sum } else { 0.0 };
        let mass: Vec<f64> = mesh.mass.iter().map(|m| m * scale).collect();
        let at: Vec<DVec3> = mesh.handles.iter().map(|&v| points[v as usize]).collect();
        let mut hold = vec![0.0; at.len()];
        for (v, m) in mass.iter().enumerate() {
            mesh.weights.entries(v).for_each(|(k, w)| hold[k as usize] += parameters.hold * m * w);
        }
        let floor = parameters.hold * LIKE_VERTICES * 1e-6;
        hold.iter_mut().for_each(|h| *h = h.max(floor));
        let functions = Functions::new(mesh.weights, &points, &at);
        let Assembly { a, groups } = Assembly::new(mesh, &functions, &points, &mass, &hold, parameters.lambda);
        let factor = Factor::new(a, 4 * at.len());
        let answer = |group: &Group| {
            let mut y = group.k.clone();
            factor.solve(&mut y);
            y
        };
        let answers: Vec<_> = groups.iter().map(answer).collect();
        let coupling = coupling(&groups, &answers);
        let handles = mesh.handles.to_vec();
        let total = mass.iter().sum();
        Self {
            parameters: *parameters,
            centre,
            radius,
            points,
            mass,
            total,
            functions,
            handles,
            at,
            hold,
            factor,
            groups,
            answers,
            coupling,
        }
    }

    /// The maps that make the mesh follow `pose` (#V points, in the reference's order).
    pub fn fit(&self, pose: &[DVec3]) -> Fit {
        self.finish(&self.placed(pose), |_| ())
    }

    /// The same, with the maps of every round: one list for each of [`Fit::energies`].
    pub fn fit_in_rounds(&self, pose: &[DVec3]) -> (Fit, Vec<Vec<DAffine3>>) {
        let placed = self.placed(pose);
        let target = self.target(&placed);
        let mut rounds = Vec::new();
        let fit = self.finish(&placed, |turns| rounds.push(self.maps(&placed.motion, &self.solution(&target, turns))));
        (fit, rounds)
    }

    /// The pose next to the reference.
    fn placed(&self, pose: &[DVec3]) -> Placed {
        Placed::new(&self.points, &self.mass, self.radius, pose)
    }

    /// Alternates to the end; `each` sees the turns of every round.
    fn finish(&self, placed: &Placed, each: impl FnMut(&[DMat3])) -> Fit {
        let target = self.target(placed);
        let (turns, energies) = self.alternate(&target, each);
        let x = self.solution(&target, &turns);
        let error = self.error(placed, &x);
        Fit { maps: self.maps(&placed.motion, &x), energies, error }
    }

    /// The error alone of the fit of a pose that is at hand next to the reference.
    pub fn fit_error(&self, placed: &Placed) -> f64 {
        let target = self.target(placed);
        let (turns, _) = self.alternate(&target, |_| ());
        self.error(placed, &self.solution(&target, &turns))
    }

    /// What a pose says to the handles.
    fn target(&self, placed: &Placed) -> Target {
        let displacements = &placed.displacements;
        let mut c = vec![Axes::default(); self.at.len()];
        let mut constant = 0.0;
        for (v, (&m, &d)) in self.mass.iter().zip(displacements).enumerate() {
            if m <= 0.0 {
                continue;
            }
            constant += m * d.length_squared();
            self.functions.spread(v, m * d, &mut c);
        }
        for (k, (&v, &hold)) in self.handles.iter().zip(&self.hold).enumerate() {
            let d = displacements[v as usize];
            constant += hold * d.length_squared();
            (0..3).for_each(|axis| c[k][axis][3] += hold * d[axis]);
        }
        let c = as_rows(&c);
        let mut x = c.clone();
        self.factor.solve(&mut x);
        constant -= c.iter().flatten().zip(x.iter().flatten()).map(|(a, b)| a * b).sum::<f64>();
        let pull = self.groups.iter().map(|g| transposed_product(&g.k, &x)).collect();
        Target { x, pull, constant }
    }

    /// Local and global steps in turn: `N_gᵀ` of every group, and the energy after each round.
    fn alternate(&self, target: &Target, mut each: impl FnMut(&[DMat3])) -> (Vec<DMat3>, Vec<f64>) {
        let mut turns = vec![DMat3::ZERO; self.groups.len()];
        let mut response = self.response(target, &turns);
        let mut energies = vec![self.energy(target, &turns, &response)];
        each(&turns);
        for _ in 0..self.parameters.rounds {
            let next: Vec<DMat3> = self
                .groups
                .iter()
                .zip(&response)
                .map(|(group, s)| polar::rotation(s.transpose() + group.p).transpose() - DMat3::IDENTITY)
                .collect();
            let answer = self.response(target, &next);
            let energy = self.energy(target, &next, &answer);
            let before = energies[energies.len() - 1];
            // What is left is rounding.
            if energy.is_nan() || energy >= before {
                break;
            }
            (turns, response) = (next, answer);
            energies.push(energy);
            each(&turns);
            if before - energy <= self.parameters.tolerance * before + NOTHING {
                break;
            }
        }
        (turns, energies)
    }

    /// `K_gᵀ X` of every group, X being the best for the given `N_gᵀ`.
    fn response(&self, target: &Target, turns: &[DMat3]) -> Vec<DMat3> {
        let n = self.groups.len();
        let mut response = target.pull.clone();
        for (g, sum) in response.iter_mut().enumerate() {
            for (h, turn) in turns.iter().enumerate() {
                let block = |i: usize, j: usize| self.coupling[(3 * g + i) * 3 * n + 3 * h + j];
                let column = |j| DVec3::new(block(0, j), block(1, j), block(2, j));
                *sum += DMat3::from_cols(column(0), column(1), column(2)) * *turn;
            }
        }
        response
    }

    /// The energy at the best X for the given `N_gᵀ`.
    fn energy(&self, target: &Target, turns: &[DMat3], response: &[DMat3]) -> f64 {
        let mut energy = target.constant;
        for (g, turn) in turns.iter().enumerate() {
            energy += dot(turn, &(self.groups[g].p * *turn)) - dot(turn, &(target.pull[g] + response[g]));
        }
        energy.max(0.0)
    }

    fn solution(&self, target: &Target, turns: &[DMat3]) -> Vec<[f64; 3]> {
        let mut x = target.x.clone();
        for (answer, turn) in self.answers.iter().zip(turns) {
            for (row, y) in x.iter_mut().zip(answer) {
                let add = turn.transpose() * DVec3::from_array(*y);
                (0..3).for_each(|i| row[i] += add[i]);
            }
        }
        x
    }

    /// Mean distance between `Φ X` and the displacements, in unit-sphere radii.
    fn error(&self, placed: &Placed, x: &[[f64; 3]]) -> f64 {
        let x = as_axes(x);
        let mut sum = 0.0;
        for (v, (&m, &wanted)) in self.mass.iter().zip(&placed.displacements).enumerate() {
            if m <= 0.0 {
                continue;
            }
            sum += m * self.functions.at(v, &x).distance(wanted);
        }
        if self.total > 0.0 { sum / self.total } else { 0.0 }
    }

    /// The maps in mesh units.
    fn maps(&self, motion: &RigidMotion, x: &[[f64; 3]]) -> Vec<DAffine3> {
        let map = |(x, &at): (&[[f64; 3]], &DVec3)| {
            let rows = [0, 1, 2, 3].map(|i| DVec3::from_array(x[i]));
            let linear = DMat3::from_cols(rows[0], rows[1], rows[2]);
            // Next to the reference: y ↦ y + linear (y − c) + shift, in the unit sphere.
            let here = DMat3::IDENTITY + linear;
            let shift = rows[3] - linear * at;
            let matrix3 = motion.rotation * here;
            let translation = motion.translation + motion.rotation * (shift * self.radius) - matrix3 * self.centre;
            DAffine3 { matrix3, translation }
        };
        x.chunks_exact(4).zip(&self.at).map(map).collect()
    }
}

/// `kᵀ x` of two n × 3 matrices.
fn transposed_product(k: &[[f64; 3]], x: &[[f64; 3]]) -> DMat3 {
    let mut sum = DMat3::ZERO;
    for (k, x) in k.iter().zip(x) {
        sum += outer(DVec3::from_array(*k), DVec3::from_array(*x));
    }
    sum
}

/// `Kᵀ A⁻¹ K`, which is symmetric.
fn coupling(groups: &[Group], answers: &[Vec<[f64; 3]>]) -> Vec<f64> {
    let n = 3 * groups.len();
    let mut coupling = vec![0.0; n * n];
    for (g, group) in groups.iter().enumerate() {
        for (h, answer) in answers.iter().enumerate().take(g + 1) {
            let block = transposed_product(&group.k, answer).to_cols_array_2d();
            for (j, column) in block.iter().enumerate() {
                for (i, &value) in column.iter().enumerate() {
                    let (row, column) = (3 * g + i, 3 * h + j);
                    coupling[row * n + column] = value;
                    coupling[column * n + row] = value;
                }
            }
        }
    }
    coupling
}

/// Sum of the products of entries.
fn dot(a: &DMat3, b: &DMat3) -> f64 {
    a.x_axis.dot(b.x_axis) + a.y_axis.dot(b.y_axis) + a.z_axis.dot(b.z_axis)
}
