//! What a visitor sees first.

use crate::harness::{Backend, Page, Screen};

/// Seconds from asking for the page to the first painted creature. The page is meant to need less than 3 on an idle
/// machine; a busy one gets more before the test fails.
pub const FIRST_PICTURE: f64 = 10.0;

/// Opens the page and waits until the creature is painted and the paint has come to rest.
pub fn opened(backend: Backend, screen: Screen, tail: &str) -> Page {
    let mut page = Page::open(backend, screen, tail);
    page.wait_until(SETTLED, 6.0 * FIRST_PICTURE);
    page
}

/// The same with nothing else open, for what measures time.
pub fn opened_alone(backend: Backend, screen: Screen, tail: &str) -> Page {
    let mut page = Page::open_alone(backend, screen, tail);
    page.wait_until(SETTLED, 6.0 * FIRST_PICTURE);
    page
}

/// Nothing runs and the paint is where it belongs.
pub const SETTLED: &str =
    "sinew.ready && sinew.state().parts && !sinew.state().busy && !sinew.state().flowing && sinew.state().drawn";

fn opens_on_a_painted_creature(backend: Backend, screen: Screen) {
    let mut page = Page::open_alone(backend, screen, "");
    page.wait_until("sinew.ready && sinew.state().parts > 1", 6.0 * FIRST_PICTURE);
    let painted = page.evaluate("performance.now() / 1000").as_f64().unwrap_or(f64::INFINITY);
    let first = "performance.getEntriesByName('first-picture')[0].startTime / 1000";
    let seconds = page.evaluate(first).as_f64().unwrap_or(f64::INFINITY);
    println!("on {}: first picture after {seconds:.2} s, painted after {painted:.2} s", backend.name());
    assert!(seconds < FIRST_PICTURE, "the first picture took {seconds} s");
    page.wait_until(SETTLED, 20.0);
    let state = page.state();
    assert_eq!(state["backend"], backend.name(), "{state}");
    assert_eq!(state["error"], serde_json::Value::Null, "{state}");
    assert!(state["source"]["faces"].as_u64().is_some_and(|faces| faces >= 1000), "{state}");
    assert!(state["source"]["poses"].as_u64().is_some_and(|poses| poses >= 2), "{state}");
    page.rest(0.3);
    let mut canvas = page.picture_of("canvas", "opening");
    // A busy machine shows a picture some time after it was drawn.
    for _ in 0..6 {
        if canvas.hues(0.001) >= 3 {
            break;
        }
        page.rest(0.4);
        canvas = page.picture_of("canvas", "opening");
    }
    assert!(canvas.colours() > 200, "the canvas has only {} colours", canvas.colours());
    assert!(canvas.hues(0.001) >= 3, "the canvas has only {} hues", canvas.hues(0.001));
    assert_eq!(page.state()["playing"], true);
    page.wait_until_changed("canvas", "moving", &canvas, 0.002);
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
fn webgl2_can_be_asked_for() {
    let mut page = Page::open(Backend::WebGpu, Screen::Still, "?backend=webgl2");
    page.wait_until("sinew.ready", 6.0 * FIRST_PICTURE);
    assert_eq!(page.state()["backend"], "webgl2");
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn the_visitors_wishes_are_respected() {
    let mut page = Page::open(Backend::WebGl2, Screen::Small, "");
    page.prefer(&[("prefers-color-scheme", "light"), ("prefers-reduced-motion", "reduce")]);
    page.go("");
    page.wait_until("sinew.ready && !sinew.state().busy", 6.0 * FIRST_PICTURE);
    let state = page.state();
    assert_eq!((&state["playing"], &state["flowing"]), (&false.into(), &false.into()), "nothing moves: {state}");
    page.wait_until("sinew.state().drawn", 20.0);
    let light = page.screenshot("light").brightness();
    page.prefer(&[("prefers-color-scheme", "dark"), ("prefers-reduced-motion", "reduce")]);
    page.wait_until("sinew.app.stage.kept.dark && sinew.state().drawn", 20.0);
    page.rest(0.3);
    let dark = page.screenshot("dark").brightness();
    assert!(light > 150.0 && dark < 100.0, "light {light}, dark {dark}");
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_lost_device_is_survived() {
    let mut page = opened(Backend::WebGl2, Screen::Small, "");
    let before = page.state();
    page.evaluate("window.lost = document.querySelector('#stage canvas')");
    page.evaluate("lost.getContext('webgl2').getExtension('WEBGL_lose_context').loseContext()");
    page.wait_until("!lost.isConnected && document.querySelector('#stage canvas')", 5.0);
    page.rest(1.0);
    page.wait_until("sinew.state().drawn", 20.0);
    let canvas = page.picture_of("canvas", "after-a-loss");
    assert!(canvas.hues(0.001) >= 3, "the new canvas has only {} hues", canvas.hues(0.001));
    let after = page.state();
    for what in ["source", "parts", "view", "error"] {
        assert_eq!(after[what], before[what], "{what}");
    }
}

/// A tetrahedron with a picture, and the files that an OBJ has beside it.
const TETRAHEDRON: &str = "mtllib t.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl skin\n\
    f 1/1 3/2 2/3\nf 1/1 2/2 4/3\nf 1/1 4/2 3/3\nusemtl eye\nf 2/1 3/2 4/3\n";
const MATERIALS: &str = "newmtl skin\nmap_Kd t.png\nnewmtl eye\nKd 0 0.5 1\n";

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn without_any_gpu_all_but_the_picture_works() {
    let tail = "?backend=none#v1;zoo=snake;faces=3000;step=keypoints;points=12,407,900,1300";
    let mut page = Page::open(Backend::WebGl2, Screen::Still, tail);
    page.wait_until("sinew.ready && sinew.state().parts > 1 && !sinew.state().busy", 60.0);
    assert_eq!(page.evaluate("document.querySelector('#no-gpu').hidden"), false, "it is said");
    let dots =
        "new Set([...document.querySelectorAll('#panel .pin-dot')].map((dot) => dot.style.backgroundColor)).size";
    assert_eq!(page.evaluate(dots), 4, "points have colours of their own");
    let made = "sinew.app.parts.export().then((bytes) => { const text = new TextDecoder().decode(bytes);
        return [new Set(text.match(/\"baseColorFactor\":\\[[^\\]]*/g)).size, sinew.state().parts].join(); })";
    let (colours, parts) = (page.evaluate_within(made, 20.0), page.state()["parts"].as_u64().unwrap_or(0));
    assert_eq!(colours, format!("{parts},{parts}"), "so have the parts in their file");
    // A target in an OBJ with what lies beside it.
    page.evaluate("sinew.app.setStep('target')");
    let files: [(&str, &[u8]); 3] =
        [("t.obj", TETRAHEDRON.as_bytes()), ("t.mtl", MATERIALS.as_bytes()), ("t.png", b"\x89PNG\r\n\x1a\n")];
    page.drop_files(&files);
    page.wait_until("sinew.state().target && !sinew.state().busy", 20.0);
    page.wait_until("sinew.state().tally.missing === 0 && !sinew.state().busy", 20.0);
    // Some of them where others are proposed.
    page.evaluate("[3, 2, 1, 0].forEach((vertex, i) => sinew.app.target.place(i, vertex))");
    page.evaluate("sinew.app.setStep('export')");
    page.wait_until("sinew.state().moves?.pairs === 4 && !sinew.state().busy", 30.0);
    let images = "sinew.app.transfer.file('exact').then(({ images }) => images)";
    assert_eq!(page.evaluate_within(images, 20.0), 1);
    page.wait_until("document.querySelector('#panel').innerText.includes('In its own materials and 1 texture')", 10.0);
    assert_eq!(page.state()["error"], serde_json::Value::Null);
    let painted = "sinew.app.parts.segment().then(() => sinew.app.stage.kept.paint.at(-1)[0])";
    assert_eq!(
        page.evaluate_within(painted, 20.0),
        "paint_clay",
        "new parts do not show where both figures are of clay"
    );
    // What lies beside an OBJ of an address comes with it, and what is left out by Cancel is asked for no more.
    page.evaluate(&format!(
        "window.there = {{ 't.obj': {}, 'looks/t.mtl': {}, 'looks/t.png': Uint8Array.of(137, 80, 78, 71, 13, 10, 26, 10) }};
        window.fetch = async (url) => {{ const found = there[new URL(url).pathname.split('/models/')[1]];
            return new Response(found, {{ status: found ? 200 : 404 }}); }}",
        serde_json::json!(TETRAHEDRON.replace("t.mtl", "looks\\t.mtl")),
        serde_json::json!(MATERIALS)
    ));
    let opened = "sinew.app.opener.openAddress('models/t.obj').then(() => sinew.app.source.files.map(({ name }) => name).join())";
    assert_eq!(page.evaluate_within(opened, 20.0), "t.obj,looks/t.mtl,looks/t.png");
    let images = "sinew.app.parts.exportRigid().then(({ images }) => images)";
    assert_eq!(page.evaluate_within(images, 20.0), 1, "they are in what is taken away");
    page.evaluate(
        "window.fetch = (url, { signal }) => new Promise((_, no) => signal.addEventListener('abort', () => no(signal.reason)))",
    );
    let cancelled = "(setTimeout(() => sinew.app.cancel(), 50), sinew.app.opener.openAddress('models/t.obj'))";
    assert_eq!(page.evaluate_within(cancelled, 5.0), false);
    assert_eq!(page.state()["error"], serde_json::Value::Null);
    page.evaluate("sinew.app.undo()");
    page.wait_until("sinew.state().source.name === 'snake' && !sinew.state().busy", 20.0);
    // A link opens its two figures in one step, and undo goes back over both; also where the page brings the address up
    // to date before it hears of the link.
    page.evaluate(
        "{ const { href } = location;
        location.hash = 'v1;zoo=octopus;faces=3000;target=cactus;target.faces=3000';
        history.replaceState(null, '', href); }",
    );
    let there = "sinew.state().source.name === 'octopus' && sinew.state().target?.name === 'cactus'";
    page.wait_until(&format!("{there} && sinew.state().parts && !sinew.state().busy"), 60.0);
    page.evaluate("sinew.app.undo()");
    page.wait_until("sinew.state().source.name === 'snake' && sinew.state().target?.name.startsWith('t')", 10.0);
    page.wait_until("sinew.state().parts && !sinew.state().busy", 30.0);
}
