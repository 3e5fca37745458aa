//! What makes the motions that are evaluated.

use physique_data::Caption;
use physique_motion::features::MotionFeatures;

use crate::Error;

/// A motion to be.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Prompt {
    /// What it is to show.
    pub caption: Caption,
    /// Its length.
    pub frames: usize,
    /// Another seed gives another motion.
    pub seed: u64,
}

/// Generates motions from captions.
pub trait MotionGenerator {
    /// Its name in tables.
    fn name(&self) -> &str;

    /// What else there is to know of it, for reports.
    fn about(&self) -> String;

    /// A motion for each prompt, not normalised, with as many frames as asked for or more. What lies
    /// behind the length that was asked for is what the generator happened to make there: published
    /// evaluations look at up to three frames of it.
    ///
    /// A motion depends on its prompt only, not on the others (within rounding).
    ///
    /// # Errors
    /// Depends on the generator.
    fn generate(&self, prompts: &[Prompt]) -> Result<Vec<MotionFeatures>, Error>;

    /// The motions without what lies behind the length that was asked for.
    ///
    /// # Errors
    /// As [`MotionGenerator::generate`]; [`Error::Input`] for motions that are too short.
    fn generate_cut(&self, prompts: &[Prompt]) -> Result<Vec<MotionFeatures>, Error> {
        let motions = self.generate(prompts)?;
        let motions = motions.iter().zip(prompts);
        motions
            .map(|(motion, prompt)| cut(motion, prompt.frames))
            .collect()
    }
}

/// The first frames of a motion.
pub(super) fn cut(motion: &MotionFeatures, frames: usize) -> Result<MotionFeatures, Error> {
    let rows = motion
        .values()
        .get(..frames * motion.skeleton().feature_count());
    let Some(rows) = rows else {
        let expected = format!("{frames} frames or more");
        return Err(Error::input(
            "Generated motion",
            expected,
            motion.frame_count(),
        ));
    };
    let (rate, skeleton) = (motion.frame_rate(), motion.skeleton());
    Ok(MotionFeatures::new(rate, skeleton, rows.to_vec())?)
}
