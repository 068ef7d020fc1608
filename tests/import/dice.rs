//! Chance that can be repeated.

/// Numbers that look random and are the same every time.
pub struct Dice(pub u64);

impl Dice {
    /// A number from 0 to `end` − 1; 0 if there is none.
    pub fn below(&mut self, end: usize) -> usize {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 33) as usize % end.max(1)
    }
}
