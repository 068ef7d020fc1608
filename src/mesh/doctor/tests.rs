//! A mesh for each finding, and none for a healthy one.

use super::*;
use std::f64::consts::TAU;

/// A closed tube along x of 12 rings of 8 points.
fn tube() -> (Vec<[u32; 3]>, Vec<DVec3>) {
    let ring = |i: u32| f64::from(i % 8) * TAU / 8.0;
    let mut points: Vec<DVec3> =
        (0..96).map(|i| DVec3::new(0.4 * f64::from(i / 8), ring(i).cos(), ring(i).sin())).collect();
    points.extend([DVec3::new(-0.3, 0.0, 0.0), DVec3::new(4.7, 0.0, 0.0)]);
    let mut faces = Vec::new();
    for i in 0..88 {
        let next = i / 8 * 8 + (i + 1) % 8;
        faces.extend([[i, next, i + 8], [next, next + 8, i + 8]]);
    }
    faces.extend((0..8).flat_map(|i| [[96, (i + 1) % 8, i], [97, 88 + i, 88 + (i + 1) % 8]]));
    (faces, points)
}

fn codes(diagnosis: &Diagnosis) -> Vec<Code> {
    diagnosis.findings.iter().map(|finding| finding.code).collect()
}

fn examined(faces: &[[u32; 3]], reference: &[DVec3], poses: &[Vec<DVec3>]) -> Diagnosis {
    Diagnosis::of_mesh(&Mesh { faces, reference, poses: poses.iter().map(Vec::as_slice).collect() }, &[])
}

/// Count and number of faces of a finding that must be there.
fn found(diagnosis: &Diagnosis, code: Code) -> (usize, usize) {
    let finding = diagnosis.finding(code).unwrap_or_else(|| panic!("no {code:?} in {:?}", codes(diagnosis)));
    assert!(!finding.what.is_empty() && !finding.done.is_empty() && !finding.means.is_empty());
    assert!(finding.faces.is_sorted());
    (finding.count, finding.faces.len())
}

#[test]
fn a_healthy_mesh_has_nothing() {
    let (faces, points) = tube();
    let bent: Vec<DVec3> = points.iter().map(|p| glam::DQuat::from_rotation_y(0.2 * p.x) * *p).collect();
    let diagnosis = examined(&faces, &points, &[bent]);
    assert_eq!(codes(&diagnosis), []);
    assert_eq!(diagnosis.summary, "Nothing is wrong with this mesh.");
}

#[test]
fn a_diagnosis_survives_being_written_down() {
    let diagnosis = examined(&[[0, 1, 2]], &[DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z], &[]);
    assert_eq!(codes(&diagnosis), [Code::Holes, Code::UnusedVertices]);
    assert_eq!(diagnosis.summary, "Nothing here disturbs the result.");
    let text = serde_json::to_string(&diagnosis).unwrap();
    assert!(text.contains("\"unused-vertices\"") && text.contains("\"harmless\""), "{text}");
    assert_eq!(serde_json::from_str::<Diagnosis>(&text).unwrap(), diagnosis);
}

#[test]
fn holes_are_counted_one_by_one() {
    let (mut faces, points) = tube();
    faces.remove(60);
    faces.remove(20);
    faces.truncate(faces.len() - 2);
    let diagnosis = examined(&faces, &points, &[]);
    // Two single faces, and one neighbouring face at each end.
    assert_eq!(found(&diagnosis, Code::Holes), (4, 12));
}

#[test]
fn crowded_edges_and_copies_are_told_apart() {
    let (mut faces, mut points) = tube();
    points.push(DVec3::new(2.0, 3.0, 0.0));
    faces.push([40, 48, 98]);
    let diagnosis = examined(&faces, &points, &[]);
    assert_eq!(found(&diagnosis, Code::CrowdedEdges), (1, 3));
    assert_eq!(found(&diagnosis, Code::Holes), (1, 1));
    let (mut faces, points) = tube();
    faces.extend([faces[7], [faces[9][1], faces[9][0], faces[9][2]]]);
    let diagnosis = examined(&faces, &points, &[]);
    assert_eq!(codes(&diagnosis), [Code::DuplicateFaces]);
    assert_eq!(diagnosis.findings[0].faces, [faces.len() as u32 - 2, faces.len() as u32 - 1]);
}

#[test]
fn the_minority_is_flipped() {
    let (mut faces, points) = tube();
    (50..60).for_each(|f: usize| faces[f].swap(0, 1));
    let diagnosis = examined(&faces, &points, &[]);
    assert_eq!(codes(&diagnosis), [Code::FlippedFaces]);
    assert_eq!(diagnosis.findings[0].faces, (50..60).collect::<Vec<u32>>());
    faces.iter_mut().for_each(|face| face.swap(0, 1));
    let diagnosis = examined(&faces, &points, &[]);
    assert_eq!(found(&diagnosis, Code::InsideOut), (1, faces.len()));
    assert_eq!(found(&diagnosis, Code::FlippedFaces), (10, 10));
}

