//! The built page in a real browser, on WebGPU and on WebGL2. See [`harness`] for how to write such a test.
#![cfg(not(target_arch = "wasm32"))]

mod everyone;
#[allow(dead_code, reason = "a harness offers more than is used today")]
mod harness;
mod looking;
mod opening;
mod pairs;
mod phone;
mod players;
mod sharing;
mod source;
mod stages;
mod watching;
