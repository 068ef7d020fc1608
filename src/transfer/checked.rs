//! Meshes and pairs as people give them.

use super::surface::WeldedSurface;
use super::{Pair, TransferError};
use crate::sequence::Sequence;
use crate::warning::Warning;
use std::collections::BTreeMap;

/// The surfaces of a source and of a target, both with faces; the target's pieces are tied.
pub fn surfaces(source: &Sequence, target: &Sequence) -> Result<[WeldedSurface; 2], TransferError> {
    let surface = |sequence: &Sequence, side: &'static str| {
        let surface = WeldedSurface::new(sequence);
        if surface.faces.is_empty() { Err(TransferError::NoFaces { side }) } else { Ok(surface) }
    };
    Ok([surface(source, "source")?, surface(target, "target")?.tied()])
}

/// The pairs without repetitions, their vertices within range; what was left out or is scarce goes to the warnings.
pub fn checked(
    source: &WeldedSurface,
    target: &WeldedSurface,
    pairs: &[Pair],
    warnings: &mut Vec<Warning>,
) -> Result<Vec<Pair>, TransferError> {
    if pairs.is_empty() {
        return Err(TransferError::NoPairs);
    }
    let mut kept: Vec<Pair> = Vec::with_capacity(pairs.len());
    let mut seen = [BTreeMap::new(), BTreeMap::new()];
    for (number, pair) in pairs.iter().enumerate() {
        let place = |side: &'static str, surface: &WeldedSurface, vertex: u32| match surface.place.get(vertex as usize)
        {
            Some(&place) => Ok(place),
            None => Err(TransferError::OutOfRange { pair: number, side, vertex, vertices: surface.place.len() }),
        };
        let places = [place("source", source, pair.source)?, place("target", target, pair.target)?];
        let before = [0, 1].map(|side| seen[side].get(&places[side]).copied());
        match before {
            [None, None] => {
                seen[0].insert(places[0], number);
                seen[1].insert(places[1], number);
                kept.push(*pair);
            }
            [Some(first), Some(same)] if first == same => {
                warnings.push(Warning::new(
                    "repeated-pair",
                    format!("pair {number} repeats pair {first} and was left out"),
                ));
            }
            [Some(first), _] => return Err(TransferError::SamePlace { first, second: number, side: "source" }),
            [None, Some(first)] => return Err(TransferError::SamePlace { first, second: number, side: "target" }),
        }
    }
    if kept.len() < 4 {
        let count = if kept.len() == 1 { "one pair".to_owned() } else { format!("{} pairs", kept.len()) };
        warnings.push(Warning::new(
            "few-pairs",
            format!("with {count} only, much is guessed; about a dozen tell where everything is"),
        ));
    }
    Ok(kept)
}
