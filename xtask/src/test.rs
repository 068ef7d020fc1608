//! `cargo xtask test`: everything that must hold, one step after the other, up to the first that fails.
//!
//! The order is by how soon a step can fail. What steps compile is shared as far as it goes: lints and documentation
//! use the same metadata, the browser's wasm tests the same dependencies as `build --dev`. The native tests run beside what
//! follows them, with what it leaves of the machine: the page's tests wait a good deal.

use crate::beside::Beside;
use crate::server::Server;
use crate::setup::{self, WASM};
use crate::{bundle, shell};
use anyhow::{Context, Result, bail};
use std::io::{BufRead, BufReader, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::Instant;

/// Tests counted from what the test programs print.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Tally {
    passed: usize,
    failed: usize,
    ignored: usize,
}

impl Tally {
    fn add(&mut self, other: Self) {
        self.passed += other.passed;
        self.failed += other.failed;
        self.ignored += other.ignored;
    }
}

/// The seed of the property tests' cases.
const SEED: &str = "PROPTEST_RNG_SEED";

/// The page's tests that need other people's programs.
const PLAYERS: &str = "players::";

/// A step: what it is called, and what it does. A step with tests says how many; any other counts as one.
type Step = (&'static str, fn(&mut Native) -> Result<Tally>);

/// The native tests while they run.
type Native = Option<Beside<Tally>>;

const STEPS: [Step; 9] = [
    ("format", |_| format()),
    ("lints, native", |_| lint_native()),
    ("lints, wasm32", |_| lint_wasm()),
    ("documentation", |_| document()),
    ("tests, native: built, and started", start_native),
    ("tests as wasm, in a page and in a worker", |_| test_wasm()),
    ("build of the page", |_| build()),
    ("the page in Chromium, on WebGPU and on WebGL2", |_| test_page()),
    ("tests, native: the rest", end_native),
];

/// Runs all the steps, prints how long each took, and ends with one line of numbers.
pub fn test() -> Result<()> {
    let start = Instant::now();
    setup::wasm_target()?;
    setup::wasm_bindgen_version()?;
    setup::browser()?;
    let mut total = Tally::default();
    let mut times = Vec::new();
    let (mut failure, mut native) = (None, None);
    for (number, (name, step)) in STEPS.iter().enumerate() {
        println!("\n== {} of {}: {name}", number + 1, STEPS.len());
        let begin = Instant::now();
        let result = step(&mut native);
        times.push((name, begin.elapsed().as_secs_f64(), result.is_ok()));
        match result {
            Ok(tally) => total.add(tally),
            Err(error) => {
                total.add(error.downcast_ref().map_or(Tally { failed: 1, ..Tally::default() }, |Failed(tally)| *tally));
                failure = Some(error.context(format!("{name} failed")));
                break;
            }
        }
    }
    if native.is_some() {
        println!("\nwhat the native tests found meanwhile:");
        let tally = |error: &anyhow::Error| error.downcast_ref().map_or(Tally::default(), |Failed(tally)| *tally);
        total.add(end_native(&mut native).unwrap_or_else(|error| tally(&error)));
    }
    println!();
    for (name, seconds, passed) in &times {
        println!("{} {seconds:>7.1} s  {name}", if *passed { "ok    " } else { "FAILED" });
    }
    for (name, _) in &STEPS[times.len()..] {
        println!("not run             {name}");
    }
    println!("all in {:.1} s", start.elapsed().as_secs_f64());
    println!("{} passed, {} failed, {} skipped", total.passed, total.failed, total.ignored);
    failure.map_or(Ok(()), Err)
}

/// A test program that found failures, with its numbers.
#[derive(Debug)]
struct Failed(Tally);

impl std::fmt::Display for Failed {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{} of {} tests failed", self.0.failed, self.0.failed + self.0.passed)
    }
}

impl std::error::Error for Failed {}

/// A step that passes or fails as a whole.
fn check(command: Command) -> Result<Tally> {
    shell::run(command)?;
    Ok(Tally { passed: 1, ..Tally::default() })
}

fn format() -> Result<Tally> {
    check(shell::cargo(["fmt", "--all", "--check"]))
}

fn lint_native() -> Result<Tally> {
    check(shell::cargo([
        "clippy",
        "--workspace",
        "--exclude",
        "wasm-test-runner",
        "--all-targets",
        "--",
        "-D",
        "warnings",
    ]))
}

/// The page and the worker at once: what both depend on is then checked once, with the features of both.
fn lint_wasm() -> Result<Tally> {
    let mut cargo = shell::cargo(["clippy", "--target", WASM, "--no-default-features", "--features", "page,worker"]);
    cargo.args(["--lib", "--test", "wasm_page", "--test", "wasm_worker", "--", "-D", "warnings"]);
    check(cargo)
}

fn document() -> Result<Tally> {
    let mut cargo = shell::cargo(["doc", "--workspace", "--exclude", "wasm-test-runner", "--no-deps", "--quiet"]);
    cargo.env("RUSTDOCFLAGS", "-D warnings");
    check(cargo)
}

