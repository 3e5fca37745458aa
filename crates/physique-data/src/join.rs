//! Several data files as one.

use std::collections::{BTreeMap, BTreeSet, HashMap};
use std::path::Path;

use physique::motion::features::StatisticsGatherer;

use crate::file::Writer;
use crate::report::Amount;
use crate::{BuildReport, Caption, CaptionSet, Clip, Dataset, Error, Index, Recording};

/// Label that tells which data set a clip of a joined file is from.
pub const SET_LABEL: &str = "set";

/// Writes the clips of several data files into one, with statistics of all of them, so that one
/// network can be trained on them all. Splits and captions stay as they are; clips get the label
/// [`SET_LABEL`], recordings the data set's name in front of theirs; windows are as short and as
/// long as any of the files allows. A wording that one of the files trains with is held out in none.
///
/// The file appears whole or not at all. Cost: some 2 microseconds a row; memory for the index.
///
/// # Errors
/// [`Error::Join`] for files of other storage, skeletons or frame rates than the first, or for none;
/// [`Error::Motion`] for damaged rows; those of writing.
pub fn join(sets: &[Dataset], output: &Path) -> Result<BuildReport, Error> {
    let (first, _) = sets.split_first().ok_or_else(|| Error::Join {
        what: "number of data files",
        expected: "1 or more".into(),
        found: "0".into(),
    })?;
    for set in sets {
        fits(first.index(), set.index())?;
    }
    let mut joined = Joined::new(first.index());
    let mut writer = Writer::create(output, first.index().columns())?;
    let mut gatherer = StatisticsGatherer::new(first.skeleton());
    for set in sets {
        let first_row = writer.rows();
        for recording in 0..set.index().recordings.len() {
            writer.append(set.recording_rows(recording)?)?;
        }
        for clip in 0..set.index().clips.len() {
            gatherer.add(&set.features(set.whole(clip)?)?)?;
        }
        joined.add(set.index(), first_row);
    }
    let statistics = gatherer.finish()?;
    joined.index.mean = statistics.mean().to_vec();
    joined.index.deviation = statistics.deviation().to_vec();
    let index = joined.finish();
    writer.finish(&index)?;
    Ok(index.report)
}

fn fits(first: &Index, other: &Index) -> Result<(), Error> {
    let both = [
        (
            "storage",
            format!("{:?}", first.storage),
            format!("{:?}", other.storage),
        ),
        (
            "skeleton",
            format!("{:?}", first.skeleton),
            format!("{:?}", other.skeleton),
        ),
        (
            "frame rate",
            first.frame_rate.to_string(),
            other.frame_rate.to_string(),
        ),
    ];
    match both.into_iter().find(|(_, first, other)| first != other) {
        None => Ok(()),
        Some((what, expected, found)) => Err(Error::Join {
            what,
            expected: format!("{expected}, as of {}", first.name),
            found: format!("{found} in {}", other.name),
        }),
    }
}

/// The index of the whole in the making.
struct Joined {
    index: Index,
    names: Vec<String>,
    licences: Vec<String>,
    attributions: Vec<String>,
    caption_numbers: HashMap<Caption, usize>,
}

impl Joined {
    fn new(first: &Index) -> Self {
        Self {
            index: Index {
                recordings: Vec::new(),
                clips: Vec::new(),
                captions: Vec::new(),
                caption_sets: Vec::new(),
                report: BuildReport::default(),
                physique_version: env!("CARGO_PKG_VERSION").to_owned(),
                ..first.clone()
            },
            names: Vec::new(),
            licences: Vec::new(),
            attributions: Vec::new(),
            caption_numbers: HashMap::new(),
        }
    }

    /// Adds what a file knows; its rows begin at `first_row`.
    fn add(&mut self, of: &Index, first_row: u64) {
        self.names.push(of.name.clone());
        self.licences.push(format!("{}: {}", of.name, of.licence));
        self.attributions
            .push(format!("{}: {}", of.name, of.attribution));
        let index = &mut self.index;
        index.shortest_window = index.shortest_window.min(of.shortest_window);
        index.longest_window = index.longest_window.max(of.longest_window);

        let mut numbers = Vec::with_capacity(of.captions.len());
        for caption in &of.captions {
            let next = index.captions.len();
            let number = *self.caption_numbers.entry(caption.clone()).or_insert(next);
            if number == next {
                index.captions.push(caption.clone());
            }
            numbers.push(number);
        }
        let renumbered = |captions: &[usize]| captions.iter().map(|&old| numbers[old]).collect();
        let (recordings, sets) = (index.recordings.len(), index.caption_sets.len());
        let new = of.caption_sets.iter().map(|set| CaptionSet {
            training: renumbered(&set.training),
            weights: set.weights.clone(),
            held_out: renumbered(&set.held_out),
        });
        index.caption_sets.extend(new);
        let mut row = first_row;
        for recording in &of.recordings {
            index.recordings.push(Recording {
                name: format!("{}/{}", of.name, recording.name),
                first_row: row,
                rows: recording.rows,
            });
            row += recording.rows as u64;
        }
        index.clips.extend(of.clips.iter().map(|clip| {
            let mut labels = clip.labels.clone();
            labels.insert(SET_LABEL.to_owned(), of.name.clone());
            Clip {
                recording: recordings + clip.recording,
                captions: sets + clip.captions,
                labels,
                ..clip.clone()
            }
        }));
        add_report(&mut index.report, &of.name, &of.report);
    }

    fn finish(mut self) -> Index {
        let index = &mut self.index;
        index.name = self.names.join(" + ");
        index.licence = self.licences.join("; ");
        index.attribution = self.attributions.join("; ");
        let training = index.caption_sets.iter().flat_map(|set| &set.training);
        let training: BTreeSet<usize> = training.copied().collect();
        for set in &mut index.caption_sets {
            set.held_out.retain(|caption| !training.contains(caption));
        }
        let held_out = index.caption_sets.iter().flat_map(|set| &set.held_out);
        let held_out: BTreeSet<usize> = held_out.copied().collect();
        index.report.training_captions = training.len();
        index.report.held_out_captions = held_out.len();
        let seconds = |clip: &Clip| clip.frames as f64 / index.frame_rate;
        let mut by_set: BTreeMap<String, Amount> = BTreeMap::new();
        for clip in &index.clips {
            let set = clip.labels.get(SET_LABEL).cloned().unwrap_or_default();
            by_set.entry(set).or_default().add(seconds(clip));
        }
        index.report.labels.insert(SET_LABEL.to_owned(), by_set);
        self.index
    }
}

/// Adds up what was found, by name of the set where names could collide.
fn add_report(sum: &mut BuildReport, name: &str, of: &BuildReport) {
    let add = |sum: &mut Amount, of: &Amount| {
        sum.clips += of.clips;
        sum.hours += of.hours;
    };
    sum.found += of.found;
    sum.unnamed_files += of.unnamed_files;
    add(&mut sum.recorded, &of.recorded);
    for (split, amount) in &of.splits {
        add(sum.splits.entry(*split).or_default(), amount);
    }
    for (label, values) in &of.labels {
        let sum = sum.labels.entry(label.clone()).or_default();
        for (value, amount) in values {
            add(sum.entry(value.clone()).or_default(), amount);
        }
    }
    sum.left_out
        .extend(of.left_out.iter().map(|left_out| crate::LeftOut {
            name: format!("{name}/{}", left_out.name),
            ..left_out.clone()
        }));
    let notes = of.notes.iter().map(|note| format!("{name}: {note}"));
    sum.notes.extend(notes);
}
