//! Where a document's bytes are: the GLB's binary chunk, `data:` addresses, files given beside it.

use super::document::Document;
use super::meshopt::Compressed;
use crate::import::beside::beside;
use crate::import::limits::Budget;
use crate::import::{File, ImportError};
use std::borrow::Cow;
use std::cell::OnceCell;

/// The buffers of a document, each found or with the reason why not: a buffer that nothing needs may be missing.
pub struct Buffers<'a> {
    files: &'a [File],
    sources: Vec<Result<Cow<'a, [u8]>, ImportError>>,
    /// For each buffer view that is stored compressed its bytes, once they were asked for.
    decoded: Vec<OnceCell<Result<Vec<u8>, ImportError>>>,
}

impl<'a> Buffers<'a> {
    /// Finds the buffers of `document`, which was read from the file called `name`, among `files`. What compressed
    /// buffer views claim is taken from the budget; they are decoded when they are asked for.
    pub fn find(
        name: &str,
        document: &Document,
        binary: Option<&'a [u8]>,
        files: &'a [File],
        budget: &mut Budget,
    ) -> Result<Self, ImportError> {
        for (view, compressed) in &document.extensions.meshopt {
            budget.take(compressed.decoded_length(), 1, &format!("compressed buffer view {view}"))?;
        }
        let find = |(index, buffer): (usize, &gltf::json::Buffer)| match (&buffer.uri, binary) {
            (Some(uri), _) => locate(name, uri, files),
            (None, Some(chunk)) if index == 0 => Ok(Cow::Borrowed(chunk)),
            _ => Err(ImportError(format!("buffer {index} of {name} has no data; export it as one GLB"))),
        };
        Ok(Self {
            files,
            sources: document.buffers.iter().enumerate().map(find).collect(),
            decoded: vec![OnceCell::new(); document.views.len()],
        })
    }

    /// The bytes at an address in the document called `name`.
    pub fn beside(&self, name: &str, uri: &str) -> Result<Cow<'a, [u8]>, ImportError> {
        locate(name, uri, self.files)
    }

    /// The bytes of a buffer view, decoded where it is stored compressed.
    pub fn view(&self, document: &Document, view: usize) -> Result<&[u8], ImportError> {
        let name = &document.name;
        let missing = || ImportError(format!("{name} names buffer view {view}, which does not exist; export it again"));
        let entry = document.views.get(view).ok_or_else(missing)?;
        let cell = self.decoded.get(view).ok_or_else(missing)?;
        match document.extensions.meshopt.get(&view) {
            None => {
                let start = entry.byte_offset.map_or(0, |o| o.0);
                self.stored(name, view, (entry.buffer.value(), start, entry.byte_length.0))
            }
            Some(compressed) => {
                let decoded = cell.get_or_init(|| self.decode(name, view, compressed));
                decoded.as_deref().map_err(ImportError::clone)
            }
        }
    }

    fn decode(&self, name: &str, view: usize, compressed: &Compressed) -> Result<Vec<u8>, ImportError> {
        let place = (compressed.buffer, compressed.byte_offset, compressed.byte_length);
        let data = self.stored(name, view, place)?;
        let wrong = |what| {
            ImportError(format!("the compressed data of buffer view {view} of {name} {what}; export the file again"))
        };
        compressed.decode(data).map_err(wrong)
    }

    /// Bytes of a buffer, as they are in the file; `start` and `length` are what buffer view `view` claims.
    fn stored(
        &self,
        name: &str,
        view: usize,
        (buffer, start, length): (usize, u64, u64),
    ) -> Result<&[u8], ImportError> {
        let source = match self.sources.get(buffer) {
            Some(Ok(bytes)) => bytes,
            Some(Err(why)) => return Err(why.clone()),
            None => {
                return Err(ImportError(format!(
                    "buffer view {view} of {name} names buffer {buffer}, which does not exist; export it again"
                )));
            }
        };
        let end = start.saturating_add(length);
        let range = usize::try_from(start).ok().zip(usize::try_from(end).ok());
        range.and_then(|(start, end)| source.get(start..end)).ok_or_else(|| {
            ImportError(format!(
                "buffer view {view} of {name} ends at byte {end}, but buffer {buffer} has only {} bytes; the file or \
                 its .bin is cut short or damaged, get it again",
                source.len()
            ))
        })
    }
}