/// Builds the native tests, and starts them beside the steps that follow.
fn start_native(native: &mut Native) -> Result<Tally> {
    if !Path::new("../shared/data").is_dir() {
        println!("left out: comparisons with public data and other programs' values, which lie beside the checkout");
    }
    let packages: [&[&str]; 2] = [&["test", "--no-fail-fast"], &["test", "--no-fail-fast", "--package", "xtask"]];
    let cargo = |arguments: &[&'static str]| {
        let mut cargo = shell::cargo(arguments.iter().copied());
        if std::env::var_os(SEED).is_none() {
            // The same cases every time, so that a failure is about the change at hand; plain `cargo test` looks further.
            cargo.env(SEED, "2006");
        }
        cargo
    };
    for arguments in packages {
        let mut building = cargo(arguments);
        building.arg("--no-run");
        shell::run(building)?;
    }
    *native = Some(Beside::start(move |out| {
        let mut tally = Tally::default();
        for arguments in packages {
            tally.add(count_to(out, shell::in_idle_time(cargo(arguments)))?);
        }
        Ok(tally)
    }));
    Ok(Tally { passed: 1, ..Tally::default() })
}

/// Waits for the native tests, and shows what they print.
fn end_native(native: &mut Native) -> Result<Tally> {
    native.take().map_or_else(|| Ok(Tally::default()), Beside::end)
}

fn test_wasm() -> Result<Tally> {
    // Built here, where it is seen to be built; Cargo's configuration names it as the runner of wasm32.
    shell::run(shell::cargo(["build", "--package", "wasm-test-runner"]))?;
    let mut cargo = shell::cargo(["test", "--no-fail-fast", "--target", WASM, "--no-default-features"]);
    cargo.args(["--features", "worker", "--test", "wasm_page", "--test", "wasm_worker"]);
    // These cases are small: they run for less time than optimising them takes, and than making them ready for the browser
    // takes with the numbers of all lines.
    cargo.args(["--config", "profile.dev.package.sinew.opt-level=0", "--config", "profile.dev.debug=false"]);
    cargo.env("CHROMEDRIVER", setup::browser()?.driver).env("WASM_BINDGEN_TEST_TIMEOUT", "120");
    count(cargo)
}

fn build() -> Result<Tally> {
    bundle::build(false)?;
    Ok(Tally { passed: 1, ..Tally::default() })
}

/// The page is served from deep inside a host, so that an address that is not relative is found out. As many tests run
/// at a time as there are cores; those that measure time see to it that they run alone.
fn test_page() -> Result<Tally> {
    let server = Server::bind(&bundle::folder(), "/some/where/", [0])?;
    let mut cargo = shell::cargo(["test", "--test", "page", "--", "--ignored", "--show-output"]);
    cargo.env("SINEW_PAGE", server.run_behind()?).env("CHROMIUM", setup::browser()?.chromium);
    let players = setup::players();
    match &players {
        Ok(folder) => {
            let address = Server::bind(folder, "/", [0])?.run_behind()?;
            cargo.env("SINEW_PLAYERS", address).env("SINEW_PLAYERS_FOLDER", folder);
        }
        Err(why) => {
            println!("left out: exported files in three.js and in the Khronos validator ({why:#})");
            cargo.args(["--skip", PLAYERS]);
        }
    }
    let mut tally = count(cargo)?;
    // The native step left these out, and said so; they have now run.
    tally.ignored = 0;
    Ok(tally)
}

/// Runs tests, shows what they print as they print it, and counts.
fn count(command: Command) -> Result<Tally> {
    count_to(&mut std::io::stdout(), command)
}

/// The same, with what they print written to `out`.
fn count_to(out: &mut dyn Write, mut command: Command) -> Result<Tally> {
    let line = shell::line(&command);
    let mut child = command.stdout(Stdio::piped()).spawn().with_context(|| format!("`{line}` cannot be started"))?;
    let mut tally = Tally::default();
    if let Some(output) = child.stdout.take() {
        for text in BufReader::new(output).split(b'\n') {
            let text = text?;
            out.write_all(&text)?;
            out.write_all(b"\n")?;
            if let Some(found) = result_line(&String::from_utf8_lossy(&text)) {
                tally.add(found);
            }
        }
    }
    let status = child.wait()?;
    if tally.failed > 0 {
        return Err(Failed(tally).into());
    }
    if !status.success() {
        bail!("`{line}` failed ({status})");
    }
    if tally == Tally::default() {
        bail!("`{line}` ran no test at all");
    }
    Ok(tally)
}

/// The numbers of a line such as `test result: ok. 3 passed; 0 failed; 1 ignored; …`.
fn result_line(line: &str) -> Option<Tally> {
    let (_, numbers) = line.split_once("test result:")?;
    let words: Vec<&str> = numbers.split_whitespace().collect();
    let before = |word: &str| {
        let at = words.iter().position(|found| found.trim_end_matches(';') == word)?;
        words.get(at.checked_sub(1)?)?.parse().ok()
    };
    Some(Tally { passed: before("passed")?, failed: before("failed")?, ignored: before("ignored").unwrap_or(0) })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn result_lines_are_read() {
        let line = "test result: FAILED. 12 passed; 1 failed; 3 ignored; 0 measured; 9 filtered out; finished in 0.2s";
        assert_eq!(result_line(line), Some(Tally { passed: 12, failed: 1, ignored: 3 }));
        assert_eq!(result_line("running 3 tests"), None);
    }
}
