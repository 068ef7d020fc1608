//! What a visitor drops on the page.

use crate::harness::{Backend, Page, Screen, glb};
use crate::opening::SETTLED;

fn a_dropped_file_is_painted(backend: Backend) {
    let mut page = Page::open(backend, Screen::Small, "");
    page.wait_until("sinew.ready && !sinew.state().busy", 20.0);
    page.drop_files(&[("hinge.glb", &glb::hinge(24))]);
    page.wait_until("sinew.state().source.name.includes('hinge') && sinew.state().parts === 2", 10.0);
    let state = page.state();
    assert_eq!(state["error"], serde_json::Value::Null, "{state}");
    assert_eq!(state["source"]["vertices"], 24 * 12 + 2, "{state}");
    assert_eq!(state["source"]["faces"], 24 * 24, "{state}");
    assert!(state["source"]["poses"].as_u64().is_some_and(|poses| poses > 2), "{state}");
    page.wait_until(SETTLED, 15.0);
    page.rest(0.3);
    let canvas = page.picture_of("canvas", "hinge");
    assert!(canvas.hues(0.001) >= 2, "the canvas has only {} hues", canvas.hues(0.001));
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_dropped_file_is_painted_on_webgpu() {
    a_dropped_file_is_painted(Backend::WebGpu);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_dropped_file_is_painted_on_webgl2() {
    a_dropped_file_is_painted(Backend::WebGl2);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_bad_file_is_refused_in_words_and_nothing_is_lost() {
    let mut page = Page::open(Backend::WebGpu, Screen::Small, "");
    page.wait_until("sinew.ready && sinew.state().parts > 1 && !sinew.state().busy", 20.0);
    let before = page.state();
    let cut = &glb::hinge(24)[..2000];
    page.drop_files(&[("half.glb", cut)]);
    page.wait_until("sinew.state().error", 10.0);
    let after = page.state();
    assert!(after["error"].as_str().is_some_and(|error| error.len() > 20), "{after}");
    assert_eq!(after["source"], before["source"], "what was open stays open");
    assert_eq!(after["parts"], before["parts"], "what was painted stays painted");
}
