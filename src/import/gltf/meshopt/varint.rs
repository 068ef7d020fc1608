//! Numbers of seven bits a byte (LEB128), and signed numbers folded into unsigned ones.

use super::{Broken, CUT_SHORT};

/// Reads one number from the front of `data`.
pub fn read(data: &mut &[u8]) -> Result<u32, Broken> {
    let mut value = 0_u32;
    for k in 0..5 {
        let (&byte, rest) = data.split_first().ok_or(CUT_SHORT)?;
        *data = rest;
        // Bits beyond the 32nd are ignored, as the format says.
        value |= u32::from(byte & 0x7f) << (7 * k);
        if byte & 0x80 == 0 {
            return Ok(value);
        }
    }
    Err("has a number of more than five bytes")
}

/// The signed number that `folded` stands for: 0, −1, 1, −2, …
pub fn unfolded(folded: u32) -> u32 {
    if folded & 1 == 0 { folded >> 1 } else { !(folded >> 1) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lowest_bits_come_first() {
        for (bytes, value) in [(&[0x7f][..], 0x7f), (&[0x81, 0x04], 0x201), (&[0xff, 0xa0, 0x05], 0x1_507f)] {
            let mut data = bytes;
            assert_eq!(read(&mut data), Ok(value), "{bytes:x?}");
            assert!(data.is_empty());
        }
        assert!(read(&mut &[0x80_u8; 6][..]).is_err());
        assert!(read(&mut &[0x80_u8][..]).is_err());
        assert_eq!([0, 1, 2, 3].map(unfolded), [0, u32::MAX, 1, u32::MAX - 1]);
    }
}
