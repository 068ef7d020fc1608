//! Several files at once: archives, folders, poses that join a mesh, soups of triangles.

use super::gltf_maker::triangle;
use super::{QUAD, close, file, unwelded};
use sinew::import::{File, Options, Up, open, open_in_order, open_more};
use std::io::Write;
use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

/// An archive of files, deflated and stored in turn.
pub fn archive(files: &[(&str, &[u8])]) -> Vec<u8> {
    let mut zip = ZipWriter::new(std::io::Cursor::new(Vec::new()));
    for (number, (name, bytes)) in files.iter().enumerate() {
        let method = if number % 2 == 0 { CompressionMethod::Deflated } else { CompressionMethod::Stored };
        zip.start_file(*name, SimpleFileOptions::default().compression_method(method)).unwrap();
        zip.write_all(bytes).unwrap();
    }
    zip.finish().unwrap().into_inner()
}

fn heights(files: &[File]) -> Vec<f64> {
    let sequence = open(files, &Options::default()).unwrap().sequence;
    let poses = sequence.poses().iter().map(|p| p.positions[3].z);
    [sequence.reference()[3].z].into_iter().chain(poses).collect()
}

fn pose(z: usize) -> String {
    QUAD.replace("v 0 1 0", &format!("v 0 1 {z}"))
}

#[test]
fn archives_stand_for_what_is_in_them() {
    let (json, bin) = triangle().split("data/tri%20angle.bin");
    let whole = archive(&[
        ("fox/made.gltf", &json),
        ("fox/data/tri angle.bin", &bin),
        ("fox/texture.png", &[1; 5000]),
        ("__MACOSX/fox/._made.gltf", b"x"),
        ("fox/.hidden.gltf", b"x"),
    ]);
    let opened = open(&[file("fox.zip", whole.clone())], &unwelded()).unwrap();
    assert_eq!((opened.sequence.faces().len(), opened.sequence.name()), (1, "made.gltf"));
    assert_eq!(open_in_order(&[file("fox", whole)], &unwelded()).unwrap().sequence, opened.sequence);
    let poses =
        archive(&[("10.obj", pose(10).as_bytes()), ("2.obj", pose(2).as_bytes()), ("1.obj", pose(1).as_bytes())]);
    assert_eq!(heights(&[file("quad.zip", poses.clone())]), [1.0, 2.0, 10.0]);
    assert_eq!(open(&[file("quad.zip", poses.clone())], &Options::default()).unwrap().sequence.name(), "quad");
    // Beside other files, as in a folder that holds both.
    assert_eq!(heights(&[file("a/b.zip", poses), file("a/a.obj", pose(7))]), [7.0, 1.0, 2.0, 10.0]);
}

#[test]
fn archives_that_hold_nothing_or_are_broken() {
    let whole = archive(&[("a.obj", QUAD.as_bytes())]);
    for (bytes, part) in [
        (archive(&[]), "no file was given"),
        (archive(&[("a.png", b"x")]), "no file was given"),
        (whole[..whole.len() / 2].to_vec(), "not a readable zip archive"),
        (archive(&[("inner.zip", &whole)]), "is no glTF"),
    ] {
        let why = open(&[file("a.zip", bytes)], &Options::default()).unwrap_err().0;
        assert!(why.contains(part), "{part}: {why}");
    }
    // A flipped bit in the data is noticed by its checksum.
    let mut flipped = archive(&[("x", b"x"), ("a.obj", QUAD.as_bytes())]);
    let at = flipped.windows(4).position(|w| w == b"v 1 ").unwrap();
    flipped[at + 2] = b'2';
    assert!(open(&[file("a.zip", flipped)], &Options::default()).unwrap_err().0.contains("\"a.obj\" in a.zip cannot"));
}

/// Eight gigabytes of zeros in eight megabytes are refused by their sizes, before anything is unpacked.
#[test]
fn bombs_are_refused_with_numbers() {
    let bytes = archive(&[("a.obj", &[b' '; 4096]), ("b.obj", &[b' '; 4096])]);
    let mut bomb = bytes.clone();
    // The sizes in the central directory, which is at the end.
    let entries: Vec<usize> = (0..bomb.len() - 4).filter(|&k| bomb[k..k + 4] == *b"PK\x01\x02").collect();
    for entry in entries {
        bomb[entry + 24..entry + 28].copy_from_slice(&0xf000_0000_u32.to_le_bytes());
    }
    let why = open(&[file("a.zip", bomb)], &Options::default()).unwrap_err().0;
    assert!(why.contains("\"a.obj\" in a.zip has 4.0 GB when it is unpacked"), "{why}");
    // Sizes that lie the other way: no more is unpacked than was announced.
    let mut liar = bytes;
    let entry = (0..liar.len() - 4).find(|&k| liar[k..k + 4] == *b"PK\x01\x02").unwrap();
    liar[entry + 24..entry + 28].copy_from_slice(&16_u32.to_le_bytes());
    assert!(open(&[file("a.zip", liar)], &Options::default()).is_err());
}

