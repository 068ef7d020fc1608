//! Files that name others: which of those that were given is meant.

use super::File;

/// The file that a path relative to `document` means: by its path, else by its last name if that is unique.
pub fn beside<'a>(document: &str, wanted: &str, files: &'a [File]) -> Option<&'a File> {
    let folder = document.rfind(['/', '\\']).map_or("", |slash| &document[..slash]);
    let path = normal_path(&format!("{folder}/{wanted}"));
    if let Some(file) = files.iter().find(|f| normal_path(&f.name) == path) {
        return Some(file);
    }
    let last = |path: &str| normal_path(path).pop().unwrap_or_default().to_lowercase();
    let mut same = files.iter().filter(|f| last(&f.name) == last(wanted));
    same.next().filter(|_| same.next().is_none())
}

/// The parts of a path with `.` and `..` resolved.
fn normal_path(path: &str) -> Vec<String> {
    let mut parts: Vec<String> = Vec::new();
    for part in path.split(['/', '\\']) {
        match part {
            "" | "." => {}
            ".." => {
                parts.pop();
            }
            _ => parts.push(part.to_owned()),
        }
    }
    parts
}

/// The kind of a picture, by how it begins.
pub fn picture_kind(bytes: &[u8]) -> Option<&'static str> {
    match bytes {
        [0x89, b'P', b'N', b'G', ..] => Some("image/png"),
        [0xff, 0xd8, 0xff, ..] => Some("image/jpeg"),
        [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => Some("image/webp"),
        [0xab, b'K', b'T', b'X', b' ', b'2', b'0', 0xbb, ..] => Some("image/ktx2"),
        _ => None,
    }
}
