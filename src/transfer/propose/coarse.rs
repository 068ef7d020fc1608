//! A surface's samples as a coarse mesh, and the graph along which distances between them run.

use crate::mesh::face::is_whole;
use crate::mesh::paths::Graph;
use glam::DVec3;

/// Triangles between three cells that meet at a face, each once.
pub fn faces(faces: &[[u32; 3]], cell: &[u32]) -> Vec<[u32; 3]> {
    let cells = faces.iter().map(|f| f.map(|v| cell[v as usize]));
    let mut coarse: Vec<[u32; 3]> = cells.filter(|[a, b, c]| a != b || b != c).map(rotated).collect();
    coarse.sort_unstable();
    coarse.dedup();
    coarse
}

/// The same triangle with its smallest number first.
fn rotated([a, b, c]: [u32; 3]) -> [u32; 3] {
    if a <= b && a <= c {
        [a, b, c]
    } else if b <= a && b <= c {
        [b, c, a]
    } else {
        [c, a, b]
    }
}

/// Links along the coarse edges, straight across pairs of triangles, and between pieces.
pub fn graph(coarse: &[[u32; 3]], places: &[DVec3]) -> Graph {
    let mut links = edges(coarse, places);
    links.extend(across(coarse, places));
    let graph = Graph::new(places.len(), &links);
    let piece = pieces(&graph);
    let bridges = bridges(&piece, places);
    if bridges.is_empty() {
        return graph;
    }
    let spacing = links.iter().map(|link| link.2).sum::<f64>() / links.len().max(1) as f64;
    for &(a, b, gap) in &bridges {
        links.extend(contacts(&piece, [piece[a as usize], piece[b as usize]], gap + spacing, places));
    }
    links.extend(bridges);
    Graph::new(places.len(), &links)
}

/// Links between the two corners opposite a coarse edge, over the two triangles laid flat: paths along edges alone are
/// too long by a tenth and depend on how the edges happen to run.
fn across(coarse: &[[u32; 3]], places: &[DVec3]) -> Vec<(u32, u32, f64)> {
    let mut sides: Vec<(u32, u32, u32)> = coarse
        .iter()
        .filter(|face| is_whole(face))
        .flat_map(|&[a, b, c]| [(a.min(b), a.max(b), c), (b.min(c), b.max(c), a), (c.min(a), c.max(a), b)])
        .collect();
    sides.sort_unstable();
    let mut links = Vec::new();
    for pair in sides.windows(2) {
        let [(a, b, c), (a2, b2, d)] = [pair[0], pair[1]];
        if (a, b) != (a2, b2) || c == d {
            continue;
        }
        let [pa, pb, pc, pd] = [a, b, c, d].map(|i| places[i as usize]);
        let length = pa.distance(pb);
        let along = (pb - pa) / length.max(1e-12);
        let flat = |p: DVec3| {
            let x = (p - pa).dot(along);
            (x, (p - pa - x * along).length())
        };
        let ((x1, y1), (x2, y2)) = (flat(pc), flat(pd));
        let crossing = x1 + (x2 - x1) * y1 / (y1 + y2).max(1e-300);
        if crossing >= 0.0 && crossing <= length {
            links.push((c, d, (x1 - x2).hypot(y1 + y2)));
        }
    }
    links
}

/// For each node of a graph the number of its connected piece.
fn pieces(graph: &Graph) -> Vec<u32> {
    let mut piece = vec![u32::MAX; graph.len()];
    let mut count = 0;
    for first in 0..graph.len() as u32 {
        if piece[first as usize] != u32::MAX {
            continue;
        }
        let mut stack = vec![first];
        piece[first as usize] = count;
        while let Some(node) = stack.pop() {
            for &(next, _) in graph.links(node) {
                if piece[next as usize] == u32::MAX {
                    piece[next as usize] = count;
                    stack.push(next);
                }
            }
        }
        count += 1;
    }
    piece
}

/// Links between two pieces all along where they lie against each other, within `reach`: a shirt that hung on the trousers
/// at one place would hang on them at another place of another figure.
fn contacts(piece: &[u32], [p, q]: [u32; 2], reach: f64, places: &[DVec3]) -> Vec<(u32, u32, f64)> {
    let of = |wanted: u32| (0..piece.len() as u32).filter(move |&s| piece[s as usize] == wanted);
    let distance = |a: u32, b: u32| places[a as usize].distance(places[b as usize]);
    let nearest = |a: u32, other: u32| {
        let to = of(other).map(|b| (a, b, distance(a, b))).min_by(|x, y| x.2.total_cmp(&y.2));
        to.filter(|link| link.2 <= reach)
    };
    of(p).filter_map(|a| nearest(a, q)).chain(of(q).filter_map(|b| nearest(b, p))).collect()
}

/// Straight links that join the pieces of a graph into one, each time between the two nearest.
fn bridges(piece: &[u32], places: &[DVec3]) -> Vec<(u32, u32, f64)> {
    let n = piece.len();
    let count = piece.iter().max().map_or(0, |&last| last + 1);
    // Prim's spanning tree over the samples, where links within a piece are free.
    let mut best = vec![(f64::INFINITY, 0_u32); n];
    let mut inside = vec![false; count as usize];
    let mut links = Vec::new();
    let mut next = piece.first().copied();
    while let Some(joined) = next {
        inside[joined as usize] = true;
        for a in (0..n).filter(|&a| piece[a] == joined) {
            for b in (0..n).filter(|&b| !inside[piece[b] as usize]) {
                let d = places[a].distance(places[b]);
                if d < best[b].0 {
                    best[b] = (d, a as u32);
                }
            }
        }
        let outside = (0..n).filter(|&b| !inside[piece[b] as usize]);
        let nearest = outside.min_by(|&a, &b| best[a].0.total_cmp(&best[b].0));
        next = nearest.map(|b| {
            links.push((best[b].1, b as u32, best[b].0.max(1e-12)));
            piece[b]
        });
    }
    links
}

/// The sides of faces as links, with their lengths.
pub fn edges(faces: &[[u32; 3]], points: &[DVec3]) -> Vec<(u32, u32, f64)> {
    let length = |a: u32, b: u32| points[a as usize].distance(points[b as usize]).max(1e-12);
    faces.iter().flat_map(|&[a, b, c]| [(a, b), (b, c), (c, a)]).map(|(a, b)| (a, b, length(a, b))).collect()
}
