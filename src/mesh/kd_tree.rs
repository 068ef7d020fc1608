//! Nearest points among many, in any small number of dimensions.
//!
//! A part of the tree is left out if its box is too far away; how far that is, is kept up to date from level to level as in
//! Sunil Arya and David Mount, *Algorithms for fast vector quantization*, DCC 1993.

use glam::DVec3;

/// So few points are compared one by one.
const FEW: usize = 8;

/// A squared distance counts as nearly the same if it is not less than this share.
const NEARLY: f64 = 0.9;

/// A balanced k-d tree over points, laid out in place.
#[derive(Clone, Debug)]
pub struct KdTree<const D: usize> {
    points: Vec<[f64; D]>,
    numbers: Vec<u32>,
    /// The box of all points, from the least to the greatest coordinates.
    whole: [[f64; D]; 2],
}

impl<const D: usize> KdTree<D> {
    /// Builds the tree over finite points.
    pub fn new(points: &[[f64; D]]) -> Self {
        let mut numbers: Vec<u32> = (0..points.len() as u32).collect();
        let mut stack = vec![(0, points.len(), 0)];
        while let Some((from, to, axis)) = stack.pop() {
            if to - from <= FEW {
                continue;
            }
            let middle = (from + to) / 2;
            numbers[from..to].select_nth_unstable_by(middle - from, |&a, &b| {
                points[a as usize][axis].total_cmp(&points[b as usize][axis]).then(a.cmp(&b))
            });
            stack.push((from, middle, (axis + 1) % D));
            stack.push((middle + 1, to, (axis + 1) % D));
        }
        let bound = |pick: fn(f64, f64) -> f64, start: f64| {
            std::array::from_fn(|axis| points.iter().map(|p| p[axis]).fold(start, pick))
        };
        let whole = [bound(f64::min, f64::INFINITY), bound(f64::max, f64::NEG_INFINITY)];
        Self { points: numbers.iter().map(|&i| points[i as usize]).collect(), numbers, whole }
    }

    /// The number of the nearest point; `None` if there is none.
    pub fn nearest(&self, to: &[f64; D]) -> Option<u32> {
        self.nearest_of(to, |_| true)
    }

    /// The number of the nearest point that is `wanted`; `None` if there is none.
    pub fn nearest_of(&self, to: &[f64; D], wanted: impl Fn(u32) -> bool) -> Option<u32> {
        Some(self.nearest_within(f64::INFINITY, to, wanted)?.1)
    }

    /// The number of the nearest point, if that is not `far` away; else of one that is nearly as near. What is far from a
    /// surface is as far from many of its points, and would have to be compared with all of them.
    pub fn nearest_roughly(&self, far: f64, to: &[f64; D]) -> Option<u32> {
        Some(self.search(Search { far: far * far, ..Search::new(self, to, |_| true, |_| true) })?.1)
    }

    /// The nearest point that is `wanted` and nearer than the square root of `within`: squared distance and number.
    pub fn nearest_within(&self, within: f64, to: &[f64; D], wanted: impl Fn(u32) -> bool) -> Option<(f64, u32)> {
        let wanted = |place: usize| wanted(self.numbers[place]);
        self.search(Search { best: within, ..Search::new(self, to, wanted, |_| true) })
    }

    /// The same among the points that have another label than `own`.
    pub fn nearest_other(&self, within: f64, to: &[f64; D], labels: &Labels, own: u32) -> Option<(f64, u32)> {
        let wanted = |place: usize| labels.points[place] != own;
        let part = |middle: usize| labels.parts[middle] != own;
        self.search(Search { best: within, ..Search::new(self, to, wanted, part) })
    }

    /// Labels of the points (none is `u32::MAX`), by number.
    pub fn labels(&self, label: impl Fn(u32) -> u32) -> Labels {
        let points: Vec<u32> = self.numbers.iter().map(|&number| label(number)).collect();
        let mut labels = Labels { parts: points.clone(), points };
        labels.common(0, self.numbers.len());
        labels
    }

    fn search<W: Fn(usize) -> bool, P: Fn(usize) -> bool>(
        &self,
        mut search: Search<'_, D, W, P>,
    ) -> Option<(f64, u32)> {
        let gap = search.apart.iter().map(|apart| apart * apart).sum();
        search.part(0, self.points.len(), 0, gap);
        Some((search.best, self.numbers[search.found?]))
    }
}

impl KdTree<3> {
    /// Builds the tree over points in space.
    pub fn of_points(points: &[DVec3]) -> Self {
        Self::new(&points.iter().map(DVec3::to_array).collect::<Vec<_>>())
    }
}

/// Labels of the points of a tree, and of its parts.
pub struct Labels {
    /// By place in the tree.
    points: Vec<u32>,
    /// By the middle of the part: what all of its points have, or [`MIXED`].
    parts: Vec<u32>,
}

/// No label.
const MIXED: u32 = u32::MAX;

