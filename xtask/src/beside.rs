//! Work that is done beside other work, and shown when it is its turn.

use anyhow::{Result, anyhow};
use std::io::Write;
use std::thread::JoinHandle;

/// Work under way, and what it writes.
pub struct Beside<T>(JoinHandle<(Vec<u8>, Result<T>)>);

impl<T: Send + 'static> Beside<T> {
    /// Starts it. What it has to show it writes to what it is given.
    pub fn start(work: impl FnOnce(&mut dyn Write) -> Result<T> + Send + 'static) -> Self {
        Self(std::thread::spawn(move || {
            let mut written = Vec::new();
            let result = work(&mut written);
            (written, result)
        }))
    }

    /// Waits for its end, shows what it wrote, and returns what came of it.
    pub fn end(self) -> Result<T> {
        let (written, result) = self.0.join().map_err(|_| anyhow!("the work beside this broke off"))?;
        std::io::stdout().write_all(&written)?;
        result
    }
}
