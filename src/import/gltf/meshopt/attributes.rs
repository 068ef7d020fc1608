//! Mode 0: elements of any kind, byte by byte as differences from the element before. Version 0 and version 1.

use super::{Broken, CUT_SHORT, TOO_LONG};

const VERSION_0: u8 = 0xa0;
const VERSION_1: u8 = 0xa1;
/// Differences that share one header.
const GROUP: usize = 16;
/// The most elements of a block.
const BLOCK: usize = 256;
/// Bytes that share one way of taking differences.
const CHANNEL: usize = 4;

/// Bits a difference, by the two bits of a group's header: version 0, then control modes 0 and 1 of version 1.
const WIDTHS: [[u32; 4]; 3] = [[0, 2, 4, 8], [0, 1, 2, 4], [1, 2, 4, 8]];

/// Decodes `count` elements of `stride` bytes (a multiple of 4, at most 256).
pub fn decode(data: &[u8], count: usize, stride: usize) -> Result<Vec<u8>, Broken> {
    let (&header, body) = data.split_first().ok_or(CUT_SHORT)?;
    let newer = match header {
        VERSION_0 => false,
        VERSION_1 => true,
        _ => return Err("does not begin as coded attributes do"),
    };
    let channels = stride / CHANNEL;
    let tail = stride + if newer { channels } else { 0 };
    let end = body.len().checked_sub(tail.max(if newer { 24 } else { 32 })).ok_or(CUT_SHORT)?;
    let (first, modes) = body[body.len() - tail..].split_at(stride);
    let modes = if newer { modes.iter().map(|&m| Mode::new(m)).collect::<Result<_, _>>()? } else { Vec::new() };
    let mut left = &body[..end];
    let block = ((8192 / stride) & !(GROUP - 1)).min(BLOCK);
    // No block is smaller than its headers: absurd counts are noticed before memory is taken.
    let headers = if newer { channels } else { stride };
    if count.div_ceil(block).saturating_mul(headers) > left.len() {
        return Err(CUT_SHORT);
    }
    let mut out = vec![0; count.checked_mul(stride).ok_or("claims more than there is memory for")?];
    let mut previous = first.to_vec();
    for elements in out.chunks_mut(block * stride) {
        let controls = if newer { take(&mut left, channels)? } else { &[] };
        for (channel, before) in previous.chunks_exact_mut(CHANNEL).enumerate() {
            let mut deltas = [[0_u8; BLOCK]; CHANNEL];
            for (k, lane) in deltas.iter_mut().enumerate() {
                let control = controls.get(channel).map(|c| (c >> (2 * k)) & 3);
                read_lane(&mut left, control, &mut lane[..elements.len() / stride])?;
            }
            let mode = modes.get(channel).copied().unwrap_or(Mode::Bytes);
            for (number, element) in elements.chunks_exact_mut(stride).enumerate() {
                mode.advance(before, deltas.map(|lane| lane[number]));
                element[channel * CHANNEL..][..CHANNEL].copy_from_slice(before);
            }
        }
    }
    if left.is_empty() { Ok(out) } else { Err(TOO_LONG) }
}

/// How the differences of a channel are taken.
#[derive(Clone, Copy, PartialEq)]
enum Mode {
    Bytes,
    Pairs,
    /// Exclusive or, turned by so many bits.
    Bits(u32),
}

impl Mode {
    fn new(byte: u8) -> Result<Self, Broken> {
        match (byte & 0xf, byte >> 4) {
            (0, 0) => Ok(Self::Bytes),
            (1, 0) => Ok(Self::Pairs),
            (2, turn) => Ok(Self::Bits(turn.into())),
            _ => Err("has a channel of an unknown kind"),
        }
    }

    /// From the four bytes of one element to those of the next.
    fn advance(self, value: &mut [u8], delta: [u8; CHANNEL]) {
        match self {
            Self::Bytes => {
                for (value, delta) in value.iter_mut().zip(delta) {
                    *value = value.wrapping_add(if delta & 1 == 0 { delta >> 1 } else { !(delta >> 1) });
                }
            }
            Self::Pairs => {
                for (value, delta) in value.chunks_exact_mut(2).zip(delta.chunks_exact(2)) {
                    let delta = u16::from_le_bytes([delta[0], delta[1]]);
                    let delta = if delta & 1 == 0 { delta >> 1 } else { !(delta >> 1) };
                    let sum = u16::from_le_bytes([value[0], value[1]]).wrapping_add(delta);
                    value.copy_from_slice(&sum.to_le_bytes());
                }
            }
            Self::Bits(turn) => {
                let delta = u32::from_le_bytes(delta).rotate_right(turn).to_le_bytes();
                value.iter_mut().zip(delta).for_each(|(value, delta)| *value ^= delta);
            }
        }
    }
}

