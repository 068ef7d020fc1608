//! Mode 2: indices of any topology, as differences from one of two baselines.

use super::varint::{read, unfolded};
use super::{Broken, CUT_SHORT, TOO_LONG};

const HEADER: u8 = 0xd1;
/// Unused bytes at the end.
const TAIL: usize = 4;

/// Decodes `count` indices.
pub fn decode(data: &[u8], count: usize) -> Result<Vec<u32>, Broken> {
    let Some((&HEADER, body)) = data.split_first() else { return Err("does not begin as coded indices do") };
    let end = body.len().checked_sub(TAIL).ok_or(CUT_SHORT)?;
    let mut left = &body[..end];
    // Every index takes a byte at least.
    if count > left.len() {
        return Err(CUT_SHORT);
    }
    let mut last = [0_u32; 2];
    let mut indices = Vec::with_capacity(count);
    for _ in 0..count {
        let code = read(&mut left)?;
        let baseline = &mut last[(code & 1) as usize];
        *baseline = baseline.wrapping_add(unfolded(code >> 1));
        indices.push(*baseline);
    }
    if left.is_empty() { Ok(indices) } else { Err(TOO_LONG) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn two_baselines() {
        // 0 +5 on the first, +100 on the second, +1 on the first, −1 on the second.
        let data = [HEADER, 5 << 2, 0x91, 0x03, 1 << 2, 0b011, 0, 0, 0, 0];
        assert_eq!(decode(&data, 4), Ok(vec![5, 100, 6, 99]));
        assert_eq!(decode(&data, 3), Err(TOO_LONG));
        assert_eq!(decode(&data, 5), Err(CUT_SHORT));
        assert!(decode(&[HEADER, 0, 0], 1).is_err());
    }
}
