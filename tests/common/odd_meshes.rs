//! Meshes as nobody wants them, small enough to be tried with everything.

use glam::{DQuat, DVec3};
use sinew::sequence::{Pose, Sequence};

/// Faces and positions.
pub type Mesh = (Vec<[u32; 3]>, Vec<DVec3>);

/// A sequence of the given positions.
pub fn sequence(name: &str, faces: &[[u32; 3]], reference: &[DVec3], poses: &[Vec<DVec3>]) -> Sequence {
    let pose = |(i, positions): (usize, &Vec<DVec3>)| Pose {
        name: format!("pose {i}"),
        time: i as f64 / 12.0,
        positions: positions.clone(),
    };
    let poses = poses.iter().enumerate().map(pose).collect();
    Sequence::new(name, faces.to_vec(), reference.to_vec(), poses).expect("a sequence")
}

/// An open tube along x, four units long, of `rings` rings of eight vertices.
pub fn tube(rings: u32) -> Mesh {
    let point = |i: u32| {
        let angle = f64::from(i % 8) * std::f64::consts::FRAC_PI_4;
        DVec3::new(4.0 * f64::from(i / 8) / f64::from(rings - 1), 0.5 * angle.cos(), 0.5 * angle.sin())
    };
    let mut faces = Vec::new();
    for (ring, side) in (0..rings - 1).flat_map(|ring| (0..8).map(move |side| (ring, side))) {
        let [a, b] = [8 * ring + side, 8 * ring + (side + 1) % 8];
        faces.extend([[a, b, a + 8], [b, b + 8, a + 8]]);
    }
    (faces, (0..8 * rings).map(point).collect())
}

/// The same, closed at both ends.
pub fn closed_tube(rings: u32) -> Mesh {
    let (mut faces, mut points) = tube(rings);
    let [first, last] = [points.len() as u32, points.len() as u32 + 1];
    points.extend([DVec3::new(-0.2, 0.0, 0.0), DVec3::new(4.2, 0.0, 0.0)]);
    let end = 8 * (rings - 1);
    faces.extend((0..8).flat_map(|side| {
        let next = (side + 1) % 8;
        [[first, next, side], [last, end + side, end + next]]
    }));
    (faces, points)
}

/// A flat square of `side` × `side` vertices.
pub fn grid(side: u32) -> Mesh {
    let points = (0..side * side).map(|i| DVec3::new(f64::from(i % side), f64::from(i / side), 0.0)).collect();
    let mut faces = Vec::new();
    for (x, y) in (0..side - 1).flat_map(|x| (0..side - 1).map(move |y| (x, y))) {
        let a = y * side + x;
        faces.extend([[a, a + 1, a + side], [a + 1, a + side + 1, a + side]]);
    }
    (faces, points)
}

/// `count` tetrahedra in rows, no two of which share a vertex.
pub fn crowd(count: u32) -> Mesh {
    let (mut faces, mut points) = (Vec::new(), Vec::new());
    for i in 0..count {
        let at = DVec3::new(f64::from(i % 20), f64::from(i / 20), 0.0) * 1.5;
        points.extend([DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z].map(|p| at + p));
        faces.extend([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|f: [u32; 3]| f.map(|v| v + 4 * i)));
    }
    (faces, points)
}

/// `count` poses that bend a mesh about z, the farther along x the more, up to one radian a unit at the last.
pub fn bent(points: &[DVec3], count: usize) -> Vec<Vec<DVec3>> {
    let pose = |k: usize| {
        let strength = (k + 1) as f64 / count as f64;
        let bend = |p: &DVec3| DQuat::from_rotation_z(strength * (0.5 * p.x).clamp(-3.0, 3.0)) * *p;
        points.iter().map(bend).collect()
    };
    (0..count).map(pose).collect()
}

/// A bending mesh.
fn bending(name: &str, (faces, points): Mesh) -> Sequence {
    sequence(name, &faces, &points, &bent(&points, 4))
}

/// Vertices changed in the reference and in every pose.
fn with(sequence: &Sequence, name: &str, change: impl Fn(usize, DVec3) -> DVec3) -> Sequence {
    let all = |points: &[DVec3]| points.iter().enumerate().map(|(v, &p)| change(v, p)).collect::<Vec<_>>();
    let poses: Vec<Vec<DVec3>> = sequence.poses().iter().map(|pose| all(&pose.positions)).collect();
    self::sequence(name, sequence.faces(), &all(sequence.reference()), &poses)
}

/// A healthy mesh to put beside the others.
pub fn healthy() -> Sequence {
    bending("healthy", closed_tube(12))
}

/// All of them.
pub fn all() -> Vec<Sequence> {
    let mut list = vec![healthy()];
    list.extend(few_faces());
    list.extend(pieces());
    list.extend(edges());
    list.extend(areas());
    list.extend(motions());
    list.extend(sizes());
    list
}

