//! Eigenvectors of small symmetric matrices by cyclic Jacobi rotations: slow for large matrices, but accurate for every
//! input, repeated and zero eigenvalues included.
//!
//! Gene H. Golub, Charles F. Van Loan. Matrix Computations, 4th edition, §8.5.

/// The largest eigenvalue of a symmetric matrix and a unit eigenvector of it. Where the eigenvalue is repeated, one of
/// its eigenvectors; for the zero matrix, the first axis.
pub fn largest_eigenpair<const N: usize>(a: [[f64; N]; N]) -> (f64, [f64; N]) {
    let (values, v) = eigen(a, 1e-16);
    let largest = (1..N).fold(0, |best, i| if values[i] > values[best] { i } else { best });
    (values[largest], std::array::from_fn(|i| v[i][largest]))
}

/// The eigenvalues of a symmetric matrix and, in the columns of a rotation, its eigenvectors, which stay as near to
/// the axes as they can: no rotation is by more than 45°, and there is none where what lies off the diagonal is no
/// more than `negligible` times the norm of the matrix. So equal eigenvalues leave their axes alone.
pub fn eigen<const N: usize>(mut a: [[f64; N]; N], negligible: f64) -> ([f64; N], [[f64; N]; N]) {
    let mut v = [[0.0; N]; N];
    for (i, row) in v.iter_mut().enumerate() {
        row[i] = 1.0;
    }
    let size: f64 = a.iter().flatten().map(|x| x * x).sum();
    for _sweep in 0..30 {
        let off: f64 = (0..N).flat_map(|p| (p + 1..N).map(move |q| (p, q))).map(|(p, q)| a[p][q] * a[p][q]).sum();
        if off <= negligible * negligible * size {
            break;
        }
        for p in 0..N {
            for q in p + 1..N {
                rotate(&mut a, &mut v, p, q);
            }
        }
    }
    (std::array::from_fn(|i| a[i][i]), v)
}

/// Makes `a[p][q]` zero by a rotation in the plane of axes p and q, collected in the columns of `v`.
fn rotate<const N: usize>(a: &mut [[f64; N]; N], v: &mut [[f64; N]; N], p: usize, q: usize) {
    if a[p][q] == 0.0 {
        return;
    }
    let theta = (a[q][q] - a[p][p]) / (2.0 * a[p][q]);
    let t = if theta.is_finite() { theta.signum() / (theta.abs() + (theta * theta + 1.0).sqrt()) } else { 0.0 };
    let c = 1.0 / (t * t + 1.0).sqrt();
    let s = t * c;
    let turned = |x: f64, y: f64| (c * x - s * y, s * x + c * y);
    for row in a.iter_mut().chain(v.iter_mut()) {
        (row[p], row[q]) = turned(row[p], row[q]);
    }
    let (above, below) = (a[p], a[q]);
    for (k, (x, y)) in above.into_iter().zip(below).enumerate() {
        (a[p][k], a[q][k]) = turned(x, y);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn the_vector_reaches_the_largest_rayleigh_quotient(
            m in prop::array::uniform4(prop::array::uniform4(-2.0..2.0f64)), rank_one in any::<bool>(),
        ) {
            let a: [[f64; 4]; 4] = std::array::from_fn(|i| std::array::from_fn(|j| {
                if rank_one { m[0][i] * m[0][j] } else { m[i][j] + m[j][i] }
            }));
            let (value, v) = largest_eigenpair(a);
            let times: [f64; 4] = std::array::from_fn(|i| (0..4).map(|j| a[i][j] * v[j]).sum());
            let lambda: f64 = (0..4).map(|i| v[i] * times[i]).sum();
            let oracle = nalgebra::Matrix4::from_fn(|i, j| a[i][j]).symmetric_eigenvalues().max();
            prop_assert!((lambda - oracle).abs() < 1e-9 && (value - oracle).abs() < 1e-9);
            for i in 0..4 {
                prop_assert!((times[i] - lambda * v[i]).abs() < 1e-9);
            }
        }
    }
}
