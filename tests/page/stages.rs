//! Stages, lessons and tours.

#[path = "../common/floor.rs"]
mod floor;

use crate::harness::{Backend, Page, Screen};
use crate::looking::VIEWS;
use crate::opening::opened;
use serde_json::{Value, json};
use sinew::export::animation::exact;
use sinew::zoo::{self, Recipe};

const SMALL: &str = "#v1;zoo=horse;faces=3000;poses=8;k.points=6;t=reference";
const IDLE: &str = "!sinew.state().busy && sinew.state().drawn";

/// Lets the engine count what it is asked, and the page how long it takes to answer.
const WATCH: &str = "window.asked = 0; const call = sinew.app.engine.call.bind(sinew.app.engine);
    sinew.app.engine.call = (...message) => { window.asked++; return call(...message); }; undefined";

fn key_points(page: &mut Page) {
    page.click("#step-keypoints");
    page.wait_until(&format!("sinew.app.keypoints.current?.rounds?.length === 8 && {IDLE}"), 60.0);
}

/// Goes to the first view of the step.
fn first(page: &mut Page, view: &str) {
    page.evaluate(&format!("sinew.app.setView('{view}'); sinew.app.setPlace(0); document.activeElement.blur()"));
    page.wait_until(&format!("sinew.state().view === '{view}' && sinew.state().place === 0"), 2.0);
}

/// Presses → until the end and ← back to the beginning; returns the views on the way.
fn walked(page: &mut Page) -> Vec<String> {
    let mut views: Vec<String> = Vec::new();
    for (key, most) in [("ArrowRight", 900), ("ArrowLeft", 900)] {
        let mut before = Value::Null;
        for _ in 0..most {
            let now = page.evaluate("[sinew.app.view, sinew.app.place]");
            if now == before {
                break;
            }
            let view = now[0].as_str().unwrap_or_default().to_owned();
            if views.last() != Some(&view) {
                views.push(view);
                // The middle of a long stage is as good as all of it: go near its end, as a hand would with the scrubber.
                page.evaluate(&format!(
                    "(() => {{ const range = document.querySelector('#stage-place');
                    if (range.closest('.off')) return;
                    range.value = {}; range.dispatchEvent(new Event('input', {{ bubbles: true }})); }})()",
                    if key == "ArrowRight" { "Math.max(0, range.max - 1)" } else { "1" }
                ));
                page.evaluate("document.activeElement.blur()");
            }
            before = page.evaluate("[sinew.app.view, sinew.app.place]");
            page.press(key);
        }
    }
    views
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn every_stage_is_walked_through_and_nothing_is_computed_again() {
    let mut page = opened(Backend::WebGl2, Screen::Still, SMALL);
    page.evaluate(WATCH);
    first(&mut page, "gradients");
    let back =
        |list: &[&str]| list.iter().chain(list.iter().rev().skip(1)).map(|&view| view.to_owned()).collect::<Vec<_>>();
    assert_eq!(walked(&mut page), back(&VIEWS));
    assert_eq!(page.evaluate("window.asked"), 0, "the engine was asked");
    key_points(&mut page);
    page.evaluate("window.asked = 0");
    first(&mut page, "spread");
    let there = ["spread", "candidates", "replacement", "weights", "groups", "alternation", "points"];
    assert_eq!(walked(&mut page), back(&there));
    assert_eq!(page.evaluate("window.asked"), 0, "the engine was asked");
    assert_eq!(page.state()["error"], Value::Null);
}

