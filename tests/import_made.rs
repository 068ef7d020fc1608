//! Imports of files made here: every feature against values worked out by hand, and damaged files of all kinds.
#![cfg(not(target_arch = "wasm32"))]

#[path = "import/archives.rs"]
mod archives;
#[path = "import/compressed.rs"]
mod compressed;
#[path = "import/dice.rs"]
mod dice;
#[path = "import/folders.rs"]
mod folders;
mod gltf_maker;
#[path = "import/hostile.rs"]
mod hostile;
#[path = "import/look.rs"]
mod look;
#[path = "import/scenes.rs"]
mod scenes;

use glam::DVec3;
use gltf_maker::{Maker, f32s, rich, skinned, triangle};
use proptest::prelude::*;
use serde_json::json;
use sinew::import::{File, ImportError, Imported, Options, Reference, Sampling, open, open_in_order};

fn file(name: &str, bytes: impl Into<Vec<u8>>) -> File {
    File { name: name.into(), bytes: bytes.into() }
}

fn unwelded() -> Options {
    Options { weld: false, ..Options::default() }
}

fn import(maker: &Maker) -> Imported {
    open(&[file("made.glb", maker.glb())], &unwelded()).unwrap()
}

fn refusal(maker: &Maker) -> String {
    let ImportError(why) = open(&[file("made.glb", maker.glb())], &Options::default()).unwrap_err();
    assert!(why.contains("made.glb") && !why.contains('\n'), "{why}");
    why
}

fn close(a: DVec3, b: [f64; 3]) {
    assert!(a.distance(DVec3::from_array(b)) < 1e-6, "{a} is not {b:?}");
}

#[test]
fn strips_fans_and_index_types() {
    for (component, indices) in [
        (5121, vec![0_u8, 1, 2, 3]),
        (5123, [0_u16, 1, 2, 3].iter().flat_map(|i| i.to_le_bytes()).collect()),
        (5125, [0_u32, 1, 2, 3].iter().flat_map(|i| i.to_le_bytes()).collect()),
    ] {
        for (mode, faces) in [(4, vec![[0, 1, 2]]), (5, vec![[0, 1, 2], [2, 1, 3]]), (6, vec![[0, 1, 2], [0, 2, 3]])] {
            let mut maker = triangle();
            let quad = [0., 0., 0., 1., 0., 0., 0., 1., 0., 1., 1., 0.];
            let positions = maker.accessor(&f32s(&quad), 5126, "VEC3", 4);
            let indices = maker.accessor(&indices, component, "SCALAR", 4);
            maker.json["meshes"][0]["primitives"][0] =
                json!({"attributes": {"POSITION": positions}, "indices": indices, "mode": mode});
            let imported = import(&maker);
            assert_eq!(imported.sequence.faces(), faces, "mode {mode}");
            // That it stands still, and that four corners are not whole triangles.
            assert_eq!(imported.warnings.len(), 1 + usize::from(mode == 4), "{:?}", imported.warnings);
        }
    }
}

#[test]
fn points_and_lines_are_left_out() {
    let mut maker = triangle();
    let mut points = maker.json["meshes"][0]["primitives"][0].clone();
    points["mode"] = json!(1);
    maker.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(points);
    let imported = import(&maker);
    assert_eq!(imported.sequence.faces().len(), 1);
    assert!(imported.warnings.iter().any(|w| w.code == "primitive-left-out"));
}

#[test]
fn triangles_that_are_not_whole_are_left_out_in_words() {
    let mut maker = triangle();
    maker.json["accessors"][0] = json!({"bufferView": 0, "componentType": 5126, "type": "VEC3", "count": 3});
    let indices = maker.accessor(&[0, 1, 2, 0, 1], 5121, "SCALAR", 5);
    maker.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    let imported = import(&maker);
    assert_eq!(imported.sequence.faces(), [[0, 1, 2]]);
    let said = imported.warnings.iter().find(|w| w.code == "incomplete-triangle").unwrap();
    assert!(said.message.ends_with("2 corners were left out."), "{}", said.message);
}