fn few_faces() -> Vec<Sequence> {
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.4)];
    let one: &[[u32; 3]] = &[[0, 1, 2]];
    let two: &[[u32; 3]] = &[[0, 1, 2], [1, 3, 2]];
    vec![
        sequence("nothing", &[], &[], &[]),
        sequence("nothing in poses", &[], &[], &[vec![], vec![]]),
        sequence("no face", &[], &points, &bent(&points, 2)),
        sequence("one face, still", one, &points, &[]),
        sequence("one face", one, &points[..3], &bent(&points[..3], 3)),
        sequence("two faces, still", two, &points, &[]),
        sequence("two faces, one pose", two, &points, &bent(&points, 1)),
        sequence("two faces", two, &points, &bent(&points, 4)),
    ]
}

fn pieces() -> Vec<Sequence> {
    let (faces, points) = crowd(300);
    // Every third piece stands still, the others turn, each about an axis of its own.
    let pose = |k: usize| {
        let turn = |(v, p): (usize, &DVec3)| {
            let piece = v / 4;
            let axis = DVec3::new((piece as f64).sin(), (piece as f64).cos(), 0.5).normalize();
            let still = piece % 3 == 0;
            let centre = points[4 * piece];
            if still { *p } else { centre + DQuat::from_axis_angle(axis, 0.4 * (k + 1) as f64) * (*p - centre) }
        };
        points.iter().enumerate().map(turn).collect::<Vec<_>>()
    };
    let poses: Vec<_> = (0..3).map(pose).collect();
    let hundreds = sequence("hundreds of pieces", &faces, &points, &poses);

    let (mut faces, mut points) = closed_tube(8);
    let moved = points.len() as u32;
    let (more, still) = closed_tube(6);
    faces.extend(more.iter().map(|face| face.map(|v| v + moved)));
    points.extend(still.iter().map(|p| *p + 3.0 * DVec3::Y));
    let mut poses = bent(&points, 4);
    for pose in &mut poses {
        pose[moved as usize..].copy_from_slice(&points[moved as usize..]);
    }
    let half = sequence("a piece that does not move", &faces, &points, &poses);

    // Every face with corners of its own.
    let (faces, points) = closed_tube(8);
    let corners: Vec<DVec3> = faces.iter().flatten().map(|&v| points[v as usize]).collect();
    let loose: Vec<[u32; 3]> = (0..faces.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
    let soup = bending("a soup of triangles", (loose.clone(), corners.clone()));
    let mut apart = bent(&corners, 3);
    for (k, pose) in apart.iter_mut().enumerate() {
        pose.iter_mut().enumerate().for_each(|(v, p)| *p += 0.1 * (k + 1) as f64 * ((v / 3) as f64).sin() * DVec3::Z);
    }
    vec![hundreds, half, soup, sequence("a soup that flies apart", &loose, &corners, &apart)]
}

fn edges() -> Vec<Sequence> {
    let (mut holed, points) = grid(9);
    // Two holes in the sheet, which touch at a corner.
    holed.retain(|face| {
        let middle = face.iter().map(|&v| points[v as usize]).sum::<DVec3>() / 3.0;
        let cell = (middle.x as u32, middle.y as u32);
        !((2..4).contains(&cell.0) && (2..4).contains(&cell.1) || (4..6).contains(&cell.0) && (4..6).contains(&cell.1))
    });
    let holes = bending("holes", (holed, points));

    // Five pages on one spine of four edges.
    let mut points: Vec<DVec3> = (0..5).map(|i| DVec3::X * f64::from(i)).collect();
    let mut pages = Vec::new();
    for page in 0..5 {
        let first = points.len() as u32;
        let out = DQuat::from_rotation_x(f64::from(page) * 1.2) * DVec3::Y;
        points.extend((0..5).map(|i| DVec3::X * f64::from(i) + out));
        pages.extend((0..4).flat_map(|i| [[i, i + 1, first + i], [i + 1, first + i + 1, first + i]]));
    }
    let book = bending("edges with five faces", (pages, points));

    let (mut faces, points) = closed_tube(8);
    faces.extend_from_within(3..20);
    faces.extend(faces[30..35].to_vec().iter().map(|&[a, b, c]| [b, a, c]));
    let twice = bending("faces twice", (faces, points));

    let (mut faces, points) = closed_tube(10);
    for face in faces.iter_mut().skip(40).take(30) {
        face.swap(0, 1);
    }
    let flipped = bending("flipped faces", (faces, points));

    // A band with half a turn: no way of winding agrees everywhere.
    let points: Vec<DVec3> = (0..48)
        .map(|i| {
            let angle = f64::from(i / 2) / 24.0 * std::f64::consts::TAU;
            let across = if i % 2 == 0 { 0.4 } else { -0.4 };
            let out = DVec3::new(angle.cos(), angle.sin(), 0.0);
            2.0 * out + across * ((0.5 * angle).cos() * DVec3::Z + (0.5 * angle).sin() * out)
        })
        .collect();
    let mut band: Vec<[u32; 3]> =
        (0..46).map(|i| if i % 2 == 0 { [i, i + 1, i + 2] } else { [i, i + 2, i + 1] }).collect();
    band.extend([[46, 47, 1], [47, 0, 1]]);
    let moebius = bending("a band with half a turn", (band, points));

    let tips: Vec<DVec3> = [
        DVec3::ZERO,
        DVec3::new(1., 1., 0.),
        DVec3::new(1., -1., 0.),
        DVec3::new(-1., 1., 0.),
        DVec3::new(-1., -1., 0.),
    ]
    .to_vec();
    let bow = bending("two faces that touch at a corner", (vec![[0, 2, 1], [0, 3, 4]], tips));
    vec![holes, book, twice, flipped, moebius, bow]
}

fn areas() -> Vec<Sequence> {
    let (mut faces, mut points) = closed_tube(8);
    // A corner named twice, a line of three corners, and a point.
    let first = points.len() as u32;
    points.extend([points[0], 0.5 * points[0] + 0.5 * points[1], points[1], points[5], points[5]]);
    faces.extend([[0, 0, 1], [3, 3, 3], [first, first + 1, first + 2], [0, first + 1, 1], [5, first + 3, first + 4]]);
    let zero = bending("faces without area", (faces, points));

    let line: Vec<DVec3> = (0..12).map(|i| DVec3::X * f64::from(i)).collect();
    let along: Vec<[u32; 3]> = (0..10).map(|i| [i, i + 1, i + 2]).collect();
    let (tube, round) = closed_tube(6);
    let point = vec![DVec3::new(1.0, 2.0, 3.0); round.len()];

    let (fan, mut rim) = (
        (1..40).map(|i| [0, i, i + 1]).collect::<Vec<[u32; 3]>>(),
        (0..40).map(|i| DVec3::new(20.0, 0.01 * f64::from(i), 0.0)).collect::<Vec<_>>(),
    );
    rim.insert(0, DVec3::ZERO);
    vec![
        zero,
        bending("all on a line", (along, line)),
        sequence("all in one point", &tube, &point, &[point.clone(), point.clone()]),
        sequence("from a point", &tube, &point, &bent(&round, 3)),
        sequence("into a point", &tube, &round, &[round.clone(), point.clone()]),
        bending("slivers", (fan, rim)),
    ]
}

fn motions() -> Vec<Sequence> {
    let (faces, points) = closed_tube(8);
    // A tube has a mirror image that is a turn of itself; one that winds like a screw has none.
    let screw: Vec<DVec3> = points.iter().map(|p| *p + DVec3::new(0.0, (1.5 * p.x).sin(), (1.5 * p.x).cos())).collect();
    let mut mirror = bent(&screw, 4);
    mirror[2].iter_mut().for_each(|p| p.x = -p.x);
    let flat: Vec<DVec3> = points.iter().map(|p| DVec3::new(p.x, p.y, 0.0)).collect();
    // Every vertex somewhere else.
    let noise = |k: usize| {
        let at = |v: usize, i: usize| (12.9898 * (v * 7 + i * 3 + k * 11) as f64).sin() * 43_758.545_3 % 1.0;
        (0..points.len()).map(|v| DVec3::new(at(v, 0), at(v, 1), at(v, 2))).collect::<Vec<_>>()
    };
    vec![
        sequence("still", &faces, &points, &[]),
        sequence("poses that are the reference", &faces, &points, &vec![points.clone(); 3]),
        sequence("one pose", &faces, &points, &bent(&points, 1)),
        sequence("a mirrored pose", &faces, &screw, &mirror),
        sequence("a flat pose", &faces, &points, &[flat]),
        sequence("noise", &faces, &points, &(0..4).map(noise).collect::<Vec<_>>()),
    ]
}

fn sizes() -> Vec<Sequence> {
    let (faces, points) = closed_tube(8);
    let tube = sequence("tube", &faces, &points, &bent(&points, 3));
    let scaled = |name: &str, size: f64| with(&tube, name, |_, p| p * size);
    let far = with(&tube, "one vertex far away", |v, p| if v == 17 { p * 1e6 } else { p });
    let shifted = with(&tube, "far from the origin", |_, p| p + DVec3::splat(1e7));
    // Vertices that no face uses, one of them very far away.
    let mut more = points.clone();
    more.splice(0..0, (0..20).map(|i| DVec3::splat(if i == 7 { 1e9 } else { f64::from(i) })));
    let moved: Vec<[u32; 3]> = faces.iter().map(|face| face.map(|v| v + 20)).collect();
    let unused = sequence("vertices without a face", &moved, &more, &bent(&more, 3));
    let explodes = sequence(
        "a pose that explodes",
        &faces,
        &points,
        &[points.clone(), points.iter().enumerate().map(|(v, &p)| if v % 5 == 0 { p * 1e12 } else { p }).collect()],
    );
    vec![
        far,
        shifted,
        unused,
        explodes,
        scaled("tiny", 1e-30),
        scaled("huge", 1e30),
        scaled("too tiny for squares", 1e-200),
        scaled("too huge for squares", 1e200),
    ]
}