fn scrubbing_shows_other_pictures_at_once(backend: Backend) {
    let mut page = opened(backend, Screen::Still, SMALL);
    page.evaluate("sinew.app.setView('merging')");
    let mut last = None;
    for place in [0, 120, 230] {
        // The best of three: other tests run meanwhile.
        let milliseconds = page.evaluate(&format!(
            "Math.min(...[0, 1, 2].map(() => {{ const begun = performance.now(); sinew.app.setPlace({place}); return performance.now() - begun; }}))"
        ));
        assert!(milliseconds.as_f64().is_some_and(|time| time < 100.0), "place {place} took {milliseconds} ms");
        page.wait_until(IDLE, 10.0);
        let picture = page.picture_of("#stage canvas", "merging");
        assert!(
            last.is_none_or(|last| picture.difference(&last, 6) > 0.002),
            "place {place} looks like the one before"
        );
        last = Some(picture);
    }
    // By the merge tree in the page there are as many parts as by the engine.
    let parts = page.state()["parts"].as_u64().unwrap_or(0);
    page.evaluate("delete sinew.app.places.merging; sinew.app.paint(); sinew.app.changed('place')");
    let words = page.evaluate("document.querySelector('.strip output').textContent");
    assert!(words.as_str().is_some_and(|words| words.contains(&format!("{parts} part"))), "{words} for {parts} parts");
    key_points(&mut page);
    page.evaluate("sinew.app.setView('alternation'); sinew.app.setPlace(0)");
    page.wait_until(&format!("sinew.app.stage.skin && {IDLE}"), 10.0);
    let begun = page.picture_of("#stage canvas", "fit-first");
    page.evaluate("sinew.app.setPlace(1000)");
    page.wait_until(IDLE, 10.0);
    let ended = page.picture_of("#stage canvas", "fit-last");
    assert!(ended.difference(&begun, 6) > 0.01, "the fit does not close in");
    page.evaluate("sinew.app.setView('points')");
    page.wait_until(&format!("!sinew.app.stage.skin && sinew.app.frozen === null && {IDLE}"), 5.0);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn scrubbing_shows_other_pictures_at_once_on_webgpu() {
    scrubbing_shows_other_pictures_at_once(Backend::WebGpu);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn scrubbing_shows_other_pictures_at_once_on_webgl2() {
    scrubbing_shows_other_pictures_at_once(Backend::WebGl2);
}

/// What is said of a place in a view under the picture: the last for a place that is too far.
fn said(page: &mut Page, view: &str, place: usize) -> String {
    let words = page.evaluate(&format!(
        "sinew.app.setView('{view}'); sinew.app.setPlace({place}); document.querySelector('.strip output').textContent"
    ));
    words.as_str().unwrap_or_default().to_owned()
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn how_things_were_before_the_first_is_not_counted() {
    let mut page = opened(Backend::WebGl2, Screen::Still, SMALL);
    let finest = page.evaluate("new Set(sinew.app.result.rounds.at(-1)).size").as_u64().unwrap_or(0);
    let merges = finest.saturating_sub(1);
    assert_eq!(said(&mut page, "merging", 0), format!("Before the first merge · {finest} parts"));
    assert!(said(&mut page, "merging", 1).starts_with(&format!("Merge 1 of {merges} · {merges} parts")));
    assert!(said(&mut page, "merging", 1000).starts_with(&format!("Merge {merges} of {merges} · 1 part")));
    page.evaluate("delete sinew.app.places.merging; sinew.app.changed('place')");
    let count = page.evaluate("sinew.app.place");
    let legend = page.evaluate("document.querySelector('.legend').innerText");
    assert!(
        legend.as_str().is_some_and(|words| words.contains(&format!("after {count} merges"))),
        "{legend} for {count}"
    );
    assert_eq!(
        ["Before the cut", "After the cut"].map(str::to_owned),
        [0, 1].map(|place| said(&mut page, "cut", place))
    );
    key_points(&mut page);
    let replacements = page.evaluate("sinew.app.doc.run.replacements.length");
    assert_eq!(said(&mut page, "replacement", 0), "As they were chosen");
    assert!(
        said(&mut page, "replacement", 1000).starts_with(&format!("Replacement {replacements} of {replacements} · "))
    );
    // The search begins with a point, and adds the second in its first step.
    assert!(said(&mut page, "candidates", 0).contains("point 2 is vertex "));
    page.wait_until("document.querySelector('#stage .pin-numbers .selected')?.textContent === '2'", 5.0);
    assert!(said(&mut page, "alternation", 0).starts_with("Before the first round · "));
    // The legend and the plot mean the same pose by the hardest, and the plot ends where the rounds do.
    let last = said(&mut page, "alternation", 1000);
    let hardest = "(words => words.match(/pose (\\d+), the hardest/)?.[1])";
    let legend = page.evaluate(&format!("{hardest}(document.querySelector('.legend').innerText)"));
    let plot = page.evaluate(&format!("{hardest}(document.querySelector('#panel').textContent)"));
    assert_eq!(legend, plot);
    let rounds = page
        .evaluate(&format!("sinew.app.keypoints.current.energies[{} - 1].length - 1", legend.as_str().unwrap_or("0")));
    assert!(last.starts_with(&format!("Round {rounds} of {rounds} · ")), "{last}");
    // The same points of another search are fitted anew, and a step back is as it was.
    let fitted =
        "JSON.stringify([sinew.app.keypoints.current?.points, [...sinew.app.keypoints.current?.energies[0] ?? []]])";
    let before = page.evaluate(fitted);
    page.evaluate_within("sinew.app.keypoints.setParameter('lambda', 0.55).then(() => 0)", 60.0);
    page.wait_until(&format!("sinew.app.keypoints.current && {IDLE}"), 10.0);
    let of_run = "JSON.stringify([[...sinew.app.doc.run.key_points], [...sinew.app.doc.run.energies[0]]])";
    let after = page.evaluate(fitted);
    assert_eq!(after, page.evaluate(of_run));
    assert_ne!(after, before);
    page.press_with_control("z");
    page.wait_until(&format!("sinew.app.keypoints.current && {IDLE}"), 10.0);
    assert_eq!(page.evaluate(fitted), before);
    // On a floor, too, what is painted is what the engine's error is the mean of.
    let horse = zoo::make(&Recipe { name: "horse".into(), faces: 2000, poses: 4, ..Recipe::default() });
    let horse = horse.expect("a creature of the zoo").sequence;
    page.drop_files(&[("floor.glb", &exact(&floor::on_a_floor(&horse, 30.0), None))]);
    page.wait_until(&format!("sinew.state().source.name === 'floor.glb' && sinew.state().points && {IDLE}"), 60.0);
    page.evaluate("sinew.app.setView('alternation'); sinew.app.setPlace(1000)");
    let painted = page.evaluate(&format!(
        "(([, field]) => field.slice(0, {0}).reduce((sum, far) => sum + far, 0) / {0})(sinew.app.stage.kept.paint[0])",
        horse.reference().len()
    ));
    let error = page.evaluate("Math.max(...sinew.app.keypoints.current.fit_errors)");
    let [painted, error] = [painted, error].map(|value| value.as_f64().unwrap_or(f64::NAN));
    assert!((painted / error - 1.0).abs() < 1e-4, "{painted} is painted for {error}");
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn epsilon_is_dragged_on_the_histogram() {
    let mut page = opened(Backend::WebGl2, Screen::Still, SMALL);
    page.evaluate("document.querySelector('#panel .plot.draggable').closest('details').open = true");
    let before = page.evaluate("sinew.app.result.epsilon").as_f64().unwrap_or(f64::NAN);
    for (by, grows) in [(40.0, true), (-60.0, false)] {
        // Its mark lies at ε, wherever that is.
        let mark = page.evaluate(
            "(() => { const plot = document.querySelector('#panel .fold[open] .plot.draggable'); plot.scrollIntoView({ block: 'center' });
            const box = plot.querySelector('.mark').getBoundingClientRect(), all = plot.getBoundingClientRect();
            return [box.x + box.width / 2, all.y + all.height / 2]; })()",
        );
        let [x, y] = [0, 1].map(|i| mark[i].as_f64().unwrap_or_default());
        let last = page.evaluate("sinew.app.result.epsilon").as_f64().unwrap_or(f64::NAN);
        page.drag_from((x, y), (by, 0.0));
        page.wait_until(&format!("sinew.app.result.epsilon !== {last} && {IDLE}"), 20.0);
        let now = page.evaluate("sinew.app.result.epsilon").as_f64().unwrap_or(f64::NAN);
        assert_eq!(now > last, grows, "dragged by {by} from {last} to {now}");
        let said = page.evaluate("document.querySelector('#panel .plot.draggable').getAttribute('aria-label')");
        assert!(said.as_str().is_some_and(|said| said.contains("ε = ")), "{said}");
    }
    // A drag is one step back.
    for _ in 0..2 {
        page.press_with_control("z");
        page.wait_until("!sinew.state().busy", 20.0);
    }
    page.wait_until(&format!("Math.abs(sinew.app.result.epsilon - {before}) < 1e-9 && {IDLE}"), 20.0);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_face_is_chosen_with_a_click_and_its_lesson_speaks_of_it() {
    let mut page = opened(Backend::WebGl2, Screen::Still, &format!("{SMALL};view=gradients;lesson=open"));
    page.wait_until("document.querySelector('.lesson .matrix')", 5.0);
    let before = page.evaluate("document.querySelector('.lesson-control').innerText");
    assert_eq!(page.evaluate("document.querySelectorAll('.overlay .axis').length"), 6);
    // The trunk, away from the panel and the strip.
    let (x, y) = (0.42, 0.36);
    let [width, height] = [960.0, 640.0];
    page.drag_from((x * width, y * height), (0.0, 0.0));
    page.wait_until("sinew.app.face >= 0", 2.0);
    let after = page.evaluate("document.querySelector('.lesson-control').innerText");
    assert_ne!(before, after);
    // In the reference nothing is deformed: the matrix is the identity.
    assert!(after.as_str().is_some_and(|text| text.contains("turns by 0°") && text.contains("1.00")), "{after}");
    page.evaluate("sinew.app.timeline.seek(3)");
    page.wait_until("document.querySelector('.lesson-control').innerText.includes('pose 4')", 3.0);
    page.evaluate("sinew.app.setView('dual')");
    page.wait_until("document.querySelectorAll('.overlay .link').length > 10", 3.0);
    page.evaluate("sinew.app.setView('parts')");
    page.wait_until("document.querySelectorAll('.overlay line').length === 0", 3.0);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn every_stage_has_a_lesson() {
    let mut page = opened(Backend::WebGl2, Screen::Still, &format!("{SMALL};lesson=open"));
    let lessons = page.evaluate(
        "(async () => { const { STEPS } = await import(new URL('www/steps/index.js', location.href));
        const views = STEPS.filter(({ id }) => ['parts', 'keypoints'].includes(id)).flatMap(({ views }) => views.map(({ id }) => id));
        return Promise.all(views.map(async (id) => { const answer = await fetch(`www/lessons/stages/${id}.html`);
            const page = new DOMParser().parseFromString(await answer.text(), 'text/html');
            return [id, answer.ok, page.querySelector('h3')?.textContent.length > 10, Boolean(page.querySelector('math')),
                page.querySelector('.try')?.textContent.length > 20, page.querySelector('.note-printed')?.textContent.length > 40]; })); })()",
    );
    let lessons = lessons.as_array().cloned().unwrap_or_default();
    assert_eq!(lessons.len(), 18);
    for lesson in lessons {
        assert_eq!(
            lesson.as_array().map(|list| &list[1..]),
            Some(&[json!(true), json!(true), json!(true), json!(true), json!(true)][..]),
            "{lesson}"
        );
    }
    // ε is dragged beside its equation.
    page.evaluate("sinew.app.setView('sets')");
    page.wait_until("document.querySelector('.lesson .plot.draggable')", 3.0);
    let before = page.evaluate("sinew.app.result.epsilon").as_f64().unwrap_or(f64::NAN);
    page.drag(".lesson .plot.draggable", (30.0, 0.0));
    page.wait_until(&format!("sinew.app.changes.epsilon && sinew.app.result.epsilon !== {before} && {IDLE}"), 10.0);
}

/// Goes through a tour from a link to its beginning, and looks at the figures of every stop. One of them is gone through in
/// motion; the others stand still, for which much less is drawn.
fn tour(id: &str, screen: Screen) {
    let mut page = opened(Backend::WebGl2, screen, "#v1;zoo=snake;faces=3000");
    // The same figures with fewer faces, in fewer poses.
    page.evaluate(&format!(
        "Object.assign(sinew.app.about.recipe, {{ faces: 3000, poses: 8 }}); sinew.app.guide.begin('{id}').then(() => 0)"
    ));
    page.wait_until(&format!("sinew.state().parts && {IDLE}"), 60.0);
    let stops = page.evaluate(&format!(
        "import(new URL('www/tours.js', location.href)).then(({{ TOURS }}) => TOURS.find((tour) => tour.id === '{id}').stops.length)"
    ));
    let stops = stops.as_u64().unwrap_or(0);
    assert!(stops >= 5, "{id} has {stops} stops");
    for stop in 0..stops {
        assert_eq!(page.state()["tour"], json!([id, stop]));
        let text = page.evaluate("document.querySelector('.tour p[aria-live]').textContent.length");
        assert!(text.as_u64().is_some_and(|length| length > 60), "{id} {stop}");
        page.wait_until("!sinew.state().busy && !sinew.state().flowing", 60.0);
        page.rest(0.2);
        let two = page.evaluate("!document.querySelector('#second').hidden") == json!(true);
        for canvas in ["#stage canvas", "#second canvas"].iter().take(if two { 2 } else { 1 }) {
            let picture = page.picture_of(canvas, &format!("tour-{id}-{}", stop + 1));
            assert!(picture.colours() > 100, "{id} {stop}: {canvas} has {} colours", picture.colours());
        }
        assert_eq!(page.state()["error"], Value::Null, "{id} {stop}");
        if stop + 1 < stops {
            page.evaluate("document.querySelector('#tour-next').click()");
        }
    }
    page.rest(0.6);
    let hash = page.evaluate("location.hash");
    let hash = hash.as_str().unwrap_or_default();
    assert!(hash.contains(&format!("tour={id}.{}", stops - 1)) && hash.len() < 2000, "{hash}");
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn the_tour_of_why_parts_bend_leads_to_its_end() {
    tour("bend", Screen::Still);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn the_tour_of_joints_leads_to_its_end() {
    tour("joints", Screen::Still);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn the_tour_of_points_leads_to_its_end() {
    tour("points", Screen::Small);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn the_tour_of_two_bodies_leads_to_its_end() {
    tour("two-bodies", Screen::Still);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn the_tour_of_poses_that_differ_leads_to_its_end() {
    tour("poses", Screen::Still);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_stop_of_a_tour_is_a_link() {
    let mut page = opened(Backend::WebGl2, Screen::Still, "#v1;tour=joints.3");
    page.wait_until("sinew.state().tour && sinew.state().view === 'cut' && sinew.state().place === 0", 30.0);
    assert_eq!(page.state()["source"]["name"], "dinosaur");
    let tours = page.evaluate("import(new URL('www/tours.js', location.href)).then(({ TOURS }) => TOURS.length)");
    assert_eq!(tours, 5, "each is walked through above");
    page.click("#tour-leave");
    page.wait_until("!sinew.state().tour", 2.0);
}
