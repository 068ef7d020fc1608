//! Seconds since an arbitrary start, on every target.
//!
//! `std::time::Instant` compiles for wasm32 and panics when called, so nothing else in the crate uses it.

/// Seconds since an arbitrary, fixed start. Only differences mean anything.
#[cfg(not(target_arch = "wasm32"))]
#[allow(clippy::disallowed_types)]
pub fn seconds() -> f64 {
    use std::sync::OnceLock;
    use std::time::Instant;
    static START: OnceLock<Instant> = OnceLock::new();
    START.get_or_init(Instant::now).elapsed().as_secs_f64()
}

/// Seconds since an arbitrary, fixed start. Only differences mean anything.
#[cfg(target_arch = "wasm32")]
pub fn seconds() -> f64 {
    #[cfg(any(feature = "worker", feature = "page"))]
    {
        js_sys::Date::now() / 1000.0
    }
    #[cfg(not(any(feature = "worker", feature = "page")))]
    {
        0.0
    }
}
