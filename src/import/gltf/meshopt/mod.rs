//! Buffer views that are stored compressed: `EXT_meshopt_compression` and `KHR_meshopt_compression`.
//!
//! A. Kapoulkine et al., *KHR_meshopt_compression*, glTF 2.0 extension registry (2025); its version 0 is the older
//! `EXT_meshopt_compression`. Each mode of appendix A has a file here, `filters` is appendix B.

mod attributes;
mod filters;
mod indices;
mod triangles;
mod varint;

use serde::Deserialize;

/// The two names of the extension.
pub const NAMES: &[&str] = &["KHR_meshopt_compression", "EXT_meshopt_compression"];

/// What a buffer view says of its compressed bytes.
#[derive(Clone, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "camelCase")]
pub struct Compressed {
    /// The buffer in which they are.
    pub buffer: usize,
    /// Where they begin.
    #[serde(default)]
    pub byte_offset: u64,
    /// How many there are.
    pub byte_length: u64,
    /// Bytes an element, once decoded.
    pub byte_stride: u64,
    /// Number of elements.
    pub count: u64,
    /// How they are compressed.
    pub mode: Mode,
    /// What is done to the elements after that.
    #[serde(default)]
    pub filter: Filter,
}

/// The codecs.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum Mode {
    /// Elements of any kind, byte by byte as differences from the element before.
    Attributes,
    /// Indices of a list of triangles.
    Triangles,
    /// Any other indices.
    Indices,
}

/// How decoded elements become what they stand for.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "UPPERCASE")]
pub enum Filter {
    /// They are it already.
    #[default]
    None,
    /// Unit vectors as points of an octahedron.
    Octahedral,
    /// Unit quaternions without their largest component.
    Quaternion,
    /// Floats with an exponent of their own.
    Exponential,
    /// Colours as luma and chroma.
    Color,
}

/// Why bytes cannot be decoded: the end of a sentence that begins with what they are.
pub type Broken = &'static str;

const CUT_SHORT: Broken = "is cut short";
const TOO_LONG: Broken = "has bytes left over";

impl Compressed {
    /// Bytes of the decoded view; saturates where the numbers are absurd.
    pub fn decoded_length(&self) -> u64 {
        self.count.saturating_mul(self.byte_stride)
    }

    /// Decodes `data`, the compressed bytes. The length of the result is [`Self::decoded_length`]; it has been
    /// compared with what is allowed before.
    pub fn decode(&self, data: &[u8]) -> Result<Vec<u8>, Broken> {
        let (Ok(count), Ok(stride)) = (usize::try_from(self.count), usize::try_from(self.byte_stride)) else {
            return Err("claims more than there is memory for");
        };
        self.check(stride)?;
        match self.mode {
            Mode::Attributes => {
                let mut bytes = attributes::decode(data, count, stride)?;
                filters::apply(self.filter, &mut bytes, stride);
                Ok(bytes)
            }
            Mode::Triangles => Ok(narrowed(&triangles::decode(data, count)?, stride)),
            Mode::Indices => Ok(narrowed(&indices::decode(data, count)?, stride)),
        }
    }

    /// The extension's rules for strides, modes and filters.
    fn check(&self, stride: usize) -> Result<(), Broken> {
        let fits = match self.mode {
            Mode::Attributes => stride.is_multiple_of(4) && (4..=256).contains(&stride),
            Mode::Triangles | Mode::Indices => stride == 2 || stride == 4,
        };
        if !fits {
            return Err("has a byteStride that its mode does not allow");
        }
        let fits = match self.filter {
            Filter::None => true,
            _ if self.mode != Mode::Attributes => false,
            Filter::Octahedral | Filter::Color => stride == 4 || stride == 8,
            Filter::Quaternion => stride == 8,
            Filter::Exponential => true,
        };
        if fits { Ok(()) } else { Err("has a filter that its mode and byteStride do not allow") }
    }
}

/// Indices as bytes, two or four each; wider ones wrap around.
fn narrowed(indices: &[u32], stride: usize) -> Vec<u8> {
    indices.iter().flat_map(|index| index.to_le_bytes().into_iter().take(stride)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn view(mode: Mode, filter: Filter, count: u64, byte_stride: u64) -> Compressed {
        Compressed { buffer: 0, byte_offset: 0, byte_length: 0, byte_stride, count, mode, filter }
    }

    #[test]
    fn rules_of_the_extension() {
        for (mode, filter, stride) in [
            (Mode::Attributes, Filter::None, 0),
            (Mode::Attributes, Filter::None, 6),
            (Mode::Attributes, Filter::None, 260),
            (Mode::Triangles, Filter::None, 8),
            (Mode::Triangles, Filter::Exponential, 4),
            (Mode::Attributes, Filter::Quaternion, 4),
            (Mode::Attributes, Filter::Octahedral, 12),
        ] {
            assert!(view(mode, filter, 3, stride).decode(&[0xa0; 64]).is_err(), "{mode:?} {filter:?} {stride}");
        }
    }

    #[test]
    fn absurd_claims_cost_nothing() {
        for mode in [Mode::Attributes, Mode::Triangles, Mode::Indices] {
            for header in [0xa0, 0xa1, 0xe1, 0xd1] {
                for count in [0, 3, 3_000_000_000] {
                    let mut data = vec![0; 80];
                    data[0] = header;
                    let decoded = view(mode, Filter::None, count, 4).decode(&data);
                    assert!(decoded.is_err() || count < 4, "{mode:?} {header:x} {count}");
                }
            }
        }
        assert_eq!(view(Mode::Attributes, Filter::None, u64::MAX, 256).decoded_length(), u64::MAX);
    }
}
