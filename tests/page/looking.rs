//! What a visitor does with a creature that is open.

use crate::harness::{Backend, Page, Screen};
use crate::opening::{SETTLED, opened, opened_alone};
use serde_json::Value;

/// Seconds for what is to answer at once; an idle machine needs far less.
const AT_ONCE: f64 = 1.5;

/// The stages of the parts, in order.
pub const VIEWS: [&str; 11] = [
    "gradients",
    "deformation",
    "dual",
    "sets",
    "distance",
    "features",
    "clusters",
    "merging",
    "unsmoothed",
    "cut",
    "parts",
];

/// Sets a slider as a hand does.
fn slide(page: &mut Page, selector: &str, value: u32) {
    page.evaluate(&format!(
        "(() => {{ const slider = document.querySelector('{selector}'); slider.value = {value};
        for (const name of ['input', 'change']) slider.dispatchEvent(new Event(name, {{ bubbles: true }})); }})()"
    ));
}

fn parts_and_views(backend: Backend) {
    let mut page = opened(backend, Screen::Small, "");
    page.press("r");
    page.wait_until("sinew.state().time === -1", AT_ONCE);
    for count in [5, 12, 2] {
        let before = page.seconds();
        slide(&mut page, "#control-number-of-parts", count);
        let after = page.wait_until(&format!("sinew.state().parts === {count}"), AT_ONCE);
        println!("{count} parts on {} after {:.0} ms", backend.name(), 1000.0 * (after - before));
    }
    let mut last = None;
    for view in VIEWS {
        page.click(&format!("label:has(#control-view-{view})"));
        page.wait_until(&format!("sinew.state().view === '{view}'"), AT_ONCE);
        page.rest(0.4);
        let picture = page.picture_of("canvas", &format!("view-{view}"));
        assert!(picture.colours() > 100, "{view} has only {} colours", picture.colours());
        let legend = page.evaluate("document.querySelector('.legend').innerText.trim()");
        assert!(legend.as_str().is_some_and(|words| words.len() > 3), "{view} has no legend: {legend}");
        let changed = last.map_or(1.0, |last| picture.difference(&last, 6));
        // Smoothing and the last round of clustering change little, and with two parts hardly anything.
        assert!(changed > 0.0 || ["unsmoothed", "parts"].contains(&view), "{view} looks like the view before it");
        last = Some(picture);
    }
    // The creature's trunk.
    page.hover("canvas", (0.42, 0.36));
    page.wait_until("!document.querySelector('#tag').hidden", 2.0 * AT_ONCE);
    let tag = page.evaluate("document.querySelector('#tag').innerText");
    for word in ["Face", "Part", "Deformation"] {
        assert!(tag.as_str().is_some_and(|text| text.contains(word)), "{word} is missing: {tag}");
    }
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn parts_and_views_on_webgpu() {
    parts_and_views(Backend::WebGpu);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn parts_and_views_on_webgl2() {
    parts_and_views(Backend::WebGl2);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn keys_do_what_the_sheet_says() {
    let mut page = opened(Backend::WebGl2, Screen::Small, "#v1;zoo=horse;faces=3000");
    page.press(" ");
    page.wait_until("!sinew.state().playing", AT_ONCE);
    let time = page.state()["time"].as_f64().unwrap_or(-1.0);
    page.press(".");
    let poses = page.state()["source"]["poses"].as_f64().unwrap_or(1.0);
    assert_eq!(page.state()["time"].as_f64(), Some((time.round() + 1.0) % poses));
    page.press("r");
    assert_eq!(page.state()["time"], -1);
    let panel = page.state()["panel"].clone();
    page.press("p");
    assert_ne!(page.state()["panel"], panel);
    page.evaluate("document.querySelector('#stage canvas').focus()");
    for (key, what) in [("ArrowLeft", "turns"), ("+", "nears"), ("w", "triangles"), ("f", "frames")] {
        page.rest(0.5);
        let before = page.picture_of("canvas", "key-before");
        page.press(key);
        page.wait_until_changed("canvas", &format!("key-{what}"), &before, 0.001);
    }
    page.press("?");
    page.wait_until("document.querySelector('#keys').open", AT_ONCE);
    page.press("Escape");
    page.wait_until("!document.querySelector('#keys').open", AT_ONCE);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn long_work_is_cancelled_at_once_and_nothing_is_lost() {
    let mut page = opened_alone(Backend::WebGl2, Screen::Small, "");
    let before = page.state();
    // All pairs of faces: this runs for minutes.
    page.evaluate("document.querySelector('#control-exact-distances').closest('details').open = true");
    page.click("#control-exact-distances");
    page.wait_until("sinew.state().busy && !document.querySelector('#progress').hidden", 5.0);
    page.rest(0.5);
    let milliseconds = page.evaluate(
        "new Promise((resolve) => { const start = performance.now();
        document.querySelector('#progress button').click();
        const look = () => sinew.state().busy ? setTimeout(look) : resolve(performance.now() - start); look(); })",
    );
    println!("cancelled after {milliseconds} ms");
    assert!(milliseconds.as_f64().is_some_and(|time| time < 200.0), "Cancel took {milliseconds} ms");
    let after = page.state();
    for what in ["source", "parts", "residual", "view", "error"] {
        assert_eq!(after[what], before[what], "{what}");
    }
    assert_eq!(page.evaluate("document.querySelector('#control-exact-distances').checked"), Value::Bool(false));
    // The engine was started afresh and knows what is open.
    slide(&mut page, "#control-number-of-parts", 4);
    page.wait_until("sinew.state().parts === 4 && !sinew.state().busy", 15.0);
    // Where there were no parts yet, they can still be asked for.
    page.evaluate("void sinew.app.opener.openCreature({ name: 'snake' }); sinew.app.on('source', () => setTimeout(() => sinew.app.cancel()))");
    page.wait_until(
        "!sinew.state().busy && !sinew.state().parts && document.querySelector('#find-parts').checkVisibility()",
        15.0,
    );
    page.click("#find-parts");
    page.wait_until(
        "sinew.state().parts && !sinew.state().busy && !document.querySelector('#find-parts').checkVisibility()",
        15.0,
    );
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_link_brings_everything_back() {
    let mut page = opened(Backend::WebGl2, Screen::Small, "#v1;zoo=camel;faces=3000");
    slide(&mut page, "#control-number-of-parts", 7);
    page.wait_until("sinew.state().parts === 7", 5.0);
    page.click("label:has(#control-view-distance)");
    page.press(" ");
    page.drag("canvas", (90.0, 20.0));
    page.rest(0.8);
    let hash = page.evaluate("location.hash");
    let before = page.state();
    assert_eq!((&before["source"]["name"], &before["playing"]), (&"camel".into(), &false.into()), "{before}");
    page.go(&format!("?again{}", hash.as_str().unwrap_or_default()));
    page.wait_until("location.search === '?again'", 10.0);
    page.wait_until(SETTLED, 20.0);
    page.wait_until("sinew.state().parts === 7", 5.0);
    page.rest(0.8);
    let after = page.state();
    for what in ["source", "parts", "residual", "step", "view", "playing", "panel"] {
        assert_eq!(after[what], before[what], "{what}");
    }
    let time = |state: &Value| state["time"].as_f64().unwrap_or(f64::NAN);
    assert!((time(&after) - time(&before)).abs() < 0.01, "{after} after {before}");
    assert_eq!(page.evaluate("location.hash"), hash);
    let camera = |hash: &Value| hash.as_str().is_some_and(|hash| hash.contains("look="));
    assert!(camera(&hash), "the camera is in the link: {hash}");
}
