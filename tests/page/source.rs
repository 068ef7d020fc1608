//! What a visitor drops on the page.

use crate::harness::{Backend, Page, Screen, glb};
use crate::opening::SETTLED;
use sinew::import::Up;
use sinew::sequence::Pose;
use sinew::zoo::{self, Recipe};

fn a_dropped_file_is_painted(backend: Backend) {
    let mut page = Page::open(backend, Screen::Still, "");
    page.wait_until("sinew.ready && !sinew.state().busy", 20.0);
    page.drop_files(&[("hinge.glb", &glb::hinge(24))]);
    page.wait_until("sinew.state().source.name.includes('hinge') && sinew.state().parts === 2", 30.0);
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
    let mut page = Page::open(Backend::WebGpu, Screen::Still, "");
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

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn what_cannot_be_opened_is_called_by_its_name() {
    let mut page = Page::open(Backend::WebGl2, Screen::Still, "#v1;zoo=snake;faces=3000");
    page.wait_until(SETTLED, 30.0);
    let files: [(&str, &[u8], &str); 4] = [
        ("hero.fbx", b"Kaydara FBX Binary  ", "Export it as glTF"),
        ("hero.glb", b"", "is empty"),
        ("notes.txt", b"nothing to see", "notes.txt is no glTF"),
        ("cut.glb", &glb::hinge(24)[..2000], "cut.glb is cut short"),
    ];
    for (name, bytes, said) in files {
        page.drop_files(&[(name, bytes)]);
        page.wait_until(&format!("sinew.state().error?.includes('{said}') && !sinew.state().busy"), 10.0);
        page.evaluate("sinew.app.dismiss()");
        assert_eq!(page.state()["source"]["name"], "snake");
    }
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_full_memory_ends_in_a_sentence() {
    let mut page = Page::open(Backend::WebGl2, Screen::Still, "#v1;zoo=snake;faces=3000");
    page.wait_until(SETTLED, 30.0);
    let before = page.state();
    // More poses than could be held: refused before it is tried.
    page.drop_files(&[("hinge.glb", &glb::hinge(1500))]);
    page.wait_until("sinew.state().source.name.includes('hinge') && sinew.state().parts && !sinew.state().busy", 60.0);
    let opened = page.state();
    assert_ne!(opened["source"], before["source"]);
    page.evaluate_within("sinew.app.opener.reopen({ sampling: { rate: 6000 } }).then(() => 0)", 60.0);
    let error = page.state()["error"].to_string();
    assert!(error.contains("12003 poses") && error.contains("take fewer poses"), "{error}");
    // What no estimate foresees: more bytes than a wasm module can have. The page itself would not let them through.
    page.expect_problem("The worker broke");
    page.evaluate_within(
        "(() => { const files = ['a', 'b', 'c'].map((name) => ({ name: `${name}.obj`, bytes: new Uint8Array(1.5 * 2 ** 30) }));
        return sinew.app.work.run('source', 'reading', () => sinew.app.engine.call('open',
            { files, options: sinew.app.about.options }, { transfer: files.map(({ bytes }) => bytes.buffer) })).then(() => 0); })()",
        120.0,
    );
    let after = page.state();
    let error = after["error"].to_string();
    println!("a full memory: {error}");
    assert!(error.contains("ran out of memory") && error.contains("nothing that was open is lost"), "{error}");
    for what in ["source", "parts", "residual", "step", "view"] {
        assert_eq!(after[what], opened[what], "{what}");
    }
    page.evaluate("sinew.app.dismiss()");
    page.evaluate("void sinew.app.parts.setCount(4)");
    page.wait_until("sinew.state().parts === 4 && !sinew.state().busy && !sinew.state().error", 30.0);
}