#[test]
fn poses_join_a_mesh_that_stands_still() {
    let still = [file("horse.obj", QUAD)];
    let more = [file("p/gallop 10.obj", pose(10)), file("p/gallop 9.obj", pose(9))];
    let (joined, with) = open_more(&still, &more, &Options::default()).unwrap();
    assert!(with);
    assert_eq!(joined.sequence.poses().iter().map(|p| p.positions[3].z).collect::<Vec<_>>(), [9.0, 10.0]);
    assert_eq!(joined.sequence.reference()[3].z, 0.0);
    let (one, with) = open_more(&still, &more[..1], &Options::default()).unwrap();
    assert_eq!((one.sequence.poses().len(), with), (1, true));
    // Another mesh, other faces, the mesh itself again, a file of another kind: opened by themselves.
    let turned = QUAD.replace("f 1 2 3\n", "f 2 3 4\n");
    for other in [
        vec![file("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3")],
        vec![file("b.obj", turned)],
        vec![file("again/horse.obj", QUAD), file("again/horse 2.obj", pose(2))],
        vec![file("b.glb", triangle().glb())],
    ] {
        let (alone, with) = open_more(&still, &other, &Options::default()).unwrap();
        assert!(!with);
        assert_eq!(alone.sequence, open(&other, &Options::default()).unwrap().sequence);
    }
    // What moves already takes no more.
    let moving = [file("a.obj", QUAD), file("b.obj", pose(2))];
    assert!(!open_more(&moving, &more, &Options::default()).unwrap().1);
    assert!(open_more(&still, &[file("b.obj", "v x")], &Options::default()).is_err());
}

#[test]
fn what_is_up_in_the_files_is_up_in_all_poses() {
    let still = [file("horse.obj", QUAD)];
    let more = [file("gallop 1.obj", pose(7))];
    let raised = Options { up: Some(Up::Z), ..Options::default() };
    let opened = open(&[still[0].clone(), more[0].clone()], &raised).unwrap();
    assert_eq!(opened.up, Up::Z);
    // The first in natural order is the gallop.
    close(opened.sequence.reference()[3], [0.0, 7.0, -1.0]);
    close(opened.sequence.poses()[0].positions[3], [0.0, 0.0, -1.0]);
    // What joins a mesh has the same axis up; what does not is no business of its.
    let (joined, with) = open_more(&still, &more, &raised).unwrap();
    assert!(with);
    close(joined.sequence.reference()[3], [0.0, 0.0, -1.0]);
    close(joined.sequence.poses()[0].positions[3], [0.0, 7.0, -1.0]);
    let other = [file("b.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3")];
    let (alone, with) = open_more(&still, &other, &raised).unwrap();
    assert_eq!((with, alone.up), (false, Up::Y));
    close(alone.sequence.reference()[2], [0.0, 1.0, 0.0]);
    // A glTF says it, and may be wrong.
    let made = [file("made.glb", triangle().glb())];
    let (said, told) = (open(&made, &unwelded()).unwrap(), open(&made, &Options { up: Some(Up::NegX), ..unwelded() }));
    assert_eq!(said.up, Up::Y);
    let lowered = told.unwrap().sequence.reference().iter().map(|&p| Up::NegX.lowered(p)).collect::<Vec<_>>();
    assert_eq!(lowered, said.sequence.reference());
}

/// Two triangles that share an edge, as STL has them; `z` lifts one corner of the second.
fn soup(z: f32) -> Vec<u8> {
    let mut bytes = vec![0; 80];
    bytes.extend(2_u32.to_le_bytes());
    for triangle in [[0., 0., 0., 1., 0., 0., 0., 1., 0.], [1., 0., 0., 1., 1., z, 0., 1., 0.]] {
        bytes.extend([0; 12]);
        triangle.iter().for_each(|x: &f32| bytes.extend(x.to_le_bytes()));
        bytes.extend([0; 2]);
    }
    bytes
}

#[test]
fn soups_are_welded_in_all_their_poses() {
    let opened = open(&[file("a.stl", soup(0.0)), file("b.stl", soup(3.0))], &Options::default()).unwrap();
    assert_eq!(opened.sequence.faces(), [[0, 1, 2], [1, 3, 2]]);
    // Their z is up.
    close(opened.sequence.poses()[0].positions[3], [1.0, 3.0, -1.0]);
    assert!(opened.warnings.is_empty(), "{:?}", opened.warnings);
    let mut flat = soup(0.0);
    // A triangle of one point is left out, and one is left.
    flat.copy_within(84 + 12..84 + 24, 84 + 24);
    let opened = open(&[file("a.stl", flat)], &Options::default()).unwrap();
    assert_eq!((opened.sequence.faces().len(), opened.sequence.polygons()), (1, Some(&[1][..])));
    assert!(opened.warnings.iter().any(|w| w.code == "collapsed-faces"));
}

#[test]
fn meshes_beside_a_document_are_said_to_be_left_out() {
    let files = [
        file("a/walk_1.obj", QUAD.as_bytes()),
        file("made.glb", triangle().glb()),
        file("walk_2.obj", QUAD.as_bytes()),
    ];
    let imported = open(&files, &Options::default()).unwrap();
    let note = imported.warnings.iter().find(|warning| warning.code == "meshes-left-out").expect("a note");
    assert!(note.message.contains("walk_1.obj and 1 more"), "{}", note.message);
    let alone = open(&files[1..2], &Options::default()).unwrap();
    assert!(alone.warnings.iter().all(|warning| warning.code != "meshes-left-out"));
}
