//! Ways in which one figure may be laid over another: turned by quarters, with or without a stretch.

use super::point_set::Figures;
use glam::{DMat3, DVec3};

/// How far a stretch to the target's box may go, either way, from its mean.
const STRETCH: [f64; 2] = [0.6, 1.6];

/// A way in which the source may be laid over the target.
#[derive(Clone, Copy, Debug)]
pub struct Orientation {
    /// One of the turns of a cube.
    pub turn: DMat3,
    /// The turn, and the turn with a stretch to the target's box.
    pub maps: [DMat3; 2],
}

impl Orientation {
    /// With a turn.
    pub fn new(figures: Figures, turn: DMat3) -> Self {
        let stretch = stretch(figures.source.sides, figures.target.sides, turn);
        Self { turn, maps: [turn, DMat3::from_diagonal(stretch) * turn] }
    }

    /// The same way, seen from the other figure.
    pub fn reversed(self, figures: Figures) -> Self {
        Self::new(figures.reversed(), self.turn.transpose())
    }
}

/// The three turns half round.
pub fn half_turns() -> [DMat3; 3] {
    let signs = [DVec3::new(1.0, -1.0, -1.0), DVec3::new(-1.0, 1.0, -1.0), DVec3::new(-1.0, -1.0, 1.0)];
    signs.map(DMat3::from_diagonal)
}

/// Factors along the axes that bring a turned box to another, within bounds about their geometric mean.
fn stretch(from: DVec3, to: DVec3, turn: DMat3) -> DVec3 {
    let from = (turn * from).abs();
    let factor = |a: f64, b: f64| if a > 1e-6 && b > 1e-6 { b / a } else { 1.0 };
    let factors = DVec3::new(factor(from.x, to.x), factor(from.y, to.y), factor(from.z, to.z));
    let mean = factors.element_product().cbrt();
    (factors / mean).clamp(DVec3::splat(STRETCH[0]), DVec3::splat(STRETCH[1])) * mean
}
