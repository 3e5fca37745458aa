//! HumanML3D and KIT-ML folders as their users have them.
//!
//! | file | what |
//! |---|---|
//! | `new_joint_vecs/NAME.npy` | features |
//! | `texts/NAME.txt` | a line a caption: `caption#lemma/POS words#from#to` |
//! | `train.txt`, `val.txt`, `test.txt` | names |
//! | `Mean.npy`, `Std.npy` | statistics; taken of all clips where they are missing |

mod texts;

use std::collections::BTreeSet;
use std::path::Path;

use physique::motion::features::{FeatureSkeleton, FeatureStatistics, MotionFeatures};
use physique::motion::npz::{Array, ArrayLimits};
use physique::motion::{FrameRate, Limits};
use physique_files::read_file;
use serde::{Deserialize, Serialize};

use super::{About, Draft, DraftClip, Outcome, Plan, Sayings, SplitBy, Work, left_out};
use crate::index::SkeletonName;
use crate::recipe::Labels;
use crate::{DataLimits, Error, LeftOut, Reason, Split, Storage};
use texts::Line;

/// Which published data set.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum PublishedSet {
    /// HumanML3D: 22 joints, 263 features, 20 frames a second, 40 to 199 frames.
    HumanMl3d,
    /// KIT-ML: 21 joints, 251 features, 12.5 frames a second, 24 to 199 frames.
    Kit,
}

/// Frames that a clip must stay below.
const FRAMES_BELOW: usize = 200;
/// Rows of the longest window.
const LONGEST_WINDOW: usize = 196;
/// Frames a second that the times of captions are counted with, in both data sets: as published.
const TAGS_PER_SECOND: f64 = 20.0;

impl PublishedSet {
    /// The set of this name, which commands take in place of a recipe.
    pub fn named(name: &str) -> Option<Self> {
        match name {
            "humanml3d" => Some(Self::HumanMl3d),
            "kit" => Some(Self::Kit),
            _ => None,
        }
    }

    const fn skeleton(self) -> SkeletonName {
        match self {
            Self::HumanMl3d => SkeletonName::Humanml3d,
            Self::Kit => SkeletonName::Kit,
        }
    }

    /// Rows of the shortest clip.
    const fn shortest(self) -> usize {
        match self {
            Self::HumanMl3d => 40,
            Self::Kit => 24,
        }
    }

    fn about(self) -> About {
        let (name, licence, attribution, frame_rate) = match self {
            Self::HumanMl3d => (
                "humanml3d",
                "of AMASS and HumanAct12, whose terms allow research only",
                "HumanML3D (Guo et al., 2022), AMASS (Mahmood et al., 2019), HumanAct12",
                20.0,
            ),
            Self::Kit => (
                "kit",
                "of the KIT Motion-Language Dataset",
                "The KIT Motion-Language Dataset (Plappert et al., 2016)",
                12.5,
            ),
        };
        About {
            name: name.into(),
            licence: licence.into(),
            attribution: attribution.into(),
            storage: Storage::Features,
            skeleton: self.skeleton(),
            frame_rate,
            windows: (self.shortest(), LONGEST_WINDOW),
            told: BTreeSet::new(),
        }
    }
}

pub(super) fn work<'a>(
    set: PublishedSet,
    folder: &'a Path,
    limits: &'a DataLimits,
) -> Result<Work<'a>, Error> {
    let (listed, left_out) = lists(folder, limits)?;
    let about = set.about();
    let reader = Reader {
        set,
        folder,
        limits,
        frame_rate: FrameRate::new(about.frame_rate)?,
    };
    let (mean, deviation) = (folder.join("Mean.npy"), folder.join("Std.npy"));
    let mut plan = Plan {
        jobs: listed.len(),
        left_out,
        ..Plan::default()
    };
    let statistics = if mean.exists() && deviation.exists() {
        Some(FeatureStatistics::read(
            mean,
            deviation,
            &Limits::default(),
        )?)
    } else {
        plan.notes.push(
            "Mean.npy and Std.npy are missing: both were taken of all clips that were kept.".into(),
        );
        None
    };
    Ok(Work {
        about,
        plan,
        look: Box::new(move |job| {
            let (name, split) = &listed[job];
            reader.look(name, *split)
        }),
        statistics,
    })
}

/// Names of the three lists with their splits; a name that stands on two lists is told.
#[allow(clippy::type_complexity)] // Two lists.
fn lists(
    folder: &Path,
    limits: &DataLimits,
) -> Result<(Vec<(String, Split)>, Vec<LeftOut>), Error> {
    let mut seen = std::collections::HashMap::new();
    let (mut listed, mut left_out) = (Vec::new(), Vec::new());
    let files = [
        ("train.txt", Split::Train),
        ("val.txt", Split::Validation),
        ("test.txt", Split::Test),
    ];
    for (file, split) in files {
        let text = texts::read(&folder.join(file), limits)?;
        let names = text.lines().map(str::trim).filter(|name| !name.is_empty());
        for name in names {
            if name.contains(['/', '\\']) || name.contains("..") {
                return Err(Error::Table {
                    path: folder.join(file),
                    place: format!("name {name:?}"),
                    expected: "the name of a clip",
                    found: "a path".into(),
                });
            }
            match seen.insert(name.to_owned(), file) {
                None => listed.push((name.to_owned(), split)),
                Some(other) => left_out.push(LeftOut {
                    name: name.to_owned(),
                    reason: Reason::Duplicate,
                    message: format!("{file} lists it again, after {other}."),
                }),
            }
        }
    }
    Ok((listed, left_out))
}