fn locate<'a>(name: &str, uri: &str, files: &'a [File]) -> Result<Cow<'a, [u8]>, ImportError> {
    if let Some(rest) = strip_prefix_ignoring_case(uri, "data:") {
        let (head, data) = rest.split_once(',').unwrap_or(("", rest));
        let data = percent_decode(data);
        return if head.to_ascii_lowercase().ends_with(";base64") {
            base64(&data).map(Cow::Owned).ok_or_else(|| {
                ImportError(format!("a data: address in {name} is not valid base64; the file is damaged, get it again"))
            })
        } else {
            Ok(Cow::Owned(data))
        };
    }
    let wanted = percent_decoded(uri);
    if let Some(file) = beside(name, &wanted, files) {
        return Ok(Cow::Borrowed(&file.bytes));
    }
    Err(ImportError(format!(
        "{name} keeps its data in {wanted}, which was not given; give both together (or the whole folder)"
    )))
}

fn strip_prefix_ignoring_case<'s>(text: &'s str, prefix: &str) -> Option<&'s str> {
    let head = text.get(..prefix.len())?;
    head.eq_ignore_ascii_case(prefix).then(|| &text[prefix.len()..])
}

/// The file name that a relative address means: `My%20Fox.bin` is `My Fox.bin`.
pub fn percent_decoded(uri: &str) -> String {
    String::from_utf8_lossy(&percent_decode(uri)).into_owned()
}

/// Decodes `%41`; a `%` that begins no number stands for itself.
fn percent_decode(text: &str) -> Vec<u8> {
    let bytes = text.as_bytes();
    let digit = |at: usize| bytes.get(at).and_then(|&b| char::from(b).to_digit(16));
    let mut out = Vec::with_capacity(bytes.len());
    let mut at = 0;
    while at < bytes.len() {
        match (bytes[at], digit(at + 1), digit(at + 2)) {
            (b'%', Some(high), Some(low)) => {
                out.push((16 * high + low) as u8);
                at += 3;
            }
            (byte, ..) => {
                out.push(byte);
                at += 1;
            }
        }
    }
    out
}

/// Decodes base64 of either alphabet, white space and padding ignored; `None` for any other character.
fn base64(text: &[u8]) -> Option<Vec<u8>> {
    let mut out = Vec::with_capacity(text.len() / 4 * 3 + 2);
    let (mut held, mut bits) = (0_u32, 0);
    for &byte in text {
        let value = match byte {
            b'A'..=b'Z' => byte - b'A',
            b'a'..=b'z' => byte - b'a' + 26,
            b'0'..=b'9' => byte - b'0' + 52,
            b'+' | b'-' => 62,
            b'/' | b'_' => 63,
            b'=' | b' ' | b'\n' | b'\r' | b'\t' => continue,
            _ => return None,
        };
        held = (held << 6) | u32::from(value);
        bits += 6;
        if bits >= 8 {
            bits -= 8;
            out.push((held >> bits) as u8);
            held &= (1 << bits) - 1;
        }
    }
    Some(out)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn file(name: &str, byte: u8) -> File {
        File { name: name.into(), bytes: vec![byte] }
    }

    #[test]
    fn finds_files_by_relative_and_percent_encoded_name() {
        let files = [file("a/My Fox.bin", 1), file("b/My Fox.bin", 2), file("c/Other.BIN", 3)];
        let byte = |document: &str, uri: &str| locate(document, uri, &files).map(|b| b[0]);
        assert_eq!(byte("a/x.gltf", "My%20Fox.bin"), Ok(1));
        assert_eq!(byte("a/x.gltf", "../b/./My%20Fox.bin"), Ok(2));
        assert_eq!(byte("x.gltf", "other.bin"), Ok(3));
        let why = byte("x.gltf", "My%20Fox.bin").unwrap_err().0;
        assert!(why.contains("My Fox.bin") && why.contains("not given"), "{why}");
    }

    #[test]
    fn decodes_base64() {
        assert_eq!(base64(b"SGVsbG8="), Some(b"Hello".to_vec()));
        assert_eq!(base64(b"SGVs\nbG8"), Some(b"Hello".to_vec()));
        assert_eq!(base64(b"-_-_"), Some(vec![0xfb, 0xff, 0xbf]));
        assert_eq!(base64(b"SG!s"), None);
    }

    #[test]
    fn decodes_percents() {
        assert_eq!(percent_decode("a%20b%2"), b"a b%2");
        assert_eq!(percent_decode("%%41%"), b"%A%");
    }
}
