//! The crate as wasm, in a dedicated worker, where it computes.
#![cfg(target_arch = "wasm32")]

#[path = "common/wasm_cases.rs"]
mod cases;

wasm_bindgen_test::wasm_bindgen_test_configure!(run_in_dedicated_worker);