#[test]
fn a_band_with_half_a_turn_has_one_side() {
    let points: Vec<DVec3> = (0..40)
        .map(|i| {
            let (angle, across) = (f64::from(i / 2) / 20.0 * TAU, if i % 2 == 0 { 0.4 } else { -0.4 });
            let out = DVec3::new(angle.cos(), angle.sin(), 0.0);
            2.0 * out + across * ((0.5 * angle).cos() * DVec3::Z + (0.5 * angle).sin() * out)
        })
        .collect();
    let mut faces: Vec<[u32; 3]> = (0..38).map(|i| [i, i + 1, i + 2]).collect();
    faces.iter_mut().skip(1).step_by(2).for_each(|face| face.swap(0, 1));
    faces.extend([[38, 39, 1], [39, 0, 1]]);
    let diagnosis = examined(&faces, &points, &[]);
    assert_eq!(found(&diagnosis, Code::OneSided), (1, 40));
    assert_eq!(found(&diagnosis, Code::Holes).0, 1);
}

#[test]
fn sheets_back_to_back_have_no_direction() {
    let points = [DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::new(1.0, 1.0, 0.0)];
    let diagnosis = examined(&[[0, 1, 2], [1, 3, 2], [0, 2, 1], [1, 2, 3]], &points, &[]);
    assert_eq!(found(&diagnosis, Code::ContradictingNormals), (4, 4));
}

#[test]
fn areas() {
    let (mut faces, mut points) = tube();
    points.push(0.5 * (points[3] + points[4]));
    faces.extend([[3, 98, 4], [3, 3, 4], [5, 5, 5]]);
    let diagnosis = examined(&faces, &points, &[]);
    assert_eq!(found(&diagnosis, Code::DegenerateFaces), (3, 3));
    assert!(diagnosis.finding(Code::DegenerateFaces).unwrap().done.starts_with("2 of them name"));
    let needle = [DVec3::ZERO, DVec3::X, DVec3::new(0.5, 0.01, 0.0)];
    assert_eq!(found(&examined(&[[0, 1, 2]], &needle, &[]), Code::Slivers), (1, 1));
}

#[test]
fn pieces_and_what_stands_still() {
    let (mut faces, mut points) = tube();
    let count = faces.len();
    faces.extend(faces.clone().iter().map(|face| face.map(|v| v + 98)));
    points.extend(points.clone().iter().map(|p| *p + 5.0 * DVec3::Y));
    let pose: Vec<DVec3> =
        points.iter().enumerate().map(|(v, p)| *p + if v < 98 { DVec3::X } else { DVec3::ZERO }).collect();
    let diagnosis = examined(&faces, &points, &[pose]);
    assert_eq!(found(&diagnosis, Code::Pieces), (2, count));
    assert_eq!(found(&diagnosis, Code::StillPieces), (1, count));
    assert!(diagnosis.finding(Code::StillPieces).unwrap().faces.iter().all(|&f| f as usize >= count));
}

