//! What a fresh machine lacks: set up where it can be, else one sentence that says what to install.

use crate::shell;
use anyhow::{Context, Result, bail};
use std::path::PathBuf;

/// The target of both bundles.
pub const WASM: &str = "wasm32-unknown-unknown";

/// Makes sure that the compiler has a standard library for wasm32.
pub fn wasm_target() -> Result<()> {
    let mut rustc = shell::program("rustc");
    rustc.args(["--print", "target-libdir", "--target", WASM]);
    let folder = shell::output(rustc).context("the Rust compiler is missing: install it from https://rustup.rs")?;
    if std::fs::read_dir(&folder).is_ok_and(|mut entries| entries.next().is_some()) {
        return Ok(());
    }
    println!("adding the compiler's target {WASM}");
    let mut rustup = shell::program("rustup");
    rustup.args(["target", "add", WASM]);
    shell::run(rustup).with_context(|| {
        format!("the Rust compiler cannot build for {WASM}: run `rustup target add {WASM}`, or install that target's standard library from your system's packages")
    })
}

/// Checks that the wasm-bindgen built into this program is the one that the crate is locked to.
pub fn wasm_bindgen_version() -> Result<()> {
    let lock = std::fs::read_to_string(shell::root().join("Cargo.lock")).context("Cargo.lock cannot be read")?;
    let of = |package| locked_version(&lock, package).with_context(|| format!("Cargo.lock has no {package}"));
    let (crate_, tool) = (of("wasm-bindgen")?, of("wasm-bindgen-cli-support")?);
    if crate_ != tool {
        bail!(
            "wasm-bindgen is locked at {crate_} but wasm-bindgen-cli-support at {tool}; they must be the same: set `wasm-bindgen-cli-support = \"={crate_}\"` in xtask/Cargo.toml and `wasm-bindgen-cli = \"={crate_}\"` in xtask/test-runner/Cargo.toml"
        );
    }
    Ok(())
}

/// The browser and its driver, for tests.
pub struct Browser {
    /// Chromium, or a browser of its family.
    pub chromium: PathBuf,
    /// What starts it for wasm-bindgen's tests.
    pub driver: PathBuf,
}

/// Finds Chromium and its driver, or installs them where that is ours to do.
pub fn browser() -> Result<Browser> {
    if let Some(browser) = find_browser() {
        return Ok(browser);
    }
    if on_path(&["apt-get"]).is_some() && is_root() {
        println!("installing chromium and chromium-driver");
        for arguments in [&["update"][..], &["install", "-y", "--no-install-recommends", "chromium", "chromium-driver"]]
        {
            let mut apt = shell::program("apt-get");
            apt.args(arguments).env("DEBIAN_FRONTEND", "noninteractive");
            shell::run(apt)?;
        }
    }
    find_browser().context("the tests need Chromium and its driver: install your system's packages `chromium` and `chromium-driver` (or Chrome and `chromedriver`), or name them in the variables CHROMIUM and CHROMEDRIVER")
}

fn find_browser() -> Option<Browser> {
    let named = |variable: &str| std::env::var_os(variable).map(PathBuf::from);
    let names = ["chromium", "chromium-browser", "google-chrome", "google-chrome-stable", "chrome"];
    Some(Browser {
        chromium: named("CHROMIUM").or_else(|| on_path(&names))?,
        driver: named("CHROMEDRIVER").or_else(|| on_path(&["chromedriver"]))?,
    })
}

/// The first of some programs that is on the path.
fn on_path(names: &[&str]) -> Option<PathBuf> {
    let path = std::env::var_os("PATH")?;
    let folders: Vec<PathBuf> = std::env::split_paths(&path).collect();
    let candidates = names.iter().flat_map(|name| folders.iter().map(move |folder| folder.join(name)));
    candidates.into_iter().find(|program| program.is_file())
}

fn is_root() -> bool {
    let mut id = shell::program("id");
    id.arg("-u");
    shell::output(id).is_ok_and(|user| user == "0")
}

/// Other people's programs that exported files are tried with, as npm packages without dependencies of their own.
const PLAYERS: [&str; 3] = ["three@0.187.0", "gltf-validator@2.0.0-dev.3.10", "axe-core@4.14.1"];

/// The folder with [`PLAYERS`] in its `node_modules`, fetched if need be; else why there is none. They are for
/// checking only: without Node.js or the network, all else goes on.
pub fn players() -> Result<PathBuf> {
    let folder = shell::target().join("players");
    let there = |package: &str| {
        let (name, version) = package.rsplit_once('@').unwrap_or((package, ""));
        let about = std::fs::read_to_string(folder.join("node_modules").join(name).join("package.json"));
        about.is_ok_and(|about| about.contains(&format!("\"version\": \"{version}\"")))
    };
    if on_path(&["node"]).is_none() {
        bail!("Node.js is not installed");
    }
    if !PLAYERS.into_iter().all(there) {
        if on_path(&["npm"]).is_none() {
            bail!("npm is not installed");
        }
        std::fs::create_dir_all(&folder)?;
        println!("fetching {}", PLAYERS.join(", "));
        let mut npm = shell::program("npm");
        npm.arg("install").arg("--prefix").arg(&folder);
        npm.args(["--ignore-scripts", "--no-audit", "--no-fund", "--no-save", "--loglevel", "error"]);
        npm.args(["--fetch-retries", "1", "--fetch-timeout", "60000"]).args(PLAYERS);
        shell::run(npm)?;
    }
    Ok(folder)
}

/// The version of a package in the text of a Cargo.lock.
fn locked_version<'a>(lock: &'a str, package: &str) -> Option<&'a str> {
    let name = format!("name = \"{package}\"");
    let mut lines = lock.lines().skip_while(|line| *line != name);
    lines.nth(1)?.strip_prefix("version = \"")?.strip_suffix('"')
}

#[cfg(test)]
mod tests {
    use super::locked_version;

    #[test]
    fn finds_a_package_by_its_whole_name() {
        let lock = "[[package]]\nname = \"wasm-bindgen-macro\"\nversion = \"0.1.0\"\n\n[[package]]\nname = \"wasm-bindgen\"\nversion = \"0.2.130\"\n";
        assert_eq!(locked_version(lock, "wasm-bindgen"), Some("0.2.130"));
        assert_eq!(locked_version(lock, "bindgen"), None);
    }
}
