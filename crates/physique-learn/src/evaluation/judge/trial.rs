//! Many motions of each label before the judge.

use std::collections::BTreeMap;

use physique_data::{Dataset, Split, Wording};
use physique_motion::features::{MotionFeatures, recover_from_positions};
use serde::Serialize;

use super::neighbours::labelled;
use super::sides::other_side;
use super::{ContentJudge, JudgeAccuracy, MotionQuality};
use crate::Error;
use crate::evaluation::Prompt;
use crate::random::Random;

/// Told apart from all other uses of a seed.
const PURPOSE: u64 = 0x0074_7269_616C;
/// Lengths are multiples of this, as those of windows to train with.
const UNIT: usize = 4;

/// What is asked of a generator.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct TrialOptions {
    /// Which label of the clips.
    pub label: String,
    /// How many of its values: those with most seconds to train with.
    pub values: usize,
    /// Motions for each value.
    pub samples: usize,
    /// Which captions.
    pub wording: Wording,
    /// Another seed asks for others.
    pub seed: u64,
}

impl Default for TrialOptions {
    /// `content`, ten values, 20 motions each, training wordings, seed 10.
    fn default() -> Self {
        Self {
            label: "content".into(),
            values: 10,
            samples: 20,
            wording: Wording::Training,
            seed: 10,
        }
    }
}

/// Motions to ask a generator for.
#[derive(Clone, Debug)]
pub struct Trial {
    /// Values of the label, most common first.
    pub values: Vec<String>,
    /// Value after value, as many for each.
    pub prompts: Vec<Prompt>,
    /// By prompt: the index of its value.
    asked: Vec<usize>,
    label: String,
    wording: Wording,
}

/// What became of a trial.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct TrialReport {
    /// The label.
    pub label: String,
    /// Whether the captions were among those to train with.
    pub wording: Wording,
    /// How far the judge can be trusted: real clips of the validation split.
    pub judge: JudgeAccuracy,
    /// By value.
    pub rows: Vec<TrialRow>,
    /// All of them together.
    pub all: TrialRow,
}

/// What became of the motions of a value.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct TrialRow {
    /// The value.
    pub value: String,
    /// Motions.
    pub samples: usize,
    /// Those that are taken for it.
    pub right: usize,
    /// Those that are taken for its mirror image.
    pub swapped: usize,
    /// What the others, swapped ones among them, are taken for, and how many.
    pub taken_for: BTreeMap<String, usize>,
    /// Mean of the motions.
    pub quality: MotionQuality,
    /// Mean of real clips of the same value.
    pub real: MotionQuality,
}

impl Trial {
    /// Draws captions and lengths: each of a clip to train with, that carries the value.
    ///
    /// # Errors
    /// [`Error::Input`] where no clip carries the label, or a value has no captions of the wording.
    pub fn new(dataset: &Dataset, options: &TrialOptions) -> Result<Self, Error> {
        let index = dataset.index();
        let mut clips: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for clip in dataset.clips_of(Split::Train) {
            if let Some(value) = index.clips[clip].labels.get(&options.label) {
                clips.entry(value).or_default().push(clip);
            }
        }
        let seconds = |clips: &[usize]| {
            clips
                .iter()
                .map(|&clip| index.clips[clip].frames)
                .sum::<usize>()
        };
        let mut values: Vec<(&str, Vec<usize>)> = clips.into_iter().collect();
        values.sort_by_key(|(value, clips)| (usize::MAX - seconds(clips), *value));
        values.truncate(options.values);
        if values.is_empty() || options.samples == 0 {
            let expected = format!(
                "clips to train with that carry the label `{}`",
                options.label
            );
            return Err(Error::input("Trial", expected, "none"));
        }
        let (mut prompts, mut asked) = (Vec::new(), Vec::new());
        for (number, (value, clips)) in values.iter().enumerate() {
            let with_captions: Vec<(usize, &[usize])> = clips
                .iter()
                .map(|&clip| {
                    let set = &index.caption_sets[index.clips[clip].captions];
                    let captions = match options.wording {
                        Wording::Training => &set.training,
                        Wording::HeldOut => &set.held_out,
                    };
                    (clip, captions.as_slice())
                })
                .filter(|(_, captions)| !captions.is_empty())
                .collect();
            if with_captions.is_empty() {
                let expected = format!("{:?} captions for `{value}`", options.wording);
                return Err(Error::input("Trial", expected, "none"));
            }
            for sample in 0..options.samples {
                let path = [options.seed, PURPOSE, number as u64, sample as u64];
                let mut random = Random::new(&path);
                let (clip, captions) = with_captions[random.below(with_captions.len())];
                let frames = index.clips[clip].frames.min(index.longest_window);
                prompts.push(Prompt {
                    caption: index.captions[captions[random.below(captions.len())]].clone(),
                    frames: (frames / UNIT).max(1) * UNIT,
                    seed: random.bits(),
                });
                asked.push(number);
            }
        }
        Ok(Self {
            values: values
                .iter()
                .map(|(value, _)| (*value).to_owned())
                .collect(),
            prompts,
            asked,
            label: options.label.clone(),
            wording: options.wording,
        })
    }

