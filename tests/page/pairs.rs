//! Key points, a target, and how it moves.

use crate::harness::{Backend, Page, Screen};
use crate::opening::{opened, opened_alone};
use serde_json::Value;

/// Seconds for the selection of key points and the rest of a transfer on a busy machine.
pub const PATIENT: f64 = 60.0;
pub const IDLE: &str = "!sinew.state().busy && sinew.state().drawn";

pub fn step(page: &mut Page, name: &str) {
    page.click(&format!("#step-{name}"));
    page.wait_until(&format!("sinew.state().step === '{name}'"), 3.0);
}

/// The horse with its key points, and the camel with what is proposed for it.
pub fn proposed(backend: Backend, screen: Screen) -> Page {
    let mut page = opened(backend, screen, "#v1;zoo=horse;faces=3000;poses=8;k.points=8");
    step(&mut page, "keypoints");
    page.wait_until("sinew.state().points > 2 && !sinew.state().busy", PATIENT);
    step(&mut page, "target");
    // With as few faces as the source; on one of the two backends as a visitor opens it.
    match backend {
        Backend::WebGpu => page.click("#target-camel"),
        Backend::WebGl2 => drop(
            page.evaluate("panel.scrollTop = 200, void sinew.app.target.openCreature({ name: 'camel', faces: 3000 })"),
        ),
    }
    page.wait_until(&format!("sinew.state().moves && sinew.state().tally.missing === 0 && {IDLE}"), PATIENT);
    assert_eq!(page.evaluate("panel.scrollTop"), 0, "what the target brings is read from its beginning");
    page
}

/// While they play, the pictures of the source and of the target are drawn together, however slowly.
fn both_show_one_moment(page: &mut Page) {
    let drawn = page.evaluate_within(
        "new Promise((resolve) => { const both = [sinew.app.stage, sinew.app.second]; const moments = both.map(() => []);
        const stop = new AbortController();
        const enough = () => { if (moments.some((list) => list.length > 4)) stop.abort(resolve(moments)); };
        both.forEach((stage, i) => stage.addEventListener('drawn', () => {
          if (moments[i].at(-1) !== stage.kept.time) moments[i].push(stage.kept.time);
          requestAnimationFrame(enough); }, { signal: stop.signal })); })",
        PATIENT,
    );
    assert!(drawn[0].as_array().is_some_and(|moments| moments.len() > 4), "{drawn}");
    assert_eq!(drawn[0], drawn[1], "the pictures show different moments");
}

fn a_camel_walks_like_a_horse(backend: Backend) {
    let mut page = proposed(backend, Screen::Small);
    let state = page.state();
    let points = state["points"].as_u64().unwrap_or(0);
    assert_eq!(points, 8, "{state}");
    assert!(state["pointError"].as_f64().is_some_and(|error| error > 0.0 && error < 0.06), "{state}");
    assert_eq!(state["tally"]["proposed"], points, "{state}");
    assert_eq!(state["error"], Value::Null, "{state}");
    page.click("#target-point-1-accept");
    page.wait_until(&format!("sinew.state().tally.placed === 1 && {IDLE}"), PATIENT);
    page.press("a");
    page.wait_until(&format!("sinew.state().tally.placed === {points} && !sinew.state().busy"), PATIENT);
    step(&mut page, "transfer");
    page.wait_until("sinew.state().playing && !sinew.state().busy", 5.0);
    let before = page.picture_of("#second canvas", "transfer");
    assert!(before.colours() > 100, "the target's picture has only {} colours", before.colours());
    page.wait_until_changed("#second canvas", "transfer-later", &before, 0.002);
    both_show_one_moment(&mut page);
    for method in ["direct", "relative", "bones"] {
        page.evaluate(&format!("document.querySelector('#control-variant-{method}').click()"));
        page.wait_until(&format!("sinew.state().moves?.method === '{method}' && !sinew.state().busy"), PATIENT);
        assert_eq!(page.state()["error"], Value::Null, "{method}");
    }
    step(&mut page, "export");
    for form in ["exact", "light"] {
        let file = page.evaluate_within(
            &format!(
                "sinew.app.transfer.file('{form}').then(async ({{ blob, error }}) => [blob.size, error,
                new TextDecoder().decode(new Uint8Array(await blob.arrayBuffer()).subarray(0, 4))])"
            ),
            PATIENT,
        );
        assert!(file[0].as_f64().is_some_and(|size| size > 10_000.0), "{form}: {file}");
        assert!(file[1].as_f64().is_some_and(|error| (0.0..0.2).contains(&error)), "{form}: {file}");
        assert_eq!(file[2], "glTF", "{form}");
    }
    page.wait_until("document.querySelector('#export-light').innerText.includes('kB')", 10.0);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_camel_walks_like_a_horse_on_webgpu() {
    a_camel_walks_like_a_horse(Backend::WebGpu);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_camel_walks_like_a_horse_on_webgl2() {
    a_camel_walks_like_a_horse(Backend::WebGl2);
}

/// How much slower than on an idle machine of these days it may be before a test fails.
const SLOWER: f64 = 3.0;

/// Drags the first point of the target from corner to corner of the faces around it; the median milliseconds that the engine
/// took, and until the page had the motion.
const DRAG: &str = "(async () => { const { app } = sinew; app.held = true; const taken = [];
    const near = app.target.sequence.faces, start = near.indexOf(app.doc.points[0].target);
    for (let i = 0; i < 12; i++) {
      const begun = performance.now();
      app.target.place(0, near[start - start % 3 + i % 3], 'drag');
      await new Promise((resolve) => app.addEventListener('motion', resolve, { once: true }));
      taken.push([app.transfer.motion.took * 1000, performance.now() - begun]);
    }
    app.held = false; app.history.rest();
    return [0, 1].map((k) => taken.map((each) => each[k]).sort((a, b) => a - b)[6]); })()";

