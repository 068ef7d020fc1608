//! Disjoint sets of numbers, as when parts join and join again.

/// The numbers `0..n` in groups; every number its own group at first.
#[derive(Clone, Debug)]
pub struct Groups {
    parent: Vec<u32>,
}

impl Groups {
    /// `count` groups of one number each.
    pub fn new(count: usize) -> Self {
        Self { parent: (0..count as u32).collect() }
    }

    /// The lowest number of the group that `member` is in.
    pub fn root(&mut self, mut member: u32) -> u32 {
        while self.parent[member as usize] != member {
            let above = self.parent[self.parent[member as usize] as usize];
            self.parent[member as usize] = above;
            member = above;
        }
        member
    }

    /// Makes one group of the groups of two numbers; false if they are in one already.
    pub fn join(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b) as usize] = a.min(b);
        a != b
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn groups_join_under_their_lowest_number() {
        let mut groups = Groups::new(5);
        assert!(groups.join(4, 2) && groups.join(2, 3) && !groups.join(3, 4));
        assert_eq!([0, 1, 2, 3, 4].map(|i| groups.root(i)), [0, 1, 2, 2, 2]);
    }
}
