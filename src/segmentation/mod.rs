//! Near-rigid segmentation of a deforming mesh, a file for each step of
//!
//! Tong-Yee Lee, Yu-Shuen Wang, Tai-Guang Chen. *Segmenting a deforming mesh into near-rigid components*. The Visual
//! Computer 22(9), 2006.
//!
//! | paper | file |
//! |---|---|
//! | Eq. 1–3, deformation gradients | `gradients` |
//! | Eq. 4–5, distance metric and dual graph weights | `deformation` |
//! | shortest paths `Dis(fᵢ, fⱼ)` | `shortest_paths` |
//! | §3.2, feature faces | `features`, with `harmonic` influence regions and `average` gradients |
//! | §3.3 and Eq. 7, clustering | `clustering`, with `averages` |
//! | §3.4 and Eq. 8, boundary smoothing | `smoothing`, with `max_flow` |
//!
//! Beyond the paper ([`Method::Tree`], the default): `finest` parts, the `merge_tree` over them, the `choice` of the
//! number of parts, and rigid `refinement`. What grows as a whole (`growth`) counts as rigid at its size, as it does by the
//! paper's gradients.
//!
//! Lengths are taken at unit diagonal of the reference pose's bounding box, without which the paper's thresholds would
//! depend on the units of the file.

mod average;
mod averages;
mod choice;
mod clustering;
mod deformation;
mod features;
mod finest;
mod geometry;
mod gradients;
mod growth;
mod harmonic;
mod max_flow;
mod merge_tree;
mod motion;
mod parameters;
mod refinement;
mod result;
mod segmenter;
pub(crate) mod shortest_paths;
mod smoothing;
mod statistics;

pub use parameters::{Method, Parameters, Smoothing};
pub use result::{Feature, Merge, Part, Segmentation, SegmentationError, Steps};
pub use segmenter::Segmenter;

use crate::observer::Observer;
use crate::sequence::Sequence;

/// Segments a sequence into near-rigid parts. To try several numbers of parts on one sequence, keep a [`Segmenter`].
pub fn segment(
    sequence: &Sequence,
    parameters: &Parameters,
    observer: &mut dyn Observer,
) -> Result<Segmentation, SegmentationError> {
    Ok(Segmenter::new(sequence, parameters, observer)?.segmentation(parameters.parts))
}
