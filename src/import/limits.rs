//! How much memory an import may take, estimated before it is taken.

use super::ImportError;

/// Bytes that an import may fill. A wasm32 module has 4 GiB at the most, and the algorithms need their share.
///
/// Very little for random files, which `cargo fuzz` makes: filling memory takes time and finds nothing.
pub const LIMIT: u64 = if cfg!(fuzzing) {
    1 << 24
} else if cfg!(target_arch = "wasm32") {
    1 << 30
} else {
    2 << 30
};

/// What is left of the limit.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    /// The file's name, for sentences.
    name: String,
    left: u64,
}

impl Budget {
    /// The whole limit, for the file called `name`.
    pub fn new(name: &str) -> Self {
        Self { name: name.to_owned(), left: LIMIT }
    }

    /// Bytes that are left.
    pub fn left(&self) -> u64 {
        self.left
    }

    /// Takes `count` items of `bytes` bytes for `what`, or says that there is not room.
    pub fn take(&mut self, count: u64, bytes: u64, what: &str) -> Result<(), ImportError> {
        match self.left.checked_sub(count.saturating_mul(bytes)) {
            Some(left) => {
                self.left = left;
                Ok(())
            }
            None => Err(ImportError(format!(
                "{what} of {} has {count} entries, which do not fit into the {} allowed here; use a simpler mesh",
                self.name,
                size(LIMIT)
            ))),
        }
    }

    /// Takes `bytes` for one more entry of a mesh whose size shows only as it is read.
    pub fn grow(&mut self, bytes: u64) -> Result<(), ImportError> {
        self.left = self.left.checked_sub(bytes).ok_or_else(|| {
            ImportError(format!(
                "{} has more vertices and faces than fit into the {} allowed here; use a simpler mesh",
                self.name,
                size(LIMIT)
            ))
        })?;
        Ok(())
    }

    /// Takes `bytes` for `what`, which is stored compressed.
    pub fn unpack(&mut self, bytes: u64, what: &str) -> Result<(), ImportError> {
        self.left = self.left.checked_sub(bytes).ok_or_else(|| {
            ImportError(format!(
                "{what} has {} when it is unpacked, more than the {} left of the {} allowed here",
                size(bytes),
                size(self.left),
                size(LIMIT)
            ))
        })?;
        Ok(())
    }

    /// Checks that so many poses (the reference included) of so many vertices fit in; 24 bytes a vertex.
    pub fn poses(&self, vertices: u64, poses: u64) -> Result<(), ImportError> {
        let needed = vertices.saturating_mul(poses).saturating_mul(24);
        if needed <= self.left {
            return Ok(());
        }
        Err(ImportError(format!(
            "{}: {poses} poses of {vertices} vertices need {}, more than the {} allowed here; take fewer poses a \
             second, or a simpler mesh",
            self.name,
            size(needed),
            size(self.left)
        )))
    }
}

fn size(bytes: u64) -> String {
    let bytes = bytes as f64;
    if bytes >= 1e8 { format!("{:.1} GB", bytes / 1e9) } else { format!("{:.0} MB", bytes / 1e6) }
}
