//! The zip format, as far as archives of meshes use it: stored and deflated entries, found by the central directory.
//!
//! PKWARE, *APPNOTE.TXT: .ZIP file format specification*, 6.3.10 (2022). The crates that read all of it are ten times
//! the size of this and of the inflation together, and every visitor of the page downloads them.

use miniz_oxide::inflate::decompress_to_vec_with_limit;

/// An entry of the central directory.
#[derive(Debug)]
pub struct Entry {
    /// Its name, with folders.
    pub name: String,
    /// Its size once it is unpacked, as announced.
    pub size: u64,
    flags: u16,
    method: u16,
    checksum: u32,
    packed: u32,
    /// Where its local header is.
    start: u32,
}

/// What is wrong, for a sentence.
pub type Broken = &'static str;

const LOCAL: &[u8; 4] = b"PK\x03\x04";
const CENTRAL: &[u8; 4] = b"PK\x01\x02";
const END: &[u8; 4] = b"PK\x05\x06";
/// Bytes of the three headers without what follows them.
const LOCAL_SIZE: usize = 30;
const CENTRAL_SIZE: usize = 46;
const END_SIZE: usize = 22;

const CUT_SHORT: Broken = "it is cut short or damaged";
const LARGE: Broken = "it is of the kind for more than 4 GB";

/// True where the bytes begin as a zip archive does (also an empty one).
pub fn is_zip(bytes: &[u8]) -> bool {
    bytes.starts_with(LOCAL) || bytes.starts_with(END)
}

/// The entries, in the order of the directory.
pub fn entries(bytes: &[u8]) -> Result<Vec<Entry>, Broken> {
    // The end record is followed by a comment of up to 64 kB only.
    let first = bytes.len().saturating_sub(END_SIZE + usize::from(u16::MAX));
    let last = bytes.len().checked_sub(END_SIZE).ok_or(CUT_SHORT)?;
    let end = (first..=last).rev().find(|&at| bytes[at..].starts_with(END)).ok_or(CUT_SHORT)?;
    let (count, start) = (short(bytes, end + 10)?, long(bytes, end + 16)?);
    if count == u16::MAX || start == u32::MAX {
        return Err(LARGE);
    }
    let mut at = start as usize;
    let mut found = Vec::new();
    for _ in 0..count {
        if bytes.get(at..at.saturating_add(4)).is_none_or(|magic| magic != CENTRAL) {
            return Err(CUT_SHORT);
        }
        let lengths = [short(bytes, at + 28)?, short(bytes, at + 30)?, short(bytes, at + 32)?].map(usize::from);
        let name = at + CENTRAL_SIZE;
        let name = bytes.get(name..name + lengths[0]).ok_or(CUT_SHORT)?;
        let entry = Entry {
            // Names in older code pages come out with replacement characters, which only shows in sentences.
            name: String::from_utf8_lossy(name).into_owned(),
            size: long(bytes, at + 24)?.into(),
            flags: short(bytes, at + 8)?,
            method: short(bytes, at + 10)?,
            checksum: long(bytes, at + 16)?,
            packed: long(bytes, at + 20)?,
            start: long(bytes, at + 42)?,
        };
        if entry.packed == u32::MAX || entry.size == u64::from(u32::MAX) || entry.start == u32::MAX {
            return Err(LARGE);
        }
        found.push(entry);
        at += CENTRAL_SIZE + lengths.iter().sum::<usize>();
    }
    Ok(found)
}

/// The bytes of an entry, to the size that was announced and no further; the checksum must be right.
pub fn unpack(bytes: &[u8], entry: &Entry) -> Result<Vec<u8>, Broken> {
    if entry.flags & 1 != 0 {
        return Err("it is locked with a password; unpack the archive first");
    }
    let at = entry.start as usize;
    if bytes.get(at..at.saturating_add(4)).is_none_or(|magic| magic != LOCAL) {
        return Err(CUT_SHORT);
    }
    let start = at + LOCAL_SIZE + usize::from(short(bytes, at + 26)?) + usize::from(short(bytes, at + 28)?);
    let packed = start.checked_add(entry.packed as usize).and_then(|end| bytes.get(start..end)).ok_or(CUT_SHORT)?;
    let size = usize::try_from(entry.size).map_err(|_| LARGE)?;
    let unpacked = match entry.method {
        0 => packed.to_vec(),
        8 => decompress_to_vec_with_limit(packed, size).map_err(|_| CUT_SHORT)?,
        _ => return Err("it is compressed in an unusual way; unpack the archive first"),
    };
    if unpacked.len() == size && checksum(&unpacked) == entry.checksum { Ok(unpacked) } else { Err(CUT_SHORT) }
}

fn short(bytes: &[u8], at: usize) -> Result<u16, Broken> {
    let two = at.checked_add(2).and_then(|end| bytes.get(at..end)).ok_or(CUT_SHORT)?;
    Ok(u16::from_le_bytes([two[0], two[1]]))
}

fn long(bytes: &[u8], at: usize) -> Result<u32, Broken> {
    Ok(u32::from(short(bytes, at)?) | u32::from(short(bytes, at.saturating_add(2))?) << 16)
}

/// CRC-32 of ISO 3309, by a table of the remainders of all bytes.
fn checksum(bytes: &[u8]) -> u32 {
    const TABLE: [u32; 256] = {
        let mut table = [0; 256];
        let mut byte = 0;
        while byte < 256 {
            let mut rest = byte as u32;
            let mut bit = 0;
            while bit < 8 {
                rest = if rest & 1 == 1 { 0xedb8_8320 ^ (rest >> 1) } else { rest >> 1 };
                bit += 1;
            }
            table[byte] = rest;
            byte += 1;
        }
        table
    };
    !bytes.iter().fold(u32::MAX, |rest, &b| TABLE[usize::from(rest as u8 ^ b)] ^ (rest >> 8))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_checksum_of_the_standard_text() {
        assert_eq!(checksum(b"123456789"), 0xcbf4_3926);
    }

    #[test]
    fn locked_unusual_and_large_entries_are_refused_in_words() {
        let entry =
            |flags, method, size| Entry { name: "a".into(), size, flags, method, checksum: 0, packed: 0, start: 0 };
        let local = [&LOCAL[..], &[0; 26]].concat();
        assert!(unpack(&local, &entry(1, 0, 0)).unwrap_err().contains("password"));
        assert!(unpack(&local, &entry(0, 14, 0)).unwrap_err().contains("unusual"));
        assert_eq!(unpack(&local, &entry(0, 0, 0)), Ok(Vec::new()));
        assert_eq!(unpack(&local, &entry(0, 0, 1)), Err(CUT_SHORT));
        assert_eq!(unpack(&local[..20], &entry(0, 0, 0)), Err(CUT_SHORT));
        let mut large = [&END[..], &[0; 18]].concat();
        assert!(entries(&large).unwrap().is_empty());
        large[10..12].copy_from_slice(&[0xff, 0xff]);
        assert_eq!(entries(&large).unwrap_err(), LARGE);
    }
}
