//! The crate as wasm, in a page of a browser.
#![cfg(target_arch = "wasm32")]

#[path = "common/wasm_cases.rs"]
mod cases;

wasm_bindgen_test::wasm_bindgen_test_configure!(run_in_browser);
