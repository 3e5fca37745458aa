//! How good generated motions are, by the published protocol.
//!
//! Guo et al., "Generating Diverse and Natural 3D Human Motions from Text", CVPR 2022: networks
//! embed captions and motions so that matching ones are close, and the metrics compare embeddings.
//!
//! | metric | says | where |
//! |---|---|---|
//! | R-precision | how often a motion's own caption is among the closest of 32 | [`Retrieval`] |
//! | multimodal distance | how far motions are from their captions | [`Retrieval`] |
//! | FID | how far the generated distribution is from the real one | [`frechet_distance`] |
//! | diversity | how far motions are from each other | [`diversity`] |
//! | multimodality | how far motions of one caption are from each other | [`multimodality`] |
//! | interval | how sure the mean of the repetitions is | [`Interval`] |

mod diversity;
mod evaluator;
mod frechet;
mod interval;
mod networks;
mod numpy_random;
mod points;
mod retrieval;

pub use diversity::{diversity, multimodality};
pub use evaluator::{CaptionWords, Evaluator};
pub use frechet::{Moments, frechet_distance};
pub use interval::Interval;
pub use numpy_random::NumpyRandom;
pub use points::Points;
pub use retrieval::{RETRIEVAL_BATCH, Retrieval};
