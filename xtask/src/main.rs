//! `cargo xtask`: the commands that build, serve, test and measure Sinew.
//!
//! Each command does the set-up that it needs; what it cannot set up is one sentence that says what to install.
//! This program runs natively only, so it may use the clock that the crate itself must not.
#![allow(clippy::disallowed_types, reason = "runs natively only")]

mod bench;
mod beside;
mod bundle;
mod dist;
mod serve;
mod server;
mod setup;
mod shell;
mod test;

use std::process::ExitCode;

const HELP: &str = "\
cargo xtask COMMAND

  build [--dev]            the page, as a folder of static files: dist/
  serve [--dev] [--port N] [--no-build]
                           build, then serve dist/ on 127.0.0.1 (8080, or the next free port)
  test                     everything: format, lints, documentation, native tests, tests as wasm in a browser,
                           and the built page in a browser on WebGPU and on WebGL2
  bench [--page] [-- ...]  the algorithms natively, or with --page the page in a browser

  --dev                    built fast for working on it: little optimisation, checks on, no size budget";

fn main() -> ExitCode {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match run(&arguments) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error:#}");
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &[String]) -> anyhow::Result<()> {
    let Some((command, rest)) = arguments.split_first() else {
        println!("{HELP}");
        return Ok(());
    };
    let mut options = Options { rest: rest.to_vec() };
    match command.as_str() {
        "build" => {
            let dev = options.flag("--dev");
            options.finish()?;
            bundle::build(dev)
        }
        "serve" => {
            let (dev, no_build) = (options.flag("--dev"), options.flag("--no-build"));
            let port = options.value("--port")?;
            options.finish()?;
            serve::serve(dev, no_build, port)
        }
        "test" => {
            options.finish()?;
            test::test()
        }
        "bench" => {
            let page = options.flag("--page");
            let passed_on = options.after("--");
            options.finish()?;
            bench::bench(page, &passed_on)
        }
        "help" | "--help" | "-h" => {
            println!("{HELP}");
            Ok(())
        }
        other => anyhow::bail!("there is no command `{other}`\n\n{HELP}"),
    }
}

/// What follows the command on the command line, taken away piece by piece.
struct Options {
    rest: Vec<String>,
}

impl Options {
    /// Whether a flag is there.
    fn flag(&mut self, name: &str) -> bool {
        let before = self.rest.len();
        self.rest.retain(|argument| argument != name);
        self.rest.len() < before
    }

    /// The number after an option, if the option is there.
    fn value<T: std::str::FromStr>(&mut self, name: &str) -> anyhow::Result<Option<T>> {
        let Some(at) = self.rest.iter().position(|argument| argument == name) else { return Ok(None) };
        let value = self.rest.get(at + 1).and_then(|text| text.parse().ok());
        let Some(value) = value else { anyhow::bail!("{name} needs a number after it") };
        self.rest.drain(at..=at + 1);
        Ok(Some(value))
    }

    /// What follows a `--`, for another program.
    fn after(&mut self, mark: &str) -> Vec<String> {
        let Some(at) = self.rest.iter().position(|argument| argument == mark) else { return Vec::new() };
        let after = self.rest.split_off(at);
        after.into_iter().skip(1).collect()
    }

    /// Nothing may be left.
    fn finish(&self) -> anyhow::Result<()> {
        match self.rest.first() {
            Some(unknown) => anyhow::bail!("`{unknown}` means nothing here\n\n{HELP}"),
            None => Ok(()),
        }
    }
}
