//! `cargo xtask bench`.

use crate::server::Server;
use crate::{bundle, setup, shell};
use anyhow::Result;

/// Measures the algorithms natively, or the page in a browser; `passed_on` goes to the benchmark program.
pub fn bench(page: bool, passed_on: &[String]) -> Result<()> {
    let mut cargo = shell::cargo(["bench"]);
    if page {
        let browser = setup::browser()?;
        bundle::build(false)?;
        let server = Server::bind(&bundle::folder(), "/", [0])?;
        // What is measured is the page. The program that drives it is that of the tests: nothing is compiled twice.
        cargo.args(["--bench", "page", "--profile", "dev"]);
        cargo.env("SINEW_PAGE", server.run_behind()?).env("CHROMIUM", browser.chromium);
    } else {
        cargo.arg("--benches");
    }
    cargo.arg("--").args(passed_on);
    shell::run(cargo)
}
