//! A harness that drives the built page in a real Chromium.
//!
//! It speaks the browser's own protocol (Chrome DevTools Protocol) over a pipe, with nothing in between. As many pages
//! are open at a time as threads run tests (four at most), each in browsers of its own: one for each [`Backend`],
//! started when first needed; every [`Page`] is a fresh tab. A test whose subject is time opens its page with
//! `Page::open_alone`: then no other is open.
//!
//! ```ignore
//! let mut page = Page::open(Backend::WebGpu, Screen::Desktop, "?creature=snake");
//! page.wait_until("sinew.ready", 10.0);             // a JavaScript condition, seconds; fails with a screenshot
//! let parts = page.evaluate("sinew.state().parts"); // a serde_json::Value; promises are awaited
//! page.drop_files(&[("hinge.glb", &bytes)]);        // a real drag from outside the browser, at the middle
//! page.choose_files("#file", &[("a.obj", &a)]);     // into an <input type="file">
//! page.click("#play");                              // a real mouse click in the middle of the element
//! page.drag("canvas", (100.0, 0.0));                // press, move, release
//! page.press("Escape");                             // a key, by its `KeyboardEvent.key`
//! page.prefer(&[("prefers-color-scheme", "dark")]); // media features
//! let picture = page.screenshot("hinge");           // also target/screenshots/hinge-webgpu-desktop.png
//! let canvas = page.picture_of("canvas", "canvas"); // the same, cut to one element
//! assert!(canvas.colours() > 100);
//! page.expect_problem("is not a glTF");             // the next check lets this problem pass
//! ```
//!
//! A page that reports an error on its console, throws, rejects unheard, violates its Content-Security-Policy,
//! crashes, fails to load something or asks any other host for anything fails its test when it goes out of scope;
//! so does a worker that it starts.
//!
//! The address of the page comes in the variable `SINEW_PAGE`; `cargo xtask test` builds and serves the page and sets
//! it. By hand: `cargo xtask serve`, and in another terminal
//! `SINEW_PAGE=http://127.0.0.1:8080/ cargo test --test page -- --ignored`.

pub mod browser;
pub mod glb;
pub mod page;
pub mod picture;

pub use browser::Backend;
pub use page::{Page, Screen};
