//! Files that lie, are damaged, or were made to do harm.

use super::dice::Dice;
use super::gltf_maker::{Maker, draco_triangle, dressed, f32s, rich, triangle};
use super::{file, opens_or_says_why, refusal, unwelded};
use proptest::prelude::*;
use serde_json::json;
use sinew::import::{Options, open};

/// A file of each kind of packing.
fn corpus() -> Vec<Vec<u8>> {
    let mut meshopt = rich();
    for (view, stride) in [(0, 12), (1, 4), (2, 4)] {
        meshopt.compress(view, "ATTRIBUTES", stride);
    }
    let mut draco = triangle();
    let view = draco.view(&draco_triangle(5));
    draco.json["meshes"][0]["primitives"][0]["extensions"] =
        json!({"KHR_draco_mesh_compression": {"bufferView": view, "attributes": {"POSITION": 0}}});
    let mut sparse = triangle();
    let (indices, values) = (sparse.view(&[0, 2]), sparse.view(&f32s(&[5., 6., 7., 0., 1., 0.])));
    sparse.json["accessors"][0]["sparse"] = json!({"count": 2,
        "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": values}});
    let mut instances = triangle();
    let places = instances.accessor(&f32s(&[0., 0., 0., 7., 0., 0.]), 5126, "VEC3", 2);
    instances.json["nodes"][0]["extensions"] =
        json!({"EXT_mesh_gpu_instancing": {"attributes": {"TRANSLATION": places}}});
    [rich(), meshopt, draco, sparse, instances, dressed()].iter().map(Maker::glb).collect()
}

/// Bytes changed, bits flipped, pieces cut out, doubled and swapped, numbers of the document replaced.
#[test]
fn mutated_files_open_or_say_why() {
    let mut dice = Dice(7);
    let numbers: [&[u8]; 8] = [b"0", b"-1", b"9", b"4294967295", b"18446744073709551615", b"1e999", b"null", b"[]"];
    let corpus = corpus();
    for round in 0..4000 {
        let mut bytes = corpus[round % corpus.len()].clone();
        for _ in 0..=dice.below(3) {
            let at = dice.below(bytes.len());
            let end = (at + dice.below(24)).min(bytes.len());
            match dice.below(6) {
                0 => bytes[at] = dice.below(256) as u8,
                1 => bytes[at] ^= 1 << dice.below(8),
                2 => drop(bytes.drain(at..end)),
                3 => {
                    let piece = bytes[at..end].to_vec();
                    bytes.splice(at..at, piece);
                }
                4 => {
                    let other = &corpus[dice.below(corpus.len())];
                    let from = dice.below(other.len());
                    let piece = other[from..(from + 16).min(other.len())].to_vec();
                    bytes.splice(at..end, piece);
                }
                _ => {
                    // A number of the document, and the document's length with it.
                    let digits = bytes.iter().enumerate().skip(20).filter(|(_, b)| b.is_ascii_digit());
                    let places: Vec<usize> = digits.map(|(at, _)| at).collect();
                    if let Some(&at) = places.get(dice.below(places.len())) {
                        let number = numbers[dice.below(numbers.len())];
                        bytes.splice(at..=at, number.iter().copied());
                        let length = u32::from_le_bytes([bytes[12], bytes[13], bytes[14], bytes[15]]);
                        let length = length.wrapping_add(number.len() as u32 - 1);
                        bytes[12..16].copy_from_slice(&length.to_le_bytes());
                    }
                }
            }
            if bytes.len() < 24 {
                break;
            }
        }
        opens_or_says_why("a.glb", bytes);
    }
}

/// A file of a few hundred bytes that claims gigabytes, in every place where a size can stand.
#[test]
fn small_files_that_claim_gigabytes() {
    type Claim = fn(&mut Maker);
    let claims: [(&str, Claim); 7] = [
        ("positions that are nowhere", |m| {
            m.json["accessors"][0] = json!({"componentType": 5126, "type": "VEC3", "count": 4_294_967_295_u32});
        }),
        ("indices that are nowhere", |m| {
            m.json["accessors"]
                .as_array_mut()
                .unwrap()
                .push(json!({"componentType": 5125, "type": "SCALAR", "count": 1_073_741_823}));
            m.json["meshes"][0]["primitives"][0]["indices"] = json!(1);
        }),
        ("keys that are nowhere", |m| {
            m.animate("translation", "LINEAR", &[0.0, 1.0], &[0., 0., 0., 1., 0., 0.], "VEC3");
            for accessor in [1, 2] {
                m.json["accessors"][accessor]["count"] = json!(1_000_000_000);
                m.json["accessors"][accessor].as_object_mut().unwrap().remove("bufferView");
            }
        }),
        ("instances that are nowhere", |m| {
            m.json["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": {"SCALE": 1}}});
            m.json["accessors"]
                .as_array_mut()
                .unwrap()
                .push(json!({"componentType": 5126, "type": "VEC3", "count": 1_073_741_823}));
        }),
        ("a compressed view", |m| {
            m.json["bufferViews"][0]["extensions"] = json!({"EXT_meshopt_compression": {
                "buffer": 0, "byteLength": 36, "byteStride": 256, "count": 16_777_216, "mode": "ATTRIBUTES"}});
        }),
        ("inverse binds that are nowhere", |m| {
            m.json["accessors"]
                .as_array_mut()
                .unwrap()
                .push(json!({"componentType": 5126, "type": "MAT4", "count": 4_000_000_000_u32}));
            m.json["skins"] = json!([{"joints": [0], "inverseBindMatrices": 1}]);
            m.json["nodes"][0]["skin"] = json!(0);
            m.json["accessors"][0]["count"] = json!(4);
        }),
        ("a stride that overflows", |m| m.json["bufferViews"][0]["byteStride"] = json!(u64::MAX)),
    ];
    for (what, claim) in claims {
        let mut maker = triangle();
        claim(&mut maker);
        assert!(maker.glb().len() < 1500, "{what}");
        refusal(&maker);
    }
}

