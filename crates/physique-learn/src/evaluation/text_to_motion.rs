//! Motion diffusion models as generators.

use physique_motion::features::MotionFeatures;

use super::motion_side::SEEN_BEHIND;
use super::{MotionGenerator, Prompt};
use crate::Error;
use crate::mdm::{self, Sampling, TextToMotion};

/// Motions of like length that are sampled at once, where a network does not see padding.
const GROUP: usize = 8;

/// A network that is asked in words, as the published evaluation asks it: every motion is sampled
/// with the frames of the data set's longest window, whatever its own length.
///
/// Of networks that do not see frames behind a motion's end (`mask_frames`), no more are sampled than
/// the evaluator sees: the same motions, for less than half the time.
#[derive(Debug)]
pub struct TextToMotionGenerator {
    network: TextToMotion,
    sampling: Sampling,
    name: String,
    frames: usize,
}

impl TextToMotionGenerator {
    /// A generator that samples `frames` frames, or more where more are asked for.
    pub const fn new(
        network: TextToMotion,
        sampling: Sampling,
        name: String,
        frames: usize,
    ) -> Self {
        Self {
            network,
            sampling,
            name,
            frames,
        }
    }
}

impl MotionGenerator for TextToMotionGenerator {
    fn name(&self) -> &str {
        &self.name
    }

    fn about(&self) -> String {
        let description = &self.network.folder().description;
        let notes = description.notes.iter();
        let notes = notes.map(|(name, note)| format!("{name} {note}"));
        let smooth = match self.sampling.smooth_hz {
            Some(cutoff) => format!("smoothed at {cutoff} Hz"),
            None => "not smoothed".into(),
        };
        let steps = self.sampling.steps.unwrap_or(description.diffusion_steps);
        format!(
            "MDM, {:?}, {steps} of {} steps, guidance {}, {:?}, {smooth} ({})",
            self.sampling.method,
            description.diffusion_steps,
            self.sampling.guidance,
            self.sampling.guides,
            notes.collect::<Vec<_>>().join(", ")
        )
    }

    fn generate(&self, prompts: &[Prompt]) -> Result<Vec<MotionFeatures>, Error> {
        let asked: Vec<mdm::Prompt<'_>> = prompts.iter().map(asked).collect();
        if !self.network.folder().network.config().mask_frames {
            return self
                .network
                .generate_whole(&asked, self.sampling, self.frames);
        }
        let mut order: Vec<usize> = (0..asked.len()).collect();
        order.sort_by_key(|&place| asked[place].frames);
        let mut motions = Vec::with_capacity(asked.len());
        for places in order.chunks(GROUP) {
            let group: Vec<_> = places.iter().map(|&place| asked[place]).collect();
            let longest = group.iter().map(|prompt| prompt.frames).max().unwrap_or(0);
            let frames = self.frames.min(longest + SEEN_BEHIND);
            let made = self.network.generate_whole(&group, self.sampling, frames)?;
            motions.extend(places.iter().zip(made));
        }
        motions.sort_by_key(|(place, _)| **place);
        Ok(motions.into_iter().map(|(_, motion)| motion).collect())
    }
}

fn asked(prompt: &Prompt) -> mdm::Prompt<'_> {
    mdm::Prompt {
        text: &prompt.caption.text,
        upper_body: None,
        frames: prompt.frames,
        seed: prompt.seed,
    }
}
