//! Drafts to an index: captions shared, splits assigned, everything counted.

use std::collections::{BTreeMap, BTreeSet, HashMap};

use physique::motion::features::{FeatureSkeleton, FeatureStatistics};

use crate::recipe::SplitRule;
use crate::source::{About, Draft, Plan, Sayings, SplitBy};
use crate::{BuildReport, Caption, CaptionSet, Clip, Error, Index, LeftOut, Recording, Split};

/// Training captions, the bits of their weights, held-out captions.
type SetKey = (Vec<usize>, Vec<u32>, Vec<usize>);

/// An index in the making.
#[derive(Debug)]
pub(super) struct Assembly {
    index: Index,
    /// Labels that the report counts by.
    told: BTreeSet<String>,
    /// By recording.
    splits: Vec<SplitBy>,
    caption_numbers: HashMap<Caption, usize>,
    /// Sets by their captions and the bits of their weights.
    set_numbers: HashMap<SetKey, usize>,
}

impl Assembly {
    pub(super) fn new(about: About, plan: Plan) -> Self {
        let index = Index {
            name: about.name,
            licence: about.licence,
            attribution: about.attribution,
            physique_version: env!("CARGO_PKG_VERSION").to_owned(),
            storage: about.storage,
            skeleton: about.skeleton,
            frame_rate: about.frame_rate,
            shortest_window: about.windows.0,
            longest_window: about.windows.1,
            mean: Vec::new(),
            deviation: Vec::new(),
            recordings: Vec::new(),
            clips: Vec::new(),
            captions: Vec::new(),
            caption_sets: Vec::new(),
            report: BuildReport {
                unnamed_files: plan.unnamed_files,
                left_out: plan.left_out,
                notes: plan.notes,
                ..BuildReport::default()
            },
        };
        Self {
            index,
            told: about.told,
            splits: Vec::new(),
            caption_numbers: HashMap::new(),
            set_numbers: HashMap::new(),
        }
    }

    pub(super) fn skeleton(&self) -> FeatureSkeleton {
        self.index.skeleton.into()
    }

    pub(super) fn columns(&self) -> usize {
        self.index.columns()
    }

    pub(super) const fn is_empty(&self) -> bool {
        self.index.clips.is_empty()
    }

    /// Motions looked at so far, and those that were left out unseen.
    pub(super) const fn found(&self) -> usize {
        self.index.recordings.len() + self.index.report.left_out.len()
    }

    pub(super) fn first_left_out(&self) -> Option<&LeftOut> {
        self.index.report.left_out.first()
    }

    pub(super) fn leave_out(&mut self, left_out: LeftOut) {
        self.index.report.left_out.push(left_out);
    }

    pub(super) fn keep(&mut self, first_row: u64, draft: Draft) {
        let recording = self.index.recordings.len();
        self.index.recordings.push(Recording {
            name: draft.name,
            first_row,
            rows: draft.row_count,
        });
        self.splits.push(draft.split);
        for clip in draft.clips {
            let captions = self.caption_set(clip.sayings);
            self.index.clips.push(Clip {
                recording,
                start: clip.start,
                frames: clip.frames,
                mirrored: clip.mirrored,
                // Assigned when all are known.
                split: Split::Train,
                captions,
                labels: clip.labels,
            });
        }
    }

    fn caption_set(&mut self, sayings: Sayings) -> usize {
        let mut set = CaptionSet::default();
        for (caption, weight) in sayings.training {
            set.training.push(self.caption(caption));
            set.weights.push(weight);
        }
        for caption in sayings.held_out {
            set.held_out.push(self.caption(caption));
        }
        let bits = set.weights.iter().map(|weight| weight.to_bits()).collect();
        let key = (set.training.clone(), bits, set.held_out.clone());
        let next = self.index.caption_sets.len();
        let number = *self.set_numbers.entry(key).or_insert(next);
        if number == next {
            self.index.caption_sets.push(set);
        }
        number
    }

    fn caption(&mut self, caption: Caption) -> usize {
        let next = self.index.captions.len();
        let number = *self.caption_numbers.entry(caption.clone()).or_insert(next);
        if number == next {
            self.index.captions.push(caption);
        }
        number
    }

    /// The index, with its report.
    pub(super) fn finish(
        mut self,
        statistics: &FeatureStatistics,
        rule: Option<&SplitRule>,
    ) -> Result<Index, Error> {
        let splits = self.assigned(rule);
        for clip in &mut self.index.clips {
            clip.split = splits[clip.recording];
        }
        if statistics.skeleton() != self.skeleton() {
            return Err(physique::motion::Error::FeatureCount {
                columns: self.skeleton().feature_count(),
                found: statistics.mean().len(),
            }
            .into());
        }
        self.index.mean = statistics.mean().to_vec();
        self.index.deviation = statistics.deviation().to_vec();
        count(&mut self.index, &self.told);
        Ok(self.index)
    }

    /// The split of each recording.
    fn assigned(&self, rule: Option<&SplitRule>) -> Vec<Split> {
        let recordings = self.index.recordings.iter();
        let named: Vec<(&str, &str)> = recordings
            .zip(&self.splits)
            .map(|(recording, split)| match split {
                SplitBy::Rule(group) => (recording.name.as_str(), group.as_str()),
                SplitBy::Given(_) => (recording.name.as_str(), ""),
            })
            .collect();
        let by_rule = rule.map(|rule| rule.assign(&named));
        let each = self.splits.iter().enumerate();
        each.map(|(recording, split)| match (split, &by_rule) {
            (SplitBy::Given(split), _) => *split,
            (SplitBy::Rule(_), Some(by_rule)) => by_rule[recording],
            (SplitBy::Rule(_), None) => Split::Train,
        })
        .collect()
    }
}

/// Fills the figures of the report; labels that are `told` become tables.
fn count(index: &mut Index, told: &BTreeSet<String>) {
    let mut report = std::mem::take(&mut index.report);
    report.found = index.recordings.len() + report.left_out.len();
    for recording in &index.recordings {
        let seconds = index.feature_rows(recording) as f64 / index.frame_rate;
        report.recorded.add(seconds);
    }
    let mut labels: BTreeMap<String, BTreeMap<String, _>> = BTreeMap::new();
    for clip in &index.clips {
        let seconds = clip.frames as f64 / index.frame_rate;
        report.splits.entry(clip.split).or_default().add(seconds);
        for (label, value) in clip
            .labels
            .iter()
            .filter(|(label, _)| told.contains(*label))
        {
            let values: &mut BTreeMap<String, crate::report::Amount> =
                labels.entry(label.clone()).or_default();
            values.entry(value.clone()).or_default().add(seconds);
        }
    }
    report.labels = labels;
    let mut in_training = vec![false; index.captions.len()];
    for &caption in index.caption_sets.iter().flat_map(|set| &set.training) {
        in_training[caption] = true;
    }
    report.training_captions = in_training.iter().filter(|&&is| is).count();
    report.held_out_captions = in_training.len() - report.training_captions;
    report.left_out.sort();
    index.report = report;
}