#[test]
fn seams_are_no_holes() {
    let (faces, points) = tube();
    let corners: Vec<DVec3> = faces.iter().flatten().map(|&v| points[v as usize]).collect();
    let loose: Vec<[u32; 3]> = (0..faces.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
    let diagnosis = examined(&loose, &corners, &[]);
    assert_eq!(codes(&diagnosis), [Code::Seams]);
    assert_eq!(found(&diagnosis, Code::Seams), (corners.len() - points.len(), faces.len()));
    let notes =
        [Warning::new("welded", "70 vertices were joined."), Warning::new("collapsed-faces", "3 faces were left out.")];
    let diagnosis = Diagnosis::of_mesh(&Mesh { faces: &faces, reference: &points, poses: Vec::new() }, &notes);
    assert_eq!(found(&diagnosis, Code::Welded), (70, 0));
    assert_eq!(found(&diagnosis, Code::DegenerateFaces), (3, 0));
}

#[test]
fn poses_that_no_motion_explains() {
    let (faces, points) = tube();
    let mirrored: Vec<DVec3> = points.iter().map(|p| DVec3::new(p.x, p.y * (1.0 + 0.3 * p.x), p.z)).collect();
    let lopsided = mirrored.clone();
    let mirrored: Vec<DVec3> = mirrored.iter().map(|p| DVec3::new(-p.x, p.y + 0.2 * p.x * p.x, p.z)).collect();
    let mut apart = points.clone();
    apart[11] *= 1e6;
    let mut pushed = points.clone();
    pushed[50].x += 1.5;
    let mut shrunk = points.clone();
    shrunk[20] = shrunk[21];
    let reference: Vec<DVec3> = lopsided.iter().map(|p| DVec3::new(p.x, p.y + 0.2 * p.x * p.x, p.z)).collect();
    assert_eq!(found(&examined(&faces, &reference, &[mirrored, reference.clone()]), Code::MirroredPoses), (1, 0));
    let diagnosis = examined(&faces, &points, &[points.clone(), apart]);
    assert_eq!(found(&diagnosis, Code::ExplodingPoses), (1, 6));
    assert!(found(&examined(&faces, &points, &[pushed]), Code::TurnedOver).0 > 0);
    assert_eq!(found(&examined(&faces, &points, &[shrunk]), Code::Vanishing), (2, 2));
    // Going away as a whole is no explosion.
    let away = points.iter().map(|p| *p + DVec3::splat(1e3)).collect();
    assert_eq!(codes(&examined(&faces, &points, &[away])), []);
}

#[test]
fn what_lies_far_away_or_nowhere() {
    let (faces, mut points) = tube();
    points[33] *= 1e5;
    let diagnosis = examined(&faces, &points, &[]);
    assert_eq!(found(&diagnosis, Code::FarVertices), (1, 6));
    assert_eq!(diagnosis.findings[0].severity, Severity::Grave);
    points[33] = DVec3::NAN;
    points[34].x = f64::INFINITY;
    let diagnosis = examined(&faces, &points, &[points.clone()]);
    assert_eq!(found(&diagnosis, Code::NotFinite).0, 2);
    assert_eq!(diagnosis.finding(Code::FarVertices), None);
}

#[test]
fn digits_are_lost_far_from_the_origin() {
    let (faces, points) = tube();
    let at = |far: f64| points.iter().map(|p| *p + DVec3::splat(far)).collect::<Vec<_>>();
    assert_eq!(codes(&examined(&faces, &at(100.0), &[])), []);
    for (far, severity) in [(1e4, Severity::Care), (1e6, Severity::Grave)] {
        let diagnosis = examined(&faces, &at(far), &[]);
        assert_eq!(codes(&diagnosis), [Code::FarFromOrigin], "{far}");
        assert_eq!(diagnosis.findings[0].severity, severity);
    }
}

#[test]
fn nothing_is_no_mesh_and_wrong_numbers_are_passed_over() {
    assert_eq!(codes(&examined(&[], &[], &[])), []);
    assert_eq!(codes(&examined(&[[0, 1, 2]], &[], &[vec![]])), []);
    let diagnosis = examined(&[[0, 1, 9], [0, 1, 2]], &[DVec3::ZERO, DVec3::X, DVec3::Y], &[vec![DVec3::ZERO]]);
    assert_eq!(found(&diagnosis, Code::DegenerateFaces), (1, 1));
}

#[test]
fn faces_are_turned_outwards() {
    let horse =
        crate::zoo::make(&crate::zoo::Recipe { name: "horse".into(), faces: 2000, poses: 1, ..Default::default() });
    let horse = horse.expect("a horse").sequence;
    let (faces, positions) = (horse.faces(), horse.reference());
    assert_eq!(outward(faces, positions), faces);
    let over = |&[a, b, c]: &[u32; 3]| [a, c, b];
    let around = |f: [u32; 3]| (0..3).map(|i| [f[i], f[(i + 1) % 3], f[(i + 2) % 3]]).min();
    let alike = |a: &[[u32; 3]], b: &[[u32; 3]]| a.iter().zip(b).all(|(&a, &b)| around(a) == around(b));
    // All, some, and all but a hole.
    let wrong: Vec<[u32; 3]> = faces.iter().map(over).collect();
    assert!(alike(&outward(&wrong, positions), faces));
    let some: Vec<[u32; 3]> =
        faces.iter().enumerate().map(|(f, face)| if f % 5 == 0 { over(face) } else { *face }).collect();
    assert!(alike(&outward(&some, positions), faces));
    assert!(alike(&outward(&wrong[3..], positions), &faces[3..]));
    // There twice, the same way round or both ways.
    for second in [&wrong[..], faces] {
        let twice: Vec<[u32; 3]> = wrong.iter().chain(second).copied().collect();
        let out = outward(&twice, positions);
        assert!(alike(&out[..faces.len()], faces) && alike(&out[faces.len()..], faces));
    }
    // What has no inside, or is no face, stays.
    let open = [[0, 1, 2], [0, 2, 3], [9, 9, 9_999_999]];
    let square = [DVec3::ZERO, DVec3::X, DVec3::new(1.0, 1.0, 0.5), DVec3::Y];
    assert_eq!(outward(&open, &square), open);
    assert!(outward(&[], &[]).is_empty());
}
