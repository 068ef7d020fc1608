//! Nearest points among many, in any small number of dimensions.

/// A balanced k-d tree over points, laid out in place.
#[derive(Clone, Debug)]
pub struct KdTree<const D: usize> {
    points: Vec<[f64; D]>,
    numbers: Vec<u32>,
}

impl<const D: usize> KdTree<D> {
    /// Builds the tree over finite points.
    pub fn new(points: &[[f64; D]]) -> Self {
        let mut numbers: Vec<u32> = (0..points.len() as u32).collect();
        let mut stack = vec![(0, points.len(), 0)];
        while let Some((from, to, axis)) = stack.pop() {
            if to - from < 2 {
                continue;
            }
            let middle = (from + to) / 2;
            numbers[from..to].select_nth_unstable_by(middle - from, |&a, &b| {
                points[a as usize][axis].total_cmp(&points[b as usize][axis]).then(a.cmp(&b))
            });
            stack.push((from, middle, (axis + 1) % D));
            stack.push((middle + 1, to, (axis + 1) % D));
        }
        Self { points: numbers.iter().map(|&i| points[i as usize]).collect(), numbers }
    }

    /// The number of the nearest point that is `wanted`; `None` if there is none.
    pub fn nearest(&self, to: &[f64; D], wanted: impl Fn(u32) -> bool) -> Option<u32> {
        let (mut best, mut found) = (f64::INFINITY, None);
        // At most one entry waits for each level of the tree.
        let mut stack = Vec::with_capacity(40);
        stack.push((0, self.points.len(), 0, 0.0));
        while let Some((from, end, axis, gap)) = stack.pop() {
            if from >= end || gap >= best {
                continue;
            }
            let middle = (from + end) / 2;
            let point = &self.points[middle];
            let distance: f64 = point.iter().zip(to).map(|(a, b)| (a - b) * (a - b)).sum();
            if distance < best && wanted(self.numbers[middle]) {
                best = distance;
                found = Some(self.numbers[middle]);
            }
            let side = to[axis] - point[axis];
            let next = (axis + 1) % D;
            let (low, high) = ((from, middle), (middle + 1, end));
            let (near, far) = if side < 0.0 { (low, high) } else { (high, low) };
            stack.push((far.0, far.1, next, side * side));
            stack.push((near.0, near.1, next, gap));
        }
        found
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
            assert_eq!(tree.nearest(&to, odd), expected);
        }
        assert_eq!(tree.nearest(&[0.0; 4], |_| false), None);
        assert_eq!(KdTree::<2>::new(&[]).nearest(&[0.0; 2], |_| true), None);
    }
}
