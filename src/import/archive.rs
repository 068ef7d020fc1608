//! Zip archives: what is in them stands in for them, as if the folder had been given.

use super::limits::Budget;
use super::{File, ImportError, is_hidden};
use std::io::{Cursor, Read};
use zip::ZipArchive;
use zip::result::ZipError;

/// Ends of the names of files that no mesh needs: pictures, sounds, texts.
const NOT_NEEDED: &[&str] = &[
    "png", "jpg", "jpeg", "webp", "gif", "bmp", "tga", "tif", "tiff", "hdr", "exr", "ktx", "ktx2", "basis", "dds",
    "mtl", "txt", "md", "pdf", "html", "xml", "mp3", "wav", "mp4", "blend", "fbx", "svg",
];

/// The most entries that are looked at.
const ENTRIES: usize = 100_000;

/// True where the bytes begin as a zip archive does (also an empty one).
pub fn is_zip(bytes: &[u8]) -> bool {
    bytes.starts_with(b"PK\x03\x04") || bytes.starts_with(b"PK\x05\x06")
}

/// The files in an archive that a mesh may need, in a folder named like it. What they will take is added up before
/// anything is unpacked, and each is unpacked to the size that was announced and no further.
pub fn unpack(archive: &File, budget: &mut Budget) -> Result<Vec<File>, ImportError> {
    let name = &archive.name;
    let wrong = |error: ZipError| {
        ImportError(match error {
            ZipError::UnsupportedArchive(_) | ZipError::InvalidPassword => {
                format!("{name} is locked, or compressed in an unusual way ({error}); unpack it and give what is in it")
            }
            _ => format!("{name} is not a readable zip archive ({error}); get it again, or unpack it first"),
        })
    };
    let mut zip = ZipArchive::new(Cursor::new(archive.bytes.as_slice())).map_err(wrong)?;
    if zip.len() > ENTRIES {
        return Err(ImportError(format!("{name} has {} entries, which are more than Sinew looks at", zip.len())));
    }
    let mut wanted = Vec::new();
    for index in 0..zip.len() {
        let entry = zip.by_index_raw(index).map_err(wrong)?;
        let inside = entry.name().map_err(wrong)?.into_owned();
        if entry.is_dir() || !may_be_needed(&inside) {
            continue;
        }
        budget.unpack(entry.size(), &format!("\"{}\" in {name}", shortened(&inside)))?;
        wanted.push((index, inside, entry.size()));
    }
    let folder = name.rsplit_once('.').map_or(name.as_str(), |(stem, _)| stem);
    let mut files = Vec::with_capacity(wanted.len());
    for (index, inside, size) in wanted {
        let entry = zip.by_index(index).map_err(wrong)?;
        let mut bytes = Vec::new();
        let read = entry.take(size).read_to_end(&mut bytes);
        let damaged = |why: String| {
            ImportError(format!("\"{}\" in {name} cannot be unpacked ({why}); get it again", shortened(&inside)))
        };
        read.map_err(|error| damaged(error.to_string()))?;
        if bytes.len() as u64 != size {
            return Err(damaged(format!("{} of {size} bytes", bytes.len())));
        }
        files.push(File { name: format!("{folder}/{inside}"), bytes });
    }
    Ok(files)
}

/// Whether a file in a folder or an archive may be needed to read a mesh: not a picture, a sound or a text, and not
/// what file managers leave behind.
pub fn may_be_needed(name: &str) -> bool {
    if is_hidden(name) {
        return false;
    }
    let end = name.rsplit_once('.').map(|(_, end)| end.to_ascii_lowercase());
    end.is_none_or(|end| !NOT_NEEDED.contains(&end.as_str()))
}

/// A name, short enough for a sentence.
fn shortened(name: &str) -> String {
    name.chars().filter(|c| !c.is_control()).take(80).collect()
}