#[test]
fn sparse_accessors_with_and_without_a_base() {
    for with_base in [true, false] {
        let mut maker = triangle();
        let indices = maker.view(&[1, 2]);
        let values = maker.view(&f32s(&[5., 6., 7., 0., 1., 0.]));
        let mut accessor = maker.json["accessors"][0].clone();
        if !with_base {
            accessor.as_object_mut().unwrap().remove("bufferView");
        }
        accessor["sparse"] = json!({
            "count": 2,
            "indices": {"bufferView": indices, "componentType": 5121},
            "values": {"bufferView": values},
        });
        maker.json["accessors"][0] = accessor;
        let imported = import(&maker);
        close(imported.sequence.reference()[0], [0.0; 3]);
        close(imported.sequence.reference()[1], [5.0, 6.0, 7.0]);
        close(imported.sequence.reference()[2], [0.0, 1.0, 0.0]);
    }
}

#[test]
fn interleaved_quantised_positions() {
    let mut maker = triangle();
    // Three signed shorts and two bytes of padding each.
    let mut bytes = Vec::new();
    for p in [[0_i16, 0, 0], [32767, 0, 0], [0, -32767, -32768]] {
        p.iter().for_each(|x| bytes.extend(x.to_le_bytes()));
        bytes.extend([99, 99]);
    }
    let view = maker.view(&bytes);
    maker.json["bufferViews"][view]["byteStride"] = json!(8);
    maker.json["accessors"][0] =
        json!({"bufferView": view, "componentType": 5122, "normalized": true, "type": "VEC3", "count": 3});
    maker.json["extensionsRequired"] = json!(["KHR_mesh_quantization"]);
    let imported = import(&maker);
    close(imported.sequence.reference()[1], [1.0, 0.0, 0.0]);
    close(imported.sequence.reference()[2], [0.0, -1.0, -1.0]);
}

#[test]
fn all_interpolations() {
    // Two keys a second apart; translation from 0 to 4 along x.
    let at_quarter = |interpolation: &str, values: &[f32]| {
        let mut maker = triangle();
        maker.animate("translation", interpolation, &[1.0, 2.0], values, "VEC3");
        let options = Options { sampling: Sampling::Rate(4.0), ..unwelded() };
        let imported = open(&[file("made.glb", maker.glb())], &options).unwrap();
        assert_eq!(imported.sequence.poses().len(), 5);
        assert_eq!(imported.sequence.poses()[4].time, 1.0);
        assert_eq!(imported.clips[0].seconds, 1.0);
        close(imported.sequence.poses()[4].positions[0], [4.0, 0.0, 0.0]);
        imported.sequence.poses()[1].positions[0].x
    };
    assert_eq!(at_quarter("LINEAR", &[0., 0., 0., 4., 0., 0.]), 1.0);
    assert_eq!(at_quarter("STEP", &[0., 0., 0., 4., 0., 0.]), 0.0);
    // In-tangent, value, out-tangent: out of the first key with speed 8, into the second with speed 0.
    let cubic = at_quarter("CUBICSPLINE", &[0., 0., 0., 0., 0., 0., 8., 0., 0., 0., 0., 0., 4., 0., 0., 0., 0., 0.]);
    let s: f64 = 0.25;
    let expected = 8.0 * (s.powi(3) - 2.0 * s.powi(2) + s) + 4.0 * (3.0 * s.powi(2) - 2.0 * s.powi(3));
    assert!((cubic - expected).abs() < 1e-12);
}

