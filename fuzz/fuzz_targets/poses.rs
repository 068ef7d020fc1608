//! Two mesh files, the second a pose of the first: the parts of the input on both sides of a zero byte.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let end = data.iter().position(|&b| b == 0).unwrap_or(data.len());
    let (first, rest) = data.split_at(end);
    sinew_fuzz::opens_or_says_why(&[("a1.obj", first), ("a2.off", rest.get(1..).unwrap_or_default())]);
});
