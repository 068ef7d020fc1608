//! Meshopt streams: encoders that compress nothing, but write the format (KHR_meshopt_compression, appendix A).

use super::Maker;
use serde_json::json;

/// Mode 0, version 0: every difference as a byte.
pub fn attributes(bytes: &[u8], stride: usize) -> Vec<u8> {
    let mut out = vec![0xa0];
    let block = (8192 / stride / 16 * 16).min(256);
    let mut previous = bytes.get(..stride).unwrap_or(&vec![0; stride]).to_vec();
    let baseline = previous.clone();
    for elements in bytes.chunks(block * stride) {
        let count = elements.len() / stride;
        for (lane, before) in previous.iter_mut().enumerate() {
            out.resize(out.len() + count.div_ceil(16).div_ceil(4), 0xff);
            let end = out.len() + count.next_multiple_of(16);
            for element in elements.chunks(stride) {
                let delta = element[lane].wrapping_sub(*before);
                *before = element[lane];
                out.push(if delta & 0x80 == 0 { delta << 1 } else { !(delta << 1) });
            }
            out.resize(end, 0);
        }
    }
    out.resize(out.len() + 32_usize.saturating_sub(stride), 0);
    out.extend(baseline);
    out
}

/// Mode 1: every corner of every triangle written out.
pub fn triangles(indices: &[u32]) -> Vec<u8> {
    let mut out = vec![0xe1];
    out.resize(1 + indices.len() / 3, 0xff);
    let mut last = 0;
    for triangle in indices.chunks(3) {
        out.push(0xff);
        for &index in triangle {
            varint(&mut out, folded(index.wrapping_sub(last)));
            last = index;
        }
    }
    out.extend([0; 16]);
    out
}

/// Mode 2: every index as a difference from the one before.
pub fn indices(indices: &[u32]) -> Vec<u8> {
    let mut out = vec![0xd1];
    let mut last = 0;
    for &index in indices {
        varint(&mut out, folded(index.wrapping_sub(last)) << 1);
        last = index;
    }
    out.extend([0; 4]);
    out
}

fn folded(signed: u32) -> u32 {
    if signed >> 31 == 0 { signed << 1 } else { !(signed << 1) }
}

fn varint(out: &mut Vec<u8>, mut value: u32) {
    while value > 0x7f {
        out.push(value as u8 | 0x80);
        value >>= 7;
    }
    out.push(value as u8);
}

impl Maker {
    /// Stores a buffer view compressed; its own bytes are then nowhere in the file.
    pub fn compress(&mut self, view: usize, mode: &str, stride: usize) {
        let entry = self.json["bufferViews"][view].clone();
        let at = |key: &str| entry[key].as_u64().unwrap() as usize;
        let bytes = self.bytes[at("byteOffset")..][..at("byteLength")].to_vec();
        let words = |bytes: &[u8]| bytes.chunks(stride).map(word).collect::<Vec<u32>>();
        let coded = match mode {
            "ATTRIBUTES" => attributes(&bytes, stride),
            "TRIANGLES" => triangles(&words(&bytes)),
            _ => indices(&words(&bytes)),
        };
        let compressed = self.view(&coded);
        let place = self.json["bufferViews"].as_array_mut().unwrap().remove(compressed);
        if self.json["buffers"].as_array().unwrap().len() < 2 {
            let fallback =
                json!({"byteLength": 1 << 20, "extensions": {"EXT_meshopt_compression": {"fallback": true}}});
            self.json["buffers"].as_array_mut().unwrap().push(fallback);
        }
        self.json["bufferViews"][view] = json!({
            "buffer": 1,
            "byteLength": bytes.len(),
            "extensions": {"EXT_meshopt_compression": {
                "buffer": 0, "byteOffset": place["byteOffset"], "byteLength": place["byteLength"],
                "byteStride": stride, "count": bytes.len() / stride, "mode": mode,
            }},
        });
    }
}

fn word(bytes: &[u8]) -> u32 {
    bytes.iter().rev().fold(0, |all, &b| (all << 8) | u32::from(b))
}
