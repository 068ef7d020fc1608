//! Bounded biharmonic weights against other solvers of the same problem.
#![cfg(all(feature = "solvers", not(target_arch = "wasm32")))]

#[path = "common/npz.rs"]
mod npz;

use clarabel::algebra::CscMatrix;
use clarabel::solver::{DefaultSettings, DefaultSolver, IPSolver, NonnegativeConeT, SolverStatus, ZeroConeT};
use glam::DVec3;
use sinew::mesh::laplacian::Laplacian;
use sinew::weights::{Biharmonic, Parameters, Weights};

type Mesh = (Vec<[u32; 3]>, Vec<DVec3>);

/// L and M of a mesh.
struct Operators {
    /// Rows of L as (column, value).
    rows: Vec<Vec<(usize, f64)>>,
    mass: Vec<f64>,
}

impl Operators {
    fn new((faces, positions): &Mesh) -> Self {
        let laplacian = Laplacian::new(faces, positions);
        let mut rows: Vec<Vec<(usize, f64)>> = (0..positions.len()).map(|v| vec![(v, 0.0)]).collect();
        for (&[a, b], &c) in laplacian.edges.iter().zip(&laplacian.cotangents) {
            let (a, b) = (a as usize, b as usize);
            rows[a].push((b, -c));
            rows[b].push((a, -c));
            rows[a][0].1 += c;
            rows[b][0].1 += c;
        }
        Self { rows, mass: laplacian.mass }
    }

    fn times(&self, w: &[f64]) -> Vec<f64> {
        self.rows.iter().map(|row| row.iter().map(|&(u, value)| value * w[u]).sum()).collect()
    }

    /// Q w = L M⁻¹ L w.
    fn forces(&self, w: &[f64]) -> Vec<f64> {
        let inner: Vec<f64> = self.times(w).iter().zip(&self.mass).map(|(x, m)| x / m).collect();
        self.times(&inner)
    }

    /// Q, dense, column by column.
    fn matrix(&self) -> Vec<Vec<f64>> {
        let n = self.rows.len();
        let unit = |v: usize| (0..n).map(|u| f64::from(u8::from(u == v))).collect::<Vec<f64>>();
        (0..n).map(|v| self.forces(&unit(v))).collect()
    }

    /// The residual of raw weights as the library defines it.
    fn residual(&self, w: &[f64], handles: &[u32]) -> f64 {
        let forces = self.forces(w);
        let wrong = |v: usize| match (handles.contains(&(v as u32)), w[v]) {
            (true, _) => 0.0,
            (_, w) if w <= 0.0 => (-forces[v]).max(0.0),
            (_, w) if w >= 1.0 => forces[v].max(0.0),
            _ => forces[v].abs(),
        };
        let largest = |values: &mut dyn Iterator<Item = f64>| values.fold(0.0, f64::max);
        largest(&mut (0..w.len()).map(wrong)) / largest(&mut forces.iter().map(|f| f.abs()))
    }
}

