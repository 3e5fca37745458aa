//! What a motion shows, judged without a network: by the five most similar known motions.
//!
//! Published evaluators need a large data set with free descriptions. Where clips carry labels, such
//! as `content = "walk"`, a plainer question can be asked of a generator: is a motion that was asked
//! for by a label's caption taken for that label? [`ContentJudge`] answers by nearest neighbours on
//! [`MotionDescription`]s, [`Trial`] asks it of many motions of each label, and compares jerk and
//! foot slide with real ones of the same label ([`MotionQuality`]).
//!
//! How far the judge can be trusted is measured in the same way, on real clips that it does not
//! know: [`ContentJudge::accuracy`].

mod accuracy;
mod description;
mod neighbours;
mod quality;
mod sides;
mod trial;

pub use accuracy::JudgeAccuracy;
pub use description::MotionDescription;
pub use neighbours::{ContentJudge, Verdict};
pub use quality::MotionQuality;
pub use trial::{Trial, TrialOptions, TrialReport, TrialRow};
