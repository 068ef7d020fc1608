//! A folder made equal to a list of files, touching only what differs.

use anyhow::{Context, Result};
use flate2::{Compression, write::GzEncoder};
use std::collections::BTreeMap;
use std::fs;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::io::Write;
use std::path::Path;

/// Files by their name in the folder (`/` between parts).
#[derive(Default)]
pub struct Files(BTreeMap<String, Vec<u8>>);

/// Bytes of some files, as they are and as a host sends them.
#[derive(Default)]
pub struct Size {
    pub raw: usize,
    pub gzipped: usize,
}

impl Files {
    /// Adds one file.
    pub fn add_file(&mut self, name: &str, path: &Path) -> Result<()> {
        let bytes = fs::read(path).with_context(|| format!("{} cannot be read", path.display()))?;
        self.0.insert(name.to_owned(), bytes);
        Ok(())
    }

    /// Adds a folder and all below it, except what is hidden.
    pub fn add_folder(&mut self, name: &str, path: &Path) -> Result<()> {
        for entry in fs::read_dir(path).with_context(|| format!("{} cannot be read", path.display()))? {
            let entry = entry?;
            let leaf = entry.file_name().to_string_lossy().into_owned();
            if leaf.starts_with('.') {
                continue;
            }
            let name = format!("{name}/{leaf}");
            if entry.file_type()?.is_dir() {
                self.add_folder(&name, &entry.path())?;
            } else {
                self.add_file(&name, &entry.path())?;
            }
        }
        Ok(())
    }

    /// Adds a file that is made here.
    pub fn add_text(&mut self, name: &str, text: String) {
        self.0.insert(name.to_owned(), text.into_bytes());
    }

    /// Takes a file out.
    pub fn take(&mut self, name: &str) -> Option<Vec<u8>> {
        self.0.remove(name)
    }

    /// The names of all files, in order.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.0.keys().map(String::as_str)
    }

    /// A number that is another when any name or byte is.
    pub fn fingerprint(&self) -> u64 {
        let mut hasher = DefaultHasher::new();
        self.0.hash(&mut hasher);
        hasher.finish()
    }

    /// Bytes of the files whose names are chosen, each gzipped by itself.
    pub fn size(&self, chosen: impl Fn(&str) -> bool) -> Size {
        let mut size = Size::default();
        for (_, bytes) in self.0.iter().filter(|(name, _)| chosen(name)) {
            size.raw += bytes.len();
            size.gzipped += gzipped(bytes);
        }
        size
    }
}

/// Makes `folder` hold exactly `files`. A file that is already right is not written again.
pub fn write(files: &Files, folder: &Path) -> Result<()> {
    fs::create_dir_all(folder)?;
    remove_others(files, folder, "")?;
    for (name, bytes) in &files.0 {
        let path = folder.join(name);
        if fs::read(&path).is_ok_and(|old| old == *bytes) {
            continue;
        }
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent)?;
        }
        fs::write(&path, bytes).with_context(|| format!("{} cannot be written", path.display()))?;
    }
    Ok(())
}

/// Removes what is not among `files`; `prefix` is the name of the folder, with a `/` after it unless it is the top.
fn remove_others(files: &Files, folder: &Path, prefix: &str) -> Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        let name = format!("{prefix}{}", entry.file_name().to_string_lossy());
        if entry.file_type()?.is_dir() {
            let below = format!("{name}/");
            if files.0.keys().any(|kept| kept.starts_with(&below)) {
                remove_others(files, &entry.path(), &below)?;
            } else {
                fs::remove_dir_all(entry.path())?;
            }
        } else if !files.0.contains_key(&name) {
            fs::remove_file(entry.path())?;
        }
    }
    Ok(())
}

fn gzipped(bytes: &[u8]) -> usize {
    let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
    // Writing into memory cannot fail.
    encoder.write_all(bytes).and_then(|()| encoder.finish()).map_or(bytes.len(), |out| out.len())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_folder_comes_to_hold_just_the_files() -> Result<()> {
        let folder = std::env::temp_dir().join(format!("sinew-dist-{}", std::process::id()));
        fs::create_dir_all(folder.join("old/deep"))?;
        fs::write(folder.join("old/deep/file"), "x")?;
        fs::write(folder.join("stale.js"), "x")?;
        let files =
            Files(BTreeMap::from([("index.html".into(), b"a".to_vec()), ("pkg/page.js".into(), b"b".to_vec())]));
        write(&files, &folder)?;
        let kept = fs::metadata(folder.join("index.html"))?.modified()?;
        write(&files, &folder)?;
        let mut found = Files::default();
        found.add_folder("top", &folder)?;
        assert_eq!(found.0.keys().collect::<Vec<_>>(), ["top/index.html", "top/pkg/page.js"]);
        assert_eq!(fs::metadata(folder.join("index.html"))?.modified()?, kept);
        fs::remove_dir_all(folder)?;
        Ok(())
    }

    #[test]
    fn a_fingerprint_is_of_names_and_bytes() {
        let of = |name: &str, byte| Files(BTreeMap::from([(name.into(), vec![byte])])).fingerprint();
        assert_eq!(of("a", 1), of("a", 1));
        assert!(of("a", 1) != of("a", 2) && of("a", 1) != of("b", 1));
    }

    #[test]
    fn sizes_add_up() {
        let files = Files(BTreeMap::from([("a".into(), vec![7; 1000]), ("b".into(), vec![0; 24])]));
        assert_eq!(files.size(|_| true).raw, 1024);
        assert!(files.size(|name| name == "a").gzipped < 100);
    }
}
