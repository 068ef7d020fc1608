//! Weights as rows without their zeros: a vertex listens to few handles.

/// Weights below this are left out; bounded biharmonic weights are exactly 0 over most of a mesh.
const NOTHING: f64 = 1e-9;

/// #V rows of #H weights, zeros left out.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Rows {
    count: usize,
    start: Vec<u32>,
    handle: Vec<u32>,
    value: Vec<f64>,
}

impl Rows {
    /// From a row-major matrix of `count` columns. Values that are no numbers count as 0.
    pub fn new(values: &[f64], count: usize) -> Self {
        let mut rows = Self { count, start: vec![0], handle: Vec::new(), value: Vec::new() };
        for row in values.chunks_exact(count.max(1)) {
            for (k, &w) in row.iter().enumerate() {
                if w.abs() > NOTHING && w.is_finite() {
                    rows.handle.push(k as u32);
                    rows.value.push(w);
                }
            }
            rows.start.push(rows.handle.len() as u32);
        }
        rows
    }

    /// The number of handles, #H.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The number of rows, #V.
    pub fn len(&self) -> usize {
        self.start.len().saturating_sub(1)
    }

    /// Whether there is no row.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The handles that vertex `v` listens to, in ascending order, and how much; none for a vertex without a row.
    pub fn entries(&self, v: usize) -> impl Iterator<Item = (u32, f64)> + '_ {
        let from = self.start.get(v).map_or(0, |&s| s as usize);
        let to = self.start.get(v + 1).map_or(from, |&s| s as usize);
        self.handle[from..to].iter().copied().zip(self.value[from..to].iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zeros_are_left_out() {
        let rows = Rows::new(&[0.0, 1.0, 0.25, 0.75, f64::NAN, 1.0], 2);
        assert_eq!((rows.len(), rows.count()), (3, 2));
        assert_eq!(rows.entries(0).collect::<Vec<_>>(), [(1, 1.0)]);
        assert_eq!(rows.entries(1).collect::<Vec<_>>(), [(0, 0.25), (1, 0.75)]);
        assert_eq!(rows.entries(2).collect::<Vec<_>>(), [(1, 1.0)]);
        assert_eq!(rows.entries(3).count(), 0);
        assert!(Rows::new(&[], 0).is_empty());
    }
}
