//! The page in a hand.

use crate::harness::{Backend, Page, Screen};
use crate::opening::opened;

/// Pairs of controls that lie over one another, and what is wider than the screen.
const CLASHES: &str = "(() => {
    const shown = (e) => { const r = e.getBoundingClientRect();
        return e.checkVisibility() && r.width > 0 && r.right > 0 && r.left < innerWidth && r.bottom > 0 && r.top < innerHeight; };
    const all = [...document.querySelectorAll('.frame button, .frame select, .frame .scrub, .frame .track, .brand h1')].filter(shown);
    const sheet = document.querySelector('#panel');
    const under = (e) => !sheet.hidden && !sheet.contains(e) && !e.closest('.panel-opener');
    const seen = all.filter((e) => !under(e));
    const name = (e) => e.getAttribute('aria-label') ?? e.innerText ?? e.className;
    const clashes = [];
    seen.forEach((a, i) => seen.slice(i + 1).forEach((b) => {
        if (a.contains(b) || b.contains(a)) return;
        const [r, s] = [a.getBoundingClientRect(), b.getBoundingClientRect()];
        const across = Math.min(r.right, s.right) - Math.max(r.left, s.left);
        const down = Math.min(r.bottom, s.bottom) - Math.max(r.top, s.top);
        if (across > 1 && down > 1) clashes.push(`${name(a)} lies over ${name(b)}`);
    }));
    if (document.documentElement.scrollWidth > innerWidth) clashes.push('the page scrolls sideways');
    for (const e of seen) if (e.getBoundingClientRect().right > innerWidth + 1) clashes.push(`${name(e)} is cut off`);
    return clashes;
})()";

fn nothing_clashes(page: &mut Page, when: &str) {
    assert_eq!(page.evaluate(CLASHES), serde_json::json!([]), "{when}");
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn everything_has_its_place_on_a_phone() {
    let mut page = opened(Backend::WebGl2, Screen::Phone, "#v1;zoo=horse;faces=3000");
    assert_eq!(page.state()["panel"], false, "the panel waits until it is asked for");
    nothing_clashes(&mut page, "with the panel away");
    for view in ["features", "distance", "parts"] {
        page.evaluate(&format!("document.querySelector('#control-view-{view}').click()"));
        nothing_clashes(&mut page, view);
    }
    page.click(".step-button");
    page.wait_until("sinew.state().step === 'source' && sinew.state().panel", 2.0);
    page.rest(0.4);
    page.screenshot("sheet");
    nothing_clashes(&mut page, "with the sheet");
    assert_eq!(page.evaluate("panel.scrollTop = 100, panel.scrollTop"), 100, "there is more than fits");
    let heading = "document.querySelector('.panel-body:not([hidden]) h2').getBoundingClientRect().top";
    let from_top = page.evaluate(&format!("Math.abs({heading} - panel.getBoundingClientRect().top)"));
    assert!(from_top.as_f64().is_some_and(|far| far < 3.0), "the heading stays: {from_top}");
    page.evaluate("document.querySelectorAll('.step-button')[1].click()");
    page.wait_until("sinew.state().step === 'parts'", 2.0);
    assert_eq!(page.evaluate("panel.scrollTop"), 0, "a step is read from its beginning");
    page.click("#panel .icon-button");
    page.wait_until("!sinew.state().panel", 2.0);
    // With letters of twice the size the names of the steps stay apart, the bold one too.
    page.evaluate("document.documentElement.style.fontSize = '200%', sinew.app.setStep('keypoints')");
    let narrowest = "(() => { const range = document.createRange(), ends = [...document.querySelectorAll('.step-title')].map((title) => {
        range.selectNodeContents(title); const { left, right } = range.getBoundingClientRect(); return [left, right]; });
        return Math.min(...ends.slice(1).map(([left], i) => left - ends[i][1])); })()";
    let gap = page.evaluate(narrowest);
    assert!(gap.as_f64().is_some_and(|gap| gap > 8.0), "{gap} pixels between two steps");
    let last = "rail.scrollLeft = 9999, document.querySelector('.panel-opener').getBoundingClientRect().left
        - document.querySelector('#step-export').getBoundingClientRect().right";
    let room = page.evaluate(last);
    assert!(room.as_f64().is_some_and(|room| room >= 0.0), "the last step is {room} pixels clear of the button");
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn nothing_clashes_on_a_desk() {
    let mut page = opened(Backend::WebGl2, Screen::Small, "");
    nothing_clashes(&mut page, "small");
    page.resize(Screen::Desktop);
    page.rest(0.3);
    nothing_clashes(&mut page, "desktop");
    let sheet = "panel.clientWidth === innerWidth && panel.getBoundingClientRect().top > innerHeight / 2";
    for (screen, name, low) in
        [(Screen::Tablet, "a tablet held upright", true), (Screen::Lying, "a phone on its side", false)]
    {
        page.resize(screen);
        for open in [true, false] {
            page.evaluate(&format!("sinew.app.setPanel({open})"));
            page.rest(0.3);
            nothing_clashes(&mut page, name);
            assert!(!open || page.evaluate(sheet) == low, "{name}: the panel is a sheet from below or it is not");
            let below = page.evaluate("document.querySelector('.below').clientHeight / innerHeight");
            assert!(low || below.as_f64().is_some_and(|share| share < 0.35), "{name}: the picture has the room");
        }
    }
    // Where the graphics are behind, what was drawn for another size is not distorted.
    page.evaluate("sinew.app.stage.view.under_way = () => 9");
    page.resize(Screen::Desktop);
    page.wait_until("innerWidth === 1440 && document.querySelector('#stage canvas').hasAttribute('data-unfit')", 5.0);
    let shape = "(({ clientWidth, clientHeight, width, height }) => clientWidth / clientHeight - width / height)\
        (document.querySelector('#stage canvas'))";
    assert!(page.evaluate(shape).as_f64().is_some_and(|change| change.abs() < 0.02));
}
