//! Less common ways to say where things are: many joints, sparse everything, cubic everything, instances, pointers.

use super::gltf_maker::{Maker, f32s, skinned, triangle};
use super::{close, file, import, refusal, unwelded};
use serde_json::{Value, json};
use sinew::import::{Options, Sampling, open};

#[test]
fn any_number_of_joint_sets() {
    let mut maker = skinned();
    // Five sets; only the last gives weight, to the second joint.
    let none = maker.accessor(&f32s(&[0.0; 12]), 5126, "VEC4", 3);
    let all = maker.accessor(&f32s(&[0., 0., 1., 0.].repeat(3)), 5126, "VEC4", 3);
    let joints = maker.accessor(&[0; 24], 5123, "VEC4", 3);
    let second = maker.accessor(&[0, 0, 0, 0, 1, 0, 0, 0].repeat(3), 5123, "VEC4", 3);
    for set in 0..5 {
        let attributes = &mut maker.json["meshes"][0]["primitives"][0]["attributes"];
        attributes[format!("JOINTS_{set}")] = json!(if set == 4 { second } else { joints });
        attributes[format!("WEIGHTS_{set}")] = json!(if set == 4 { all } else { none });
    }
    maker.animate("translation", "LINEAR", &[0.0, 1.0], &[1., 0., 0., 1., 0., 2.], "VEC3");
    maker.json["animations"][0]["channels"][0]["target"]["node"] = json!(3);
    let imported = import(&maker);
    let last = &imported.sequence.poses().last().unwrap().positions;
    for (posed, resting) in last.iter().zip(imported.sequence.reference()) {
        close(*posed - *resting, [0.0, 0.02, 0.0]);
    }
}

/// Moves the values of every accessor into a sparse part over a base of zeros that is nowhere in the file.
fn made_sparse(maker: &mut Maker) {
    for number in 0..maker.json["accessors"].as_array().unwrap().len() {
        let mut accessor = maker.json["accessors"][number].clone();
        let count = accessor["count"].as_u64().unwrap();
        let indices = maker.view(&(0..count as u32).flat_map(u32::to_le_bytes).collect::<Vec<u8>>());
        let view = accessor.as_object_mut().unwrap().remove("bufferView").unwrap();
        accessor["sparse"] = json!({
            "count": count,
            "indices": {"bufferView": indices, "componentType": 5125},
            "values": {"bufferView": view},
        });
        maker.json["accessors"][number] = accessor;
    }
}

#[test]
fn everything_may_be_sparse() {
    let mut maker = super::gltf_maker::rich();
    let indices = maker.accessor(&[2, 1, 0], 5121, "SCALAR", 3);
    maker.json["meshes"][0]["primitives"][0]["indices"] = json!(indices);
    for clip in 0..3 {
        let options = Options { clip: Some(clip.to_string()), ..unwelded() };
        let plain = open(&[file("made.glb", maker.glb())], &options).unwrap();
        let mut sparse = maker.clone();
        made_sparse(&mut sparse);
        assert_eq!(open(&[file("made.glb", sparse.glb())], &options).unwrap().sequence, plain.sequence, "clip {clip}");
    }
}

#[test]
fn cubic_splines_of_every_property() {
    // Tangents of zero: halfway between two keys lies the middle of their values.
    let at_half = |path: &str, from: &[f32], to: &[f32], shape: &str| {
        let mut maker = triangle();
        let offsets = maker.accessor(&f32s(&[0., 0., 1., 0., 0., 0., 0., 0., 0.]), 5126, "VEC3", 3);
        maker.json["meshes"][0]["primitives"][0]["targets"] = json!([{"POSITION": offsets}]);
        let flat = vec![0.0; from.len()];
        let values = [&flat, from, &flat, &flat, to, &flat].concat();
        maker.animate(path, "CUBICSPLINE", &[0.0, 1.0], &values, shape);
        let options = Options { sampling: Sampling::Rate(2.0), ..unwelded() };
        open(&[file("made.glb", maker.glb())], &options).unwrap().sequence.poses()[1].positions.clone()
    };
    close(at_half("translation", &[0., 0., 0.], &[4., 0., 2.], "VEC3")[0], [2.0, 0.0, 1.0]);
    close(at_half("scale", &[1., 1., 1.], &[3., 1., 1.], "VEC3")[1], [2.0, 0.0, 0.0]);
    close(at_half("weights", &[0.], &[3.], "SCALAR")[0], [0.0, 0.0, 1.5]);
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let sine = half as f32;
    close(at_half("rotation", &[0., 0., 0., 1.], &[0., 0., sine, sine], "VEC4")[1], [half, half, 0.0]);
}

#[test]
fn nodes_above_a_skin_move_it() {
    let mut maker = skinned();
    // Node 1 is above both joints; the scene's scale of a hundredth is its own.
    maker.animate("translation", "LINEAR", &[0.0, 1.0], &[0., 0., 0., 3., 0., 0.], "VEC3");
    maker.json["animations"][0]["channels"][0]["target"]["node"] = json!(1);
    let imported = import(&maker);
    let last = &imported.sequence.poses().last().unwrap().positions;
    close(last[1] - imported.sequence.reference()[1], [3.0, 0.0, 0.0]);
    // The node that shows the mesh does not.
    let target = &mut maker.json["animations"][0]["channels"][0]["target"];
    target["node"] = json!(0);
    assert_eq!(import(&maker).clip, None);
}

