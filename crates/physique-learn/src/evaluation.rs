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
//!
//! [`EvaluationProtocol`] says what is compared with what, by any [`PairEvaluator`]: the published one
//! ([`PublishedEvaluator`]), or our own for other data ([`sentence`]), for the motions of any
//! [`MotionGenerator`]. [`judge`] asks a plainer question: is it what was asked for?

mod diversity;
mod evaluator;
mod frechet;
mod generator;
mod interval;
pub mod judge;
mod motion_side;
mod networks;
mod numpy_random;
mod pair_evaluator;
mod points;
mod protocol;
mod published;
mod retrieval;
pub mod sentence;
mod text_to_motion;
mod words;

pub use diversity::{diversity, multimodality};
pub use evaluator::{CaptionWords, Evaluator};
pub use frechet::{Moments, frechet_distance};
pub use generator::{MotionGenerator, Prompt};
pub use interval::Interval;
pub use networks::EvaluatorSizes;
pub use numpy_random::NumpyRandom;
pub use pair_evaluator::{CaptionReading, PairEvaluator};
pub use points::Points;
pub use protocol::{
    EvaluationProtocol, EvaluationRow, MultimodalityOptions, ProtocolOptions, RepetitionMeasures,
    SelfIntersectionMeter,
};
pub use published::PublishedEvaluator;
pub use retrieval::{RETRIEVAL_BATCH, Retrieval};
pub use text_to_motion::TextToMotionGenerator;
pub use words::{WordLimits, WordVectors};
