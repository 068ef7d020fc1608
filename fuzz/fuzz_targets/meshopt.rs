//! Compressed buffer views in an otherwise sound file. The first four bytes choose mode, filter, stride and count.
#![no_main]

use sinew_fuzz::{glb, json, opens_or_says_why};

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let Some((&[mode, filter, stride, count], data)) = data.split_first_chunk() else { return };
    let mode = ["ATTRIBUTES", "TRIANGLES", "INDICES"][usize::from(mode % 3)];
    let filter = ["NONE", "OCTAHEDRAL", "QUATERNION", "EXPONENTIAL", "COLOR"][usize::from(filter % 5)];
    let (stride, count) = (u64::from(stride), u64::from(count));
    let view = json!({"buffer": 0, "byteLength": stride * count, "extensions": {"KHR_meshopt_compression": {
        "buffer": 0, "byteLength": data.len(), "byteStride": stride, "count": count, "mode": mode, "filter": filter}}});
    let attributes = mode == "ATTRIBUTES";
    let document = json!({
        "asset": {"version": "2.0"},
        "nodes": [{"mesh": 0}],
        "meshes": [{"primitives": [if attributes {
            json!({"attributes": {"POSITION": 0}})
        } else {
            json!({"attributes": {"POSITION": 1}, "indices": 0})
        }]}],
        "accessors": [
            if attributes {
                json!({"componentType": 5126, "count": count, "type": "VEC3", "bufferView": 0})
            } else {
                json!({"componentType": if stride == 2 { 5123 } else { 5125 }, "count": count, "type": "SCALAR",
                    "bufferView": 0})
            },
            {"componentType": 5126, "count": 70_000, "type": "VEC3"},
        ],
        "bufferViews": [view],
        "buffers": [{"byteLength": data.len()}],
    });
    opens_or_says_why(&[("a.glb", &glb(&document, data))]);
});