/// A closed box of 3 × 3 × 3 squares a side that bends, with a hole of one square, a face that is there twice, a face
/// without area, a face that shows its back, and a small piece beside it that stands still. In two poses.
fn broken_boxes() -> [String; 2] {
    let at = |i: usize, j: usize, k: usize| (i as f64, j as f64, k as f64);
    let mut corners: Vec<(f64, f64, f64)> = Vec::new();
    let mut number = |p: (f64, f64, f64)| {
        let found = corners.iter().position(|&q| q == p);
        found.unwrap_or_else(|| {
            corners.push(p);
            corners.len() - 1
        })
    };
    let mut faces: Vec<[usize; 3]> = Vec::new();
    for (i, j) in (0..3).flat_map(|i| (0..3).map(move |j| (i, j))) {
        // Each side of the box, its corners counter-clockwise from outside.
        let sides: [[(f64, f64, f64); 4]; 6] = [
            [at(i, j, 3), at(i + 1, j, 3), at(i + 1, j + 1, 3), at(i, j + 1, 3)],
            [at(i, j, 0), at(i, j + 1, 0), at(i + 1, j + 1, 0), at(i + 1, j, 0)],
            [at(3, i, j), at(3, i + 1, j), at(3, i + 1, j + 1), at(3, i, j + 1)],
            [at(0, i, j), at(0, i, j + 1), at(0, i + 1, j + 1), at(0, i + 1, j)],
            [at(i, 3, j), at(i, 3, j + 1), at(i + 1, 3, j + 1), at(i + 1, 3, j)],
            [at(i, 0, j), at(i + 1, 0, j), at(i + 1, 0, j + 1), at(i, 0, j + 1)],
        ];
        for side in sides {
            let [a, b, c, d] = side.map(&mut number);
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    // The square in the middle of the first side.
    faces.drain(48..50);
    let [a, b, c] = faces[20];
    faces[20] = [b, a, c];
    faces.extend([faces[40], [faces[50][0], faces[50][0], faces[50][1]]]);
    let first = corners.len();
    corners.extend([(5.0, 0.0, 0.0), (6.0, 0.0, 0.0), (5.0, 1.0, 0.0), (5.0, 0.0, 1.0)]);
    faces.extend([[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]].map(|f| f.map(|v| v + first)));
    let written = |lean: f64| {
        let vertex = |(v, &(x, y, z)): (usize, &(f64, f64, f64))| {
            let lean = if v < first { lean } else { 0.0 };
            format!("v {} {y} {z}\n", x + lean * y * y)
        };
        let vertices: String = corners.iter().enumerate().map(vertex).collect();
        let faces: String = faces.iter().map(|[a, b, c]| format!("f {} {} {}\n", a + 1, b + 1, c + 1)).collect();
        vertices + &faces
    };
    [written(0.0), written(0.1)]
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn what_is_wrong_with_a_mesh_is_counted_and_shown() {
    let mut page = Page::open(Backend::WebGpu, Screen::Still, "");
    page.wait_until("sinew.ready && !sinew.state().busy", 20.0);
    let [rest, bent] = broken_boxes();
    page.drop_files(&[("box1.obj", rest.as_bytes()), ("box2.obj", bent.as_bytes())]);
    page.wait_until("sinew.state().source.name.startsWith('box') && sinew.state().parts", 15.0);
    page.evaluate("(sinew.app.setStep('source'), sinew.app.setPanel(true))");
    page.wait_until(SETTLED, 15.0);
    let listed = page.evaluate("[...document.querySelectorAll('#panel .doctor-item')].map((e) => e.innerText.trim())");
    let listed = listed.to_string();
    for what in [
        "1 face shows its back",
        "1 face is there twice",
        "1 face has no area",
        "1 open border",
        "2 pieces",
        "1 of 2 pieces stand still",
    ] {
        assert!(listed.contains(what), "no “{what}” in {listed}");
    }
    let marked = "[...(sinew.app.stage.kept.marks.get(0) ?? [])]";
    let camera = "[...sinew.app.stage.camera]";
    assert_eq!(page.evaluate(marked), serde_json::json!([]));
    let before = (page.evaluate(camera), page.picture_of("canvas", "before-the-doctor"));
    page.click("#doctor-source-flipped-faces");
    page.wait_until(SETTLED, 15.0);
    assert_eq!(page.evaluate(marked), serde_json::json!([20]));
    assert_eq!(page.state()["time"], -1, "it is shown in the reference");
    assert_ne!(page.evaluate(camera), before.0, "the camera goes there");
    page.rest(0.3);
    let shown = page.picture_of("canvas", "the-doctor");
    assert!(shown.difference(&before.1, 12) > 0.05, "nothing is to be seen of it");
    let words = "document.querySelector('#doctor-source-flipped-faces-words').innerText";
    assert!(page.evaluate(words).as_str().is_some_and(|words| words.contains("direction")));
    // Another one takes its place; the same one again takes it away.
    page.click("#doctor-source-holes");
    assert_eq!(page.evaluate(&format!("{marked}.length")), 4);
    page.click("#doctor-source-holes");
    assert_eq!(page.evaluate(marked), serde_json::json!([]));
    assert_eq!(page.evaluate("document.querySelectorAll('#panel [aria-expanded=true]').length"), 0);
    page.wait_until(SETTLED, 15.0);
    assert_eq!(page.state()["error"], serde_json::Value::Null);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_broken_engine_costs_one_step() {
    let mut page = Page::open(Backend::WebGl2, Screen::Still, "");
    page.wait_until("sinew.ready && sinew.state().parts > 1 && !sinew.state().busy", 20.0);
    let before = page.state();
    // More than a wasm module can have at once: a trap, as when memory is full.
    page.evaluate(
        "void sinew.app.work.run('points', 'too much', () =>
            sinew.app.engine.call('fit', { points: { length: 2 ** 29 }, parameters: {} }))",
    );
    page.wait_until("sinew.state().error", 10.0);
    let error = page.state()["error"].to_string();
    assert!(error.contains("started afresh") && error.contains("Nothing that was open is lost"), "{error}");
    page.expect_problem("The worker broke");
    page.evaluate("sinew.app.dismiss()");
    page.evaluate("void sinew.app.parts.setCount(3)");
    page.wait_until("sinew.state().parts === 3 && !sinew.state().busy", 20.0);
    let after = page.state();
    assert_eq!((&after["source"], &after["error"]), (&before["source"], &serde_json::Value::Null));
    // What breaks it while it starts, or takes back what was open, is not tried for ever.
    page.evaluate("window.module = sinew.app.engine.module; sinew.app.engine.module = Promise.resolve(0); sinew.app.engine.call('nothing', {}).catch(() => {})");
    page.wait_until("sinew.state().error?.includes('could not be started again')", 10.0);
    page.evaluate("sinew.app.dismiss(); sinew.app.engine.module = module; void sinew.app.parts.setCount(4)");
    page.wait_until("sinew.state().parts === 4 && !sinew.state().busy && !sinew.state().error", 20.0);
    page.evaluate("sinew.app.engine.kept.set('restore', null); sinew.app.engine.call('nothing', {}).catch(() => {})");
    page.wait_until("sinew.state().error?.includes('goes on without it')", 10.0);
    page.evaluate("sinew.app.dismiss(); void sinew.app.opener.openCreature({ name: 'snake', faces: 3000 })");
    page.wait_until(
        "sinew.state().source.name === 'snake' && sinew.state().parts && !sinew.state().busy && !sinew.state().error",
        20.0,
    );
}

/// Whether a point is where it was, on both sides.
const PLACES: &str = "JSON.stringify(sinew.app.doc.points.map(({ source, target, state }) => [source, target, state]))";
const STILL: &str = "sinew.app.result && !sinew.state().busy && !sinew.app.opener.underWay && sinew.state().drawn";

/// A hinge of the visitor's own, and a target on which every point is placed.
fn placed() -> Page {
    let mut page = Page::open(Backend::WebGl2, Screen::Still, "#v1;zoo=snake;faces=3000;k.points=4");
    page.wait_until(SETTLED, 30.0);
    page.drop_files(&[("hinge.glb", &glb::hinge(24))]);
    page.wait_until(&format!("sinew.state().source.name.includes('hinge') && {STILL}"), 30.0);
    page.evaluate("sinew.app.setStep('target')");
    page.wait_until(&format!("sinew.state().points === 4 && {STILL}"), 60.0);
    page.drop_files(&[("other.glb", &glb::hinge(16))]);
    page.wait_until(&format!("sinew.state().moves && sinew.state().tally.proposed === 4 && {STILL}"), 60.0);
    page.evaluate("sinew.app.target.acceptAll()");
    page.wait_until(&format!("sinew.state().tally.placed === 4 && {STILL}"), 60.0);
    page
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn points_are_placed_once_for_all_poses_of_a_mesh() {
    let mut page = placed();
    let places = page.evaluate(PLACES);
    let before = page.state();
    page.evaluate("void sinew.app.opener.reopen({ sampling: { rate: 6 } })");
    page.wait_until(
        &format!("sinew.state().source.poses < {} && sinew.state().moves && {STILL}", before["source"]["poses"]),
        30.0,
    );
    page.wait_until(&format!("sinew.state().pointError > 0 && {STILL}"), 30.0);
    let after = page.state();
    assert_eq!(page.evaluate(PLACES), places);
    assert_ne!(after["pointError"], before["pointError"], "the error is that of the new poses");
    assert_eq!(page.evaluate("sinew.app.doc.run"), serde_json::Value::Null);
    page.press_with_control("z");
    page.wait_until(
        &format!("sinew.state().source.poses === {} && sinew.state().moves && {STILL}", before["source"]["poses"]),
        30.0,
    );
    let back = page.state();
    for what in ["source", "target", "parts", "points", "pointError", "tally", "error"] {
        assert_eq!(back[what], before[what], "{what}");
    }
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn undo_reopens_what_was_open() {
    let mut page = placed();
    let (places, before) = (page.evaluate(PLACES), page.state());
    for opening in [
        "void sinew.app.opener.openCreature({ name: 'snake', faces: 3000 })",
        "void sinew.app.target.openPair('snake', 'hand')",
        "location.hash = '#v1;zoo=snake;faces=3000'",
    ] {
        page.evaluate(&format!("{opening}; undefined"));
        page.wait_until("sinew.state().source.name === 'snake'", 60.0);
        let said = page.evaluate("sinew.app.notice?.text").to_string();
        assert!(said.contains("hinge.glb was closed. Undo brings it back with its points"), "{opening}: {said}");
        page.wait_until(&format!("sinew.state().parts && {STILL}"), 60.0);
        page.click("#undo");
        page.wait_until(
            &format!("sinew.state().source.name.includes('hinge') && sinew.state().moves && {STILL}"),
            60.0,
        );
        let after = page.state();
        assert_eq!(page.evaluate(PLACES), places, "{opening}");
        for what in ["source", "target", "parts", "residual", "tally", "error"] {
            assert_eq!(after[what], before[what], "{opening}: {what}");
        }
    }
    page.click("#redo");
    page.wait_until(&format!("sinew.state().source.name === 'snake' && {STILL}"), 60.0);
    // The last target is held, those before it as far as there is room, what several states share once.
    let held = page.evaluate(
        "(async () => { const [{ History }, { makeRoom }] = await Promise.all(['history', 'room'].map((name) => import(new URL(`www/${name}.js`, location.href))));
        const figure = () => ({ sequence: { poses: new Uint8Array(100 << 20) } });
        const history = new History({ open: figure(), target: null, run: null });
        const held = [];
        for (let i = 0; i < 6; i++) {
          for (const patch of [{ target: figure() }, { points: [] }]) history.edit(patch);
          makeRoom(history);
          held.push(history.past.length);
        }
        return held; })()",
    );
    assert_eq!(held, serde_json::json!([2, 4, 6, 8, 7, 7]));
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_tour_gives_back_what_it_took_the_place_of() {
    let mut page = placed();
    let (places, before) = (page.evaluate(PLACES), page.state());
    page.click("#open-tours");
    page.click("#tour-bend");
    page.wait_until(
        &format!("sinew.state().source.name === 'horse' && sinew.state().step === 'parts' && {STILL}"),
        60.0,
    );
    page.click("#tour-leave");
    page.wait_until(&format!("sinew.state().source.name.includes('hinge') && sinew.state().moves && {STILL}"), 60.0);
    let after = page.state();
    assert_eq!(page.evaluate(PLACES), places);
    for what in ["source", "target", "parts", "tally", "step", "tour", "error"] {
        assert_eq!(after[what], before[what], "{what}");
    }
    let asks = "!dispatchEvent(new Event('beforeunload', { cancelable: true }))";
    assert_eq!(page.evaluate(asks), true, "points that were placed by hand are not left without a question");
    page.evaluate("sinew.app.target.close()");
    assert_eq!(page.evaluate(asks), false);
}

/// The first poses of a person who walks, as OBJ files in which z is up.
fn lying_poses(faces: usize, count: usize) -> Vec<String> {
    let recipe = Recipe { name: "person".into(), faces, poses: 6, ..Recipe::default() };
    let sequence = zoo::make(&recipe).expect("there is a person").sequence;
    let faces: String =
        sequence.faces().iter().map(|f| format!("f {} {} {}\n", f[0] + 1, f[1] + 1, f[2] + 1)).collect();
    let lowered = |&p: &glam::DVec3| Up::Z.lowered(p);
    let vertex = |p: glam::DVec3| format!("v {} {} {}\n", p.x, p.y, p.z);
    let written = |pose: &Pose| pose.positions.iter().map(lowered).map(vertex).collect::<String>() + &faces;
    sequence.poses().iter().take(count).map(written).collect()
}

/// How high the source and the target are, each over how far it goes away from the viewer.
const HEIGHTS: &str = "[sinew.app.sequence, sinew.app.target.sequence].map(({ reference }) => {
    const [, high, deep] = [0, 1, 2].map((axis) => { const along = reference.filter((_, i) => i % 3 === axis);
        return Math.max(...along) - Math.min(...along); });
    return high / deep; })";

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn who_lies_is_raised_and_nothing_is_lost() {
    let mut page = Page::open(Backend::WebGl2, Screen::Still, "#v1;zoo=snake;faces=3000;k.points=5");
    page.wait_until(SETTLED, 30.0);
    assert_eq!(page.evaluate("document.querySelectorAll('.corner select').length"), 0, "creatures stand");
    let poses = lying_poses(2000, 3);
    page.drop_files(&[
        ("w1.obj", poses[0].as_bytes()),
        ("w2.obj", poses[1].as_bytes()),
        ("w3.obj", poses[2].as_bytes()),
    ]);
    page.wait_until(&format!("sinew.state().source.name.startsWith('w') && {STILL}"), 30.0);
    page.evaluate("void sinew.app.parts.setCount(4)");
    page.evaluate("sinew.app.setStep('target')");
    page.wait_until(&format!("sinew.state().points === 5 && {STILL}"), 60.0);
    page.drop_files(&[("other.obj", lying_poses(1400, 1)[0].as_bytes())]);
    page.wait_until(&format!("sinew.state().moves && sinew.state().tally.proposed === 5 && {STILL}"), 60.0);
    page.evaluate("sinew.app.target.acceptAll()");
    page.wait_until(&format!("sinew.state().tally.placed === 5 && {STILL}"), 60.0);
    page.evaluate("sinew.app.timeline.setPlaying(false), sinew.app.timeline.seek(1), sinew.app.select(2)");
    let ratios = |page: &mut Page| {
        let found = page.evaluate(HEIGHTS);
        [0, 1].map(|i| found[i].as_f64().unwrap_or(0.0))
    };
    let (before, places, lying) = (page.state(), page.evaluate(PLACES), ratios(&mut page));
    assert!(lying.iter().all(|&ratio| ratio < 0.7), "they lie on their backs: {lying:?}");
    page.screenshot("lying");
    // The source by itself, the target by the keyboard.
    let choose = "(list, axis) => { list.value = axis; list.dispatchEvent(new Event('change')); }";
    page.evaluate(&format!("({choose})(document.querySelector('#picture-up-source'), 'z')"));
    page.wait_until(&format!("sinew.app.sequence.up === 'z' && sinew.state().moves && {STILL}"), 60.0);
    let half = ratios(&mut page);
    assert!(half[0] > 1.4 && half[1] < 0.7, "only the source stands: {half:?}");
    page.evaluate("document.querySelector('#picture-up-target').focus()");
    page.press("z");
    page.wait_until(&format!("sinew.app.target.sequence.up === 'z' && sinew.state().moves && {STILL}"), 60.0);
    let upright = ratios(&mut page);
    assert!(upright.iter().all(|&ratio| ratio > 1.4), "{upright:?}");
    assert_eq!(page.evaluate("document.activeElement.id"), "picture-up-target");
    page.screenshot("upright");
    let after = page.state();
    assert_eq!(page.evaluate(PLACES), places);
    for what in ["source", "target", "parts", "points", "tally", "selected", "time", "step", "error"] {
        assert_eq!(after[what], before[what], "{what}");
    }
    let errors = [&before, &after].map(|state| state["pointError"].as_f64().unwrap_or(0.0));
    assert!((errors[0] - errors[1]).abs() < 1e-6, "{errors:?}");
    // A project takes it along, and so does a link to files of another site.
    let kept = "Promise.all(['link', 'project'].map((name) => import(new URL(`www/${name}.js`, location.href)))).then(
        async ([{ writeLink, readLink, optionsOf }, { writeProject, readProject }]) => {
            const blob = await writeProject(sinew.app, sinew.app.timeline);
            const { source, target } = await readProject([{ name: 'p.glb', blob }]);
            const link = readLink(writeLink(sinew.app, sinew.app.timeline, { own: true }));
            return [source.options.up, target.options.up, link['import.up'], optionsOf(link, sinew.app.about).up].join(); })";
    assert_eq!(page.evaluate_within(kept, 30.0), "z,z,z,z");
    // Undo lays both down again, one after the other.
    page.evaluate("sinew.app.undo()");
    page.wait_until(&format!("sinew.app.target.sequence.up === 'y' && sinew.state().moves && {STILL}"), 60.0);
    page.evaluate("sinew.app.undo()");
    page.wait_until(&format!("sinew.app.sequence.up === 'y' && sinew.state().moves && {STILL}"), 60.0);
    assert_eq!((page.evaluate(PLACES), ratios(&mut page)), (places, lying));
    for what in ["time", "playing", "selected", "parts"] {
        assert_eq!(page.state()[what], before[what], "{what}");
    }
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn parts_have_colours_though_the_picture_comes_late() {
    let mut page = Page::open(Backend::WebGl2, Screen::Still, "#v1;zoo=snake;faces=3000");
    page.wait_until(SETTLED, 30.0);
    let shown = "[sinew.app.colours.length, document.querySelectorAll('#panel .swatch').length].join()";
    let before = page.evaluate(shown);
    // As it is when the parts are found before there is a picture to colour them.
    page.evaluate("sinew.app.colours = new Uint8Array(); sinew.app.changed('result'); window.lost = document.querySelector('#stage canvas'); undefined");
    assert_ne!(page.evaluate(shown), before);
    page.evaluate("lost.getContext('webgl2').getExtension('WEBGL_lose_context').loseContext()");
    page.wait_until("!lost.isConnected && sinew.app.colours.length", 10.0);
    assert_eq!(page.evaluate(shown), before);
}
