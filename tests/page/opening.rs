//! What a visitor sees first.

use crate::harness::{Backend, Page, Screen};

/// Seconds from asking for the page to the first painted creature. The page is meant to need less than 3 on an idle
/// machine; a busy one gets more before the test fails.
const FIRST_PICTURE: f64 = 10.0;

fn opens_on_a_painted_creature(backend: Backend, screen: Screen) {
    let mut page = Page::open(backend, screen, "");
    let seconds = page.wait_until("sinew.ready && sinew.state().parts > 1", FIRST_PICTURE);
    println!("first picture on {} after {seconds:.2} s", backend.name());
    let state = page.state();
    assert_eq!(state["backend"], backend.name(), "{state}");
    assert_eq!(state["error"], serde_json::Value::Null, "{state}");
    assert!(state["source"]["faces"].as_u64().is_some_and(|faces| faces >= 1000), "{state}");
    assert!(state["source"]["poses"].as_u64().is_some_and(|poses| poses >= 2), "{state}");
    page.rest(0.5);
    let canvas = page.picture_of("canvas", "opening");
    assert!(canvas.colours() > 200, "the canvas has only {} colours", canvas.colours());
    assert!(canvas.hues(0.001) >= 3, "the canvas has only {} hues", canvas.hues(0.001));
}

fn the_creature_moves(backend: Backend) {
    let mut page = Page::open(backend, Screen::Desktop, "");
    page.wait_until("sinew.ready && sinew.state().parts > 1 && sinew.state().playing", FIRST_PICTURE);
    let before = page.picture_of("canvas", "moving-1");
    page.rest(0.35);
    let after = page.picture_of("canvas", "moving-2");
    let changed = before.difference(&after, 8);
    assert!(changed > 0.002, "only {:.3} % of the canvas changed", 100.0 * changed);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn opens_on_webgpu() {
    opens_on_a_painted_creature(Backend::WebGpu, Screen::Desktop);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn opens_on_webgl2() {
    opens_on_a_painted_creature(Backend::WebGl2, Screen::Desktop);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn opens_on_a_phone_with_webgpu() {
    opens_on_a_painted_creature(Backend::WebGpu, Screen::Phone);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn opens_on_a_phone_with_webgl2() {
    opens_on_a_painted_creature(Backend::WebGl2, Screen::Phone);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn moves_on_webgpu() {
    the_creature_moves(Backend::WebGpu);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn moves_on_webgl2() {
    the_creature_moves(Backend::WebGl2);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn webgl2_can_be_asked_for() {
    let mut page = Page::open(Backend::WebGpu, Screen::Desktop, "?backend=webgl2");
    page.wait_until("sinew.ready", FIRST_PICTURE);
    assert_eq!(page.state()["backend"], "webgl2");
}
