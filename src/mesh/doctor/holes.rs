//! Open borders: chains of edges with one face.

use super::chart::Chart;
use super::words::{counted, grouped};
use super::{Code, Finding, Severity};

const NONE: u32 = u32::MAX;

/// Chains of edges with one face, each closed where it first meets itself.
pub fn check(chart: &Chart) -> Option<Finding> {
    let mut faces: Vec<u32> = Vec::new();
    let mut edges: Vec<[u32; 2]> = Vec::new();
    for edge in chart.edges().filter(|edge| edge.len() == 1) {
        edges.push(edge[0].points());
        faces.push(edge[0].face());
    }
    faces.sort_unstable();
    faces.dedup();
    let loops = loops(&edges);
    let count = loops.len();
    let longest = loops.iter().copied().max().unwrap_or(0);
    (count > 0).then(|| Finding {
        code: Code::Holes,
        severity: Severity::Harmless,
        count,
        what: counted(count, "open border", "open borders"),
        done: "Nothing was closed.".into(),
        means: format!(
            "The surface ends there ({} in the longest). Parts, points and weights end with it, which is right where \
             nothing is missing.",
            counted(longest, "edge", "edges").replace(&longest.to_string(), &grouped(longest))
        ),
        faces,
    })
}

/// The numbers of edges of simple loops that `edges` are made of. What is left over, where more than one face is missing
/// at an edge, counts as a loop as well.
fn loops(edges: &[[u32; 2]]) -> Vec<usize> {
    let points = edges.iter().flatten().max().map_or(0, |&v| v as usize + 1);
    let mut start = vec![0_u32; points + 1];
    edges.iter().flatten().for_each(|&v| start[v as usize + 1] += 1);
    for v in 0..points {
        start[v + 1] += start[v];
    }
    let mut next = start.clone();
    let mut around = vec![0_u32; 2 * edges.len()];
    for (e, edge) in edges.iter().enumerate() {
        for &v in edge {
            around[next[v as usize] as usize] = e as u32;
            next[v as usize] += 1;
        }
    }
    let mut gone = vec![false; edges.len()];
    // Where the search for edges of a point goes on, and where on the path it is.
    let mut at = start.clone();
    let mut place = vec![NONE; points];
    let mut found = Vec::new();
    let mut path: Vec<u32> = Vec::new();
    for first in 0..edges.len() {
        if gone[first] {
            continue;
        }
        path.push(edges[first][0]);
        place[edges[first][0] as usize] = 0;
        while let Some(&v) = path.last() {
            let slot = &mut at[v as usize];
            while *slot < start[v as usize + 1] && gone[around[*slot as usize] as usize] {
                *slot += 1;
            }
            if *slot == start[v as usize + 1] {
                // A dead end: what is left of the path is open.
                if path.len() > 1 {
                    found.push(path.len() - 1);
                }
                path.drain(..).for_each(|v| place[v as usize] = NONE);
                break;
            }
            let e = around[*slot as usize] as usize;
            gone[e] = true;
            let [a, b] = edges[e];
            let w = if a == v { b } else { a };
            if place[w as usize] == NONE {
                place[w as usize] = path.len() as u32;
                path.push(w);
            } else {
                let from = place[w as usize] as usize;
                found.push(path.len() - from);
                path.drain(from + 1..).for_each(|v| place[v as usize] = NONE);
            }
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::loops;

    #[test]
    fn loops_that_touch_are_two() {
        // Two triangles that touch at 2, begun inside either.
        let edges = [[0, 1], [1, 2], [2, 0], [2, 3], [3, 4], [4, 2]];
        assert_eq!(loops(&edges), [3, 3]);
        let turned: Vec<[u32; 2]> = edges.iter().rev().copied().collect();
        assert_eq!(loops(&turned), [3, 3]);
    }

    #[test]
    fn what_does_not_close_counts_once() {
        assert_eq!(loops(&[[0, 1], [1, 2]]).len(), 1);
        assert_eq!(loops(&[]), [0; 0]);
    }
}