/// Least Σ ½ wⱼᵀ Q wⱼ over all columns within bounds, by clarabel: #V × #H, row by row. `fixed` holds the weights that are
/// given. Where `sums` is set, rows sum to one.
fn oracle(q: &[Vec<f64>], fixed: &[Vec<Option<f64>>], sums: bool) -> Vec<f64> {
    let (n, count) = (q.len(), fixed.len());
    let scale = (0..n).map(|v| q[v][v]).fold(0.0, f64::max);
    let unknowns: Vec<(usize, usize)> =
        (0..count).flat_map(|j| (0..n).map(move |v| (j, v))).filter(|&(j, v)| fixed[j][v].is_none()).collect();
    let rows_summed: Vec<usize> = (0..n).filter(|&v| sums && (0..count).any(|j| fixed[j][v].is_none())).collect();
    let given = |j: usize, v: usize| fixed[j][v].unwrap_or(0.0);

    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for (column, &(j, v)) in unknowns.iter().enumerate() {
        for (row, &(i, u)) in unknowns[..=column].iter().enumerate() {
            if i == j && q[v][u] != 0.0 {
                rows.push(row);
                values.push(q[v][u] / scale);
            }
        }
        starts.push(rows.len());
    }
    let quadratic = CscMatrix::new(unknowns.len(), unknowns.len(), starts, rows, values);
    let pull = |&(j, v): &(usize, usize)| (0..n).map(|u| q[v][u] * given(j, u)).sum::<f64>() / scale;
    let linear: Vec<f64> = unknowns.iter().map(pull).collect();

    // Rows: the sums; then −w ≤ 0 and w ≤ 1.
    let (m, s) = (unknowns.len(), rows_summed.len());
    let (mut starts, mut rows, mut values) = (vec![0], Vec::new(), Vec::new());
    for (i, &(_, v)) in unknowns.iter().enumerate() {
        if let Ok(row) = rows_summed.binary_search(&v) {
            rows.push(row);
            values.push(1.0);
        }
        rows.extend([s + i, s + m + i]);
        values.extend([-1.0, 1.0]);
        starts.push(rows.len());
    }
    let constraints = CscMatrix::new(s + 2 * m, m, starts, rows, values);
    let mut right: Vec<f64> = rows_summed.iter().map(|&v| 1.0 - (0..count).map(|j| given(j, v)).sum::<f64>()).collect();
    right.extend(std::iter::repeat_n(0.0, m).chain(std::iter::repeat_n(1.0, m)));
    let cones = [ZeroConeT(s), NonnegativeConeT(2 * m)];
    let tight = 1e-15;
    let settings = DefaultSettings {
        verbose: false,
        tol_gap_abs: tight,
        tol_gap_rel: tight,
        tol_feas: 1e-12,
        tol_ktratio: 1e-12,
        max_iter: 100,
        ..DefaultSettings::default()
    };
    let mut solver =
        DefaultSolver::new(&quadratic, &linear, &constraints, &right, &cones, settings).expect("a problem");
    solver.solve();
    let fine = [SolverStatus::Solved, SolverStatus::AlmostSolved, SolverStatus::InsufficientProgress];
    assert!(fine.contains(&solver.solution.status), "{:?}", solver.solution.status);
    let mut weights: Vec<f64> = (0..n * count).map(|i| given(i % count, i / count)).collect();
    unknowns.iter().zip(&solver.solution.x).for_each(|(&(j, v), &w)| weights[v * count + j] = w);
    weights
}

/// What the handles fix: their own rows and, of each, the pieces that it is not on. `piece` is each vertex's piece.
fn fixed(handles: &[u32], piece: &[usize]) -> Vec<Vec<Option<f64>>> {
    let of = |&handle: &u32| {
        let weight = |v: usize| match handles.contains(&(v as u32)) {
            true => Some(f64::from(u8::from(v as u32 == handle))),
            false if piece[v] != piece[handle as usize] => Some(0.0),
            false => None,
        };
        (0..piece.len()).map(weight).collect()
    };
    handles.iter().map(of).collect()
}

fn grid(columns: u32, rows: u32, at: impl Fn(f64, f64) -> DVec3) -> Mesh {
    let positions = (0..columns * rows).map(|i| at(f64::from(i % columns), f64::from(i / columns))).collect();
    let cells = (0..columns * (rows - 1)).filter(|i| i % columns + 1 != columns);
    let faces = cells.flat_map(|i| [[i, i + 1, i + columns + 1], [i, i + columns + 1, i + columns]]).collect();
    (faces, positions)
}

fn torus(around: u32, across: u32) -> Mesh {
    let at = |i: u32| {
        let turn = std::f64::consts::TAU;
        let (a, b) =
            (turn * f64::from(i / across) / f64::from(around), turn * f64::from(i % across) / f64::from(across));
        let from_axis = 2.0 + 0.8 * b.cos();
        DVec3::new(from_axis * a.cos(), from_axis * a.sin(), 0.8 * b.sin())
    };
    let number = |a: u32, b: u32| (a % around) * across + b % across;
    let cells = (0..around).flat_map(|a| (0..across).map(move |b| (a, b)));
    let faces = cells
        .flat_map(|(a, b)| {
            let [p, q, r, s] = [number(a, b), number(a + 1, b), number(a + 1, b + 1), number(a, b + 1)];
            [[p, q, r], [p, r, s]]
        })
        .collect();
    (faces, (0..around * across).map(at).collect())
}

