//! Captions to vectors that networks read.
//!
//! One trait, [`TextEncoder`], and three encoders behind it, which share one transformer:
//!
//! | encoder | from | gives |
//! |---|---|---|
//! | [`MiniLm`] | embedded (feature `embedded`), or a folder of the user's | one vector of 384 numbers |
//! | [`Clip`] | the user's `ViT-B/32` | one vector of 512 numbers |
//! | [`DistilBert`] | the user's folder | a vector of 768 numbers a token, and a mask |
//!
//! [`open`] tells a folder of the user's by its `config.json`, and reads CLIP's own TorchScript file. [`CaptionIndex`] finds the training
//! caption that is nearest to a prompt, so that a generator can say when it is asked for what it does
//! not know; [`BodyPartTexts`] splits a caption that tells two things at once.
//!
//! All of it is plain `f32` arithmetic on the processor: no learning framework, no start-up cost but
//! unpacking the weights. Results do not depend on the number of threads, nor on what other captions
//! are encoded along.

mod bert;
mod body_parts;
mod clip;
mod config;
mod distil_bert;
mod embeddings;
mod encoder;
mod error;
mod limits;
mod mini_lm;
mod nearest;
pub mod tokens;
mod transformer;
mod weights;

pub use body_parts::BodyPartTexts;
pub use clip::{Clip, ClipContext};
pub use distil_bert::DistilBert;
pub use embeddings::TextEmbeddings;
pub use encoder::{TextEncoder, open, open_with};
pub use error::Error;
pub use limits::TextLimits;
pub use mini_lm::MiniLm;
pub use nearest::{CaptionIndex, Nearest};
