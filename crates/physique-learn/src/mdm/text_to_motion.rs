//! A network with all that is needed to ask it for motions in words.

mod given;
mod request;

use physique_motion::FrameRate;
use physique_motion::features::MotionFeatures;
use physique_text::TextEncoder;

use super::{Condition, ConditionKind, GenerateRequest, MdmFolder, generate_whole, plan_motions};
use crate::Error;
use crate::diffusion::{BatchEdit, Sampler, Schedule};
use crate::text::{NearestCaption, PromptEncoder};

pub use request::{KnownMotion, Prompt, Sampling};

/// Asks a network for motions in words.
#[derive(Debug)]
pub struct TextToMotion {
    folder: MdmFolder,
    prompts: Option<PromptEncoder>,
    schedule: Schedule,
    frame_rate: FrameRate,
}

/// What a batch of motions starts from.
#[derive(Clone, Copy)]
enum Start<'a> {
    Nothing,
    Edit(&'a BatchEdit),
    After(&'a MotionFeatures),
}

impl TextToMotion {
    /// A network and the encoder that it was trained with.
    ///
    /// # Errors
    /// [`Error::Input`] where the encoder is missing or gives other vectors than the network reads;
    /// [`Error::Setting`] and [`Error::Motion`] for descriptions that cannot be.
    pub fn new(folder: MdmFolder, encoder: Option<Box<dyn TextEncoder>>) -> Result<Self, Error> {
        let schedule = Schedule::cosine(folder.description.diffusion_steps)?;
        let schedule = schedule.with_signal(folder.description.signal)?;
        let frame_rate = FrameRate::new(folder.description.frame_rate)?;
        let kind = folder.network.config().condition;
        let expected = match kind {
            ConditionKind::Sentence { width } => Some((width, false)),
            ConditionKind::Tokens { width } => Some((width, true)),
            ConditionKind::Unconditioned | ConditionKind::Action { .. } => None,
        };
        let found = encoder
            .as_ref()
            .map(|encoder| (encoder.width(), encoder.is_by_token()));
        if let Some((width, by_token)) = expected
            && expected != found
        {
            let what = if by_token { "a token" } else { "a caption" };
            let expected = format!("vectors of {width} numbers for {what}");
            let found = match (&encoder, found) {
                (Some(encoder), Some((width, _))) => format!("{width} by {}", encoder.name()),
                _ => "none".into(),
            };
            return Err(Error::input("Text encoder", expected, found));
        }
        let centre = folder.captions.as_ref().and_then(|known| known.centre());
        let prompts = encoder
            .filter(|_| expected.is_some())
            .map(|encoder| PromptEncoder::new(encoder, centre.cloned()))
            .transpose()?;
        Ok(Self {
            folder,
            prompts,
            schedule,
            frame_rate,
        })
    }

    /// The network and what is known of it.
    pub const fn folder(&self) -> &MdmFolder {
        &self.folder
    }

    /// Frames a second of its motions.
    pub const fn frame_rate(&self) -> FrameRate {
        self.frame_rate
    }

    /// The training caption that is nearest to a prompt, where they are known.
    pub fn nearest(&self, prompt: &str) -> Option<NearestCaption> {
        let known = self.folder.captions.as_ref()?;
        known.nearest(self.prompts.as_ref()?.encoder(), prompt)
    }

    /// Generates a motion for each prompt, as features that are not normalised. A motion depends on
    /// its own text, frames and seed only, but for the frames of the longest of a batch where the
    /// network sees padding.
    ///
    /// Parts of a `known` motion are in all of them, which then have its frames. `observe` is told
    /// the number of steps that are left. Cost: two passes through the network a step, and the same
    /// again where trunk and arms have a text of their own: they are made anew for the legs that were
    /// made first. (Both at once, put together after each prediction as Petrovich et al. do in
    /// "Multi-Track Timeline Control", CVPRW 2024, stand still in networks that have never seen arms
    /// raised in walking.)
    ///
    /// # Errors
    /// [`Error::Input`] without prompts, for edits that do not fit, and for a known motion beside texts
    /// of the upper body; [`Error::Setting`] for steps that the network does not have;
    /// [`Error::Motion`] for features that are not finite, and for a cutoff that the frame rate does
    /// not allow.
    pub fn generate(
        &self,
        prompts: &[Prompt<'_>],
        sampling: Sampling,
        known: Option<&KnownMotion>,
        mut observe: impl FnMut(usize),
    ) -> Result<Vec<MotionFeatures>, Error> {
        if known.is_some() {
            undivided(prompts)?;
        }
        let divided = prompts.iter().any(|prompt| prompt.upper_body.is_some());
        let later = match divided {
            true => self.schedule(sampling)?.len(),
            false => 0,
        };
        let edit = known
            .map(|known| self.edit(known, &lengths(prompts)))
            .transpose()?;
        let start = edit.as_ref().map_or(Start::Nothing, Start::Edit);
        let mut motions = self.sample(prompts, sampling, start, 0, |left| observe(later + left))?;
        if divided {
            self.make_upper_bodies(&mut motions, prompts, sampling, observe)?;
        }
        for (motion, prompt) in motions.iter_mut().zip(prompts) {
            motion.truncate(prompt.frames * self.folder.statistics.mean().len());
        }
        let smooth_hz = sampling.smooth_hz.filter(|_| known.is_none());
        self.features(motions, smooth_hz)
    }

    /// As [`TextToMotion::generate`], with at least so many frames, and with what lies behind each
    /// motion's length: see [`generate_whole`].
    ///
    /// # Errors
    /// As [`TextToMotion::generate`].
    pub fn generate_whole(
        &self,
        prompts: &[Prompt<'_>],
        sampling: Sampling,
        frames: usize,
    ) -> Result<Vec<MotionFeatures>, Error> {
        undivided(prompts)?;
        let motions = self.sample(prompts, sampling, Start::Nothing, frames, |_| ())?;
        self.features(motions, sampling.smooth_hz)
    }

    /// Goes on from the last frames of a motion, piece by piece, as [`plan_motions`] does; the frames of
    /// that motion are not in the result. Networks that plan only.
    ///
    /// # Errors
    /// As [`TextToMotion::generate`]; [`Error::Input`] for a motion of other features or with too few
    /// frames, and for networks that make whole motions.
    pub fn go_on(
        &self,
        prompts: &[Prompt<'_>],
        sampling: Sampling,
        after: &MotionFeatures,
        observe: impl FnMut(usize),
    ) -> Result<Vec<MotionFeatures>, Error> {
        undivided(prompts)?;
        let motions = self.sample(prompts, sampling, Start::After(after), 0, observe)?;
        self.features(motions, sampling.smooth_hz)
    }

    /// Makes trunk and arms anew where they have a text of their own, for path and legs as they are.
    fn make_upper_bodies(
        &self,
        motions: &mut [Vec<f32>],
        prompts: &[Prompt<'_>],
        sampling: Sampling,
        observe: impl FnMut(usize),
    ) -> Result<(), Error> {
        let (mut places, mut legs, mut upper) = (Vec::new(), Vec::new(), Vec::new());
        for (place, prompt) in prompts.iter().enumerate() {
            if let Some(text) = prompt.upper_body {
                places.push(place);
                legs.push(motions[place].as_slice());
                upper.push(Prompt {
                    text,
                    upper_body: None,
                    ..*prompt
                });
            }
        }
        let edit = self.legs(&legs, &lengths(&upper))?;
        let made = self.sample(&upper, sampling, Start::Edit(&edit), 0, observe)?;
        for (place, made) in places.into_iter().zip(made) {
            motions[place] = made;
        }
        Ok(())
    }

    /// Normalised motions with what lies behind their lengths, by texts of the whole body.
    fn sample(
        &self,
        prompts: &[Prompt<'_>],
        sampling: Sampling,
        start: Start<'_>,
        frames: usize,
        observe: impl FnMut(usize),
    ) -> Result<Vec<Vec<f32>>, Error> {
        let device = self.folder.network.device();
        let condition = match (&self.prompts, self.folder.network.config().condition) {
            (Some(encoder), _) => {
                let texts: Vec<&str> = prompts.iter().map(|prompt| prompt.text).collect();
                Condition::text(&encoder.encode(&texts)?, &device)?
            }
            (None, ConditionKind::Unconditioned) => Condition::Nothing,
            (None, kind) => {
                let expected = format!("{kind:?}");
                return Err(Error::input("Prompts", expected, "words"));
            }
        };
        let schedule = self.schedule(sampling)?;
        let guidance = match self.prompts {
            Some(_) if !self.folder.is_unguided() => sampling.guidance,
            _ => 1.0,
        };
        let guides = sampling.guides.guides(&self.folder.statistics)?;
        let lengths = lengths(prompts);
        let seeds: Vec<u64> = prompts.iter().map(|prompt| prompt.seed).collect();
        let request = GenerateRequest {
            condition: &condition,
            lengths: &lengths,
            seeds: &seeds,
            guidance,
            edit: match start {
                Start::Edit(edit) => Some(edit),
                Start::Nothing | Start::After(_) => None,
            },
            guides: &guides,
            context: None,
        };
        let sampler = Sampler::new(schedule, sampling.method);
        let network = &self.folder.network;
        match start {
            Start::Nothing | Start::Edit(_) => {
                generate_whole(network, &sampler, request, frames, observe)
            }
            Start::After(after) => {
                let context = self.context(after, prompts.len())?;
                plan_motions(network, &sampler, request, &context, observe)
            }
        }
    }

    /// The steps of noise that are walked.
    fn schedule(&self, sampling: Sampling) -> Result<Schedule, Error> {
        match sampling.steps {
            None => Ok(self.schedule.clone()),
            Some(steps) => self.schedule.respaced(steps),
        }
    }

    /// Normalised features as they are.
    fn features(
        &self,
        motions: Vec<Vec<f32>>,
        smooth_hz: Option<f64>,
    ) -> Result<Vec<MotionFeatures>, Error> {
        let statistics = &self.folder.statistics;
        let motions = motions.into_iter().map(|mut motion| {
            statistics.denormalise(&mut motion);
            let skeleton = statistics.skeleton();
            let made = MotionFeatures::new(self.frame_rate, skeleton, motion)?;
            Ok(match smooth_hz {
                Some(cutoff_hz) => made.low_passed(cutoff_hz)?,
                None => made,
            })
        });
        motions.collect()
    }
}

/// Refuses texts of the upper body, where there is one pass only.
fn undivided(prompts: &[Prompt<'_>]) -> Result<(), Error> {
    let divided = prompts.iter().filter(|prompt| prompt.upper_body.is_some());
    match divided.count() {
        0 => Ok(()),
        found => Err(Error::input("Texts of the upper body", "none here", found)),
    }
}

fn lengths(prompts: &[Prompt<'_>]) -> Vec<usize> {
    prompts.iter().map(|prompt| prompt.frames).collect()
}