#[test]
fn one_mesh_at_several_nodes() {
    let mut maker = triangle();
    maker.json["nodes"] = json!([{"mesh": 0, "children": [1]}, {"mesh": 0, "translation": [5, 0, 0]}]);
    let imported = import(&maker);
    assert_eq!(imported.sequence.faces(), [[0, 1, 2], [3, 4, 5]]);
    close(imported.sequence.reference()[3], [5.0, 0.0, 0.0]);
}

fn instanced(maker: &mut Maker, attributes: Value) {
    maker.json["nodes"][0]["extensions"] = json!({"EXT_mesh_gpu_instancing": {"attributes": attributes}});
    maker.json["extensionsRequired"] = json!(["EXT_mesh_gpu_instancing"]);
}

#[test]
fn instances_of_one_node() {
    let mut maker = triangle();
    let places = maker.accessor(&f32s(&[0., 0., 0., 7., 0., 0.]), 5126, "VEC3", 2);
    let sizes = maker.accessor(&f32s(&[1., 1., 1., 2., 2., 2.]), 5126, "VEC3", 2);
    // None and a half turn about z, as normalised bytes.
    let turns = maker.accessor(&[0, 0, 0, 127, 0, 0, 127, 0], 5120, "VEC4", 2);
    maker.json["accessors"][turns]["normalized"] = json!(true);
    maker.json["nodes"][0]["translation"] = json!([0, 0, 1]);
    instanced(&mut maker, json!({"TRANSLATION": places, "SCALE": sizes, "ROTATION": turns, "_ID": 99}));
    let imported = import(&maker);
    assert_eq!(imported.sequence.faces().len(), 2);
    close(imported.sequence.reference()[1], [1.0, 0.0, 1.0]);
    close(imported.sequence.reference()[4], [5.0, 0.0, 1.0]);
    let mut short = maker.clone();
    short.json["accessors"][sizes]["count"] = json!(1);
    assert!(refusal(&short).contains("instances of node 0"));
    maker.json["accessors"][places] = json!({"componentType": 5126, "type": "VEC3", "count": 4_000_000_000_u32});
    instanced(&mut maker, json!({"TRANSLATION": places}));
    assert!(refusal(&maker).contains("do not fit into"));
}

#[test]
fn pointers_to_nodes_move_them() {
    let mut maker = triangle();
    maker.animate("translation", "LINEAR", &[0.0, 1.0], &[0., 0., 0., 4., 0., 0.], "VEC3");
    maker.json["animations"][0]["channels"][0]["target"] = json!({"path": "pointer", "extensions": {
        "KHR_animation_pointer": {"pointer": "/nodes/0/translation"}}});
    close(import(&maker).sequence.poses().last().unwrap().positions[0], [4.0, 0.0, 0.0]);
}

#[test]
fn extensions_of_the_look_stop_no_file() {
    let mut maker = triangle();
    maker.json["extensionsRequired"] = json!(["KHR_materials_unlit", "KHR_texture_basisu", "KHR_lights_punctual"]);
    maker.json["materials"] = json!([{"extensions": {"KHR_materials_unlit": 7}, "alphaMode": -3}]);
    maker.json["meshes"][0]["primitives"][0]["material"] = json!(55);
    let imported = import(&maker);
    let codes: Vec<_> = imported.warnings.iter().map(|w| w.code).collect();
    assert_eq!(codes, ["look-left-out", "no-animation"]);
}

#[test]
fn buffers_in_the_document() {
    for head in ["data:application/octet-stream;base64,", "DATA:application/gltf-buffer;BASE64,"] {
        let (document, bytes) = triangle().split("x");
        let address = format!("{head}{}", base64::Engine::encode(&base64::prelude::BASE64_STANDARD, bytes));
        let document = String::from_utf8(document).unwrap().replace("\"x\"", &json!(address).to_string());
        assert_eq!(open(&[file("made.gltf", document)], &unwelded()).unwrap().sequence.faces().len(), 1);
    }
    let (document, _) = triangle().split("data:application/octet-stream;base64,@@@@");
    assert!(open(&[file("made.gltf", document)], &unwelded()).unwrap_err().0.contains("not valid base64"));
}

#[test]
fn a_mirrored_node_is_wound_the_other_way_round() {
    let area = |maker: &Maker| {
        let sequence = import(maker).sequence;
        let [a, b, c] = sequence.faces()[0].map(|v| sequence.reference()[v as usize]);
        (b - a).cross(c - a)
    };
    let plain = triangle();
    let mut mirrored = triangle();
    mirrored.json["nodes"][0]["scale"] = json!([-1.0, 1.0, 1.0]);
    let (as_it_is, in_the_mirror) = (area(&plain), area(&mirrored));
    // The triangle lies in the plane of x and y, and still shows the same side to z.
    assert!(as_it_is.z * in_the_mirror.z > 0.0, "{as_it_is} {in_the_mirror}");
}
