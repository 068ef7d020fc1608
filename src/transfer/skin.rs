//! The result as a skin.

use super::rig::weights::Row;
use super::surface::WeldedSurface;
use glam::{DAffine3, DVec3};

/// A mesh that follows handles: what the page plays and the light export writes.
///
/// A vertex at `p` goes to Σ `share` · `map(p)`; positions are in the target's own frame and scale.
#[derive(Clone, Debug, Default)]
pub struct Skin {
    /// #H vertices of the target, one where each handle acts most.
    pub handles: Vec<u32>,
    /// #V rows of handles and their shares, the largest first, which sum to 1.
    pub rows: Vec<Vec<(u32, f64)>>,
    /// For each pose, #H affine maps.
    pub maps: Vec<Vec<DAffine3>>,
}

impl Skin {
    /// A skin of `count` handles over all given vertices, of #N rows for the places of the target.
    pub(super) fn new(target: &WeldedSurface, count: usize, rows: &[Row], maps: Vec<Vec<DAffine3>>) -> Self {
        let mut strongest = vec![(0.0, 0); count];
        for (row, &vertex) in rows.iter().zip(&target.vertex) {
            for &(handle, share) in row {
                if share > strongest[handle as usize].0 {
                    strongest[handle as usize] = (share, vertex);
                }
            }
        }
        Self {
            handles: strongest.into_iter().map(|best| best.1).collect(),
            rows: target.place.iter().map(|&place| rows[place as usize].clone()).collect(),
            maps,
        }
    }

    /// #V positions in one pose, of the reference positions; the reference itself where there is no such pose.
    pub fn pose(&self, reference: &[DVec3], pose: usize) -> Vec<DVec3> {
        match self.maps.get(pose) {
            Some(maps) => self.posed(reference, maps),
            None => reference.to_vec(),
        }
    }

    /// #V positions under #H maps.
    pub fn posed(&self, reference: &[DVec3], maps: &[DAffine3]) -> Vec<DVec3> {
        let blend = |(&p, row): (&DVec3, &Vec<(u32, f64)>)| {
            row.iter().filter_map(|&(h, share)| Some(share * maps.get(h as usize)?.transform_point3(p))).sum()
        };
        reference.iter().zip(&self.rows).map(blend).collect()
    }

    /// The most handles that any vertex follows.
    pub fn most_influences(&self) -> usize {
        self.rows.iter().map(Vec::len).max().unwrap_or(0)
    }

    /// The `most` strongest handles of every vertex and their shares, which sum to 1 in each row: #V × `most`, filled up
    /// with shares of zero.
    pub fn influences(&self, most: usize) -> (Vec<u16>, Vec<f32>) {
        let mut indices = Vec::with_capacity(self.rows.len() * most);
        let mut shares = Vec::with_capacity(self.rows.len() * most);
        for row in &self.rows {
            let kept = &row[..row.len().min(most)];
            let sum: f64 = kept.iter().map(|entry| entry.1).sum();
            let scale = if sum > 0.0 { 1.0 / sum } else { 0.0 };
            indices.extend(kept.iter().map(|entry| u16::try_from(entry.0).unwrap_or(0)));
            shares.extend(kept.iter().map(|entry| (entry.1 * scale) as f32));
            indices.extend(std::iter::repeat_n(0, most - kept.len()));
            shares.extend(std::iter::repeat_n(0.0, most - kept.len()));
        }
        (indices, shares)
    }

    /// #V × #H shares, row by row.
    pub fn dense(&self) -> Vec<f64> {
        let count = self.handles.len();
        let mut values = vec![0.0; self.rows.len() * count];
        for (row, values) in self.rows.iter().zip(values.chunks_exact_mut(count.max(1))) {
            row.iter().for_each(|&(h, share)| values[h as usize] = share);
        }
        values
    }

    /// The maps as numbers: poses × #H × 12, each a 3 × 4 matrix row by row.
    pub fn matrices(&self) -> Vec<f32> {
        let numbers = |map: &DAffine3| {
            let [x, y, z] = map.matrix3.transpose().to_cols_array_2d();
            let t = map.translation;
            [x[0], x[1], x[2], t.x, y[0], y[1], y[2], t.y, z[0], z[1], z[2], t.z].map(|n| n as f32)
        };
        self.maps.iter().flatten().flat_map(numbers).collect()
    }
}
