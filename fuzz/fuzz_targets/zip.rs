//! One zip file.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| sinew_fuzz::opens_or_says_why(&[("a.zip", data)]));
