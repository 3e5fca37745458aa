//! Which windows and captions a training step sees.

use std::collections::BTreeMap;

use crate::random::Random;
use crate::{Dataset, Error, Split, Window};

/// In which order clips are drawn.
#[derive(Clone, Debug, PartialEq)]
pub enum Order {
    /// Every clip once in each pass, in another order each time; what is left over of a pass when a
    /// batch is no longer full is dropped, as the published trainers do.
    Passes,
    /// A value of a label in proportion to the square root of its seconds, then any of its clips:
    /// rare contents are seen more often than their share, but not as often as common ones.
    BalancedBy(Balance),
}

/// The label that draws are balanced by.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Balance {
    /// Name of the label.
    pub label: String,
    /// By value of the label: how many times as often as balance alone would have it; 1 where
    /// nothing is said.
    pub favoured: BTreeMap<String, f64>,
}

impl From<&str> for Balance {
    fn from(label: &str) -> Self {
        Self {
            label: label.to_owned(),
            favoured: BTreeMap::new(),
        }
    }
}

/// What to draw.
#[derive(Clone, Debug, PartialEq)]
pub struct SamplerOptions {
    /// From which split.
    pub split: Split,
    /// In which order.
    pub order: Order,
    /// Lengths of windows are multiples of this many rows; the published data sets take 4.
    pub unit: usize,
    /// Rows of the longest window; `None`, and more than the data set's longest: that one.
    pub longest: Option<usize>,
}

impl Default for SamplerOptions {
    fn default() -> Self {
        Self {
            split: Split::Train,
            order: Order::Passes,
            unit: 4,
            longest: None,
        }
    }
}

/// A window and what is said of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Drawn {
    /// Which rows.
    pub window: Window,
    /// Which caption of the [`crate::Index`]; `None` where the clip has none.
    pub caption: Option<usize>,
}

/// Draws windows and captions: a pure function of the seed and the number of the step, so that a
/// run which was killed goes on with the very batches it would have seen.
#[derive(Clone, Debug)]
pub struct Sampler {
    options: SamplerOptions,
    /// Clips to draw from, and rows of each.
    clips: Vec<(usize, usize)>,
    /// Running sums of the weights of `groups`, and their members as indices of `clips`.
    group_weights: Vec<f64>,
    groups: Vec<Vec<usize>>,
    /// By caption set: the captions and running sums of their weights.
    captions: Vec<(Vec<usize>, Vec<f64>)>,
    /// By clip of the data set: its caption set.
    caption_set: Vec<usize>,
    shortest: usize,
    longest: usize,
}

impl Sampler {
    /// Prepares to draw from a data set.
    ///
    /// # Errors
    /// [`Error::NothingToDraw`] when the split has no clip of `unit` rows; [`Error::Favoured`] for a
    /// favoured value that no clip has, or a factor that is not above 0 and finite.
    pub fn new(dataset: &Dataset, options: SamplerOptions) -> Result<Self, Error> {
        let index = dataset.index();
        let unit = options.unit.max(1);
        let clips: Vec<(usize, usize)> = dataset
            .clips_of(options.split)
            .map(|clip| (clip, index.clips[clip].frames))
            .filter(|&(_, frames)| frames >= unit)
            .collect();
        if clips.is_empty() {
            return Err(Error::NothingToDraw {
                split: options.split.name(),
                frames: unit,
            });
        }
        let mut by_value: BTreeMap<&str, Vec<usize>> = BTreeMap::new();
        for (member, &(clip, _)) in clips.iter().enumerate() {
            let value = match &options.order {
                Order::Passes => "",
                Order::BalancedBy(balance) => index.clips[clip]
                    .labels
                    .get(&balance.label)
                    .map_or("", String::as_str),
            };
            by_value.entry(value).or_default().push(member);
        }
        let unfavoured = BTreeMap::new();
        let favoured = match &options.order {
            Order::Passes => &unfavoured,
            Order::BalancedBy(balance) => &balance.favoured,
        };
        for (value, &factor) in favoured {
            if !(by_value.contains_key(value.as_str()) && factor > 0.0 && factor.is_finite()) {
                return Err(Error::Favoured {
                    value: value.clone(),
                    factor,
                    known: by_value.keys().copied().collect::<Vec<_>>().join(", "),
                });
            }
        }
        let weight = |(value, members): (&&str, &Vec<usize>)| {
            let rows: usize = members.iter().map(|&member| clips[member].1).sum();
            (rows as f64).sqrt() * favoured.get(*value).copied().unwrap_or(1.0)
        };
        let captions = index.caption_sets.iter().map(|set| {
            let weights = set.weights.iter().copied().map(f64::from);
            (set.training.clone(), running_sums(weights))
        });
        Ok(Self {
            group_weights: running_sums(by_value.iter().map(weight)),
            groups: by_value.into_values().collect(),
            captions: captions.collect(),
            caption_set: index.clips.iter().map(|clip| clip.captions).collect(),
            shortest: index.shortest_window,
            longest: options
                .longest
                .map_or(index.longest_window, |rows| rows.min(index.longest_window)),
            clips,
            options: SamplerOptions { unit, ..options },
        })
    }