fn take<'a>(left: &mut &'a [u8], count: usize) -> Result<&'a [u8], Broken> {
    let (taken, rest) = left.split_at_checked(count).ok_or(CUT_SHORT)?;
    *left = rest;
    Ok(taken)
}

/// Reads one byte's differences of all elements of a block into `lane`, which is zero before; `control` is the
/// control mode of version 1, `None` for version 0.
fn read_lane(left: &mut &[u8], control: Option<u8>, lane: &mut [u8]) -> Result<(), Broken> {
    let widths = match control {
        None => WIDTHS[0],
        Some(0) => WIDTHS[1],
        Some(1) => WIDTHS[2],
        Some(2) => return Ok(()),
        Some(_) => {
            lane.copy_from_slice(take(left, lane.len())?);
            return Ok(());
        }
    };
    let headers = take(left, lane.len().div_ceil(GROUP).div_ceil(4))?;
    for (number, group) in lane.chunks_mut(GROUP).enumerate() {
        let width = widths[usize::from((headers[number / 4] >> (2 * (number % 4))) & 3)];
        read_group(left, width, group)?;
    }
    Ok(())
}

/// Reads sixteen differences of `width` bits; those beyond the end of `group` are passed over. All bits set means
/// that the difference follows as a byte of its own.
fn read_group(left: &mut &[u8], width: u32, group: &mut [u8]) -> Result<(), Broken> {
    if width == 0 {
        return Ok(());
    }
    let packed = take(left, GROUP * width as usize / 8)?;
    if width == 8 {
        group.copy_from_slice(&packed[..group.len()]);
        return Ok(());
    }
    let each = 8 / width as usize;
    let sentinel = (1_u8 << width) - 1;
    for k in 0..GROUP {
        let place = k % each;
        // Single bits are stored from the lowest on, wider ones from the highest.
        let shift = if width == 1 { place } else { 8 - (place + 1) * width as usize };
        let mut delta = (packed[k / each] >> shift) & sentinel;
        if delta == sentinel {
            delta = take(left, 1)?[0];
        }
        if let Some(slot) = group.get_mut(k) {
            *slot = delta;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The example of the extension's text: sixteen differences of four bits, two of them spelled out.
    #[test]
    fn differences_of_the_text() {
        let mut left: &[u8] = &[0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5];
        let mut group = [0; 16];
        read_group(&mut left, 4, &mut group).unwrap();
        assert!(left.is_empty());
        let signed = group.map(|d| if d & 1 == 0 { d >> 1 } else { !(d >> 1) } as i8);
        assert_eq!(signed, [-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0]);
    }

    #[test]
    fn single_bits_are_stored_from_the_lowest() {
        let mut group = [0; 16];
        read_group(&mut &[0b0000_0010, 0b1000_0000, 40, 41][..], 1, &mut group).unwrap();
        assert_eq!((group[1], group[15], group.iter().filter(|&&d| d == 0).count()), (40, 41, 14));
    }

    /// Three elements of four bytes, all sums of the same differences, in both versions.
    #[test]
    fn versions_and_channels() {
        let old = [&[VERSION_0][..], &[0b11], &[2; 16], &[0], &[0], &[0], &[0; 28], &[10, 20, 30, 40]].concat();
        let expected = [11, 20, 30, 40, 12, 20, 30, 40, 13, 20, 30, 40];
        assert_eq!(decode(&old, 3, 4), Ok(expected.to_vec()));
        // Literal bytes for the first, nothing for the others.
        let newer = |mode: u8, deltas: [u8; 3]| {
            [&[VERSION_1][..], &[0b10_10_10_11], &deltas, &[0; 19], &[10, 20, 30, 40], &[mode]].concat()
        };
        assert_eq!(decode(&newer(0, [2, 2, 2]), 3, 4), Ok(expected.to_vec()));
        assert_eq!(decode(&newer(1, [2, 2, 2]), 3, 4), Ok(expected.to_vec()));
        // 10 ^ 1 = 11, 11 ^ 7 = 12, 12 ^ 1 = 13.
        assert_eq!(decode(&newer(2, [1, 7, 1]), 3, 4), Ok(expected.to_vec()));
        assert_eq!(decode(&newer(0x12, [2, 14, 2]), 3, 4), Ok(expected.to_vec()));
        assert!(decode(&newer(3, [2, 2, 2]), 3, 4).is_err());
        assert!(decode(&newer(0x11, [2, 2, 2]), 3, 4).is_err());
    }

    #[test]
    fn every_cut_is_noticed() {
        let whole = [&[VERSION_0][..], &[0b11], &[2; 16], &[0], &[0], &[0], &[0; 28], &[10, 20, 30, 40]].concat();
        for length in 0..whole.len() {
            assert!(decode(&whole[..length], 3, 4).is_err(), "{length}");
        }
        assert_eq!(decode(&[&whole[..20], &[0], &whole[20..]].concat(), 3, 4), Err(TOO_LONG));
    }
}
