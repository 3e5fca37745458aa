//! Motions with captions, ready to learn from: one memory-mapped file for a whole data set.
//!
//! * [`Recipe`]: a short TOML text that says which files of a folder are clips, which labels their
//!   names carry, how labels become sentences, which wordings are held out, and how clips are split.
//!   [`recipe::embedded`] has those of public archives. HumanML3D and KIT-ML folders need no recipe:
//!   [`Source::Published`].
//! * [`build()`]: reads the folder, brings every clip to the 22 joints and to HumanML3D's skeleton,
//!   lists what is broken with the reason, and writes the file. The same folder gives the same bytes,
//!   for any number of threads.
//! * [`join()`]: several data files as one.
//! * [`Dataset`]: opens the file without reading it; windows of clips as features, in batches.
//! * [`Sampler`]: which windows and captions a training step sees, a pure function of seed and step:
//!   a run that was killed goes on as if nothing had happened.
//!
//! This crate knows no network and no learning framework.

mod batch;
pub mod build;
mod captions;
mod dataset;
mod error;
mod file;
mod index;
mod join;
mod limits;
mod random;
pub mod recipe;
pub mod report;
mod sampler;
mod source;
mod split;
mod window;

pub use batch::Batch;
pub use build::{BuildObserver, build};
pub use captions::{Caption, CaptionSet, Wording};
pub use dataset::Dataset;
pub use error::Error;
pub use index::{Clip, Index, Recording, Storage};
pub use join::{SET_LABEL, join};
pub use limits::DataLimits;
pub use recipe::Recipe;
pub use report::{BuildReport, LeftOut, Reason};
pub use sampler::{Balance, Drawn, Order, Sampler, SamplerOptions};
pub use source::{PublishedSet, Source};
pub use split::Split;
pub use window::Window;