#[test]
fn rotations_take_the_short_way() {
    let mut maker = triangle();
    // Half a right angle about z, written with the opposite sign.
    let (sine, cosine) = (std::f32::consts::FRAC_PI_4).sin_cos();
    maker.animate("rotation", "LINEAR", &[0.0, 1.0], &[0., 0., 0., 1., 0., 0., -sine, -cosine], "VEC4");
    let imported =
        open(&[file("made.glb", maker.glb())], &Options { sampling: Sampling::Rate(2.0), ..unwelded() }).unwrap();
    let half = std::f64::consts::FRAC_1_SQRT_2;
    close(imported.sequence.poses()[1].positions[1], [half, half, 0.0]);
    close(imported.sequence.poses()[2].positions[1], [0.0, 1.0, 0.0]);
}

#[test]
fn keys_give_one_pose_each() {
    let mut maker = triangle();
    maker.animate("translation", "LINEAR", &[0.0, 0.25, 1.0], &[0., 0., 0., 1., 0., 0., 2., 0., 0.], "VEC3");
    let imported = open(&[file("made.glb", maker.glb())], &Options { sampling: Sampling::Keys, ..unwelded() }).unwrap();
    let times: Vec<f64> = imported.sequence.poses().iter().map(|p| p.time).collect();
    assert_eq!(times, [0.0, 0.25, 1.0]);
}

#[test]
fn morph_weights_of_mesh_node_and_clip() {
    let mut maker = triangle();
    let offsets = maker.accessor(&f32s(&[0., 0., 1., 0., 0., 0., 0., 0., 0.]), 5126, "VEC3", 3);
    maker.json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": offsets}]);
    maker.json["meshes"][0]["weights"] = json!([0.5]);
    close(import(&maker).sequence.reference()[0], [0.0, 0.0, 0.5]);
    maker.json["nodes"][0]["weights"] = json!([2.0]);
    close(import(&maker).sequence.reference()[0], [0.0, 0.0, 2.0]);
    maker.animate("weights", "LINEAR", &[0.0, 1.0], &[0.0, 4.0], "SCALAR");
    let imported =
        open(&[file("made.glb", maker.glb())], &Options { sampling: Sampling::Rate(2.0), ..unwelded() }).unwrap();
    close(imported.sequence.poses()[1].positions[0], [0.0, 0.0, 2.0]);
}

#[test]
fn skins_ignore_their_own_node_and_normalise_weights() {
    let mut maker = skinned();
    let rest = import(&maker);
    // Bound, resting and as the joints say, all the same: a triangle of a hundredth of the size, turned up.
    close(rest.sequence.reference()[1], [0.01, 0.0, 0.0]);
    close(rest.sequence.reference()[2], [0.0, 0.0, -0.01]);
    // The second joint moves by 2 along its parent's z, which is the world's y.
    maker.animate("translation", "LINEAR", &[0.0, 1.0], &[1., 0., 0., 1., 0., 2.], "VEC3");
    maker.json["animations"][0]["channels"][0]["target"]["node"] = json!(3);
    for reference in [Reference::Bind, Reference::Nodes, Reference::FirstFrame] {
        let imported = open(&[file("made.glb", maker.glb())], &Options { reference, ..unwelded() }).unwrap();
        close(imported.sequence.reference()[2], [0.0, 0.0, -0.01]);
        let last = &imported.sequence.poses().last().unwrap().positions;
        close(last[0], [0.0; 3]);
        close(last[1], [0.01, 0.02, 0.0]);
        close(last[2], [0.0, 0.01, -0.01]);
    }
}

#[test]
fn bind_pose_keeps_the_scale_of_the_poses() {
    // The nodes rest in another pose than the one that was bound: the second joint is far away.
    let mut maker = skinned();
    maker.json["nodes"][3]["translation"] = json!([1, 0, 5]);
    let bind = import(&maker);
    close(bind.sequence.reference()[1], [0.01, 0.0, 0.0]);
    let nodes = open(&[file("made.glb", maker.glb())], &Options { reference: Reference::Nodes, ..unwelded() }).unwrap();
    close(nodes.sequence.reference()[1], [0.01, 0.05, 0.0]);
}