/// A list of a hundred nodes a hundred nodes deep is fine, a hundred million brackets are not.
#[test]
fn documents_are_estimated_before_they_are_read() {
    let nodes = "{},".repeat(8_500_000);
    let document = format!("{{\"asset\": {{\"version\": \"2.0\"}}, \"nodes\": [{nodes}{{}}]}}");
    let why = open(&[file("a.gltf", document)], &Options::default()).unwrap_err().0;
    assert!(why.contains("the document of a.gltf has 17000"), "{why}");
    let deep = format!("{{\"extras\": {}{}}}", "[".repeat(100_000), "]".repeat(100_000));
    assert!(open(&[file("a.gltf", deep)], &Options::default()).unwrap_err().0.contains("not a readable glTF"));
}

#[test]
fn nothing_at_all() {
    type Emptying = fn(&mut Maker);
    let cases: [Emptying; 6] = [
        |m| m.json["accessors"][0]["count"] = json!(0),
        |m| m.json["meshes"][0]["primitives"] = json!([]),
        |m| m.json["nodes"] = json!([]),
        |m| m.json["meshes"][0]["primitives"][0]["attributes"] = json!({}),
        |m| {
            let none = m.accessor(&[], 5123, "SCALAR", 0);
            m.json["meshes"][0]["primitives"][0]["indices"] = json!(none);
        },
        |m| m.bytes.iter_mut().for_each(|b| *b = 0),
    ];
    for empty in cases {
        let mut maker = triangle();
        empty(&mut maker);
        refusal(&maker);
    }
    for end in ["gltf", "glb", "obj", "off", "ply", "stl", "zip"] {
        let name = format!("a.{end}");
        assert!(!open(&[file(&name, "")], &Options::default()).unwrap_err().0.is_empty(), "{end}");
    }
}

/// Names come through as they are: the page shows them as text.
#[test]
fn names_with_markup_stay_names() {
    let evil = "<img src=x onerror=alert(1)>\u{202e}\"'&";
    let mut maker = triangle();
    maker.animate("translation", "LINEAR", &[0.0, 1.0], &[0., 0., 0., 1., 0., 0.], "VEC3");
    maker.json["animations"][0]["name"] = json!(evil);
    let opened = open(&[file(evil, maker.glb())], &unwelded()).unwrap();
    assert_eq!((opened.sequence.name(), opened.clips[0].name.as_str()), (evil, evil));
    assert!(
        refusal(&{
            maker.json["meshes"][0]["name"] = json!(evil);
            maker.json["accessors"][0]["type"] = json!("VEC2");
            maker
        })
        .contains(evil)
    );
}

/// What goes wrong is told on one line, whatever the names, and whatever a decoder says about its data.
#[test]
fn refusals_are_one_line() {
    let mut maker = triangle();
    maker.json["meshes"][0]["name"] = json!(format!("two\nlines\u{7}{}", "x".repeat(5000)));
    maker.json["accessors"][0]["type"] = json!("VEC2");
    let why = refusal(&maker);
    assert!(why.contains("two lines") && why.chars().count() < 700, "{why}");
    // More raw corrections than there are bytes for, of which the decoder speaks in two lines.
    let mut data = draco_triangle(10);
    for at in 0..data.len() {
        let before = std::mem::replace(&mut data[at], 0xff);
        let mut maker = triangle();
        let view = maker.view(&data);
        maker.json["meshes"][0]["primitives"][0]["extensions"] =
            json!({"KHR_draco_mesh_compression": {"bufferView": view, "attributes": {"POSITION": 0}}});
        opens_or_says_why("a.glb", maker.glb());
        data[at] = before;
    }
}