/// Everything that undo brings back.
const DOCUMENT: &str = "JSON.stringify([sinew.app.doc.points, sinew.app.doc.count, sinew.app.doc.method,
    sinew.app.doc.search, sinew.app.doc.target?.sequence.name, sinew.app.doc.wanted])";

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn everything_is_undone_and_redone() {
    let mut page = proposed(Backend::WebGl2, Screen::Still);
    let acts = [
        "sinew.app.target.accept(0)",
        "sinew.app.target.remove(1)",
        "sinew.app.keypoints.setCount(3)",
        "sinew.app.transfer.setMethod('relative')",
        "sinew.app.keypoints.remove(2)",
        "void sinew.app.parts.setCount(5)",
        "sinew.app.target.close()",
    ];
    let mut states = vec![page.evaluate(DOCUMENT)];
    for act in acts {
        page.evaluate(act);
        page.wait_until("!sinew.state().busy", PATIENT);
        states.push(page.evaluate(DOCUMENT));
    }
    for pair in states.windows(2) {
        assert_ne!(pair[0], pair[1]);
    }
    for before in states.iter().rev().skip(1) {
        page.click("#undo");
        page.wait_until("!sinew.state().busy", PATIENT);
        assert_eq!(&page.evaluate(DOCUMENT), before);
    }
    page.wait_until("sinew.state().moves && !sinew.state().busy", PATIENT);
    for after in states.iter().skip(1) {
        page.click("#redo");
        page.wait_until("!sinew.state().busy", PATIENT);
        assert_eq!(&page.evaluate(DOCUMENT), after);
    }
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_point_is_dragged_and_the_motion_follows() {
    let mut page = proposed(Backend::WebGl2, Screen::Still);
    a_point_is_dragged(&mut page);
    // On a phone the target is below the source, and both are wider than half of it.
    page.resize(Screen::Phone);
    page.evaluate("sinew.app.setPanel(false)");
    page.wait_until("document.documentElement.hasAttribute('data-stacked')", 3.0);
    page.wait_until(IDLE, PATIENT);
    let wide = "['stage', 'second'].map((id) => document.getElementById(id).clientWidth)";
    assert_eq!(page.evaluate(wide), serde_json::json!([390, 390]));
    let index = a_point_is_dragged(&mut page);
    page.evaluate(&format!("sinew.app.select({index})"));
    page.wait_until("document.querySelector('#dock-remove')?.clientHeight >= 40", 3.0);
    page.click("#dock-remove");
    page.wait_until(&format!("sinew.state().tally.missing === 1 && {IDLE}"), PATIENT);
}

/// Drags a pin of the target that can be seen, and takes that back; which it was.
fn a_point_is_dragged(page: &mut Page) -> f64 {
    // A pin of the target that can be seen, and a way to go that stays on the surface.
    let seen = page.evaluate(
        "(() => { const { second } = sinew.app, box = second.canvas.getBoundingClientRect();
        const ways = [[14, 0], [-14, 0], [0, 14], [0, -14]];
        for (const [i, pin] of second.pinPositions().entries()) {
          const way = pin.visible && ways.find(([dx, dy]) => second.pick(pin.x + dx, pin.y + dy));
          if (way && second.pickPin(pin.x, pin.y, 4) === i) return [i, box.x + pin.x, box.y + pin.y, ...way];
        } })()",
    );
    let [index, x, y, dx, dy] = [0, 1, 2, 3, 4].map(|i| seen[i].as_f64().unwrap_or(-1.0));
    assert!(index >= 0.0, "no pin can be seen");
    let vertex = format!("sinew.app.doc.points[{index}].target");
    let before = page.evaluate(&vertex);
    let undo = page.state()["undo"].as_u64().unwrap_or(0);
    page.drag_from((x, y), (dx, dy));
    page.wait_until(&format!("sinew.app.doc.points[{index}].state === 'placed' && {IDLE}"), PATIENT);
    assert_ne!(page.evaluate(&vertex), before, "the point did not move");
    assert_eq!(page.state()["undo"], undo + 1, "a drag is one step back");
    page.press_with_control("z");
    page.wait_until("!sinew.state().busy", PATIENT);
    assert_eq!(page.evaluate(&vertex), before, "Ctrl+Z brings it back");
    index
}