/// Hair bound to the second joint alone, and a hat that hangs on it without a skin, go with the body's bind pose.
#[test]
fn what_hangs_on_a_joint_is_bound_with_it() {
    let mut maker = skinned();
    let joints = maker.accessor(&[0; 12], 5121, "VEC4", 3);
    let weights = maker.accessor(&[255, 0, 0, 0, 255, 0, 0, 0, 255, 0, 0, 0], 5121, "VEC4", 3);
    maker.json["accessors"][weights]["normalized"] = json!(true);
    let attributes = json!({"POSITION": 0, "JOINTS_0": joints, "WEIGHTS_0": weights});
    let hair = json!({"primitives": [{"attributes": attributes}]});
    let hat = json!({"primitives": [{"attributes": {"POSITION": 0}}]});
    maker.json["meshes"].as_array_mut().unwrap().extend([hair, hat]);
    // The hair's skin has the second joint only, bound at x = 1 of the mesh's frame.
    let bind = maker.json["skins"][0]["inverseBindMatrices"].as_u64().unwrap() as usize;
    let mut second = maker.json["accessors"][bind].clone();
    second["byteOffset"] = json!(64);
    second["count"] = json!(1);
    maker.json["accessors"].as_array_mut().unwrap().push(second);
    let second = maker.json["accessors"].as_array().unwrap().len() - 1;
    maker.json["skins"].as_array_mut().unwrap().push(json!({"joints": [3], "inverseBindMatrices": second}));
    let nodes = maker.json["nodes"].as_array_mut().unwrap();
    nodes.extend([json!({"mesh": 1, "skin": 1}), json!({"mesh": 2})]);
    maker.json["nodes"][3]["children"] = json!([5]);
    maker.json["scenes"] = json!([{"nodes": [0, 1, 4]}]);
    // The nodes rest with the second joint turned and far away.
    maker.json["nodes"][3]["translation"] = json!([1, 7, 5]);
    maker.json["nodes"][3]["rotation"] = json!([0, 0, 1, 0]);
    let imported = import(&maker);
    let reference = imported.sequence.reference();
    assert_eq!(reference.len(), 9);
    // In the order of the tree: the body, the hat (below the joints), the hair.
    let (body, hat, hair) = (&reference[0..3], &reference[3..6], &reference[6..9]);
    for k in 0..3 {
        close(hair[k], body[k].to_array());
        close(hat[k], (body[k] + DVec3::new(0.01, 0.0, 0.0)).to_array());
    }
}

#[test]
fn clips_are_chosen_by_name_by_number_or_because_they_move() {
    let mut maker = triangle();
    maker.animate("translation", "LINEAR", &[0.0, 1.0], &[0.; 6], "VEC3");
    maker.animate("translation", "LINEAR", &[0.0, 2.0], &[0., 0., 0., 1., 0., 0.], "VEC3");
    maker.json["animations"][0]["name"] = json!("stand");
    maker.json["animations"][1]["name"] = json!("go");
    let clip = |clip: Option<&str>| {
        let options = Options { clip: clip.map(Into::into), ..unwelded() };
        open(&[file("made.glb", maker.glb())], &options).map(|imported| imported.clip)
    };
    assert_eq!(clip(None), Ok(Some(1)));
    assert_eq!(clip(Some("stand")), Ok(Some(0)));
    assert_eq!(clip(Some("1")), Ok(Some(1)));
    let why = clip(Some("fly")).unwrap_err().0;
    assert!(why.contains("\"stand\", \"go\""), "{why}");
}

#[test]
fn seams_are_welded_and_counted() {
    let mut maker = triangle();
    // Two triangles that share an edge, as six vertices; the second as another primitive.
    let other = maker.accessor(&f32s(&[1., 0., 0., 1., 1., 0., 0., 1., 0.]), 5126, "VEC3", 3);
    let primitive = json!({"attributes": {"POSITION": other}});
    maker.json["meshes"][0]["primitives"].as_array_mut().unwrap().push(primitive);
    let imported = open(&[file("made.glb", maker.glb())], &Options::default()).unwrap();
    assert_eq!(imported.sequence.faces(), [[0, 1, 2], [1, 3, 2]]);
    assert!(imported.warnings.iter().any(|w| w.code == "welded" && w.message.starts_with("2 vertices")));
    assert_eq!(import(&maker).sequence.reference().len(), 6);
}