/// What glTF 2.0, §3.6.2 says that a stored number is.
fn meant(component: u32, normalized: bool, bytes: &[u8]) -> f64 {
    let raw = match (component, bytes) {
        (5120, &[a]) => f64::from(a as i8),
        (5121, &[a]) => f64::from(a),
        (5122, &[a, b]) => f64::from(i16::from_le_bytes([a, b])),
        (5123, &[a, b]) => f64::from(u16::from_le_bytes([a, b])),
        (5125, &[a, b, c, d]) => f64::from(u32::from_le_bytes([a, b, c, d])),
        (_, &[a, b, c, d]) => f64::from(f32::from_le_bytes([a, b, c, d])),
        _ => unreachable!("sizes are chosen here"),
    };
    let largest = match component {
        5120 => 127.0,
        5121 => 255.0,
        5122 => 32_767.0,
        5123 => 65_535.0,
        _ => 1.0,
    };
    if normalized { (raw / largest).max(if component == 5126 { raw } else { -1.0 }) } else { raw }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, failure_persistence: None, ..ProptestConfig::default() })]

    /// Accessors of every kind: component, normalised or not, any stride and offset, with and without sparse values.
    #[test]
    fn accessors_of_every_kind(
        component in prop_oneof![Just(5120), Just(5121), Just(5122), Just(5123), Just(5125), Just(5126)],
        normalized in any::<bool>(),
        padding in 0..9_usize,
        offset in 0..9_usize,
        count in 3..40_usize,
        replaced in proptest::collection::btree_set(0..40_usize, 0..6),
        base in any::<bool>(),
        bytes in proptest::collection::vec(any::<u8>(), 40 * 28 + 16),
        values in proptest::collection::vec(any::<u8>(), 6 * 12),
    ) {
        let width = match component { 5120 | 5121 => 1, 5122 | 5123 => 2, _ => 4 };
        let (size, stride) = (3 * width, 3 * width + padding * width.min(2));
        let replaced: Vec<usize> = replaced.into_iter().filter(|&r| r < count).collect();
        let mut maker = triangle();
        let mut accessor = json!({"componentType": component, "normalized": normalized, "type": "VEC3", "count": count});
        if base {
            let view = maker.view(&bytes[..offset + (count - 1) * stride + size]);
            maker.json["bufferViews"][view]["byteStride"] = json!(stride);
            accessor["bufferView"] = json!(view);
            accessor["byteOffset"] = json!(offset);
        }
        if !replaced.is_empty() {
            let indices = maker.view(&replaced.iter().map(|&r| r as u8).collect::<Vec<_>>());
            let view = maker.view(&values[..replaced.len() * size]);
            accessor["sparse"] = json!({"count": replaced.len(),
                "indices": {"bufferView": indices, "componentType": 5121}, "values": {"bufferView": view}});
        }
        maker.json["accessors"][0] = accessor;
        let expected: Vec<[f64; 3]> = (0..count)
            .map(|v| {
                let at = |k: usize| match replaced.iter().position(|&r| r == v) {
                    Some(place) => meant(component, normalized, &values[place * size + k * width..][..width]),
                    None if base => meant(component, normalized, &bytes[offset + v * stride + k * width..][..width]),
                    None => 0.0,
                };
                [at(0), at(1), at(2)]
            })
            .collect();
        let used = &expected[..count / 3 * 3];
        match open(&[file("a.glb", maker.glb())], &unwelded()) {
            Ok(imported) => {
                let read: Vec<[f64; 3]> = imported.sequence.reference().iter().map(|p| p.to_array()).collect();
                prop_assert_eq!(read, used);
            }
            Err(error) => prop_assert!(
                used.iter().flatten().any(|x| !x.is_finite()) && error.0.contains("not a finite number"), "{}", error
            ),
        }
    }

    #[test]
    fn damaged_archives(changes in proptest::collection::vec((0..400_usize, any::<u8>()), 0..6), cut in 0..400_usize) {
        let mut zip = zip::ZipWriter::new(std::io::Cursor::new(Vec::new()));
        for name in ["a.obj", "b.obj"] {
            zip.start_file(name, zip::write::SimpleFileOptions::default()).unwrap();
            std::io::Write::write_all(&mut zip, super::QUAD.as_bytes()).unwrap();
        }
        let mut bytes = zip.finish().unwrap().into_inner();
        changes.iter().for_each(|&(at, byte)| if let Some(b) = bytes.get_mut(at) { *b = byte });
        if cut % 2 == 0 {
            bytes.truncate(cut);
        }
        opens_or_says_why("a.zip", bytes);
    }

    #[test]
    fn damaged_stl(changes in proptest::collection::vec((0..134_usize, any::<u8>()), 0..6), text in any::<bool>()) {
        let mut bytes = if text {
            b"solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\n".to_vec()
        } else {
            [&[0; 80][..], &1_u32.to_le_bytes(), &f32s(&[0., 0., 1., 0., 0., 0., 1., 0., 0., 0., 1., 0.]), &[0, 0]].concat()
        };
        changes.iter().for_each(|&(at, byte)| if let Some(b) = bytes.get_mut(at) { *b = byte });
        opens_or_says_why("a.stl", bytes);
    }
}
