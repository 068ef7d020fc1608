//! The two wasm bundles and the folder of static files around them.
//!
//! ```text
//! dist/index.html           as it is in the project
//! dist/www/…                as it is in the project
//! dist/sw.js                www/service-worker.js, with the names of all files and a version of them
//! dist/pkg/page.js          loads page_bg.wasm: the crate with feature `page`
//! dist/pkg/worker.js        loads worker_bg.wasm: the crate with feature `worker`
//! ```

use crate::setup::{self, WASM};
use crate::{dist, shell};
use anyhow::{Context, Result, bail};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Child, Command};
use std::time::{Instant, UNIX_EPOCH};
use wasm_bindgen_cli_support::Bindgen;

/// One of the two wasm files, by the name that its feature, its release profile and its files share.
struct Bundle {
    name: &'static str,
    /// The most that its JavaScript and wasm together may weigh, gzipped.
    budget: usize,
}

const BUNDLES: [Bundle; 2] = [Bundle { name: "page", budget: 1_200_000 }, Bundle { name: "worker", budget: 1_122_000 }];

/// Where the result lies.
pub fn folder() -> PathBuf {
    shell::root().join("dist")
}

/// Builds everything that is not up to date into `dist/`, and holds the bundles to their budgets unless `dev`.
pub fn build(dev: bool) -> Result<()> {
    let start = Instant::now();
    setup::wasm_target()?;
    setup::wasm_bindgen_version()?;
    let root = shell::root();
    let mut files = dist::Files::default();
    files.add_file("index.html", &root.join("index.html"))?;
    files.add_folder("www", &root.join("www"))?;
    if !dev {
        compile_all()?;
    }
    for bundle in &BUNDLES {
        // The quick way's bundles are one file, one after the other.
        if dev {
            shell::run(compilation(bundle, dev))?;
        }
        files.add_folder("pkg", &bind(bundle, dev)?)?;
    }
    add_service_worker(&mut files)?;
    dist::write(&files, &folder())?;
    report(&files, dev)?;
    println!("dist/ is ready ({:.1} s)", start.elapsed().as_secs_f64());
    Ok(())
}

/// Puts the service worker beside the page, because it serves what lies below it, with the list of what it keeps and a
/// version that changes with any file.
fn add_service_worker(files: &mut dist::Files) -> Result<()> {
    let code = files.take("www/service-worker.js").context("www/service-worker.js is missing")?;
    let names: Vec<String> = files.names().map(|name| format!("'{name}'")).collect();
    let head = format!("const VERSION = '{:016x}';\nconst FILES = [{}];\n", files.fingerprint(), names.join(", "));
    files.add_text("sw.js", head + &String::from_utf8(code)?);
    Ok(())
}

/// Compiles the crate for release with the feature of each bundle, all at the same time: optimising one at link time keeps
/// only one core busy. Profiles have folders of their own, so that no Cargo waits for the other.
fn compile_all() -> Result<()> {
    let start = |bundle| {
        let mut command = compilation(bundle, false);
        // Two bars on one line cannot be read.
        command.env("CARGO_TERM_PROGRESS_WHEN", "never");
        let child = shell::start(&mut command);
        (command, child)
    };
    let running: Vec<_> = BUNDLES.iter().map(start).collect();
    let wait = |(command, child): (Command, Result<Child>)| shell::wait(&command, &mut child?);
    let ended: Vec<Result<()>> = running.into_iter().map(wait).collect();
    ended.into_iter().collect()
}

/// The quick way uses the profile of tests, so that most of what it needs is there already. The other asks for the wasm
/// alone: beside a library for Rust, Cargo leaves out optimisation at link time.
fn compilation(bundle: &Bundle, dev: bool) -> Command {
    let (verb, profile) = if dev { ("build", "dev") } else { ("rustc", bundle.name) };
    let mut cargo = shell::cargo([verb, "--lib", "--target", WASM, "--no-default-features"]);
    cargo.args(["--features", bundle.name, "--profile", profile]);
    if !dev {
        cargo.args(["--crate-type", "cdylib"]);
    }
    cargo
}

/// Runs wasm-bindgen, unless it has already run on just this file, and returns the folder with what it wrote.
fn bind(bundle: &Bundle, dev: bool) -> Result<PathBuf> {
    let name = bundle.name;
    let wasm = shell::target().join(WASM).join(if dev { "debug" } else { name }).join("sinew.wasm");
    let folder = shell::target().join("xtask").join(if dev { format!("{name}-dev") } else { name.to_owned() });
    let (output, stamp) = (folder.join("pkg"), folder.join("stamp"));
    let mark = mark(&wasm)?;
    if fs::read_to_string(&stamp).is_ok_and(|old| old == mark) {
        return Ok(output);
    }
    if output.exists() {
        fs::remove_dir_all(&output)?;
    }
    // The default path of the wasm beside the JavaScript is kept, so that the page need not know it.
    let mut bindgen = Bindgen::new();
    bindgen.web(true)?.typescript(false).omit_default_module_path(false).remove_producers_section(true);
    if !dev {
        bindgen.remove_name_section(true);
    }
    bindgen.input_path(&wasm).out_name(name).generate(&output).context("wasm-bindgen failed")?;
    fs::write(stamp, mark)?;
    Ok(output)
}

/// What tells one build of a file from another: its length, when it was written, and the wasm-bindgen that reads it.
fn mark(wasm: &Path) -> Result<String> {
    let about = fs::metadata(wasm).with_context(|| format!("{} was not built", wasm.display()))?;
    let time = about.modified()?.duration_since(UNIX_EPOCH)?.as_nanos();
    let program = fs::metadata(std::env::current_exe()?)?.len();
    Ok(format!("{} {time} {program}", about.len()))
}

/// Prints what the visitor downloads, and fails where a bundle is over its budget.
fn report(files: &dist::Files, dev: bool) -> Result<()> {
    let mut over = Vec::new();
    println!("{:<10} {:>12} {:>14}", "", "bytes", "gzipped");
    for bundle in &BUNDLES {
        let prefix = format!("pkg/{}", bundle.name);
        let size = files.size(|name| name.starts_with(&prefix));
        println!("{:<10} {:>12} {:>14}", bundle.name, size.raw, size.gzipped);
        if size.gzipped > bundle.budget {
            over.push(format!(
                "the {} bundle is {} bytes gzipped, over its budget of {}",
                bundle.name, size.gzipped, bundle.budget
            ));
        }
    }
    let rest = files.size(|name| !name.starts_with("pkg/"));
    println!("{:<10} {:>12} {:>14}", "the rest", rest.raw, rest.gzipped);
    if !over.is_empty() && !dev {
        bail!("{}", over.join("; "));
    }
    Ok(())
}
