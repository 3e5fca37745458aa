//! An evaluator for data sets without a published one.
//!
//! Motions go through networks of the published architecture, narrower; captions through a sentence
//! encoder that is there already ([`MiniLm`](physique_text::MiniLm)) and a small head, so that neither
//! word vectors nor parts of speech are needed.
//!
//! Published evaluators are trained with a margin of 10 and one random negative a pair, the movement
//! encoder beforehand and by itself. Here all is trained at once against every other pair of the
//! batch: van den Oord et al., "Representation Learning with Contrastive Predictive Coding", 2018,
//! in both directions and on squared Euclidean distances, which the metrics look at. Small data sets
//! say the same of many motions: pairs whose captions are all but equal are no negatives of each
//! other (Petrovich et al., "TMR", ICCV 2023, section 3.2).
//!
//! Numbers of one evaluator say nothing beside those of another.

mod config;
mod folder;
mod loss;
mod network;
mod task;
mod train;

pub use config::{SentenceConfig, SentenceTraining};
pub use folder::SentenceEvaluator;
pub use network::SentenceNetworks;
pub use task::SentenceTask;
pub use train::{EvaluatorRun, train_evaluator};
