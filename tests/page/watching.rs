//! The harness notices what it promises to notice.

use crate::harness::{Backend, Page, Screen};

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn planted_problems_are_noticed() {
    // A text, not the page: no policy stands in the way of what is planted.
    let mut page = Page::open(Backend::WebGl2, Screen::Desktop, "pkg/page.js");
    page.wait_until("document.readyState === 'complete' && document.body", 10.0);
    page.evaluate("console.error('planted: an error', 1)");
    page.evaluate("void setTimeout(() => { throw new Error('planted: thrown') })");
    page.evaluate("void Promise.reject(new Error('planted: rejected'))");
    page.evaluate("fetch('http://other.example/planted').catch(() => 0)");
    page.evaluate("fetch('planted-and-missing').then(() => 0)");
    page.evaluate("void new Worker('data:text/javascript,console.error(\"planted: in a worker\")')");
    page.rest(0.5);
    let problems = page.problems().join("\n");
    for planted in [
        "planted: an error 1",
        "planted: thrown",
        "planted: in a worker",
        "planted: rejected",
        "asked another host for http://other.example/planted",
        "planted-and-missing",
    ] {
        assert!(problems.contains(planted), "`{planted}` went unnoticed: {problems}");
    }
    page.expect_problem("planted");
    // The browser looks for an icon of a text by itself.
    page.expect_problem("favicon.ico");
    page.expect_problem("other.example");
    assert_eq!(page.problems(), [""; 0]);
}

#[test]
#[ignore = "drives the built page in Chromium: run by `cargo xtask test`"]
fn the_policy_refuses_other_hosts() {
    let mut page = Page::open(Backend::WebGl2, Screen::Desktop, "");
    page.wait_until("document.readyState === 'complete'", 10.0);
    assert_eq!(page.problems(), [""; 0]);
    page.evaluate("void (new Image().src = 'https://other.example/planted.png')");
    page.rest(0.2);
    let problems = page.problems().join("\n");
    assert!(problems.contains("Content Security Policy"), "nothing refused it: {problems}");
    page.expect_problem("other.example");
    page.expect_problem("Content Security Policy");
}