#[test]
fn collapsed_faces_go_but_the_others_keep_their_numbers() {
    let mut maker = triangle();
    let indices = maker.accessor(&[0, 1, 1, 0, 1, 2], 5121, "SCALAR", 6);
    maker.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    let imported = import(&maker);
    assert_eq!(imported.sequence.faces(), [[0, 1, 2]]);
    assert_eq!((imported.input_faces, imported.sequence.polygons()), (2, Some(&[1][..])));
    assert!(imported.warnings.iter().any(|w| w.code == "collapsed-faces" && w.message.starts_with("1 face was")));
}

#[test]
fn scenes_default_first_or_all() {
    let mut maker = triangle();
    maker.json["nodes"] = json!([{"mesh": 0}, {"mesh": 0, "translation": [5, 0, 0]}]);
    let first_x = |maker: &Maker| import(maker).sequence.reference()[0].x;
    maker.json["scenes"] = json!([{"nodes": [0]}, {"nodes": [1]}]);
    maker.json["scene"] = json!(1);
    assert_eq!(first_x(&maker), 5.0);
    maker.json.as_object_mut().unwrap().remove("scene");
    assert_eq!(first_x(&maker), 0.0);
    maker.json.as_object_mut().unwrap().remove("scenes");
    assert_eq!(import(&maker).sequence.faces().len(), 2);
    maker.json["scenes"] = json!([{}]);
    assert_eq!(import(&maker).sequence.faces().len(), 2);
}

#[test]
fn external_buffers_come_with_the_file() {
    let (json, bin) = triangle().split("tri%20angle.bin");
    let files = [file("folder/tri angle.bin", bin.clone()), file("folder/made.gltf", json.clone())];
    assert_eq!(open(&files, &unwelded()).unwrap().sequence.faces().len(), 1);
    let why = open(&[file("made.gltf", json)], &unwelded()).unwrap_err().0;
    assert!(why.contains("tri angle.bin"), "{why}");
}

#[test]
fn damaged_documents_are_refused_in_words() {
    type Damage = fn(&mut Maker);
    let cases: [(&str, Damage); 15] = [
        ("is its own ancestor", |m| m.json["nodes"] = json!([{"mesh": 0, "children": [1]}, {"children": [0]}])),
        ("already has a parent", |m| m.json["nodes"] = json!([{"children": [2]}, {"children": [2]}, {"mesh": 0}])),
        ("has child 7", |m| m.json["nodes"][0]["children"] = json!([7])),
        ("shows mesh 3", |m| m.json["nodes"][0]["mesh"] = json!(3)),
        ("shows node 8", |m| m.json["scenes"] = json!([{"nodes": [8]}])),
        ("needs 36000000000 bytes", |m| m.json["accessors"][0]["count"] = json!(3_000_000_000_u32)),
        ("more elements than can be numbered", |m| m.json["accessors"][0]["count"] = json!(u64::MAX)),
        ("do not fit into", |m| {
            m.json["accessors"][0] = json!({"componentType": 5126, "type": "VEC3", "count": 4_000_000_000_u32});
        }),
        ("type Vec2 where Vec3", |m| m.json["accessors"][0]["type"] = json!("VEC2")),
        ("at a stride of 4", |m| m.json["bufferViews"][0]["byteStride"] = json!(4)),
        ("ends at byte", |m| m.json["bufferViews"][0]["byteOffset"] = json!(u64::MAX)),
        ("does not exist", |m| m.json["accessors"][0]["bufferView"] = json!(9)),
        ("version 1.0", |m| m.json["asset"]["version"] = json!("1.0")),
        ("node 0", |m| m.json["nodes"][0]["matrix"] = json!([1, 2, 3])),
        ("skin 4", |m| m.json["nodes"][0]["skin"] = json!(4)),
    ];
    for (part, damage) in cases {
        let mut maker = triangle();
        damage(&mut maker);
        let why = refusal(&maker);
        assert!(why.contains(part), "{part}: {why}");
    }
    let mut maker = triangle();
    maker.bytes[4..8].copy_from_slice(&f32::NAN.to_le_bytes());
    assert!(refusal(&maker).contains("not a finite number"));
    let mut maker = skinned();
    maker.json["skins"][0]["joints"] = json!([2]);
    assert!(refusal(&maker).contains("names joint 1"));
}

