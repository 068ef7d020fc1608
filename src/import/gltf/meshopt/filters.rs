//! Filters: what decoded elements stand for.

use super::Filter;

/// Replaces elements of `stride` bytes, which the filter allows, by what they stand for.
pub fn apply(filter: Filter, bytes: &mut [u8], stride: usize) {
    match (filter, stride) {
        (Filter::None, _) => {}
        (Filter::Octahedral, 4) => bytes.as_chunks_mut().0.iter_mut().for_each(octahedral_narrow),
        (Filter::Octahedral, _) => each_wide(bytes, |e| octahedral(e.map(f32::from), 32_767.0)),
        (Filter::Quaternion, _) => each_wide(bytes, quaternion),
        (Filter::Exponential, _) => bytes.as_chunks_mut().0.iter_mut().for_each(exponential),
        (Filter::Color, 4) => bytes.as_chunks_mut().0.iter_mut().for_each(colour_narrow),
        (Filter::Color, _) => each_wide(bytes, |[y, co, cg, a]| {
            let [r, g, b, a] = colour([y as u16 as i32, co.into(), cg.into(), a as u16 as i32], 65_535.0);
            [r, g, b, a].map(|c| c.round() as u16 as i16)
        }),
    }
}

fn each_wide(bytes: &mut [u8], change: impl Fn([i16; 4]) -> [i16; 4]) {
    for element in bytes.as_chunks_mut::<8>().0 {
        let word = |k: usize| i16::from_le_bytes([element[2 * k], element[2 * k + 1]]);
        let changed = change([word(0), word(1), word(2), word(3)]);
        for (pair, value) in element.as_chunks_mut().0.iter_mut().zip(changed) {
            *pair = value.to_le_bytes();
        }
    }
}

/// Filter 1 for components of 16 bits; `largest` stands for 1 in the result. The fourth stays.
fn octahedral([x, y, one, rest]: [f32; 4], largest: f32) -> [i16; 4] {
    let (mut x, mut y) = (x / one, y / one);
    let z = 1.0 - x.abs() - y.abs();
    let below = z.min(0.0);
    x -= below.copysign(x);
    y -= below.copysign(y);
    let scale = largest / (x * x + y * y + z * z).sqrt();
    // A cast takes what is not a number for 0.
    [(x * scale).round() as i16, (y * scale).round() as i16, (z * scale).round() as i16, rest as i16]
}

fn octahedral_narrow(element: &mut [u8; 4]) {
    *element = octahedral(element.map(|b| f32::from(b as i8)), 127.0).map(|c| c as i8 as u8);
}

/// Filter 2: three components, and in the low bits of the fourth which one was left away.
fn quaternion([x, y, z, last]: [i16; 4]) -> [i16; 4] {
    let scale = std::f32::consts::FRAC_1_SQRT_2 / f32::from(last | 3);
    let [x, y, z] = [x, y, z].map(|c| f32::from(c) * scale);
    let w = (1.0 - x * x - y * y - z * z).max(0.0).sqrt();
    let largest = (last & 3) as usize;
    let mut out = [0; 4];
    for (k, c) in [w, x, y, z].into_iter().enumerate() {
        out[(largest + k) % 4] = (c * 32_767.0).round() as i16;
    }
    out
}

/// Filter 3: eight bits of exponent, 24 of mantissa, both signed.
fn exponential(word: &mut [u8; 4]) {
    let value = i32::from_le_bytes(*word);
    let (exponent, mantissa) = (value >> 24, (value << 8) >> 8);
    // In double precision nothing is lost before the last step.
    *word = ((f64::from(exponent).exp2() * f64::from(mantissa)) as f32).to_le_bytes();
}

/// Filter 4: luma, two chromas, and an alpha whose highest bit tells the number of bits of all.
fn colour([y, co, cg, a]: [i32; 4], largest: f32) -> [f32; 4] {
    let all = (1_i32 << (32 - a.leading_zeros())) - 1;
    let alpha = a & (all >> 1);
    let scale = largest / all.max(1) as f32;
    [y + co - cg, y + cg, y - co - cg, (alpha << 1) | (alpha & 1)].map(|c| c as f32 * scale)
}

fn colour_narrow(element: &mut [u8; 4]) {
    let [y, co, cg, a] = *element;
    *element = colour([y.into(), (co as i8).into(), (cg as i8).into(), a.into()], 255.0).map(|c| c.round() as u8);
}

#[cfg(test)]
mod tests {
    use super::*;

    fn filtered<const N: usize>(filter: Filter, words: [i16; N], stride: usize) -> Vec<i16> {
        let mut bytes: Vec<u8> = words.iter().flat_map(|w| w.to_le_bytes()).collect();
        apply(filter, &mut bytes, stride);
        bytes.as_chunks().0.iter().map(|&pair| i16::from_le_bytes(pair)).collect()
    }

    #[test]
    fn quaternions_get_their_largest_component_back() {
        // The identity (w largest), then a half turn about x (x largest).
        assert_eq!(filtered(Filter::Quaternion, [0, 0, 0, 2047], 8), [0, 0, 0, 32_767]);
        assert_eq!(filtered(Filter::Quaternion, [0, 0, 0, 2044], 8), [32_767, 0, 0, 0]);
        // A quarter turn about y: y and w alike, so the component that is written is the whole range.
        let quarter = filtered(Filter::Quaternion, [0, 2047, 0, 2047], 8);
        assert!((quarter[1] - 23_170).abs() <= 1 && (quarter[3] - 23_170).abs() <= 1, "{quarter:?}");
    }

    #[test]
    fn floats_get_their_exponent_back() {
        for (exponent, mantissa, value) in [(0, 3, 3.0), (-2, -5, -1.25), (10, 1, 1024.0), (-100, 1, 2_f32.powi(-100))]
        {
            let mut word = ((exponent << 24) | (mantissa & 0xff_ffff_i32)).to_le_bytes();
            exponential(&mut word);
            assert_eq!(f32::from_le_bytes(word), value);
        }
    }

    #[test]
    fn octahedra_become_unit_vectors() {
        assert_eq!(filtered(Filter::Octahedral, [0, 0, 511, 7], 8), [0, 0, 32_767, 7]);
        assert_eq!(filtered(Filter::Octahedral, [511, 0, 511, 7], 8), [32_767, 0, 0, 7]);
        // The corners of the square are the pole below.
        assert_eq!(filtered(Filter::Octahedral, [511, 511, 511, 7], 8), [0, 0, -32_767, 7]);
        assert_eq!(filtered(Filter::Octahedral, [0, 0, 0, 0], 8)[3], 0);
    }

    #[test]
    fn colours() {
        // Grey of seven bits, opaque.
        let mut bytes = [64, 0, 0, 0x7f];
        apply(Filter::Color, &mut bytes, 4);
        assert_eq!(bytes, [129, 129, 129, 255]);
        let mut bytes = [0; 8];
        apply(Filter::Color, &mut bytes, 8);
        assert_eq!(bytes, [0; 8]);
    }
}
