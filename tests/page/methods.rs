//! Methods that ask each face, the fit as it closes in, and two methods side by side.

use crate::harness::{Backend, Screen};
use crate::pairs::{IDLE, PATIENT, proposed, step};
use serde_json::Value;

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn faces_carry_the_motion_and_methods_stand_side_by_side() {
    let mut page = proposed(Backend::WebGl2, Screen::Still);
    step(&mut page, "transfer");
    for method in ["posed", "gradients"] {
        page.evaluate(&format!("document.querySelector('#control-variant-{method}').click()"));
        page.wait_until(&format!("sinew.state().moves?.method === '{method}' && !sinew.state().busy"), PATIENT);
        let motion = page.evaluate(
            "(({ positions, quality, rounds }) => [positions.length / (3 * sinew.state().target.vertices),
            quality.coverage, rounds])(sinew.app.transfer.motion)",
        );
        assert_eq!(motion[0], 8, "{method}: {motion}");
        assert!(motion[1].as_f64().is_some_and(|coverage| coverage > 0.8), "{method}: {motion}");
        assert_eq!(page.state()["error"], Value::Null, "{method}");
    }
    // The fit closes in: the first figure is the source, bent a little more each round.
    page.evaluate("sinew.app.setView('fit')");
    page.wait_until(&format!("sinew.app.frozen > 3 && {IDLE}"), PATIENT);
    page.screenshot("fit-page");
    let bent = page.picture_of("#stage canvas", "fit-last");
    page.evaluate("sinew.app.setPlace(0)");
    page.wait_until(&format!("sinew.app.frozen === 0 && {IDLE}"), PATIENT);
    let changed = page.picture_of("#stage canvas", "fit-first").difference(&bent, 8);
    assert!(changed > 0.01, "only {:.2} % of the picture changed from round to round", 100.0 * changed);
    page.evaluate("sinew.app.setView('points')");
    page.wait_until(&format!("sinew.app.frozen === null && {IDLE}"), PATIENT);
    // Another method beside it, at the same time, painted by the distance.
    page.evaluate(
        "(({ list }) => { list.value = 'direct'; list.dispatchEvent(new Event('change')); })
        ({ list: document.querySelector('#control-beside-it') })",
    );
    page.wait_until(&format!("sinew.state().moves.beside === 'direct' && {IDLE}"), PATIENT);
    page.wait_until("document.querySelector('.beside-words').textContent.includes('reference')", PATIENT);
    page.press(".");
    page.wait_until("document.querySelector('.beside-words').textContent.includes('%')", PATIENT);
    let together = "[sinew.app.third.kept.time === sinew.app.second.kept.time,
        sinew.app.third.kept.paint[0][0], sinew.app.second.kept.paint[0][0]]";
    assert_eq!(page.evaluate(together), serde_json::json!([true, "paint_vertices", "paint_vertices"]));
    assert!(page.picture_of(".beside canvas", "beside").colours() > 100);
    page.screenshot("beside-page");
    // The other way round, and away again.
    page.evaluate("sinew.app.second.move('orbit', 40, 10)");
    page.wait_until("Math.abs(sinew.app.third.turn[0] - sinew.app.second.turn[0]) < 1e-3", 5.0);
    step(&mut page, "export");
    page.wait_until("!sinew.app.third && !document.querySelector('#export-light')", PATIENT);
    let file = page.evaluate_within("sinew.app.transfer.file('exact').then(({ blob }) => blob.size)", PATIENT);
    assert!(file.as_f64().is_some_and(|size| size > 10_000.0), "{file}");
    // The one beside it takes its place: a method is not compared with itself.
    step(&mut page, "transfer");
    page.wait_until(&format!("sinew.app.third && {IDLE}"), PATIENT);
    page.evaluate("document.querySelector('#control-variant-direct').click()");
    page.wait_until(&format!("sinew.state().moves?.method === 'direct' && {IDLE}"), PATIENT);
    let beside = "[sinew.app.third, sinew.app.transfer.rival, document.querySelector('#control-beside-it').value]";
    assert_eq!(page.evaluate(beside), serde_json::json!([null, "", ""]));
}
