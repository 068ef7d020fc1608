//! A document up to the first zero byte, its buffer after that; or a GLB.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    if data.starts_with(b"glTF") {
        return sinew_fuzz::opens_or_says_why(&[("a.glb", data)]);
    }
    let end = data.iter().position(|&b| b == 0).unwrap_or(data.len());
    let (text, rest) = data.split_at(end);
    let buffer = rest.get(1..).unwrap_or_default();
    sinew_fuzz::opens_or_says_why(&[("a.gltf", text), ("a.bin", buffer)]);
});
