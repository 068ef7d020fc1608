//! Weights where the source has nothing like the target: a tail, a hump or a hat follows what it grows from.

use super::mend::SHORT;
use super::rig::weights::{LEAST, Row, normalised};
use super::surface::WeldedSurface;
use crate::linalg::cholesky::Cholesky;

/// Gives `lost` vertices weights that are harmonic along the surface between those of the others; pieces that are lost
/// altogether keep theirs.
pub fn fill(surface: &WeldedSurface, rows: &mut [Row], lost: &[bool]) {
    let (region, number) = grown(surface, lost);
    let bones = beside(surface, rows, lost, &region);
    let n = region.len();
    let mut entries = Vec::new();
    let mut columns = vec![0.0; n * bones.len()];
    for (i, &v) in region.iter().enumerate() {
        for &u in surface.neighbours(v as usize) {
            let length = surface.positions[v as usize].distance(surface.positions[u as usize]).max(SHORT);
            let tie = 1.0 / (length * length);
            entries.push((i as u32, i as u32, tie));
            match number[u as usize] {
                // Each tie once, below the diagonal.
                Some(j) if j < i as u32 => entries.push((i as u32, j, -tie)),
                Some(_) => {}
                None => rows[u as usize].iter().for_each(|&(bone, share)| {
                    if let Ok(column) = bones.binary_search(&bone) {
                        columns[column * n + i] += tie * share;
                    }
                }),
            }
        }
    }
    // Every vertex of the region is tied to the rest, so that the system has a solution.
    let Ok(system) = Cholesky::new(n, &entries) else { return };
    system.solve(&mut columns);
    for (i, &v) in region.iter().enumerate() {
        let shares = bones.iter().enumerate().map(|(column, &bone)| (bone, columns[column * n + i]));
        rows[v as usize] = normalised(shares.filter(|share| share.1 > LEAST).collect());
    }
}

/// The lost vertices that hang together with others, and for each vertex its number among them.
fn grown(surface: &WeldedSurface, lost: &[bool]) -> (Vec<u32>, Vec<Option<u32>>) {
    let mut number = vec![None; lost.len()];
    let mut region: Vec<u32> = Vec::new();
    let roots = (0..lost.len()).filter(|&v| !lost[v]);
    let mut stack: Vec<u32> = roots.map(|v| v as u32).collect();
    while let Some(v) = stack.pop() {
        for &u in surface.neighbours(v as usize) {
            if lost[u as usize] && number[u as usize].is_none() {
                number[u as usize] = Some(region.len() as u32);
                region.push(u);
                stack.push(u);
            }
        }
    }
    (region, number)
}

/// The bones, in order, of what is not lost next to a region.
fn beside(surface: &WeldedSurface, rows: &[Row], lost: &[bool], region: &[u32]) -> Vec<u32> {
    let around = region.iter().flat_map(|&v| surface.neighbours(v as usize)).filter(|&&u| !lost[u as usize]);
    let mut bones: Vec<u32> = around.flat_map(|&u| rows[u as usize].iter().map(|entry| entry.0)).collect();
    bones.sort_unstable();
    bones.dedup();
    bones
}
