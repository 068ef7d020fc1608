//! The page for everyone: with a keyboard and a screen reader, without a network, after something broke.

use crate::harness::{Backend, Page, Screen};
use crate::opening::{SETTLED, opened, opened_alone};
use serde_json::{Value, json};
use std::io::{Read, Write};
use std::net::{Shutdown, TcpListener, TcpStream};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

const IDLE: &str = "!sinew.state().busy && sinew.state().drawn";
const SMALL: &str = "#v1;zoo=horse;faces=3000;poses=8;k.points=6;t=reference";

/// These need a program of other people's: see the players.
mod players {
    use super::*;

    /// What axe-core finds that is serious or worse, in words.
    fn complaints(page: &mut Page) -> Value {
        page.evaluate_within(
            "axe.run(document, { resultTypes: ['violations'] }).then(({ violations }) => violations
            .filter(({ impact }) => impact === 'serious' || impact === 'critical')
            .flatMap(({ id, nodes }) => nodes.slice(0, 4).map(({ html, any }) => `${id}: ${html.slice(0, 140)} ${any[0]?.message ?? ''}`)))",
            60.0,
        )
    }

    #[test]
    #[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
    fn axe_finds_nothing_serious() {
        let folder = std::env::var("SINEW_PLAYERS_FOLDER").expect("`cargo xtask test` fetches axe-core");
        let path = std::path::Path::new(&folder).join("node_modules/axe-core/axe.min.js");
        let axe = std::fs::read_to_string(path).expect("axe-core is there");
        let mut page = opened(Backend::WebGl2, Screen::Desktop, SMALL);
        page.evaluate(&format!("{axe}; undefined"));
        let mut found = Vec::new();
        for theme in ["light", "dark"] {
            page.prefer(&[("prefers-color-scheme", theme), ("prefers-reduced-motion", "reduce")]);
            page.evaluate("sinew.app.setLessons(true)");
            for step in ["source", "parts", "keypoints", "target", "transfer", "export"] {
                page.evaluate(&format!("sinew.app.setStep('{step}'); for (const fold of document.querySelectorAll('#panel details')) fold.open = true"));
                page.wait_until(IDLE, 60.0);
                page.rest(0.3);
                found.push((theme, step, complaints(&mut page)));
            }
            for (button, sheet) in [("#open-share", "share"), ("#open-tours", "tours")] {
                page.evaluate(&format!("document.querySelector('{button}').click()"));
                found.push((theme, sheet, complaints(&mut page)));
                page.evaluate(&format!("document.querySelector('#{sheet}').close()"));
            }
        }
        found.retain(|(_, _, list)| *list != json!([]));
        assert!(found.is_empty(), "{found:#?}");
    }
}

/// A way to the page that can be cut: bytes go through as they are.
struct Wire {
    address: String,
    cut: Arc<AtomicBool>,
    streams: Arc<Mutex<Vec<TcpStream>>>,
}

impl Wire {
    fn new(page: &str) -> Self {
        let (host, path) = page.trim_start_matches("http://").split_once('/').expect("an address with a path");
        let listener = TcpListener::bind("127.0.0.1:0").expect("a free port");
        let address = format!("http://{}/{path}", listener.local_addr().expect("it is bound"));
        let (cut, streams) = (Arc::new(AtomicBool::new(false)), Arc::new(Mutex::new(Vec::new())));
        let wire = Self { address, cut: cut.clone(), streams: streams.clone() };
        let host = host.to_owned();
        std::thread::spawn(move || {
            for near in listener.incoming().flatten() {
                if cut.load(Ordering::Relaxed) {
                    continue;
                }
                let Ok(far) = TcpStream::connect(&host) else { continue };
                let mut known = streams.lock().expect("nobody panics with it");
                for (from, to) in [(&near, &far), (&far, &near)] {
                    let (Ok(from), Ok(to)) = (from.try_clone(), to.try_clone()) else { continue };
                    std::thread::spawn(move || pass(from, to));
                }
                known.extend([near, far]);
            }
        });
        wire
    }

    fn cut(&self) {
        self.cut.store(true, Ordering::Relaxed);
        for stream in self.streams.lock().expect("nobody panics with it").drain(..) {
            // What is closed already stays closed.
            drop(stream.shutdown(Shutdown::Both));
        }
    }
}

