//! The similarity that brings weighted points nearest to others.
//!
//! S. Umeyama, *Least-squares estimation of transformation parameters between two point patterns*, IEEE Transactions on
//! Pattern Analysis and Machine Intelligence 13(4), 1991, pp. 376–380. Reflections are ruled out. The
//! scale is the ratio of the spreads (B. K. P. Horn, *Closed-form solution of absolute orientation using unit quaternions*,
//! Journal of the Optical Society of America A 4(4), 1987, section 2.D): that of least squares is too small where places are
//! uncertain, and limbs would shrink a little with every round.

use crate::linalg::outer::outer;
use crate::linalg::rigid_fit::best_rotation;
use glam::{DMat3, DVec3};

/// Bounds of the scale: what a limb of one figure may be in another's, lengths being in shares of the diagonal.
const SCALE: [f64; 2] = [0.4, 2.5];

/// `x ↦ scale · rotation · (x − from) + to`.
#[derive(Clone, Copy, Debug)]
pub struct Similarity {
    /// A rotation.
    pub rotation: DMat3,
    /// Between 0.4 and 2.5.
    pub scale: f64,
    /// The weighted mean of the points.
    pub from: DVec3,
    /// The weighted mean of where they go.
    pub to: DVec3,
}

impl Similarity {
    /// The best one for `(weight, p, q)` that are to go from p to q; the identity for no weight at all.
    pub fn fit(pairs: impl Iterator<Item = (f64, DVec3, DVec3)> + Clone) -> Self {
        let mut total = 0.0;
        let (mut from, mut to) = (DVec3::ZERO, DVec3::ZERO);
        for (w, p, q) in pairs.clone() {
            total += w;
            from += w * p;
            to += w * q;
        }
        if total <= 0.0 || !total.is_finite() {
            return Self { rotation: DMat3::IDENTITY, scale: 1.0, from: DVec3::ZERO, to: DVec3::ZERO };
        }
        (from, to) = (from / total, to / total);
        let mut h = DMat3::ZERO;
        let (mut spread, mut there) = (0.0, 0.0);
        for (w, p, q) in pairs {
            let (p, q) = (p - from, q - to);
            h += outer(q, w * p);
            spread += w * p.length_squared();
            there += w * q.length_squared();
        }
        let rotation = best_rotation(h);
        let scale = if spread > 1e-300 { (there / spread).sqrt().clamp(SCALE[0], SCALE[1]) } else { 1.0 };
        Self { rotation, scale, from, to }
    }

    /// Where a point goes.
    pub fn apply(&self, p: DVec3) -> DVec3 {
        self.to + self.scale * (self.rotation * (p - self.from))
    }
}
