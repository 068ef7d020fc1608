//! The GLB container: a header, a JSON chunk and at most one binary chunk.

use crate::import::ImportError;

/// The two chunks of a GLB, or a glTF file by itself.
#[derive(Debug)]
pub struct Container<'a> {
    /// The JSON document.
    pub json: &'a [u8],
    /// The binary chunk, which is buffer 0 where the document gives that no address.
    pub binary: Option<&'a [u8]>,
}

const MAGIC: &[u8; 4] = b"glTF";
const JSON_CHUNK: u32 = 0x4E4F_534A;
const BINARY_CHUNK: u32 = 0x004E_4942;

/// True where the bytes begin as a GLB does.
pub fn is_glb(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

/// Splits a GLB into its chunks; takes anything else for the JSON document.
pub fn split<'a>(name: &str, bytes: &'a [u8]) -> Result<Container<'a>, ImportError> {
    if !is_glb(bytes) {
        let json = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
        return Ok(Container { json, binary: None });
    }
    let cut_short = || ImportError(format!("{name} is cut short: a GLB's header or chunk is incomplete; get it again"));
    let version = word(bytes, 4).ok_or_else(cut_short)?;
    if version != 2 {
        return Err(ImportError(format!(
            "{name} is a GLB of version {version}, but only version 2 is read; convert it to glTF 2.0"
        )));
    }
    let mut container = Container { json: &[], binary: None };
    let mut at = 12_usize;
    while at < bytes.len() {
        let (Some(length), Some(kind)) = (word(bytes, at), word(bytes, at.saturating_add(4))) else {
            // Stray bytes after the last chunk do no harm; a missing JSON chunk is noticed below.
            break;
        };
        let start = at.saturating_add(8);
        let end = start.checked_add(length as usize).ok_or_else(cut_short)?;
        let chunk = bytes.get(start..end).ok_or_else(cut_short)?;
        match kind {
            JSON_CHUNK if container.json.is_empty() => container.json = chunk,
            BINARY_CHUNK if container.binary.is_none() => container.binary = Some(chunk),
            _ => {}
        }
        at = end;
    }
    if container.json.is_empty() {
        return Err(ImportError(format!("{name} is a GLB without a JSON chunk; export it again")));
    }
    Ok(container)
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    let four = bytes.get(at..at.checked_add(4)?)?;
    Some(u32::from_le_bytes(four.try_into().ok()?))
}