struct Reader<'a> {
    set: PublishedSet,
    folder: &'a Path,
    limits: &'a DataLimits,
    frame_rate: FrameRate,
}

impl Reader<'_> {
    fn look(&self, name: &str, split: Split) -> Vec<Outcome> {
        let mut outcomes = Vec::new();
        match self.draft(name, split, &mut outcomes) {
            Ok(draft) => outcomes.push(Outcome::Kept(draft)),
            Err((reason, message)) => outcomes.push(left_out(name, reason, message)),
        }
        outcomes
    }

    fn draft(
        &self,
        name: &str,
        split: Split,
        outcomes: &mut Vec<Outcome>,
    ) -> Result<Draft, (Reason, String)> {
        let features = self.features(name)?;
        let frames = features.frame_count();
        self.check_length(frames)?;
        let text = format!("texts/{name}.txt");
        let lines = texts::read(&self.folder.join(&text), self.limits)
            .map_err(|problem| (Reason::Text, self.plainly(&problem)))
            .and_then(|content| {
                let lines = texts::lines(&content);
                lines.map_err(|problem| (Reason::Text, format!("{text}, {problem}")))
            })?;

        let mut whole = Sayings::default();
        let mut clips = Vec::new();
        for line in lines {
            let Line { caption, span } = line;
            let Some((from, to)) = span else {
                whole.training.push((caption, 1.0));
                continue;
            };
            let start = ((from * TAGS_PER_SECOND) as usize).min(frames);
            let end = ((to * TAGS_PER_SECOND) as usize).clamp(start, frames);
            if let Err((reason, message)) = self.check_length(end - start) {
                let part = format!("{name}[{start}..{end}]");
                outcomes.push(left_out(&part, reason, message));
                continue;
            }
            let sayings = Sayings {
                training: vec![(caption, 1.0)],
                held_out: Vec::new(),
            };
            clips.push(clip(start, end - start, sayings));
        }
        if !whole.training.is_empty() {
            clips.insert(0, clip(0, frames, whole));
        }
        if clips.is_empty() {
            let message = format!("{text} has no caption of a part that is long enough.");
            return Err((Reason::NoCaption, message));
        }
        Ok(Draft {
            name: name.to_owned(),
            rows: features.values().to_vec(),
            row_count: frames,
            features: vec![features],
            clips,
            split: SplitBy::Given(split),
        })
    }

    fn features(&self, name: &str) -> Result<MotionFeatures, (Reason, String)> {
        let file = format!("new_joint_vecs/{name}.npy");
        let unreadable = |problem: String| (Reason::Unreadable, problem);
        let bytes = read_file(&self.folder.join(&file), Limits::default().bytes)
            .map_err(|problem| unreadable(self.plainly(&problem)))?;
        let array = Array::from_npy(&file, bytes, &ArrayLimits::default());
        let array = array.map_err(|problem| unreadable(problem.to_string()))?;
        let skeleton = FeatureSkeleton::from(self.set.skeleton());
        let columns = skeleton.feature_count();
        if array.shape().len() != 2 || array.shape()[1] != columns {
            let found = array.shape();
            let message = format!("{file}: expected shape [frames][{columns}], found {found:?}.");
            return Err(unreadable(message));
        }
        let values = array.to_f32();
        let values = values.map_err(|problem| unreadable(problem.to_string()))?;
        MotionFeatures::new(self.frame_rate, skeleton, values)
            .map_err(|problem| (Reason::NotFinite, problem.to_string()))
    }

    fn check_length(&self, frames: usize) -> Result<(), (Reason, String)> {
        let shortest = self.set.shortest();
        let expected = format!("{frames} frames; the data set takes {shortest} to 199.");
        match frames {
            frames if frames < shortest => Err((Reason::TooShort, expected)),
            frames if frames >= FRAMES_BELOW => Err((Reason::TooLong, expected)),
            _ => Ok(()),
        }
    }

    /// An error without the path of the folder.
    fn plainly(&self, problem: &impl ToString) -> String {
        let folder = format!("{}/", self.folder.display());
        problem.to_string().replace(&folder, "")
    }
}

const fn clip(start: usize, frames: usize, sayings: Sayings) -> DraftClip {
    DraftClip {
        start,
        frames,
        mirrored: false,
        labels: Labels::new(),
        sayings,
    }
}