impl Labels {
    /// The label that all points of a part have.
    fn common(&mut self, from: usize, end: usize) -> u32 {
        if end - from <= FEW {
            let Some((&first, others)) = self.points[from..end].split_first() else { return MIXED };
            return if others.iter().all(|&label| label == first) { first } else { MIXED };
        }
        let middle = (from + end) / 2;
        let sides = [self.common(from, middle), self.common(middle + 1, end)];
        let own = self.points[middle];
        self.parts[middle] = if sides == [own, own] { own } else { MIXED };
        self.parts[middle]
    }
}

/// A search under way.
struct Search<'a, const D: usize, W, P> {
    tree: &'a KdTree<D>,
    to: &'a [f64; D],
    /// Which points are wanted, by place in the tree, and in which parts there may be some, by their middle.
    wanted: W,
    in_part: P,
    /// How far the box of the part is away along each axis.
    apart: [f64; D],
    /// The squared distance of what is found.
    best: f64,
    /// Its place in the tree.
    found: Option<usize>,
    /// Beyond this squared distance only what is nearer by [`NEARLY`] is sought.
    far: f64,
}

impl<'a, const D: usize, W: Fn(usize) -> bool, P: Fn(usize) -> bool> Search<'a, D, W, P> {
    fn new(tree: &'a KdTree<D>, to: &'a [f64; D], wanted: W, in_part: P) -> Self {
        let [low, high] = &tree.whole;
        let apart = std::array::from_fn(|axis| (low[axis] - to[axis]).max(to[axis] - high[axis]).max(0.0));
        Self { tree, to, wanted, in_part, apart, best: f64::INFINITY, found: None, far: f64::INFINITY }
    }

    /// Searches a part of the tree, whose box is away by the square root of `gap`.
    fn part(&mut self, from: usize, end: usize, axis: usize, gap: f64) {
        if end - from <= FEW {
            return (from..end).for_each(|i| self.compare(i));
        }
        let middle = (from + end) / 2;
        if !(self.in_part)(middle) {
            return;
        }
        let side = self.to[axis] - self.tree.points[middle][axis];
        let next = (axis + 1) % D;
        let (low, high) = ((from, middle), (middle + 1, end));
        let (near, far) = if side < 0.0 { (low, high) } else { (high, low) };
        self.part(near.0, near.1, next, gap);
        self.compare(middle);
        let before = self.apart[axis];
        let gap = gap - before * before + side * side;
        let enough = if self.best > self.far { NEARLY * self.best } else { self.best };
        if gap < enough {
            self.apart[axis] = side;
            self.part(far.0, far.1, next, gap);
            self.apart[axis] = before;
        }
    }

    #[inline]
    fn compare(&mut self, i: usize) {
        let distance: f64 = self.tree.points[i].iter().zip(self.to).map(|(a, b)| (a - b) * (a - b)).sum();
        if distance < self.best && (self.wanted)(i) {
            (self.best, self.found) = (distance, Some(i));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn agrees_with_comparing_all() {
        let mut state = 3_u64;
        let mut next = || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 40) as f64 / (1_u64 << 24) as f64
        };
        let points: Vec<[f64; 4]> = (0..300).map(|_| [next(), next(), next(), next()]).collect();
        let tree = KdTree::new(&points);
        for _ in 0..100 {
            let to = [next(), next(), next(), next()];
            let distance = |i: u32| points[i as usize].iter().zip(&to).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
            let odd = |i: u32| i % 2 == 1;
            let expected = (0..300).filter(|&i| odd(i)).min_by(|&a, &b| distance(a).total_cmp(&distance(b)));
            assert_eq!(tree.nearest_of(&to, odd), expected);
            let outside = to.map(|x| x + 2.0);
            let distance =
                |i: u32| points[i as usize].iter().zip(&outside).map(|(a, b)| (a - b) * (a - b)).sum::<f64>();
            let least = (0..300).map(distance).fold(f64::INFINITY, f64::min);
            assert_eq!(tree.nearest(&outside).map(distance), Some(least));
            assert_eq!(tree.nearest_roughly(9.0, &outside).map(distance), Some(least));
            assert!(tree.nearest_roughly(1.0, &outside).is_some_and(|i| NEARLY * distance(i) <= least));
        }
        let thirds = tree.labels(|i| (3.0 * points[i as usize][0]) as u32);
        for (to, own) in points.iter().zip([0, 1, 2].into_iter().cycle()) {
            let other = |i: u32| (3.0 * points[i as usize][0]) as u32 != own;
            assert_eq!(tree.nearest_other(0.3, to, &thirds, own), tree.nearest_within(0.3, to, other));
        }
        assert_eq!(tree.nearest_other(f64::INFINITY, &[0.0; 4], &tree.labels(|_| 7), 7), None);
        assert_eq!(tree.nearest_of(&[0.0; 4], |_| false), None);
        let empty = KdTree::<2>::new(&[]);
        assert_eq!(empty.nearest(&[0.0; 2]), None);
        assert_eq!(empty.nearest_other(1.0, &[0.0; 2], &empty.labels(|_| 0), 1), None);
    }
}
