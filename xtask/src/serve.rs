//! `cargo xtask serve`.

use crate::bundle;
use crate::server::Server;
use anyhow::{Result, bail};

/// The first port that is tried when none is asked for, and how many after it.
const PORTS: std::ops::Range<u16> = 8080..8180;

/// Builds the page, serves it on this machine and prints the link. Never returns unless it fails.
pub fn serve(dev: bool, no_build: bool, port: Option<u16>) -> Result<()> {
    if !no_build {
        bundle::build(dev)?;
    } else if !bundle::folder().join("index.html").exists() {
        bail!("there is nothing in dist/ yet: run `cargo xtask build`");
    }
    let server = match port {
        Some(port) => Server::bind(&bundle::folder(), "/", [port])?,
        None => Server::bind(&bundle::folder(), "/", PORTS)?,
    };
    println!("\nSinew is at {}  (Ctrl+C to stop)", server.address()?);
    server.run();
    Ok(())
}
