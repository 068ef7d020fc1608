//! Running other programs from the root of the project.

use anyhow::{Context, Result, bail};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};

/// The root of the project.
pub fn root() -> PathBuf {
    let package = std::env::var_os("CARGO_MANIFEST_DIR").map_or(env!("CARGO_MANIFEST_DIR").into(), PathBuf::from);
    package.parent().map_or(package.clone(), Path::to_path_buf)
}

/// Where Cargo puts what it builds.
pub fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), |folder| root().join(folder))
}

/// A program that will run in the root of the project with nothing on its standard input.
pub fn program(name: &str) -> Command {
    let mut command = Command::new(name);
    command.current_dir(root()).stdin(Stdio::null());
    command
}

/// The Cargo that started this program, with the given arguments.
pub fn cargo<'a>(arguments: impl IntoIterator<Item = &'a str>) -> Command {
    let mut command = program(&std::env::var("CARGO").unwrap_or_else(|_| "cargo".into()));
    command.args(arguments);
    command
}

/// The same command with the lowest priority, where there are priorities to choose from: what else runs hardly feels it.
pub fn in_idle_time(command: Command) -> Command {
    if !cfg!(unix) {
        return command;
    }
    let mut nice = program("nice");
    nice.args(["-n", "19"]).arg(command.get_program()).args(command.get_args());
    let set = command.get_envs().filter_map(|(name, value)| Some((name, value?)));
    nice.envs(set);
    nice
}

/// Runs to the end; anything but success is an error that names what ran.
pub fn run(mut command: Command) -> Result<()> {
    let mut child = start(&mut command)?;
    wait(&command, &mut child)
}

/// Starts a program beside this one.
pub fn start(command: &mut Command) -> Result<Child> {
    command.spawn().with_context(|| format!("`{}` cannot be started", line(command)))
}

/// Waits for the end of what a command has started; anything but success is an error that names what ran.
pub fn wait(command: &Command, child: &mut Child) -> Result<()> {
    let status = child.wait().with_context(|| format!("`{}` cannot be waited for", line(command)))?;
    if !status.success() {
        bail!("`{}` failed ({status})", line(command));
    }
    Ok(())
}

/// Runs to the end and returns what it wrote, without the white space around it.
pub fn output(mut command: Command) -> Result<String> {
    let output = command.output().with_context(|| format!("`{}` cannot be started", line(&command)))?;
    if !output.status.success() {
        bail!("`{}` failed: {}", line(&command), String::from_utf8_lossy(&output.stderr).trim());
    }
    Ok(String::from_utf8_lossy(&output.stdout).trim().to_owned())
}

/// The command as a person would type it.
pub fn line(command: &Command) -> String {
    let program = Path::new(command.get_program()).file_name().unwrap_or(command.get_program());
    let words = std::iter::once(program).chain(command.get_args());
    words.map(|word| word.to_string_lossy().into_owned()).collect::<Vec<_>>().join(" ")
}
