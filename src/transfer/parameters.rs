//! The parameters of the transfer.

use super::correspondence::Fitting;
use serde::{Deserialize, Serialize};

/// What can be turned. The defaults need no turning.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, rename_all = "kebab-case")]
pub struct Parameters {
    /// How motions are carried over.
    pub method: Method,
    /// At most so many bones are sought in the source by [`Method::Bones`].
    pub bones: usize,
    /// How the source is bent into the target by [`Method::Gradients`] and [`Method::Posed`].
    pub fitting: Fitting,
    /// By these two a face that ends off by so much (the Frobenius norm of the difference of maps) from what is asked of it
    /// counts half; 0: all count in full, as in the paper.
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
