//! Zip archives: what is in them stands in for them, as if the folder had been given.

use super::limits::Budget;
use super::zip::{self, Entry};
use super::{File, ImportError, is_hidden};

pub use super::zip::is_zip;

/// Ends of the names of files that no mesh needs: pictures, sounds, texts.
const NOT_NEEDED: &[&str] = &[
    "gif", "bmp", "tga", "tif", "tiff", "hdr", "exr", "ktx", "basis", "dds", "txt", "md", "pdf", "html", "xml", "mp3",
    "wav", "mp4", "blend", "fbx", "svg",
];

/// Ends of the names of files that only a look needs: images, and the materials of an OBJ.
const FOR_LOOKS: &[&str] = &["png", "jpg", "jpeg", "webp", "ktx2", "mtl"];

/// The files in an archive that a mesh may need, in a folder named like it. What they will take is added up before
/// anything is unpacked, and each is unpacked to the size that was announced and no further.
pub fn unpack(archive: &File, look: bool, budget: &mut Budget) -> Result<Vec<File>, ImportError> {
    let name = &archive.name;
    let unreadable =
        |what| ImportError(format!("{name} is not a readable zip archive ({what}); get it again, or unpack it first"));
    let mut wanted: Vec<Entry> = Vec::new();
    for entry in zip::entries(&archive.bytes).map_err(unreadable)? {
        if !entry.name.ends_with('/') && may_be_needed(&entry.name, look) {
            budget.unpack(entry.size, &format!("\"{}\" in {name}", shortened(&entry.name)))?;
            wanted.push(entry);
        }
    }
    let folder = name.rsplit_once('.').map_or(name.as_str(), |(stem, _)| stem);
    let unpack = |entry: Entry| {
        let bytes = zip::unpack(&archive.bytes, &entry).map_err(|what| {
            ImportError(format!("\"{}\" in {name} cannot be unpacked: {what}", shortened(&entry.name)))
        })?;
        Ok(File { name: format!("{folder}/{}", entry.name), bytes })
    };
    wanted.into_iter().map(unpack).collect()
}

/// Whether a file in a folder or an archive may be needed to read a mesh: not a sound or a text, a picture or a
/// list of materials only for its look, and not what file managers leave behind.
pub fn may_be_needed(name: &str, look: bool) -> bool {
    if is_hidden(name) {
        return false;
    }
    let end = name.rsplit_once('.').map(|(_, end)| end.to_ascii_lowercase());
    end.is_none_or(|end| !NOT_NEEDED.contains(&end.as_str()) && (look || !FOR_LOOKS.contains(&end.as_str())))
}

/// A name, short enough for a sentence.
fn shortened(name: &str) -> String {
    name.chars().filter(|c| !c.is_control()).take(80).collect()
}
