//! How long things take in the browser, where visitors feel them: `cargo xtask bench --page`.
//!
//! The page measures itself: `sinew.bench()` returns a promise of rows `{ name, milliseconds }`. Opened with
//! `?bench`, the page does nothing else meanwhile. Given `--json` after `--`, the rows are printed as JSON.

#[path = "../tests/page/harness/mod.rs"]
#[allow(dead_code, reason = "a benchmark uses little of the harness")]
mod harness;

use harness::{Backend, Page, Screen};
use serde_json::{Value, json};

fn main() {
    if std::env::var_os("SINEW_PAGE").is_none() {
        println!("page benchmark left out: it needs the built page on a server; run `cargo xtask bench --page`");
        return;
    }
    let mut rows = Vec::new();
    for backend in [Backend::WebGpu, Backend::WebGl2] {
        let mut page = Page::open(backend, Screen::Desktop, "?bench");
        let opened = page.wait_until("sinew.ready", 30.0);
        rows.push(json!({ "name": format!("open on {}", backend.name()), "milliseconds": 1000.0 * opened }));
        let measured = page.evaluate_within("sinew.bench()", 600.0);
        let measured = measured.as_array().expect("sinew.bench() gives a list of rows");
        rows.extend(measured.iter().map(|row| {
            let name = format!("{} on {}", row["name"].as_str().unwrap_or("?"), backend.name());
            json!({ "name": name, "milliseconds": row["milliseconds"] })
        }));
    }
    if std::env::args().any(|argument| argument == "--json") {
        println!("{}", Value::Array(rows));
        return;
    }
    for row in rows {
        println!(
            "{:<84} {:>10.1} ms",
            row["name"].as_str().unwrap_or("?"),
            row["milliseconds"].as_f64().unwrap_or(f64::NAN)
        );
    }
}
