//! Motion diffusion models as generators.

use physique_motion::features::MotionFeatures;

use super::{MotionGenerator, Prompt};
use crate::Error;
use crate::mdm::{self, Sampling, TextToMotion};

/// A network that is asked in words, as the published evaluation asks it: every motion is sampled
/// with the frames of the data set's longest window, whatever its own length.
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
        let prompts: Vec<mdm::Prompt<'_>> = prompts
            .iter()
            .map(|prompt| mdm::Prompt {
                text: &prompt.caption.text,
                upper_body: None,
                frames: prompt.frames,
                seed: prompt.seed,
            })
            .collect();
        self.network
            .generate_whole(&prompts, self.sampling, self.frames)
    }
}
