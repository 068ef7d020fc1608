//! The two wasm entries: the page, which draws, and the worker, which computes.
