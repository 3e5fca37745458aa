//! The five most similar known motions.

use std::collections::BTreeMap;

use physique_data::{Dataset, Sampler, SamplerOptions, Split};
use physique_motion::features::MotionFeatures;
use rayon::prelude::*;

use super::{JudgeAccuracy, MotionDescription};
use crate::Error;

/// Neighbours that vote.
const NEIGHBOURS: usize = 5;
/// Least deviation that numbers are divided by: what hardly varies does not decide.
const LEAST_DEVIATION: f32 = 0.05;

/// Tells which of some labels a motion belongs to.
///
/// Each number of a description is divided by its deviation over all known motions; the five nearest
/// ones vote with one over their squared distance.
#[derive(Clone, Debug)]
pub struct ContentJudge {
    /// Of each number.
    mean: Vec<f32>,
    deviation: Vec<f32>,
    /// Of each known motion, normalised, and its label.
    known: Vec<(Vec<f32>, usize)>,
    labels: Vec<String>,
}

/// What a judge says of a motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Verdict<'a> {
    /// The label.
    pub label: &'a str,
    /// Share of the votes that it got, above 0 and at most 1.
    pub share: f64,
    /// Distance of the nearest known motion, in deviations of all numbers.
    pub distance: f64,
}

impl ContentJudge {
    /// A judge that knows these motions.
    ///
    /// # Errors
    /// [`Error::Input`] for fewer than five motions, or for those of two skeletons.
    pub fn new(examples: &[(MotionDescription, &str)]) -> Result<Self, Error> {
        if examples.len() < NEIGHBOURS {
            let expected = format!("at least {NEIGHBOURS}");
            return Err(Error::input("Known motions", expected, examples.len()));
        }
        let width = examples[0].0.numbers().len();
        if let Some((other, _)) = examples.iter().find(|(of, _)| of.numbers().len() != width) {
            let expected = format!("descriptions of {width} numbers");
            let found = other.numbers().len();
            return Err(Error::input("Known motions", expected, found));
        }
        let count = examples.len() as f32;
        let mut mean = vec![0.0; width];
        for (description, _) in examples {
            for (mean, number) in mean.iter_mut().zip(description.numbers()) {
                *mean += number / count;
            }
        }
        let mut deviation = vec![0.0; width];
        for (description, _) in examples {
            let numbers = description.numbers().iter().zip(&mean);
            for (sum, (number, mean)) in deviation.iter_mut().zip(numbers) {
                *sum += (number - mean) * (number - mean) / count;
            }
        }
        for square in &mut deviation {
            *square = square.sqrt().max(LEAST_DEVIATION);
        }
        let numbers: BTreeMap<&str, usize> =
            examples.iter().map(|&(_, label)| (label, 0)).collect();
        let labels: Vec<String> = numbers.keys().map(|&label| label.to_owned()).collect();
        let mut judge = Self {
            mean,
            deviation,
            known: Vec::with_capacity(examples.len()),
            labels,
        };
        for (description, label) in examples {
            let known = judge
                .labels
                .binary_search_by(|known| known.as_str().cmp(label));
            let normalised = judge.normalised(description);
            judge.known.push((normalised, known.unwrap_or_default()));
        }
        Ok(judge)
    }

    /// A judge that knows the clips of a split by one of their labels; each clip once, as a step of
    /// training would see it.
    ///
    /// # Errors
    /// [`Error::Input`] where fewer than five clips carry the label; those of the data set.
    pub fn of_dataset(dataset: &Dataset, split: Split, label: &str) -> Result<Self, Error> {
        let clips = labelled(dataset, split, label)?;
        let examples = clips.iter();
        let examples: Vec<_> = examples
            .map(|(features, label)| (MotionDescription::of(features), label.as_str()))
            .collect();
        Self::new(&examples)
    }

    /// What a motion shows.
    ///
    /// # Errors
    /// [`Error::Input`] for a motion of another skeleton.
    pub fn judge(&self, features: &MotionFeatures) -> Result<Verdict<'_>, Error> {
        let description = MotionDescription::of(features);
        if description.numbers().len() != self.mean.len() {
            let expected = format!("{} numbers, as known ones have", self.mean.len());
            let found = description.numbers().len();
            return Err(Error::input("Description of a motion", expected, found));
        }
        let asked = self.normalised(&description);
        let distance = |known: &[f32]| {
            let squares = known
                .iter()
                .zip(&asked)
                .map(|(a, b)| f64::from(a - b).powi(2));
            squares.sum::<f64>()
        };
        let mut distances: Vec<(f64, usize)> = self
            .known
            .iter()
            .map(|(known, label)| (distance(known), *label))
            .collect();
        let (nearest, ..) = distances.select_nth_unstable_by(NEIGHBOURS - 1, |a, b| {
            a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
        });
        let mut neighbours = nearest.to_vec();
        neighbours.push(distances[NEIGHBOURS - 1]);
        let mut votes = vec![0.0; self.labels.len()];
        for &(square, label) in &neighbours {
            votes[label] += 1.0 / (square + 1e-3);
        }
        let all: f64 = votes.iter().sum();
        let nearest = neighbours.iter().map(|(square, _)| *square);
        let (best, most) =
            votes
                .iter()
                .enumerate()
                .fold((0, 0.0), |(best, most), (label, &votes)| {
                    if votes > most {
                        (label, votes)
                    } else {
                        (best, most)
                    }
                });
        Ok(Verdict {
            label: &self.labels[best],
            share: most / all,
            distance: nearest.fold(f64::INFINITY, f64::min).sqrt(),
        })
    }

    /// Labels that the judge knows, sorted.
    pub fn labels(&self) -> &[String] {
        &self.labels
    }

    /// How many clips of a split the judge is right about: how far it can be trusted, where the split is
    /// not the one it knows.
    ///
    /// # Errors
    /// [`Error::Input`] where no clip carries the label; those of the data set.
    pub fn accuracy(
        &self,
        dataset: &Dataset,
        split: Split,
        label: &str,
    ) -> Result<JudgeAccuracy, Error> {
        let clips = labelled(dataset, split, label)?;
        if clips.is_empty() {
            let expected = format!("clips with the label `{label}`");
            return Err(Error::input("Split", expected, "none"));
        }
        let mut right = 0;
        for (features, label) in &clips {
            right += usize::from(self.judge(features)?.label == label);
        }
        Ok(JudgeAccuracy {
            right,
            clips: clips.len(),
        })
    }

    fn normalised(&self, description: &MotionDescription) -> Vec<f32> {
        let statistics = self.mean.iter().zip(&self.deviation);
        let numbers = description.numbers().iter().zip(statistics);
        numbers
            .map(|(number, (mean, deviation))| (number - mean) / deviation)
            .collect()
    }
}

/// A window of each clip of a split that carries a label, and the label's value.
pub(super) fn labelled(
    dataset: &Dataset,
    split: Split,
    label: &str,
) -> Result<Vec<(MotionFeatures, String)>, Error> {
    let options = SamplerOptions {
        split,
        ..SamplerOptions::default()
    };
    let sampler = Sampler::new(dataset, options)?;
    let drawn = sampler.draw(0, 0, sampler.clip_count());
    let clips: Vec<_> = drawn
        .into_iter()
        .filter_map(|drawn| {
            let value = dataset.index().clips[drawn.window.clip].labels.get(label)?;
            Some((drawn.window, value.clone()))
        })
        .collect();
    let made: Vec<Result<_, Error>> = clips
        .into_par_iter()
        .map(|(window, value)| Ok((dataset.features(window)?, value)))
        .collect();
    made.into_iter().collect()
}