#[test]
fn many_poses_are_refused_with_numbers() {
    let mut maker = triangle();
    maker.animate("translation", "LINEAR", &[0.0, 1e6], &[0., 0., 0., 1., 0., 0.], "VEC3");
    for rate in [1e6, 300.0] {
        let options = Options { sampling: Sampling::Rate(rate), ..unwelded() };
        let why = open(&[file("made.glb", maker.glb())], &options).unwrap_err().0;
        assert!(why.contains("fewer poses a second"), "{why}");
    }
    for rate in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let options = Options { sampling: Sampling::Rate(rate), ..unwelded() };
        assert!(open(&[file("made.glb", maker.glb())], &options).unwrap_err().0.contains("above 0"));
    }
}

const QUAD: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\nf 1 2 3\n";

#[test]
fn numbered_files_are_poses_in_natural_order() {
    let pose = |z: usize| QUAD.replace("v 0 1 0", &format!("v 0 1 {z}"));
    let mut files = vec![file("d/.DS_Store", "x"), file("d/mesh.mtl", "x")];
    files.extend([10, 2, 1].map(|z| file(&format!("d/mesh.{z}.obj"), pose(z))));
    let dropped = open(&files, &Options::default()).unwrap();
    let heights = |i: &Imported| i.sequence.poses().iter().map(|p| p.positions[3].z).collect::<Vec<_>>();
    assert_eq!((dropped.sequence.reference()[3].z, heights(&dropped)), (1.0, vec![2.0, 10.0]));
    assert_eq!((dropped.input_faces, dropped.sequence.polygons()), (2, Some(&[0, 0, 1][..])));
    let given = open_in_order(&files, &Options::default()).unwrap();
    assert_eq!((given.sequence.reference()[3].z, heights(&given)), (10.0, vec![2.0, 1.0]));
}

#[test]
fn poses_of_other_meshes_are_refused() {
    let with = |other: &str| open(&[file("a.obj", QUAD), file("b.obj", other)], &Options::default());
    let why = with("v 0 0 0\nf 1 1 1").unwrap_err().0;
    assert!(why.contains("b.obj has 1 vertices, but a.obj has 4"), "{why}");
    let why = with(&QUAD.replace("f 1 2 3\n", "")).unwrap_err().0;
    assert!(why.contains("b.obj has 1 faces, but a.obj has 2"), "{why}");
    let turned = with(&QUAD.replace("f 1 2 3\n", "f 2 3 4\n")).unwrap();
    assert!(turned.warnings.iter().any(|w| w.code == "different-faces"));
    let off = "OFF\n4 0 0\n0 0 0\n1 0 0\n1 1 0\n0 1 5\n";
    let mixed = open(&[file("a.obj", QUAD), file("b.off", off)], &Options::default()).unwrap();
    assert!(mixed.warnings.is_empty());
    assert_eq!(mixed.sequence.poses()[0].positions[3].z, 5.0);
}

