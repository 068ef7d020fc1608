//! A Draco mesh in an otherwise sound file.
#![no_main]

use sinew_fuzz::{glb, json, opens_or_says_why};

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let document = json!({
        "asset": {"version": "2.0"},
        "nodes": [{"mesh": 0, "skin": 0}, {}],
        "skins": [{"joints": [1]}],
        "meshes": [{"primitives": [{
            "attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2},
            "extensions": {"KHR_draco_mesh_compression": {
                "bufferView": 0, "attributes": {"POSITION": 0, "JOINTS_0": 1, "WEIGHTS_0": 2}}},
        }]}],
        "accessors": [
            {"componentType": 5126, "count": 3, "type": "VEC3"},
            {"componentType": 5121, "count": 3, "type": "VEC4"},
            {"componentType": 5126, "count": 3, "type": "VEC4"},
        ],
        "bufferViews": [{"buffer": 0, "byteLength": data.len()}],
        "buffers": [{"byteLength": data.len()}],
    });
    opens_or_says_why(&[("a.glb", &glb(&document, data))]);
});
