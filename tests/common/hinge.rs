//! A bar that bends in the middle: the smallest mesh with two rigid parts.

/// Points on each ring of the bar.
const AROUND: u32 = 12;

/// Positions and faces of a closed eight-to-one bar along x, from -1 to 1, of `rings` rings.
///
/// An even number of rings leaves none at x = 0, so that one ring of faces takes up the bend.
pub fn bar(rings: u32) -> (Vec<[f64; 3]>, Vec<[u32; 3]>) {
    let mut positions = Vec::new();
    for ring in 0..rings {
        let x = 2.0 * f64::from(ring) / f64::from(rings - 1) - 1.0;
        for point in 0..AROUND {
            let angle = std::f64::consts::TAU * f64::from(point) / f64::from(AROUND);
            positions.push([x, 0.125 * angle.cos(), 0.125 * angle.sin()]);
        }
    }
    let (low, high) = (rings * AROUND, rings * AROUND + 1);
    positions.extend([[-1.0, 0.0, 0.0], [1.0, 0.0, 0.0]]);
    let mut faces = Vec::new();
    for point in 0..AROUND {
        let next = (point + 1) % AROUND;
        for ring in 0..rings - 1 {
            let (near, far) = (ring * AROUND, (ring + 1) * AROUND);
            faces.push([near + point, far + next, far + point]);
            faces.push([near + point, near + next, far + next]);
        }
        faces.push([low, next, point]);
        faces.push([high, (rings - 1) * AROUND + point, (rings - 1) * AROUND + next]);
    }
    (positions, faces)
}

/// The bar with its right half turned by `angle` (radians) about the z axis.
pub fn bend(positions: &[[f64; 3]], angle: f64) -> Vec<[f64; 3]> {
    let (sin, cos) = angle.sin_cos();
    let turn = |&[x, y, z]: &[f64; 3]| if x > 0.0 { [cos * x - sin * y, sin * x + cos * y, z] } else { [x, y, z] };
    positions.iter().map(turn).collect()
}