/// Milliseconds from a point being moved on a target of some 5,000 vertices to the picture that follows it.
pub const FOLLOWS: f64 = 100.0;

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_target_of_5000_vertices_follows_the_hand() {
    let mut page = opened_alone(Backend::WebGl2, Screen::Small, "#v1;zoo=horse;faces=10000;poses=16;k.points=12");
    step(&mut page, "keypoints");
    page.wait_until("sinew.state().points > 2 && !sinew.state().busy", PATIENT);
    step(&mut page, "target");
    page.evaluate("void sinew.app.target.openCreature({ name: 'camel', faces: 10000 })");
    page.wait_until(&format!("sinew.state().moves && sinew.state().tally.missing === 0 && {IDLE}"), PATIENT);
    let measured = page.evaluate_within(DRAG, PATIENT);
    let [engine, all] = [0, 1].map(|i| measured[i].as_f64().unwrap_or(f64::INFINITY));
    println!(
        "a dragged point, {} pairs, {} vertices: the engine takes {engine:.0} ms, the motion is there after {all:.0} ms",
        page.state()["points"],
        page.state()["target"]["vertices"],
    );
    assert!(all <= FOLLOWS * SLOWER, "{all} ms");
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_link_brings_the_pairs_back() {
    let mut page = proposed(Backend::WebGl2, Screen::Still);
    page.click("#target-point-2-accept");
    page.wait_until("sinew.state().tally.placed === 1 && !sinew.state().busy", PATIENT);
    page.evaluate("sinew.app.transfer.setMethod('direct'), 0");
    step(&mut page, "transfer");
    page.wait_until("sinew.state().moves?.method === 'direct' && !sinew.state().busy", PATIENT);
    page.rest(0.8);
    let pairs = "JSON.stringify(sinew.app.keypoints.used.map(({ source, target, state }) => [source, target, state]))";
    let (hash, before) = (page.evaluate("location.hash"), page.evaluate(pairs));
    page.go(&format!("?again{}", hash.as_str().unwrap_or_default()));
    page.wait_until("location.search === '?again'", 10.0);
    page.wait_until("sinew.ready && sinew.state().moves && !sinew.state().busy", PATIENT);
    assert_eq!(page.evaluate(pairs), before, "{hash}");
    let state = page.state();
    assert_eq!((&state["step"], &state["moves"]["method"]), (&"transfer".into(), &"direct".into()), "{state}");
    assert_eq!(state["target"]["name"], "camel");
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_cancel_costs_one_step() {
    let mut page = proposed(Backend::WebGl2, Screen::Still);
    let before = page.evaluate(DOCUMENT);
    page.evaluate("void sinew.app.keypoints.setParameter('literal', true)");
    page.wait_until("sinew.state().busy?.done > 0", PATIENT);
    page.evaluate("sinew.app.cancel()");
    page.wait_until("!sinew.state().busy", PATIENT);
    assert_eq!(page.evaluate(DOCUMENT), before);
    // The new worker is told of the motion before it writes it.
    let file = page.evaluate_within("sinew.app.transfer.file('exact').then((file) => file?.blob.size ?? 0)", PATIENT);
    assert!(file.as_f64().is_some_and(|bytes| bytes > 0.0), "{}", page.state());
    page.evaluate("sinew.app.transfer.setMethod('relative'); sinew.app.cancel()");
    page.wait_until("sinew.app.transfer.method === 'bones' && !sinew.state().busy", PATIENT);
    page.evaluate("sinew.app.target.remove(0); sinew.app.cancel(); sinew.app.cancel()");
    page.wait_until("!sinew.state().busy && sinew.app.transfer.behind", PATIENT);
    page.evaluate("document.querySelector('#step-transfer').click()");
    page.wait_until("!sinew.state().busy && sinew.app.transfer.current", PATIENT);
    page.evaluate("sinew.app.transfer.setMethod('relative')");
    page.wait_until("sinew.state().moves?.method === 'relative' && !sinew.state().busy", PATIENT);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn one_point_more_keeps_those_that_were_placed() {
    let mut page = proposed(Backend::WebGl2, Screen::Still);
    page.press("a");
    page.wait_until(&format!("sinew.state().tally.placed === 8 && {IDLE}"), PATIENT);
    let first = "JSON.stringify(sinew.app.doc.points.slice(0, 8))";
    let before = page.evaluate(first);
    page.evaluate("void sinew.app.keypoints.setCount(10)");
    page.wait_until(&format!("sinew.state().points === 10 && sinew.state().tally.proposed === 2 && {IDLE}"), PATIENT);
    assert_eq!(page.evaluate(first), before);
    assert_eq!(page.evaluate("new Set(sinew.app.doc.points.map(({ source }) => source)).size"), 10);
    page.press_with_control("z");
    page.wait_until(&format!("sinew.state().points === 8 && sinew.state().moves && {IDLE}"), PATIENT);
    assert_eq!(page.evaluate(first), before);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_search_finds_as_many_points_as_were_in_use() {
    let mut page = opened(Backend::WebGl2, Screen::Still, "#v1;zoo=snake;faces=3000;k.points=8");
    step(&mut page, "keypoints");
    page.wait_until("sinew.state().points === 8 && !sinew.state().busy", PATIENT);
    page.evaluate("sinew.app.keypoints.setCount(5)");
    page.evaluate_within("sinew.app.keypoints.setParameter('lambda', 1).then(() => 0)", PATIENT);
    assert_eq!(page.state()["points"], 5);
    assert_eq!(page.evaluate("sinew.app.doc.run.key_points.length"), 5);
    page.evaluate_within("sinew.app.keypoints.setParameter('error', 0.05).then(() => 0)", PATIENT);
    assert_eq!(page.evaluate("sinew.app.doc.search.points"), Value::Null, "a rule takes the place of a number");
}

/// Notes the target's name under its picture when another target is open but not seen yet, and when it is first seen.
const FORMER: &str = "(() => { const { app } = sinew; window.captions = [];
    const note = (i) => (captions[i] ??= document.querySelector('#second .caption').textContent || null);
    app.addEventListener('target', function hear() {
        if (!app.target.sequence) return;
        app.removeEventListener('target', hear);
        queueMicrotask(() => { note(0); app.second.addEventListener('shown', () => note(1), { once: true }); });
    }); })()";

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn the_gallery_opens_pairs_that_move() {
    let mut page = opened(Backend::WebGl2, Screen::Still, "#v1;zoo=snake;faces=3000");
    page.evaluate("Object.assign(sinew.app.about.recipe, { faces: 4000, poses: 12 }); undefined");
    for (source, target) in [("snake", "hand"), ("person", "dinosaur"), ("horse", "camel")] {
        let was = page.evaluate("sinew.app.target.sequence?.name ?? null");
        page.evaluate(&format!("{FORMER}; document.querySelector('#pair-{source}-{target}').click()"));
        let open = format!("sinew.state().target?.name === '{target}' && sinew.state().source.name === '{source}'");
        page.wait_until(&format!("{open} && sinew.state().moves && sinew.state().step === 'transfer'"), PATIENT);
        let state = page.state();
        assert_eq!((&state["error"], &state["tally"]["missing"]), (&Value::Null, &0.into()), "{state}");
        page.wait_until("captions[1]", PATIENT);
        page.rest(1.0);
        page.screenshot(&format!("gallery-{source}-{target}"));
        let named = page.evaluate("captions");
        let before = was.as_str().unwrap_or(target);
        for (name, wanted) in [(&named[0], before), (&named[1], target)] {
            assert_eq!(name.as_str().map(str::to_lowercase).as_deref(), Some(wanted), "{named}");
        }
    }
    // One figure in the room of two is looked at from where it is to be seen, from the first frame on.
    page.resize(Screen::Desktop);
    page.rest(1.0);
    page.evaluate(
        "{ const { stage } = sinew.app, { view } = stage; window.seen = [];
        view.render = () => { const drew = Object.getPrototypeOf(view).render.call(view);
            if (drew) seen.push([stage.canvas.width, view.camera()[5]]); return drew; };
        sinew.app.setStep('source'); }",
    );
    page.rest(2.0);
    let late = page.evaluate(
        "seen.filter(([width, distance]) => width === seen.at(-1)[0] && Math.abs(distance - seen.at(-1)[1]) > 0.2)",
    );
    assert_eq!(late, serde_json::json!([]));
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn what_to_click_next_is_known_a_step_back_and_in_a_link() {
    let mut page = proposed(Backend::WebGl2, Screen::Still);
    let known = "JSON.stringify([sinew.state().next, sinew.app.doc.points])";
    let before = page.evaluate(known);
    let next = page.state()["next"].as_u64().expect("one of the points is the least sure");
    assert_eq!(page.evaluate("document.querySelector('.points .next .pin-dot').innerText"), (next + 1).to_string());
    page.press("a");
    page.wait_until(&format!("sinew.state().tally.placed === 8 && {IDLE}"), PATIENT);
    assert_eq!(page.state()["next"], -1);
    page.press_with_control("z");
    page.wait_until(&format!("sinew.state().tally.proposed === 8 && {IDLE}"), PATIENT);
    assert_eq!(page.evaluate(known), before, "a step back");
    page.evaluate("sinew.app.changed('link')");
    page.rest(0.8);
    let hash = page.evaluate("location.hash").as_str().unwrap_or_default().to_owned();
    page.go(&format!("?again{hash}"));
    let sure = "sinew.app.doc.points.every(({ confidence }) => confidence !== null)";
    page.wait_until(&format!("location.search === '?again' && sinew.state().moves && {sure} && {IDLE}"), PATIENT);
    assert_eq!(page.evaluate(known), before, "in a link");
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn no_two_points_share_a_place() {
    let link = "#v1;zoo=snake;faces=3000;poses=8;step=target;points=12,407,900,1300,1400";
    let mut page = opened(Backend::WebGl2, Screen::Still, link);
    // Two triangles on three places: their vertices are not joined.
    let triangles = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 0 1 0\nv 1 0 0\nf 1 2 3\nf 4 5 6\n";
    page.drop_files(&[("triangles.obj", triangles.as_bytes())]);
    page.wait_until(&format!("sinew.state().target && sinew.state().moves?.pairs === 3 && {IDLE}"), PATIENT);
    let state = page.state();
    assert_eq!((&state["tally"]["proposed"], &state["tally"]["missing"]), (&3.into(), &2.into()), "{state}");
    assert_eq!(state["error"], Value::Null);
    let said =
        page.evaluate("document.querySelector('#panel .step:has(.points li[data-state=none])').innerText").to_string();
    assert!(said.contains("no place for 2 points") && said.contains("no vertex left for it"), "{said}");
    // One that is taken away makes room.
    page.evaluate("sinew.app.target.remove(sinew.app.doc.points.findIndex(({ target }) => target != null))");
    page.wait_until(&format!("sinew.state().tally.proposed === 3 && {IDLE}"), PATIENT);
    assert_eq!(page.evaluate("sinew.app.doc.points.filter(({ crowded }) => crowded).length"), 1);
}
