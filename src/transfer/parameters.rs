//! The parameters of the transfer.

use super::TransferError;
use super::correspondence::Fitting;
use serde::{Deserialize, Serialize};

/// What can be turned. The defaults need no turning.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, rename_all = "kebab-case")]
pub struct Parameters {
    /// How motions are carried over.
    pub method: Method,
    /// At most so many bones are sought in the source by [`Method::Bones`]; 1 at least. One whose vertices lie apart on the
    /// surface becomes several, so that there can be a few more.
    pub bones: usize,
    /// How the source is bent into the target by [`Method::Gradients`] and [`Method::Posed`].
    pub fitting: Fitting,
    /// By these two a face that ends off by so much (the Frobenius norm of the difference of maps) from what is asked of it
    /// counts half; 0 … 1,000,000; 0: all count in full, as in the paper.
    pub doubt: f64,
    /// Vertices of the target that, by these two, go exactly as far as the source does where it corresponds, but for the
    /// size: feet that shall stand.
    pub pinned: Vec<u32>,
}

impl Default for Parameters {
    fn default() -> Self {
        Self { method: Method::default(), bones: 32, fitting: Fitting::default(), doubt: 0.2, pinned: Vec::new() }
    }
}

impl Parameters {
    /// Refuses values outside their ranges (NaN included).
    pub fn check(&self) -> Result<(), TransferError> {
        if self.bones == 0 {
            return Err(TransferError::Parameter { name: "bones", value: 0.0, range: "at least 1" });
        }
        let Fitting { smoothness, identity, closeness } = &self.fitting;
        let single = [("smoothness", *smoothness), ("identity", *identity), ("doubt", self.doubt)];
        let closeness = closeness.iter().map(|&value| ("closeness", value));
        match single.into_iter().chain(closeness).find(|(_, value)| !(0.0..=1e6).contains(value)) {
            Some((name, value)) => Err(TransferError::Parameter { name, value, range: "between 0 and 1000000" }),
            None => Ok(()),
        }
    }
}

/// How motions are carried over.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Method {
    /// The source is taken apart into near-rigid bones; the target, bent onto the source with the pairs where they belong,
    /// tells where on it they are, and its joints are put where its own proportions have them. Nearest to the truth where
    /// that is known.
    #[default]
    Bones,
    /// The paper: the affine motion of each key point is that of its twin, in the target's frame and scale.
    Direct,
    /// The affine motion of each key point about itself, and its displacement scaled.
    Relative,
    /// What each face of the source does is asked of the target's faces (Sumner & Popović 2004). By a
    /// [`Mover`](super::gradients::Mover); a [`Prepared`](super::Prepared) takes it for [`Method::Bones`].
    Gradients,
    /// The same, after the target was turned part by part into the posture of the source's reference (Lee, Wang & Chen
    /// 2006, §5). By a [`Mover`](super::gradients::Mover), too.
    Posed,
}

impl Method {
    /// Whether it gives positions of vertices, by a [`Mover`](super::gradients::Mover), and no skin.
    pub fn moves_vertices(self) -> bool {
        matches!(self, Self::Gradients | Self::Posed)
    }

    /// Whether a [`Prepared`](super::Prepared) takes the source apart into bones for it, and not the motions of the key
    /// points alone.
    pub fn by_bones(self) -> bool {
        !matches!(self, Self::Direct | Self::Relative)
    }
}