#[test]
fn what_is_no_mesh_is_refused() {
    for files in [vec![], vec![file("a.txt", "hello")], vec![file("a.png", "x"), file("b", "")]] {
        assert!(open(&files, &Options::default()).unwrap_err().0.contains("glTF"));
    }
    let two = [file("a.glb", triangle().glb()), file("b.glb", triangle().glb())];
    assert!(open(&two, &Options::default()).unwrap_err().0.contains("one at a time"));
    assert!(open(&[file("a.obj", "v 0 0 0\n")], &Options::default()).unwrap_err().0.contains("no faces"));
}

fn damaged(bytes: Vec<u8>) -> impl Strategy<Value = Vec<u8>> {
    let length = bytes.len();
    let changes = proptest::collection::vec((0..length, any::<u8>()), 0..6);
    (changes, 0..=length, any::<bool>()).prop_map(move |(changes, cut, whole)| {
        let mut bytes = bytes.clone();
        changes.into_iter().for_each(|(at, byte)| bytes[at] = byte);
        bytes.truncate(if whole { bytes.len() } else { cut });
        bytes
    })
}

/// Whether a file can be opened; what comes of it must be sound, or a sentence.
fn opens_or_says_why(name: &str, bytes: Vec<u8>) -> bool {
    // Few poses, so that a damaged time does not make the test slow.
    let options = Options { sampling: Sampling::Keys, look: true, ..Options::default() };
    match open(&[file(name, bytes)], &options) {
        Ok(Imported { sequence, look, .. }) => {
            assert!(sequence.reference().iter().all(|p| p.is_finite()));
            assert!(look.is_none_or(|look| look.fits(sequence.reference().len(), sequence.faces().len())));
            true
        }
        Err(ImportError(why)) => {
            assert!(why.len() > 10 && !why.contains('\n'), "{why}");
            false
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 1500, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn damaged_glb(bytes in damaged(rich().glb())) {
        opens_or_says_why("a.glb", bytes);
    }

    #[test]
    fn damaged_obj(bytes in damaged(QUAD.into())) {
        opens_or_says_why("a.obj", bytes);
    }

    #[test]
    fn damaged_off(bytes in damaged(b"OFF 4 2 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n3 0 1 2\n".to_vec())) {
        opens_or_says_why("a.off", bytes);
    }

    #[test]
    fn damaged_ply(bytes in damaged(ply())) {
        opens_or_says_why("a.ply", bytes);
    }

    #[test]
    fn numbers_in_the_document_may_be_anything(at in 0..200_usize, value in prop_oneof![
        Just(json!(0)), Just(json!(-1)), Just(json!(4_294_967_295_u32)), Just(json!(u64::MAX)), Just(json!(1e300)),
        Just(json!("x")), Just(json!([])), Just(json!({})), Just(json!(null)), (0..20_u32).prop_map(|n| json!(n)),
    ]) {
        let bytes = rich().glb();
        let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
        let mut document: serde_json::Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
        let mut count = at;
        replace_nth(&mut document, &mut count, &value);
        let maker = Maker { json: document, bytes: bytes[28 + length..].to_vec() };
        opens_or_says_why("a.glb", maker.glb());
    }
}

/// Replaces the n-th value of a document that is no list or object.
fn replace_nth(value: &mut serde_json::Value, count: &mut usize, by: &serde_json::Value) {
    use serde_json::Value;
    match value {
        Value::Array(values) => values.iter_mut().for_each(|v| replace_nth(v, count, by)),
        Value::Object(values) => values.iter_mut().for_each(|(_, v)| replace_nth(v, count, by)),
        leaf => {
            if *count == 0 {
                *leaf = by.clone();
            }
            *count = count.wrapping_sub(1);
        }
    }
}

fn ply() -> Vec<u8> {
    let mut bytes = b"ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n\
        property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
        .to_vec();
    bytes.extend(f32s(&[0., 0., 0., 1., 0., 0., 0., 1., 0.]));
    bytes.push(3);
    [0_i32, 1, 2].iter().for_each(|v| bytes.extend(v.to_le_bytes()));
    bytes
}
