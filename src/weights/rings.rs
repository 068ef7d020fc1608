//! Which vertices share an edge.

/// The neighbours of every vertex.
#[derive(Debug)]
pub struct Rings {
    starts: Vec<u32>,
    neighbours: Vec<u32>,
}

impl Rings {
    /// The neighbours in a mesh: vertices that share a face.
    pub fn new(faces: &[[u32; 3]], vertices: usize) -> Self {
        let mut pairs: Vec<[u32; 2]> = Vec::with_capacity(6 * faces.len());
        for &[a, b, c] in faces {
            pairs.extend([[a, b], [b, a], [b, c], [c, b], [c, a], [a, c]]);
        }
        pairs.sort_unstable();
        pairs.dedup();
        let mut starts = vec![0; vertices + 1];
        pairs.iter().for_each(|pair| starts[pair[0] as usize + 1] += 1);
        (0..vertices).for_each(|v| starts[v + 1] += starts[v]);
        Self { starts, neighbours: pairs.iter().map(|pair| pair[1]).collect() }
    }

    /// The neighbours of a vertex, ascending.
    pub fn of(&self, v: u32) -> &[u32] {
        &self.neighbours[self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize]
    }
}