    /// Clips that are drawn from.
    pub fn clip_count(&self) -> usize {
        self.clips.len()
    }

    /// Steps of a pass over all clips, at least 1.
    pub fn steps_a_pass(&self, batch: usize) -> u64 {
        ((self.clips.len() / batch.max(1)) as u64).max(1)
    }

    /// What step `step` (from 0) of a run of this seed sees, with `batch` windows.
    pub fn draw(&self, seed: u64, step: u64, batch: usize) -> Vec<Drawn> {
        let order = match self.options.order {
            Order::Passes => self.pass(seed, step / self.steps_a_pass(batch)),
            Order::BalancedBy(_) => Vec::new(),
        };
        let first = (step % self.steps_a_pass(batch)) as usize * batch;
        let draw = |place: usize| {
            let mut random = Random::new(seed, &[step, place as u64]);
            let member = match order.is_empty() {
                false => order[(first + place) % order.len()],
                true => {
                    let members = &self.groups[random.weighted(&self.group_weights)];
                    members[random.below(members.len())]
                }
            };
            self.drawn(member, &mut random)
        };
        (0..batch).map(draw).collect()
    }

    /// All clips in the order of a pass.
    fn pass(&self, seed: u64, pass: u64) -> Vec<usize> {
        let mut order: Vec<usize> = (0..self.clips.len()).collect();
        // Steps count from 0, so that no step has this stream.
        Random::new(seed, &[u64::MAX, pass]).shuffle(&mut order);
        order
    }

    fn drawn(&self, member: usize, random: &mut Random) -> Drawn {
        let (clip, rows) = self.clips[member];
        let frames = self.length(rows, random);
        let start = random.below(rows - frames + 1);
        let (captions, weights) = &self.captions[self.caption_set[clip]];
        let caption = match captions.is_empty() {
            true => None,
            false => Some(captions[random.weighted(weights)]),
        };
        Drawn {
            window: Window {
                clip,
                start,
                frames,
            },
            caption,
        }
    }

    /// Rows of a window: nearly the whole clip, twice as often the greatest multiple of the unit as
    /// the one below it, as published; of a clip beyond the longest window that, or with equal
    /// chance any length from the shortest on.
    fn length(&self, rows: usize, random: &mut Random) -> usize {
        let unit = self.options.unit;
        let units = (rows.min(self.longest) / unit).max(1);
        let units = if rows > self.longest {
            let shortest = self.shortest.div_ceil(unit).min(units);
            match random.below(2) {
                0 => units,
                _ => shortest + random.below(units - shortest + 1),
            }
        } else {
            match random.below(3) {
                0 if units > 1 => units - 1,
                _ => units,
            }
        };
        units * unit
    }
}

fn running_sums(weights: impl Iterator<Item = f64>) -> Vec<f64> {
    weights
        .scan(0.0, |sum, weight| {
            *sum += weight;
            Some(*sum)
        })
        .collect()
}