fn pass(mut from: TcpStream, mut to: TcpStream) {
    let mut buffer = [0; 1 << 16];
    while let Ok(count) = from.read(&mut buffer) {
        if count == 0 || to.write_all(&buffer[..count]).is_err() {
            break;
        }
    }
    drop(to.shutdown(Shutdown::Both));
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn once_loaded_it_works_without_a_network() {
    let wire = Wire::new(&std::env::var("SINEW_PAGE").expect("the page is served"));
    let mut page = Page::open_at(wire.address.clone(), Backend::WebGl2, Screen::Still, "#v1;zoo=snake;faces=3000");
    page.wait_until(SETTLED, 60.0);
    page.evaluate_within("navigator.serviceWorker.ready.then(() => 0)", 30.0);
    page.wait_until("navigator.serviceWorker.controller", 10.0);
    wire.cut();
    page.go("?away#v1;zoo=hand;faces=3000;lesson=open");
    page.wait_until(&format!("location.search === '?away' && {SETTLED}"), 60.0);
    assert_eq!(page.state()["source"]["name"], "hand");
    page.wait_until("document.querySelector('.lesson math')", 10.0);
    // Nothing is left of it for the tests that follow.
    page.evaluate("navigator.serviceWorker.getRegistrations().then((all) => Promise.all(all.map((one) => one.unregister()))).then(() => 0)");
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_crashed_engine_costs_one_question_and_nothing_else() {
    let mut page = opened(Backend::WebGl2, Screen::Still, SMALL);
    page.evaluate("sinew.app.setStep('keypoints')");
    page.wait_until(&format!("sinew.state().points === 6 && {IDLE}"), 60.0);
    page.evaluate("sinew.app.setView('weights'); sinew.app.select(2)");
    let before = page.state();
    page.expect_problem("The worker broke");
    let said = page.evaluate("sinew.app.engine.call('there is no such operation', {}).catch((error) => error.message)");
    assert!(said.as_str().is_some_and(|said| said.contains("Nothing that was open is lost")), "{said}");
    let after = page.state();
    for what in ["source", "parts", "step", "view", "points", "selected", "undo"] {
        assert_eq!(after[what], before[what], "{what}");
    }
    page.evaluate("void sinew.app.parts.setCount(5)");
    page.wait_until(&format!("sinew.state().parts === 5 && {IDLE}"), 20.0);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_crew_of_workers_comes_to_the_same_answer_as_one() {
    let mut page = opened(Backend::WebGl2, Screen::Still, SMALL);
    let answers = page.evaluate_within(
        "(async () => {
            const { engine, about } = sinew.app;
            const told = [];
            for (const crew of [1, 3]) {
                const parameters = { ...about.keypoints, points: 6 };
                const run = await engine.call('keypoints', { parameters, crew });
                const shares = [];
                const fitted = await engine.call('fit', { points: run.key_points, parameters, crew }, { progress: ({ done }) => shares.push(done) });
                told.push({ points: [...run.key_points], weights: [...run.weights], helped: engine.helped,
                    shares: shares.length, radii: run.radius / fitted.radius });
            }
            return told;
        })()",
        120.0,
    );
    let [alone, together] = [&answers[0], &answers[1]];
    assert_eq!(alone["points"], together["points"]);
    assert_eq!(alone["weights"], together["weights"]);
    assert_eq!(alone["helped"], 0);
    assert!(together["helped"].as_u64() > Some(0), "no helper did anything");
    for answer in [alone, together] {
        assert!(answer["shares"].as_u64() > Some(0) && answer["radii"] == 1, "{answer}");
    }
    // Weights that follow a point are those that are found from nothing.
    let apart = page.evaluate_within(
        "(async () => {
            const { engine, about } = sinew.app;
            const open = () => engine.call('target', { recipe: { ...about.recipe, name: 'camel', faces: 3000 } });
            const ask = (...points) => engine.call('target_weights', { points });
            await open();
            await ask(10, 300, 900);
            const followed = await ask(11, 300, 900);
            await open();
            const found = await ask(11, 300, 900);
            return Math.max(...found.map((weight, i) => Math.abs(weight - followed[i])));
        })()",
        120.0,
    );
    assert!(apart.as_f64().is_some_and(|apart| apart < 1e-5), "{apart}");
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn a_lost_picture_comes_back_in_the_middle_of_a_stage() {
    let mut page = opened(Backend::WebGl2, Screen::Still, SMALL);
    page.evaluate("sinew.app.setStep('keypoints')");
    page.wait_until(&format!("sinew.app.keypoints.current?.rounds && {IDLE}"), 60.0);
    page.evaluate("sinew.app.setView('alternation'); sinew.app.setPlace(1)");
    page.wait_until(IDLE, 10.0);
    page.rest(0.5);
    let before = (page.state(), page.picture_of("#stage canvas", "before-a-loss"));
    page.evaluate("window.lost = document.querySelector('#stage canvas')");
    page.evaluate("lost.getContext('webgl2').getExtension('WEBGL_lose_context').loseContext()");
    page.wait_until("!lost.isConnected && document.querySelector('#stage canvas')", 5.0);
    page.rest(0.5);
    page.wait_until(IDLE, 20.0);
    page.rest(0.5);
    let after = (page.state(), page.picture_of("#stage canvas", "after-a-loss-in-a-stage"));
    for what in ["source", "points", "step", "view", "place", "error"] {
        assert_eq!(after.0[what], before.0[what], "{what}");
    }
    let apart = after.1.difference(&before.1, 12);
    assert!(apart < 0.01, "{:.2} % of the picture is another", 100.0 * apart);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn the_policy_is_kept_all_the_way() {
    let mut page = opened(Backend::WebGl2, Screen::Still, SMALL);
    page.evaluate("window.refused = []; document.addEventListener('securitypolicyviolation', ({ violatedDirective, blockedURI }) => refused.push(`${violatedDirective} ${blockedURI}`)); undefined");
    for step in ["source", "parts", "keypoints", "target", "transfer", "export"] {
        page.evaluate(&format!("sinew.app.setLessons(true); sinew.app.setStep('{step}'); for (const fold of document.querySelectorAll('#panel details')) fold.open = true"));
        page.wait_until(IDLE, 60.0);
    }
    page.evaluate("document.querySelector('#export-picture').click()");
    page.evaluate("document.querySelector('#export-labels').click()");
    page.evaluate("document.querySelector('#open-share').click()");
    page.rest(0.5);
    assert_eq!(page.evaluate("refused"), json!([]));
    let policy = page.evaluate("document.querySelector('meta[http-equiv=Content-Security-Policy]').content");
    let policy = policy.as_str().unwrap_or_default();
    assert!(
        policy.contains("default-src 'self'") && !policy.contains("unsafe-inline") && !policy.contains("'unsafe-eval'"),
        "{policy}"
    );
    assert_eq!(page.evaluate("document.cookie"), "");
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn the_page_is_never_held_up_while_a_job_runs() {
    let mut page = opened_alone(Backend::WebGl2, Screen::Small, "#v1;zoo=horse;faces=12000;t=reference");
    page.rest(1.0);
    page.evaluate("window.long = []; new PerformanceObserver((list) => long.push(...list.getEntries().map(({ duration }) => Math.round(duration)))).observe({ type: 'longtask' }); undefined");
    page.evaluate("void sinew.app.keypoints.find()");
    page.wait_until("sinew.state().busy", 5.0);
    page.rest(1.0);
    let during = page.evaluate("[Boolean(sinew.state().busy), long]");
    println!("tasks over 50 ms while key points are sought: {during}");
    assert_eq!(during[0], true, "the job was over too soon to say anything");
    let worst = during[1].as_array().into_iter().flatten().filter_map(Value::as_f64).fold(0.0, f64::max);
    assert!(worst <= 100.0, "the page was held up for {worst} ms");
    page.press("Escape");
    page.wait_until("!sinew.state().busy", 5.0);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn all_that_can_be_pressed_is_reached_with_tab() {
    let mut page = opened(Backend::WebGl2, Screen::Still, SMALL);
    page.evaluate("sinew.app.setLessons(true); document.activeElement.blur(); window.reached = new Set(); document.addEventListener('focusin', ({ target }) => reached.add(target)); undefined");
    page.rest(0.5);
    for _ in 0..160 {
        page.press("Tab");
    }
    let missed = page.evaluate(
        "[...document.querySelectorAll('button, select, input, summary, a[href], canvas, [tabindex=\"0\"]')]
        .filter((e) => e.checkVisibility({ visibilityProperty: true }) && !e.disabled && !e.closest('dialog'))
        .filter((e) => !reached.has(e) && !(e.type === 'radio' && [...document.getElementsByName(e.name)].some((other) => reached.has(other))))
        .map((e) => e.outerHTML.slice(0, 120))",
    );
    assert_eq!(missed, json!([]));
    page.press("?");
    page.wait_until("document.querySelector('#keys').open", 2.0);
    page.press("Escape");
    page.wait_until("!document.querySelector('#keys').open", 2.0);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn what_the_page_finds_stays_whichever_way_one_goes() {
    let mut page = opened(Backend::WebGl2, Screen::Still, SMALL);
    // The parts are taken back while the search for key points is on its way.
    page.evaluate(
        "sinew.app.setStep('keypoints'); sinew.app.parts.setCount(3); sinew.app.parts.setCount(4);
        window.dispatchEvent(new Event('change')); sinew.app.parts.setCount(5); sinew.app.undo()",
    );
    page.wait_until(&format!("sinew.state().points > 0 && sinew.state().parts === 4 && {IDLE}"), 60.0);
    let found = page.state()["points"].clone();
    for (way, parts) in [("redo", 5), ("undo", 4)] {
        page.evaluate(&format!("sinew.app.{way}()"));
        page.wait_until(&format!("sinew.state().parts === {parts} && {IDLE}"), 20.0);
        assert_eq!(page.state()["points"], found, "{way}");
    }
}
