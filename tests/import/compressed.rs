//! Compressed geometry: the same triangles whatever they are packed in.

use super::gltf_maker::{Maker, draco_mesh, draco_triangle, f32s, meshopt, rich, skinned, triangle};
use super::{close, file, import, refusal, unwelded};
use glam::DVec3;
use proptest::prelude::*;
use serde_json::json;
use sinew::import::gltf::meshopt::{Compressed, Filter, Mode};
use sinew::import::{Options, open};

/// The corners of all faces in all poses, sorted, as another encoding may number and turn them differently.
fn corners(maker: &Maker) -> Vec<[i64; 3]> {
    let sequence = open(&[file("made.glb", maker.glb())], &unwelded()).unwrap().sequence;
    let poses = sequence.poses().iter().map(|pose| pose.positions.as_slice());
    let mut all: Vec<[i64; 3]> = [sequence.reference()]
        .into_iter()
        .chain(poses)
        .flat_map(|positions| sequence.faces().iter().flatten().map(|&v| positions[v as usize]))
        .map(|p| (p * 1e5).round().to_array().map(|x| x as i64))
        .collect();
    all.sort_unstable();
    all
}

/// Replaces the one primitive's attributes by a Draco mesh, which has them as 0, 1 and 2.
fn pack(maker: &mut Maker, data: &[u8]) {
    let view = maker.view(data);
    let primitive = &mut maker.json["meshes"][0]["primitives"][0];
    primitive["extensions"] = json!({"KHR_draco_mesh_compression": {
        "bufferView": view, "attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}});
    let attributes = primitive["attributes"].clone();
    for name in ["POSITION", "JOINTS_0", "WEIGHTS_0"] {
        if let Some(accessor) = attributes.get(name).and_then(|a| a.as_u64()) {
            maker.json["accessors"][accessor as usize].as_object_mut().unwrap().remove("bufferView");
        }
    }
    maker.json["extensionsRequired"] = json!(["KHR_draco_mesh_compression"]);
}

#[test]
fn draco_in_every_method() {
    let mut plain = skinned();
    let weights = plain.accessor(&f32s(&[0.25; 12]), 5126, "VEC4", 3);
    plain.json["meshes"][0]["primitives"][0]["attributes"]["WEIGHTS_0"] = json!(weights);
    plain.animate("translation", "LINEAR", &[0.0, 1.0], &[1., 0., 0., 1., 0., 2.], "VEC3");
    plain.json["animations"][0]["channels"][0]["target"]["node"] = json!(3);
    for speed in [0, 5, 10] {
        let mut packed = plain.clone();
        pack(&mut packed, &draco_triangle(speed));
        assert_eq!(corners(&packed), corners(&plain), "speed {speed}");
    }
}

#[test]
fn draco_with_a_morph_target_beside_it() {
    let mut maker = triangle();
    let offsets = maker.accessor(&f32s(&[0., 0., 1., 0., 0., 0., 0., 0., 0.]), 5126, "VEC3", 3);
    maker.json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": offsets}]);
    maker.json["meshes"][0]["weights"] = json!([0.5]);
    // The sequential method keeps the order of the vertices, which the target's are in.
    pack(&mut maker, &draco_triangle(10));
    close(import(&maker).sequence.reference()[0], [0.0, 0.0, 0.5]);
}

#[test]
fn draco_that_is_damaged_is_refused_in_words() {
    let whole = draco_triangle(5);
    for length in 0..whole.len() {
        let mut maker = triangle();
        pack(&mut maker, &whole[..length]);
        assert!(refusal(&maker).contains("the Draco data of mesh 0"), "{length}");
    }
    type Damage = fn(&mut Maker);
    let cases: [(&str, Damage); 4] = [
        ("has no attribute 7", |m| {
            m.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]["POSITION"] =
                json!(7);
        }),
        ("was compressed as something else", |m| {
            m.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["attributes"]["POSITION"] =
                json!(2);
        }),
        ("but its compressed mesh has 3", |m| {
            let extension = &mut m.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"];
            extension["attributes"] = json!({});
            m.json["accessors"][0]["count"] = json!(2);
        }),
        ("buffer view 9", |m| {
            m.json["meshes"][0]["primitives"][0]["extensions"]["KHR_draco_mesh_compression"]["bufferView"] = json!(9);
        }),
    ];
    for (part, damage) in cases {
        let mut maker = triangle();
        pack(&mut maker, &whole);
        damage(&mut maker);
        let why = refusal(&maker);
        assert!(why.contains(part), "{part}: {why}");
    }
}

#[test]
fn draco_of_many_faces() {
    // A wavy sheet of 12 by 12 vertices.
    let side = 12_u32;
    let at = |k: u32| [(k % side) as f32, (k / side) as f32, ((k * k) % 7) as f32 * 0.1];
    let positions: Vec<f32> = (0..side * side).flat_map(at).collect();
    let cells = (0..side * (side - 1)).filter(|k| k % side < side - 1);
    let faces: Vec<[u32; 3]> = cells.flat_map(|k| [[k, k + 1, k + side], [k + 1, k + side + 1, k + side]]).collect();
    let mut plain = triangle();
    let vertices = plain.accessor(&f32s(&positions), 5126, "VEC3", positions.len() / 3);
    let numbers: Vec<u8> = faces.iter().flatten().flat_map(|v| (*v as u16).to_le_bytes()).collect();
    let indices = plain.accessor(&numbers, 5123, "SCALAR", 3 * faces.len());
    plain.json["meshes"][0]["primitives"][0] = json!({"attributes": {"POSITION": vertices}, "indices": indices});
    for speed in [0, 3, 7, 10] {
        let mut packed = plain.clone();
        pack(&mut packed, &draco_mesh(&positions, &faces, &vec![0; 4 * positions.len() / 3], speed));
        assert_eq!(corners(&packed), corners(&plain), "speed {speed}");
    }
}

#[test]
fn meshopt_for_everything() {
    let mut maker = rich();
    let indices = maker.accessor(&[0, 0, 1, 0, 2, 0], 5123, "SCALAR", 3);
    maker.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    let expected = corners(&maker);
    for mode in ["TRIANGLES", "INDICES"] {
        let mut packed = maker.clone();
        for (view, entry) in maker.json["bufferViews"].as_array().unwrap().iter().enumerate() {
            let length = entry["byteLength"].as_u64().unwrap() as usize;
            let accessor =
                maker.json["accessors"].as_array().unwrap().iter().find(|a| a["bufferView"] == view).unwrap();
            let each = length / accessor["count"].as_u64().unwrap() as usize;
            if view == indices { packed.compress(view, mode, 2) } else { packed.compress(view, "ATTRIBUTES", each) }
        }
        packed.json["extensionsRequired"] = json!(["EXT_meshopt_compression"]);
        assert_eq!(corners(&packed), expected, "{mode}");
    }
}

#[test]
fn meshopt_claims_are_compared_with_what_is_allowed() {
    let compressed = |m: &mut Maker, key: &str, value: u64| {
        m.compress(0, "ATTRIBUTES", 12);
        m.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"][key] = json!(value);
    };
    for (key, value, part) in [
        ("count", u64::MAX, "do not fit into"),
        ("count", 4_000_000_000, "do not fit into"),
        ("count", 10_000_000, "is cut short"),
        ("count", 2, "needs 36 bytes"),
        ("byteLength", 20, "is cut short"),
        ("byteLength", u64::MAX, "ends at byte"),
        ("byteStride", 13, "byteStride"),
        ("buffer", 7, "names buffer 7"),
        ("buffer", 1, "has no data"),
    ] {
        let mut maker = triangle();
        compressed(&mut maker, key, value);
        let why = refusal(&maker);
        assert!(why.contains(part), "{key} {value}: {why}");
    }
    let mut maker = triangle();
    maker.compress(0, "ATTRIBUTES", 12);
    maker.json["bufferViews"][0]["extensions"]["EXT_meshopt_compression"]["mode"] = json!("ZIP");
    assert!(refusal(&maker).contains("EXT_meshopt_compression of buffer view 0"));
}

/// A view that nothing needs may be in a filter or a mode that is not known here.
#[test]
fn what_is_not_needed_is_not_decoded() {
    let mut maker = triangle();
    let normals = maker.accessor(&[0; 24], 5122, "VEC3", 3);
    maker.json["meshes"][0]["primitives"][0]["attributes"]["NORMAL"] = json!(normals);
    maker.compress(normals, "ATTRIBUTES", 8);
    maker.json["bufferViews"][normals]["extensions"]["EXT_meshopt_compression"]["byteLength"] = json!(3);
    assert_eq!(import(&maker).sequence.reference()[1], DVec3::X);
    assert!(open(&[file("made.glb", maker.glb())], &Options::default()).is_ok());
}

fn view(data: &[u8], mode: Mode, count: usize, stride: usize) -> Compressed {
    Compressed {
        buffer: 0,
        byte_offset: 0,
        byte_length: data.len() as u64,
        byte_stride: stride as u64,
        count: count as u64,
        mode,
        filter: Filter::None,
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 200, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn meshopt_attributes_of_any_size(channels in 1..65_usize, bytes in proptest::collection::vec(any::<u8>(), 0..9000)) {
        let stride = 4 * channels;
        let whole = &bytes[..bytes.len() / stride * stride];
        let coded = meshopt::attributes(whole, stride);
        let decoded = view(&coded, Mode::Attributes, whole.len() / stride, stride).decode(&coded);
        prop_assert_eq!(decoded.as_deref(), Ok(whole));
    }

    #[test]
    fn meshopt_indices_of_any_size(indices in proptest::collection::vec(0..1_u32 << 30, 0..500)) {
        let whole = &indices[..indices.len() / 3 * 3];
        for (coded, mode) in [(meshopt::triangles(whole), Mode::Triangles), (meshopt::indices(whole), Mode::Indices)] {
            let expected: Vec<u8> = whole.iter().flat_map(|i| i.to_le_bytes()).collect();
            prop_assert_eq!(view(&coded, mode, whole.len(), 4).decode(&coded), Ok(expected));
        }
    }

    #[test]
    fn meshopt_of_random_bytes(
        mode in 0..3_usize, count in 0..400_usize, channels in 0..66_usize, data in proptest::collection::vec(any::<u8>(), 0..300),
    ) {
        let mode = [Mode::Attributes, Mode::Triangles, Mode::Indices][mode];
        for header in [0xa0, 0xa1, 0xe1, 0xd1] {
            let mut data = data.clone();
            data.insert(0, header);
            for stride in [4 * channels, 2] {
                if let Ok(decoded) = view(&data, mode, count, stride).decode(&data) {
                    prop_assert_eq!(decoded.len(), count * stride);
                }
            }
        }
    }
}