/// Small meshes, with handles and the piece of every vertex.
fn cases() -> Vec<(&'static str, Mesh, Vec<u32>, Vec<usize>)> {
    let bumpy = grid(13, 11, |x, y| DVec3::new(x, y, (0.9 * x).sin() * (0.7 * y).cos()));
    let obtuse = grid(12, 12, |x, y| DVec3::new(x + 1.7 * y + 0.2 * (y * 2.3).sin(), 0.35 * y, 0.1 * (x * 1.9).cos()));
    let torus = torus(16, 10);
    let mut two = grid(9, 7, |x, y| DVec3::new(x, y, 0.0));
    let other = grid(8, 8, |x, y| DVec3::new(x, 12.0 + y, 0.3 * x * y / 10.0));
    two.0.extend(other.0.iter().map(|face| face.map(|v| v + 63)));
    two.1.extend(other.1);
    let one = |mesh: &Mesh| vec![0; mesh.1.len()];
    let (a, b, c) = (one(&bumpy), one(&obtuse), one(&torus));
    vec![
        ("bumpy", bumpy, vec![14, 50, 97, 128], a),
        ("obtuse", obtuse, vec![0, 66, 130, 101, 19], b),
        ("torus", torus, vec![3, 48, 77], c),
        ("two pieces", two, vec![0, 31, 62, 70, 120], (0..127).map(|v| usize::from(v >= 63)).collect()),
    ]
}

fn weights((faces, positions): &Mesh, handles: &[u32], joint: bool) -> Weights {
    let solver = Biharmonic::new(faces, positions).expect("a mesh");
    solver.weights(handles, &Parameters { joint }).expect("weights")
}

fn apart(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max)
}

/// Rows divided by their sums.
fn shares(raw: &[f64], count: usize) -> Vec<f64> {
    raw.chunks_exact(count).flat_map(|row| row.iter().map(|x| x / row.iter().sum::<f64>())).collect()
}

#[test]
fn the_separate_form_is_what_clarabel_finds() {
    for (name, mesh, handles, piece) in cases() {
        let ours = weights(&mesh, &handles, false);
        let theirs = oracle(&Operators::new(&mesh).matrix(), &fixed(&handles, &piece), false);
        let apart = apart(&ours.values, &shares(&theirs, handles.len()));
        println!("{name}: {apart:.1e} apart, residual {:.1e}", ours.kkt_residual);
        assert!(apart < 1e-6, "{name}: {apart}");
        assert!(ours.kkt_residual < 1e-9, "{name}: {}", ours.kkt_residual);
    }
}

#[test]
fn the_joint_form_is_what_clarabel_finds() {
    for (name, mesh, handles, piece) in cases() {
        let ours = weights(&mesh, &handles, true);
        let separate = weights(&mesh, &handles, false);
        let theirs = oracle(&Operators::new(&mesh).matrix(), &fixed(&handles, &piece), true);
        let (near, far) = (apart(&ours.values, &theirs), apart(&ours.values, &separate.values));
        println!("{name}: {near:.1e} apart, separate {far:.1e}, residual {:.1e}", ours.kkt_residual);
        assert!(near < 1e-6, "{name}: {near}");
        assert!(ours.kkt_residual < 1e-9, "{name}: {}", ours.kkt_residual);
        assert!(far > 1e-3, "{name}: the two forms are not the same problem");
        assert!(ours.values.iter().all(|w| (0.0..=1.0).contains(w)));
    }
}

/// libigl says of weights that they have converged when they have not; where they have, by the residual, they are ours.
#[test]
fn libigl_agrees_where_it_has_converged() {
    let Some(data) = npz::data("libigl's weights") else { return };
    let mut compared = 0;
    for name in ["grid31", "knight502", "bumpy1250", "cactus5261"] {
        let path = data.join(format!("reference/{name}_bbw.npz"));
        let (positions, faces, handles) = (npz::points(&path, "V"), npz::numbers(&path, "F"), npz::numbers(&path, "b"));
        let mesh = (faces.chunks_exact(3).map(|f| [f[0], f[1], f[2]]).collect::<Vec<_>>(), positions);
        let raw = npz::values(&path, "W");
        let operators = Operators::new(&mesh);
        let count = handles.len();
        let column = |j: usize| raw.iter().skip(j).step_by(count).map(|w| w.clamp(0.0, 1.0)).collect::<Vec<f64>>();
        let residuals: Vec<f64> = (0..count).map(|j| operators.residual(&column(j), &handles)).collect();
        let told: Vec<String> = residuals.iter().map(|r| format!("{r:.1e}")).collect();
        println!("{name}: residuals of libigl {}", told.join(", "));
        if residuals.iter().all(|r| *r > 1e-6) {
            continue;
        }
        let ours = weights(&mesh, &handles, false);
        for j in (0..count).filter(|&j| residuals[j] <= 1e-6) {
            let apart = apart(&ours.raw_column(j), &column(j));
            println!("{name} {j}: {apart:.1e} apart");
            assert!(apart < 1e-3, "{name} {j}: {apart}");
            compared += 1;
        }
    }
    assert!(compared > 0, "there is nothing to compare with");
}