    /// Lets the judge look at the motions that the prompts gave, in their order.
    ///
    /// # Errors
    /// [`Error::Input`] when the counts disagree; those of judge and data set.
    pub fn report(
        &self,
        dataset: &Dataset,
        judge: &ContentJudge,
        motions: &[MotionFeatures],
    ) -> Result<TrialReport, Error> {
        if motions.len() != self.prompts.len() {
            let expected = format!("{}, one a prompt", self.prompts.len());
            return Err(Error::input("Motions", expected, motions.len()));
        }
        let real = self.real(dataset)?;
        let mut rows = Vec::with_capacity(self.values.len());
        for (number, (value, real)) in self.values.iter().zip(real).enumerate() {
            let mut row = TrialRow {
                value: value.clone(),
                real,
                ..TrialRow::default()
            };
            let other = other_side(value);
            let mut qualities = Vec::new();
            for (motion, _) in motions
                .iter()
                .zip(&self.asked)
                .filter(|(_, asked)| **asked == number)
            {
                let label = judge.judge(motion)?.label;
                row.samples += 1;
                if label == value {
                    row.right += 1;
                } else {
                    row.swapped += usize::from(other.as_deref() == Some(label));
                    *row.taken_for.entry(label.to_owned()).or_default() += 1;
                }
                qualities.push(MotionQuality::of(&recover_from_positions(motion)?)?);
            }
            row.quality = MotionQuality::mean(&qualities);
            rows.push(row);
        }
        Ok(TrialReport {
            label: self.label.clone(),
            wording: self.wording,
            judge: judge.accuracy(dataset, Split::Validation, &self.label)?,
            all: together(&rows),
            rows,
        })
    }

    /// Mean quality of the real clips of each value.
    fn real(&self, dataset: &Dataset) -> Result<Vec<MotionQuality>, Error> {
        let mut qualities = vec![Vec::new(); self.values.len()];
        for (features, value) in labelled(dataset, Split::Train, &self.label)? {
            if let Some(number) = self.values.iter().position(|known| *known == value) {
                qualities[number].push(MotionQuality::of(&recover_from_positions(&features)?)?);
            }
        }
        Ok(qualities.iter().map(|of| MotionQuality::mean(of)).collect())
    }
}

/// Sums, and means over values.
fn together(rows: &[TrialRow]) -> TrialRow {
    let mut all = TrialRow {
        value: "all".into(),
        quality: MotionQuality::mean(&rows.iter().map(|row| row.quality).collect::<Vec<_>>()),
        real: MotionQuality::mean(&rows.iter().map(|row| row.real).collect::<Vec<_>>()),
        ..TrialRow::default()
    };
    for row in rows {
        all.samples += row.samples;
        all.right += row.right;
        all.swapped += row.swapped;
        for (label, count) in &row.taken_for {
            *all.taken_for.entry(label.clone()).or_default() += count;
        }
    }
    all
}
