//! Damaged zip archives: fields of their headers replaced, bytes changed, pieces moved. [`tens_of_thousands`] runs with
//! the other tests; `cargo test --test import_made ten_million -- --ignored` tries ten million.

use super::dice::Dice;
use super::folders::archive;
use super::gltf_maker::triangle;
use super::opens_or_says_why;

/// Beginnings of the three headers and the bytes of each with what it says, names and comments excepted.
const HEADERS: [(&[u8], usize); 3] = [(b"PK\x03\x04", 30), (b"PK\x01\x02", 46), (b"PK\x05\x06", 22)];
/// What a number of a header may claim, besides what chance gives.
const CLAIMS: [u32; 8] = [0, 1, 22, 0x7fff, 0xffff, 0x7fff_ffff, 0xffff_fffe, 0xffff_ffff];

/// Archives to begin with: deflated and stored, in folders, with pictures, without anything, in each other.
fn corpus() -> Vec<Vec<u8>> {
    let obj = b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n".as_slice();
    let glb = triangle().glb();
    let pair = [("a.obj", obj), ("b.obj", obj)];
    let inner = archive(&pair);
    let folder = [("folder/a.glb", glb.as_slice()), ("folder/a.png", obj), ("__MACOSX/a.glb", obj)];
    let nested = archive(&[("inner.zip", &inner), ("a.obj", obj)]);
    vec![inner, archive(&folder), nested, archive(&[("a.obj", obj)]), archive(&[])]
}

/// Where headers begin, and how long they are.
fn headers(bytes: &[u8]) -> Vec<(usize, usize)> {
    let header = |at: usize| HEADERS.iter().find(|h| bytes[at..].starts_with(h.0)).map(|h| (at, h.1));
    (0..bytes.len()).filter_map(header).filter(|&(at, size)| at + size <= bytes.len()).collect()
}

/// Changes an archive in one place.
fn mutate(bytes: &mut Vec<u8>, other: &[u8], dice: &mut Dice) {
    let at = dice.below(bytes.len());
    let end = (at + dice.below(48)).min(bytes.len());
    match dice.below(8) {
        // A number of a header: twice as often as the rest together, for there most decisions are made.
        0..5 => {
            let headers = headers(bytes);
            let Some(&(at, size)) = headers.get(dice.below(headers.len())) else { return };
            let width = [2, 4][dice.below(2)];
            let field = at + 4 + dice.below(size - 3 - width);
            let near = u32::try_from(bytes.len()).unwrap_or(0).wrapping_add(dice.below(64) as u32).wrapping_sub(32);
            let chance = dice.below(1 << 31) as u32;
            let claim = [CLAIMS[dice.below(CLAIMS.len())], near, chance][dice.below(3)];
            bytes[field..field + width].copy_from_slice(&claim.to_le_bytes()[..width]);
        }
        5 => {
            if let Some(byte) = bytes.get_mut(at) {
                *byte ^= 1 << dice.below(8);
            }
        }
        6 => drop(bytes.drain(at..end)),
        _ => {
            let from = dice.below(other.len());
            bytes.splice(at..at, other[from..(from + 64).min(other.len())].iter().copied());
        }
    }
}

/// Opens damaged archives; returns how many of them could be opened nevertheless.
fn open_damaged(rounds: usize, seed: u64) -> usize {
    let (corpus, mut dice) = (corpus(), Dice(seed));
    let damaged = |round: usize| {
        let mut bytes = corpus[round % corpus.len()].clone();
        for _ in 0..=dice.below(4) {
            let other = dice.below(corpus.len());
            mutate(&mut bytes, &corpus[other], &mut dice);
        }
        bytes
    };
    (0..rounds).map(damaged).filter(|bytes| opens_or_says_why("a.zip", bytes.clone())).count()
}

#[test]
fn tens_of_thousands() {
    let opened = open_damaged(20_000, 3);
    // Damage is mostly noticed, and not everything is damage.
    assert!((500..10_000).contains(&opened), "{opened} of 20000 could be opened");
}

#[test]
#[ignore = "takes a minute"]
fn ten_million() {
    println!("{} of ten million could be opened", open_damaged(10_000_000, 11));
}
